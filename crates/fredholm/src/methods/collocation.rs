//! φ_n(x_i) − (Aφ_n)(x_i) = f(x_i), φ_n = Σ_j α_j u_j (paper, §1.4.2, (1.47)–(1.48), whose right-hand side is f, not g).

use super::integrals::{images, sources};
use super::{Approximation, Discrete, Integrals};
use crate::equation::{Equation, EquationError, Scalar};
use crate::space::Basis;
use std::sync::Arc;

/// F_ij = (A u_j)(x_i) and s_i = f(x_i), (1.48). With the nodes' own rule for the integrals it is Nyström's (1.28).
pub fn discrete<T: Scalar>(
    equation: &Equation<'_, T>,
    basis: &dyn Basis,
    integrals: Integrals<'_>,
) -> Result<Discrete<T>, EquationError> {
    let matrix = images(equation, basis, basis.nodes(), integrals)?;
    Ok(Discrete::new(matrix, sources(equation, basis.nodes())?))
}

/// Collocation at the nodes of the space, with integrals to rounding.
pub fn solve<'e, T: Scalar>(
    equation: &'e Equation<'e, T>,
    basis: Arc<dyn Basis>,
) -> Result<Approximation<'e, T>, EquationError> {
    let coefficients = discrete(equation, &*basis, Integrals::Accurate)?.solve()?;
    Ok(Approximation::in_space(equation.components(), basis, coefficients))
}
