//! Rules with nodes cos θ_k, θ equidistant: Gauss–Chebyshev (weights 1/√(1 − x²) and √(1 − x²)), Clenshaw–Curtis and Fejér.

use super::reference::{Node, mapped, mirrored};
use super::{Quadrature, QuadratureError, check_size};
use std::f64::consts::PI;

/// The `n`-point rule for ∫_a^b g(x) / √((b − x)(x − a)) dx, exact for g of degree 2n − 1; nodes ascending.
pub fn gauss_chebyshev_1(n: usize, a: f64, b: f64) -> Quadrature<f64> {
    let nodes = symmetric(n, |k| (k as f64 - 0.5) / n as f64, |_| 1.0);
    // The weight's integral does not depend on the interval.
    let mut rule = mapped(&nodes, a, b);
    rule.weights.fill(PI / n as f64);
    rule
}

/// The `n`-point rule for ∫_a^b g(x) √((b − x)(x − a)) dx, exact for g of degree 2n − 1; nodes ascending.
pub fn gauss_chebyshev_2(n: usize, a: f64, b: f64) -> Quadrature<f64> {
    let step = 1.0 / (n as f64 + 1.0);
    let half = 0.5 * (b - a).abs();
    let weight = |turn: f64| half * PI * step * (PI * turn).sin().powi(2);
    mapped(&symmetric(n, |k| k as f64 * step, weight), a, b)
}

/// The `n`-point Clenshaw–Curtis rule on [a, b]: both ends and the extrema of T_{n−1}; exact for degree n − 1, positive.
///
/// O(n²) operations. It loses little against Gauss for functions that are not entire, and the nodes nest.
///
/// # Errors
///
/// When n < 2.
pub fn clenshaw_curtis(n: usize, a: f64, b: f64) -> Result<Quadrature<f64>, QuadratureError> {
    check_size("Clenshaw–Curtis", n, 2, usize::MAX)?;
    let last = n - 1;
    let cosines = Cosines::new(last);
    let weights: Vec<f64> = (0..=last)
        .map(|k| {
            // ∫ T_2j = 2/(1 − 4j²); the coefficients j = 0 and j = last/2 of the interpolant count half, as do the ends.
            let term = |j: usize| {
                let half = if 2 * j == last { 0.5 } else { 1.0 };
                half * 2.0 * cosines.at(j * k) / (1.0 - 4.0 * (j * j) as f64)
            };
            let ends = if k == 0 || k == last { 0.5 } else { 1.0 };
            ends * 2.0 / last as f64 * (1.0 + (1..=last / 2).map(term).sum::<f64>())
        })
        .collect();
    let turn = |k: usize| (k as f64 - 1.0) / last as f64;
    Ok(mapped(&symmetric_with(n, turn, |k| weights[k - 1]), a, b))
}

/// Fejér's first rule with `n` points on [a, b]: the roots of T_n, so not the ends; exact for degree n − 1, positive.
///
/// O(n²) operations. `n = 0` gives the empty rule.
pub fn fejer(n: usize, a: f64, b: f64) -> Quadrature<f64> {
    let cosines = Cosines::new(2 * n.max(1));
    let weight = |k: usize| {
        let term = |j: usize| 2.0 * cosines.at(j * (2 * k - 1)) / (1.0 - 4.0 * (j * j) as f64);
        2.0 / n as f64 * (1.0 + (1..=n / 2).map(term).sum::<f64>())
    };
    mapped(&symmetric_with(n, |k| (k as f64 - 0.5) / n as f64, weight), a, b)
}

/// cos(2πk/n) for all k, from one table.
struct Cosines(Vec<f64>);

impl Cosines {
    fn new(n: usize) -> Self {
        Self((0..n).map(|k| (2.0 * PI * k as f64 / n as f64).cos()).collect())
    }

    fn at(&self, k: usize) -> f64 {
        self.0[k % self.0.len()]
    }
}

/// The symmetric rule with nodes cos(π turn(k)) for k = 1 … n and weights of the turn.
fn symmetric(n: usize, turn: impl Fn(usize) -> f64, weight: impl Fn(f64) -> f64) -> Vec<Node> {
    symmetric_with(n, &turn, |k| weight(turn(k)))
}

fn symmetric_with(n: usize, turn: impl Fn(usize) -> f64, weight: impl Fn(usize) -> f64) -> Vec<Node> {
    let node = |k: usize| {
        let angle = PI * turn(k);
        Node { x: angle.cos(), t: 2.0 * (0.5 * angle).sin().powi(2), weight: weight(k) }
    };
    mirrored(n, (1..=n.div_ceil(2)).map(node).collect())
}
