//! φ_{n+1} = f + A φ_n: successive approximations from any φ_0 (paper, §1.2.2, (1.23), th. 1.6).
//!
//! They are a Neumann series: φ_n = φ_0 + Σ_{k < n} A^k d with d = f + A φ_0 − φ_0, the residual of the start; from φ_0 = 0
//! it is that of f. They converge for every f when the spectral radius of A is below 1.

use super::integrals::{or_nan, transform_resolved};
use super::neumann::Series;
use super::{Approximation, Yardstick};
use crate::equation::{EquationError, Function, Scalar};
use crate::product::Product;
use crate::space::resolve;
use std::sync::Arc;

/// φ_n after `steps` steps from `start`. `unknowns` is the number of steps.
pub fn solve<'e, T: Scalar>(
    product: &Arc<Product<'e, 'e, T>>,
    yardstick: Yardstick,
    start: &Function<'e, f64, T>,
    steps: usize,
) -> Result<Approximation<'e, T>, EquationError> {
    let equation = product.equation();
    let m = equation.components();
    let ends = vec![equation.interval().a(), equation.interval().b()];
    let (resolved, phi) = (resolve(start, &ends, MORE_PANELS), start.clone());
    if steps == 0 {
        let condition = yardstick.condition();
        return Ok(Approximation { solution: phi, breaks: ends, unknowns: 0, condition });
    }
    let own = product.clone();
    let residual = move |a: usize, x: &f64| {
        equation.source(a, *x) + or_nan(transform_resolved(&own, (a, *x), &resolved)) - phi.component(a, x)
    };
    let series = Series::of(product, yardstick, Function::new(m, residual))?;
    let (sum, phi) = (series.partial_sum(steps - 1), start.clone());
    let value = move |a: usize, x: &f64| phi.component(a, x) + sum.solution.component(a, x);
    let condition = yardstick.condition();
    Ok(Approximation { solution: Function::new(m, value), breaks: ends, unknowns: steps, condition })
}

/// Panels added to resolve φ_0.
const MORE_PANELS: usize = 48;
