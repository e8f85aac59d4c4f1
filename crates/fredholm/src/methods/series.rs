//! n with ‖(I − A)⁻¹‖ ‖A^{n+1} f‖ ≤ ε: how many terms of Σ A^k f, and whether they converge at all (paper, §1.2.1, §1.2.2).
//!
//! The front of [`super::neumann`] and [`super::successive`].

use super::growth::answer;
use super::neumann::{Series, largest};
use super::residual::judge;
use super::{Method, Setup, Yardstick};
use crate::equation::{Answer, EquationError, Scalar, Status};
use crate::product::Product;
use std::sync::Arc;

/// The most terms that are summed: with a spectral radius of 0.997 they give 13 digits.
const MOST: usize = 10_000;

/// The terms that a divergent series is searched for its best partial sum: an asymptotic one turns early.
const SEARCHED: usize = 50;

/// A term that is this part of ‖A‖ times the one before is what rounding left of 0.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

pub(super) fn solve<'e, T: Scalar>(
    product: &Arc<Product<'e, 'e, T>>,
    setup: &Setup,
    yardstick: Yardstick,
) -> Result<Answer<'e, f64, T>, EquationError> {
    let series = Series::new(product, yardstick)?;
    // n steps from φ_0 = 0 are the terms 0 … n − 1.
    let extra = usize::from(setup.method == Method::Successive);
    let n = match setup.n {
        Some(n) if n > MOST || n < extra => {
            return Err(EquationError::Method(format!(
                "{} takes n from {extra} to {MOST}, not {n}",
                setup.method
            )));
        }
        Some(n) => n - extra,
        None if series.converges() => enough(&series, setup.tolerance),
        None => smallest(&series),
    };
    let method = described(setup.method, n + extra, &series, series.remainder(n));
    let converges = series.converges();
    let mut approximation = series.partial_sum(n);
    approximation.unknowns += extra;
    let judgement = judge(product, &approximation, &yardstick)?;
    let mut answer = answer(approximation, judgement, setup, method);
    if !converges {
        answer.status = Status::ToleranceNotMet;
    }
    Ok(answer)
}

/// The n for which ‖A^{n+1} f‖, the residual of φ_n, times ‖(I − A)⁻¹‖ is a quarter of what is tolerated; or from where on
/// the terms are rounding.
fn enough<T: Scalar>(series: &Series<'_, T>, tolerance: f64) -> usize {
    let part = 0.25 * tolerance.max(f64::EPSILON) / series.yardstick().inverse_norm;
    let mut terms = series.terms();
    let mut term = terms.next().unwrap_or_default();
    let mut sum = term.clone();
    for n in 0..MOST {
        let next = terms.next().unwrap_or_default();
        let rounding = ROUNDING * series.norm() * largest(&term);
        if largest(&next) <= rounding.max(part * largest(&sum)) {
            return n;
        }
        sum.iter_mut().zip(&next).for_each(|(sum, next)| *sum += *next);
        term = next;
    }
    MOST
}

/// The n of the smallest ‖A^{n+1} f‖.
fn smallest<T: Scalar>(series: &Series<'_, T>) -> usize {
    let residuals: Vec<f64> = series.sizes().skip(1).take(SEARCHED).collect();
    (0..residuals.len()).min_by(|i, j| residuals[*i].total_cmp(&residuals[*j])).unwrap_or(0)
}

fn described<T: Scalar>(
    method: Method,
    terms: usize,
    series: &Series<'_, T>,
    remainder: Option<f64>,
) -> String {
    let (norm, radius) = (series.norm(), series.spectral_radius());
    let verdict = match remainder {
        _ if !series.converges() => "diverges: use a method that solves a linear system".to_owned(),
        Some(remainder) => format!("remainder certified to be below {remainder:.1e}"),
        None => "‖A‖ ≥ 1, no remainder is certified".to_owned(),
    };
    let counted = if method == Method::Neumann { "up to A^" } else { "steps: " };
    format!("{method}, {counted}{terms}, ‖A‖ = {norm:.4}, spectral radius {radius:.4}, {verdict}")
}
