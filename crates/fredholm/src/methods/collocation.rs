//! φ_n(x_i) − (Aφ_n)(x_i) = f(x_i), φ_n = Σ_j α_j u_j (paper, §1.4.2, (1.47)–(1.48), whose right-hand side is f, not g).

use super::integrals::{images, sources};
use super::{Approximation, Discrete, Integrals};
use crate::equation::{EquationError, Scalar};
use crate::product::Product;
use crate::space::Basis;
use std::sync::Arc;

/// F_ij = (A u_j)(x_i) and s_i = f(x_i), (1.48). With the nodes' own rule for the integrals it is Nyström's (1.28).
pub fn discrete<T: Scalar>(
    product: &Product<'_, '_, T>,
    basis: &dyn Basis,
    integrals: Integrals<'_>,
) -> Result<Discrete<T>, EquationError> {
    let matrix = images(product, basis, basis.nodes(), integrals)?;
    Ok(Discrete::new(&matrix, sources(product.equation(), basis.nodes())?))
}

/// Collocation at the nodes of the space, with integrals to rounding.
pub fn solve<'e, T: Scalar>(
    product: &Product<'e, '_, T>,
    basis: Arc<dyn Basis>,
) -> Result<Approximation<'e, T>, EquationError> {
    let coefficients = discrete(product, &*basis, Integrals::Accurate)?.solve()?;
    Ok(Approximation::in_space(product.equation().components(), basis, coefficients))
}
