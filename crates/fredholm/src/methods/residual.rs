//! ‖φ − φ_n‖∞ ≤ ‖(I − A)⁻¹‖∞ ‖f + Aφ_n − φ_n‖∞: the error of an answer from the equation's own residual (paper, §1.1.3).
//!
//! The residual is that of the *function* that is returned, with integrals to rounding, at points that no method chose.

use super::integrals::{source, transform_resolved};
use super::{Approximation, Yardstick};
use crate::equation::{Equation, EquationError, Scalar};
use crate::product::Product;
use crate::space::resolve;
use rayon::prelude::*;
use std::f64::consts::PI;

/// What is known of an answer's error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Judgement {
    /// An estimate of max |φ_n − φ|, rounding included.
    pub error: f64,
    /// The part of it that is rounding: no method gets below.
    pub rounding: f64,
    /// max |φ_n|.
    pub size: f64,
}

/// Panels added to those of a solution to resolve it.
const MORE_PANELS: usize = 256;

/// Points of either family at which the residual is computed.
const POINTS: usize = 48;

/// The largest residual met is not the largest there is.
const SAMPLING: f64 = 1.5;

/// Rounding of a residual and of the solution's evaluation, as a part of their sizes: a handful of operations each.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// The error of an answer.
///
/// # Errors
///
/// Where source, kernel or solution are not finite.
pub fn judge<T: Scalar>(
    product: &Product<'_, '_, T>,
    answer: &Approximation<'_, T>,
    yardstick: &Yardstick,
) -> Result<Judgement, EquationError> {
    let equation = product.equation();
    let resolved = resolve(&answer.solution, &answer.breaks, MORE_PANELS);
    let points: Vec<(usize, f64)> = (0..equation.components())
        .flat_map(|a| points(equation, a).into_iter().map(move |x| (a, x)))
        .collect();
    let residual = |&(a, x): &(usize, f64)| -> Result<(f64, f64, f64), EquationError> {
        let (f, image) = (source(equation, a, x)?, transform_resolved(product, (a, x), &resolved)?);
        let r = f + image.value - answer.solution.component(a, &x);
        if r.finite() {
            Ok((r.modulus(), image.error, f.modulus()))
        } else {
            Err(EquationError::Method(format!("the solution is not a finite number at x = {x}")))
        }
    };
    let residuals = points.par_iter().map(residual).collect::<Result<Vec<_>, _>>()?;
    let (r, rule, f) = residuals
        .iter()
        .fold((0.0_f64, 0.0_f64, 0.0_f64), |max, at| (max.0.max(at.0), max.1.max(at.1), max.2.max(at.2)));
    let size = resolved.scale;
    let rounding = yardstick.inverse_norm * (rule * size + ROUNDING * (f + (1.0 + yardstick.norm) * size));
    let error = yardstick.inverse_norm * (SAMPLING * r + yardstick.norm * resolved.defect) + rounding;
    Ok(Judgement { error, rounding, size })
}

/// Points spread evenly and points gathered towards the ends, by the golden ratio: never the nodes of a space or a rule,
/// and at every distance from them. The ends themselves, where f has a value.
fn points<T: Scalar>(equation: &Equation<'_, T>, component: usize) -> Vec<f64> {
    const GOLDEN: f64 = 0.618_033_988_749_895;
    let (a, b) = (equation.interval().a(), equation.interval().b());
    let share = |k: usize| (0.5 + GOLDEN * k as f64).fract();
    let even = (0..POINTS).map(share);
    let gathered = (0..POINTS).map(|k| 0.5 - 0.5 * (PI * share(k + POINTS)).cos());
    let inside = even.chain(gathered).map(|share| a + (b - a) * share);
    let ends = [a, b].into_iter().filter(|x| equation.source(component, *x).finite());
    inside.chain(ends).collect()
}
