//! φ_n(x) = f(x) + Σ_k α_k K(x, x_k) φ_n(x_k): the integral replaced by a rule (paper, §1.2.3, (1.25)–(1.29)).
//!
//! The values φ_n(x_j) solve (1.28) (whose last row has α_2, not α_1), and (1.29) is the returned function.

use super::integrals::{sampled, sampled_row, sources};
use super::{Approximation, Discrete};
use crate::equation::{Equation, EquationError, Function, Scalar};
use crate::quadrature::Quadrature;

/// F_ij = α_j K(x_i, x_j) and s_i = f(x_i), (1.28).
pub fn discrete<T: Scalar>(
    equation: &Equation<'_, T>,
    rule: &Quadrature<f64>,
) -> Result<Discrete<T>, EquationError> {
    let m = equation.components();
    let line = |a: usize, x: f64| -> Result<Vec<T>, EquationError> {
        let rows = (0..m).map(|b| sampled_row(equation, (a, b), x, rule));
        Ok(rows.collect::<Result<Vec<_>, _>>()?.into_iter().flat_map(|row| row.weights).collect())
    };
    let points = (0..m).flat_map(|a| rule.nodes.iter().map(move |x| (a, *x)));
    let matrix = points.map(|(a, x)| line(a, x)).collect::<Result<Vec<_>, _>>()?;
    Ok(Discrete::new(&matrix, sources(equation, &rule.nodes)?))
}

/// Nyström's method with this rule; its interpolant (1.29) is the solution.
///
/// # Errors
///
/// [`EquationError::KernelNotFinite`] where the kernel is infinite at a pair of nodes: a singular kernel needs
/// collocation, or the automatic method.
pub fn solve<'e, T: Scalar>(
    equation: &'e Equation<'e, T>,
    rule: Quadrature<f64>,
) -> Result<Approximation<'e, T>, EquationError> {
    let coefficients = discrete(equation, &rule)?.solve()?;
    let interval = equation.interval();
    let (n, values) = (rule.nodes.len(), coefficients.values);
    let unknowns = values.len();
    let interpolant = move |a: usize, x: &f64| {
        let terms = values.chunks_exact(n).enumerate().map(|(b, phi)| {
            let kernel = sampled(equation, (a, b), *x, &rule.nodes);
            let kernel = kernel.unwrap_or_else(|_| vec![T::from(f64::NAN); n]);
            kernel.iter().zip(&rule.weights).zip(phi).map(|((k, w), phi)| *k * *w * *phi).sum::<T>()
        });
        equation.source(a, *x) + terms.sum::<T>()
    };
    Ok(Approximation {
        solution: Function::new(equation.components(), interpolant),
        breaks: vec![interval.a(), interval.b()],
        unknowns,
        condition: coefficients.condition,
    })
}
