//! Gauss–Legendre: the nodes are the roots of the Legendre polynomial P_n, and the rule has order 2n − 1 (paper, §4.3.2).

use super::Quadrature;
use super::bessel::Zeros;
use super::end_form::EndForm;
use super::phase::Phase;
use super::reference::{Node, mapped, mirrored};
use std::f64::consts::PI;

/// From here on the asymptotic series is good to rounding; below, Halley's method on the recurrence is quicker as well.
const MANY: usize = 50;

/// The `n`-point Gauss–Legendre rule on [a, b], exact for polynomials of degree 2n − 1; nodes ascending.
///
/// To rounding, weights near the ends too, in O(n) operations: from n = 50 by an asymptotic series, below by two steps
/// on the recurrence. `n = 0` gives the empty rule.
pub fn gauss_legendre(n: usize, a: f64, b: f64) -> Quadrature<f64> {
    let half = if n < MANY { few(n) } else { many(n) };
    mapped(&mirrored(n, half), a, b)
}

/// The nodes from the right end to the middle, by the recurrence.
fn few(n: usize) -> Vec<Node> {
    let nu = n as f64 + 0.5;
    let guess = |k: usize| {
        // The first term of [`Phase`], with McMahon's first term for Bessel's zero.
        let zero = PI * (k as f64 - 0.25);
        let angle = (zero + 0.125 / zero) / nu;
        let theta = angle - (1.0 / angle - 1.0 / angle.tan()) / (8.0 * nu * nu);
        2.0 * (0.5 * theta).sin().powi(2)
    };
    let guesses: Vec<f64> = (1..=n.div_ceil(2)).map(guess).collect();
    // w = 2 / ((1 − x²) P′²).
    let node = |root: super::end_form::Root| Node::from_right(root.t, 2.0 * root.weight);
    EndForm::jacobi(n, 0.0, 0.0).roots(&guesses).into_iter().map(node).collect()
}

/// The nodes from the right end to the middle, by the series.
fn many(n: usize) -> Vec<Node> {
    let nu = n as f64 + 0.5;
    let (phase, zeros) = (Phase::new(nu), Zeros::new());
    let node = |k: usize| {
        let (zero, bessel) = zeros.zero(k);
        let (theta, slope) = phase.inverse(zero / nu);
        // w = 2 / P_θ² with P_θ² = z z′ ν² J₁² / sinθ.
        let weight = 2.0 * theta.sin() / (bessel * nu * slope);
        Node { x: theta.cos(), t: 2.0 * (0.5 * theta).sin().powi(2), weight }
    };
    (1..=n.div_ceil(2)).map(node).collect()
}
