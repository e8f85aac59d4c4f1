//! A_{m,n} = (r^n A_{m,n−1} − A_{m−1,n−1})/(r^n − 1): Richardson's extrapolation, and Romberg's rule from it (paper, §4.4).

use super::{Integral, IntegrateError, QuadratureError};

/// The triangle A_{m,n} (4.33) of the values A_{m,0} = A(t₀ r^−m), where A(t) = a₀ + a₁ t + a₂ t² + …: row m has
/// m + 1 entries, and its last is exact but for O(t^{m+1}). For an expansion in powers t^p give r^p.
pub fn richardson(values: &[f64], ratio: f64) -> Vec<Vec<f64>> {
    let mut triangle: Vec<Vec<f64>> = Vec::with_capacity(values.len());
    for value in values {
        let row = extended(triangle.last().map(Vec::as_slice), *value, ratio);
        triangle.push(row);
    }
    triangle
}

/// The row after `before`, beginning with `value`.
fn extended(before: Option<&[f64]>, value: f64, ratio: f64) -> Vec<f64> {
    let mut row = vec![value];
    let mut power = ratio;
    for coarse in before.unwrap_or(&[]) {
        let fine = row[row.len() - 1];
        // As a correction of the finer value, which is how rounding stays small.
        row.push(fine + (fine - coarse) / (power - 1.0));
        power *= ratio;
    }
    row
}

/// No function needs a finer step: 2^22 evaluations.
const FINEST: usize = 22;
/// So many halvings before an error is believed: three values may agree by chance, as for a function with a short period.
const LEAST: usize = 4;

/// Romberg's integral of `f` over [a, b]: the trapezoidal sums with steps (b − a)/2^m, each using the points of those
/// before it, extrapolated with r = 4 (4.41) until two diagonal entries differ by no more than `tolerance`, relative to
/// the sum of |f|.
///
/// With m halvings and a smooth f, the error falls as h^{2(m+1)}; the estimate is the last correction, which belongs to the
/// entry before the one returned.
///
/// # Errors
///
/// When f is not finite at a node, or the tolerance is not met by 2^22 steps; the best value comes with the error.
pub fn romberg(
    mut f: impl FnMut(f64) -> f64,
    a: f64,
    b: f64,
    tolerance: f64,
) -> Result<Integral, IntegrateError> {
    let mut sample = |at: f64| match f(at) {
        value if value.is_finite() => Ok(value),
        value => Err(QuadratureError::NotFinite { what: "integrand", at, value }),
    };
    let ends = [sample(a)?, sample(b)?];
    let mut sum = 0.5 * (ends[0] + ends[1]);
    let mut size = 0.5 * (ends[0].abs() + ends[1].abs());
    let mut row = vec![(b - a) * sum];
    let mut best = Integral { value: row[0], error: f64::INFINITY, evaluations: 2 };
    for m in 1..=FINEST {
        let panels = 1_usize << m;
        let h = (b - a) / panels as f64;
        // Only the odd points are new.
        for k in (1..panels).step_by(2) {
            let value = sample(a + h * k as f64)?;
            sum += value;
            size += value.abs();
        }
        row = extended(Some(&row), h * sum, 4.0);
        let value = row[m];
        let change = (value - row[m - 1]).abs().max((value - best.value).abs());
        let rounding = 4.0 * f64::EPSILON * h.abs() * size;
        best = Integral { value, error: change.max(rounding), evaluations: panels + 1 };
        if m >= LEAST && best.error <= (tolerance * h.abs() * size).max(rounding) {
            return Ok(best);
        }
    }
    Err(IntegrateError::NotConverged { best, tolerance })
}
