//! Gauss–Legendre: the nodes are the roots of the Legendre polynomial P_n, and the rule has order 2n − 1 (paper, §4.3.2).

use super::Quadrature;
use std::f64::consts::PI;

/// The `n`-point Gauss–Legendre rule on [a, b], exact for polynomials of degree 2n − 1; nodes ascending.
///
/// The roots are found by Newton's method from the asymptotic guess cos(π(k − ¼)/(n + ½)), in O(n²) operations,
/// to rounding. `n = 0` gives the empty rule.
pub fn gauss_legendre(n: usize, a: f64, b: f64) -> Quadrature<f64> {
    let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
    let (nodes, weights) = (0..n)
        .map(|k| {
            let (root, weight) = root_and_weight(n, n - k);
            (middle + half * root, half * weight)
        })
        .unzip();
    Quadrature { nodes, weights }
}

/// The k-th largest root x of P_n (k = 1 … n) and its weight 2 / ((1 − x²) P′_n(x)²).
fn root_and_weight(n: usize, k: usize) -> (f64, f64) {
    let mut x = (PI * (k as f64 - 0.25) / (n as f64 + 0.5)).cos();
    // Newton doubles the digits: from the guess, three steps reach rounding; the last ones cost nothing.
    for _ in 0..5 {
        let (p, slope) = legendre(n, x);
        x -= p / slope;
    }
    let (_, slope) = legendre(n, x);
    (x, 2.0 / ((1.0 - x * x) * slope * slope))
}

/// (P_n(x), P′_n(x)) by the three-term recurrence (paper, (4.14)), for |x| < 1 and n ≥ 1.
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut before, mut p) = (1.0, x);
    for k in 2..=n {
        let k = k as f64;
        (before, p) = (p, ((2.0 * k - 1.0) * x * p - (k - 1.0) * before) / k);
    }
    (p, n as f64 * (before - x * p) / (1.0 - x * x))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫₀² x^d dx = 2^(d+1)/(d+1), relative error of the n-point rule.
    fn error(n: usize, degree: i32) -> f64 {
        let exact = 2_f64.powi(degree + 1) / f64::from(degree + 1);
        (gauss_legendre(n, 0.0, 2.0).integrate(|x| x.powi(degree)) / exact - 1.0).abs()
    }

    #[test]
    fn the_order_is_2n_minus_1_and_no_more() {
        for n in 1..=8 {
            let order = 2 * n as i32 - 1;
            assert!((0..=order).all(|d| error(n, d) < 1e-14), "{n} points");
            assert!(error(n, order + 1) > 1e-10, "{n} points are exact for degree {}", order + 1);
        }
    }

    #[test]
    fn two_hundred_points_are_still_exact_to_rounding() {
        let rule = gauss_legendre(200, -1.0, 1.0);
        assert!((rule.weights.iter().sum::<f64>() - 2.0).abs() < 1e-13);
        assert!(rule.nodes.windows(2).all(|w| w[0] < w[1]));
        assert!((rule.integrate(|x| x.exp()) - 2.0 * 1_f64.sinh()).abs() < 1e-13);
    }

    #[test]
    fn the_square_of_a_rule_integrates_products() {
        let rule = gauss_legendre(3, 0.0, 1.0).squared();
        assert!((rule.integrate(|[x, y]| x.powi(5) * y.powi(4)) - 1.0 / 30.0).abs() < 1e-15);
    }
}
