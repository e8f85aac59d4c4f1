//! T_f(h) = ∫f + Σ_m b_{2m}/(2m)! h^{2m} (f^{(2m−1)}(b) − f^{(2m−1)}(a)) + …: Euler–Maclaurin (paper, §4.4.2, (4.35), (4.36)).

use super::{QuadratureError, check_size};
use std::f64::consts::TAU;

/// The largest whose Bernoulli number is a number: b_258 = 1.6e306.
const MOST: usize = 258;
/// Up to here the tangent numbers are exact in 128 bits.
const EXACT: usize = 38;

/// The Bernoulli number b_p = B_p(0) (4.37), (4.38): 1, −½, 1/6, 0, −1/30, …; correctly rounded or next to it up to p = 38,
/// within 1e-14 of itself up to 258.
///
/// # Errors
///
/// Beyond p = 258, where b_p is no longer in the range of numbers.
pub fn bernoulli(p: usize) -> Result<f64, QuadratureError> {
    check_size("Bernoulli number", p, 0, MOST)?;
    Ok(match p {
        0 => 1.0,
        1 => -0.5,
        _ if p % 2 == 1 => 0.0,
        _ if p <= EXACT => from_tangent(p),
        _ => from_zeta(p),
    })
}

fn sign(p: usize) -> f64 {
    if p.is_multiple_of(4) { -1.0 } else { 1.0 }
}

/// |b_p| = p T / (4^{p/2} (4^{p/2} − 1)), T the tangent number of index p/2 (1, 2, 16, 272, …), by a sum without signs.
fn from_tangent(p: usize) -> f64 {
    let k = p / 2;
    let mut t = vec![1_u128; k + 1];
    for i in 2..=k {
        t[i] = (i as u128 - 1) * t[i - 1];
    }
    for i in 2..=k {
        for j in i..=k {
            t[j] = (j - i) as u128 * t[j - 1] + (j - i + 2) as u128 * t[j];
        }
    }
    let power = 1_u128 << p;
    // One factor 2^p is exact in floating point: divide by it last.
    sign(p) * (p as f64 * t[k] as f64) / (power - 1) as f64 / power as f64
}

/// |b_p| = 2 p!/(2π)^p ζ(p).
fn from_zeta(p: usize) -> f64 {
    // ζ(40) − 1 = 9e-13: two terms more than 1 suffice.
    let zeta = 1.0 + 0.5_f64.powi(p as i32) + (1.0_f64 / 3.0).powi(p as i32);
    // 2π is TAU + 2.4e-16, which counts p times.
    let tail = 2.449_293_598_294_706_4e-16 / TAU;
    let product: f64 = (1..=p).map(|j| j as f64 / TAU).product();
    sign(p) * 2.0 * zeta * product * (1.0 - p as f64 * tail)
}

/// The trapezoidal sum of `f` over `panels` equal parts of [a, b] with its ends corrected by `derivatives`, the pairs
/// (f′, f‴, f⁗′, …) at a and at b: k pairs leave an error O(h^{2k+2}).
///
/// # Errors
///
/// When there is no panel, or there are more than 129 derivatives.
pub fn euler_maclaurin(
    f: impl FnMut(f64) -> f64,
    derivatives: &[[f64; 2]],
    a: f64,
    b: f64,
    panels: usize,
) -> Result<f64, QuadratureError> {
    let rule = super::trapezoid(a, b, panels)?;
    let h = (b - a) / panels as f64;
    let mut correction = 0.0;
    let mut factor = 1.0;
    for (k, [at_a, at_b]) in derivatives.iter().enumerate() {
        let p = 2 * k + 2;
        factor *= h * h / ((p - 1) * p) as f64;
        correction += bernoulli(p)? * factor * (at_b - at_a);
    }
    let values = rule.nodes.iter().copied().map(f);
    Ok(values.zip(&rule.weights).map(|(value, w)| value * w).sum::<f64>() - correction)
}
