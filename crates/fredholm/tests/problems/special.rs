//! The few functions that closed forms need, to double precision.

use std::f64::consts::PI;

/// ∫₀^x e^{−t²} dt 2/√π, by a series of positive terms.
pub fn erf(x: f64) -> f64 {
    // 1 − erf(6) = 2e-17.
    if x.abs() > 6.0 {
        return x.signum();
    }
    let (mut term, mut sum, mut k) = (x, x, 1.0);
    while term.abs() > 1e-18 * sum.abs() {
        term *= 2.0 * x * x / (2.0 * k + 1.0);
        sum += term;
        k += 1.0;
    }
    2.0 / PI.sqrt() * (-x * x).exp() * sum
}

/// Li₂(x) = Σ x^k/k² for 0 ≤ x ≤ 1.
pub fn li2(x: f64) -> f64 {
    if x == 1.0 {
        return PI * PI / 6.0;
    }
    if x > 0.5 {
        return PI * PI / 6.0 - x.ln() * (1.0 - x).ln() - li2(1.0 - x);
    }
    (1..60).rev().map(|k| x.powi(k) / f64::from(k * k)).sum()
}

/// sin x / x.
pub fn sinc(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { x.sin() / x }
}

/// (e^x − 1)/x.
pub fn exp_mean(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { x.exp_m1() / x }
}

/// x ln x, which is 0 at 0.
pub fn x_ln(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x * x.ln() }
}

/// ∫_a^b ln|x − y| p(y) dy for the polynomial p(y) = Σ c_k y^k.
pub fn log_integral(c: &[f64], x: f64, [a, b]: [f64; 2]) -> f64 {
    let primitive = |k: i32, u: f64| {
        let n = f64::from(k + 1);
        if u == 0.0 { 0.0 } else { u.powi(k + 1) * (u.abs().ln() / n - 1.0 / (n * n)) }
    };
    by_moments(c, x, |k| primitive(k, b - x) - primitive(k, a - x))
}

/// ∫_a^b |x − y|^α p(y) dy for the polynomial p(y) = Σ c_k y^k.
pub fn power_integral(alpha: f64, c: &[f64], x: f64, [a, b]: [f64; 2]) -> f64 {
    let primitive =
        |k: i32, u: f64| u.powi(k) * u.signum() * u.abs().powf(1.0 + alpha) / (f64::from(k + 1) + alpha);
    by_moments(c, x, |k| primitive(k, b - x) - primitive(k, a - x))
}

/// Σ_k d_k · `moment(k)` where p(x + u) = Σ d_k u^k, by Horner's division.
fn by_moments(c: &[f64], x: f64, moment: impl Fn(i32) -> f64) -> f64 {
    let mut d = c.to_vec();
    for first in 0..d.len() {
        for k in (first..d.len() - 1).rev() {
            d[k] += x * d[k + 1];
        }
    }
    d.iter().zip(0..).map(|(d, k)| d * moment(k)).sum()
}
