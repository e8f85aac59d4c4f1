//! ‖A‖∞ = max_x Σ_b ∫ |K_ab(x, y)| dy (paper, §1.1.1): below 1, the equation has one solution (§1.1.3).

use crate::equation::{EquationError, Scalar};
use crate::product::Product;
use crate::space::equal_parts;

/// Where ∫ |K(x, y)| dy is computed for its maximum, before that is searched more closely.
const SAMPLES: usize = 65;

/// The pieces on which |K| is integrated. A change of sign in one of them costs (1/32)² / 16² of |K|, at most: 4e-6.
const PIECES: usize = 32;

/// ‖A‖∞, rounded up in the fifth digit.
///
/// # Errors
///
/// [`EquationError::KernelNotFinite`].
pub fn operator_norm<T: Scalar>(product: &Product<'_, '_, T>) -> Result<f64, EquationError> {
    let equation = product.equation();
    let interval = equation.interval();
    let breaks = equal_parts(interval.a(), interval.b(), PIECES);
    let points = equal_parts(interval.a(), interval.b(), SAMPLES - 1);
    let mut largest = 0.0_f64;
    for a in 0..equation.components() {
        let at = |x: f64| absolute_integral(product, a, x, &breaks);
        let values = points.iter().map(|x| at(*x)).collect::<Result<Vec<_>, _>>()?;
        let best = (0..SAMPLES).max_by(|i, j| values[*i].total_cmp(&values[*j])).unwrap_or(0);
        let around = (points[best.saturating_sub(1)], points[(best + 1).min(SAMPLES - 1)]);
        largest = largest.max(values[best]).max(maximum(at, around)?);
    }
    Ok(largest * (1.0 + 1e-5))
}

/// Σ_b ∫ |K_ab(x, y)| dy.
fn absolute_integral<T: Scalar>(
    product: &Product<'_, '_, T>,
    a: usize,
    x: f64,
    breaks: &[f64],
) -> Result<f64, EquationError> {
    let rows = (0..product.equation().components()).map(|b| product.row((a, b), x, breaks));
    rows.map(|row| row.map(|row| row.weights.iter().map(|weight| weight.modulus()).sum::<f64>())).sum()
}

/// The maximum by golden section, to the square root of the fifth digit: a maximum is flat.
fn maximum(
    at: impl Fn(f64) -> Result<f64, EquationError>,
    (mut low, mut high): (f64, f64),
) -> Result<f64, EquationError> {
    const GOLDEN: f64 = 0.618_033_988_749_895;
    let mut largest = 0.0_f64;
    for _ in 0..12 {
        let width = GOLDEN * (high - low);
        let (left, right) = (high - width, low + width);
        let (at_left, at_right) = (at(left)?, at(right)?);
        largest = largest.max(at_left).max(at_right);
        if at_left < at_right {
            low = left;
        } else {
            high = right;
        }
    }
    Ok(largest)
}
