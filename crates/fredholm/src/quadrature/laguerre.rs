//! Gauss–Laguerre, ∫₀^∞ x^α e^{−x} g(x) dx, and Gauss–Hermite, ∫ e^{−x²} g(x) dx, of order 2n − 1 (paper, §4.3.2).

use super::end_form::{EndForm, Root};
use super::orthogonal::Recurrence;
use super::scaled::{Scaled, normalised};
use super::tridiagonal::eigenvalues;
use super::{Quadrature, QuadratureError};
use std::f64::consts::PI;

/// Γ(171.6…) is the largest that is a number.
const MOST: f64 = 170.0;

/// The `n`-point Gauss–Laguerre rule for ∫₀^∞ x^α e^{−x} g(x) dx, exact for g of degree 2n − 1; nodes ascending.
///
/// O(n²) operations; nodes and weights to rounding, small ones too. Weights below 1e-308 are 0.
///
/// # Errors
///
/// When α is not above −1, or above 170.
pub fn gauss_laguerre(n: usize, alpha: f64) -> Result<Quadrature<f64>, QuadratureError> {
    if !(alpha > -1.0 && alpha <= MOST) {
        return Err(QuadratureError::Exponent { rule: "Gauss–Laguerre", given: alpha, most: MOST });
    }
    Ok(laguerre(n, alpha))
}

fn laguerre(n: usize, alpha: f64) -> Quadrature<f64> {
    let roots = roots(n, alpha);
    let raw: Vec<Scaled> = roots.iter().map(|root| Scaled::new(root.weight, root.exponent)).collect();
    Quadrature {
        nodes: roots.iter().map(|root| root.t).collect(),
        weights: normalised(&raw, |_| 1.0, libm::tgamma(alpha + 1.0)),
    }
}

fn roots(n: usize, alpha: f64) -> Vec<Root> {
    let recurrence = Recurrence::laguerre(n, alpha);
    let guesses = eigenvalues(&recurrence.diagonal, &recurrence.beside[1.min(n)..]);
    EndForm::laguerre(n, alpha).roots(&guesses)
}

/// The `n`-point Gauss–Hermite rule for ∫ e^{−x²} g(x) dx over the real line, exact for g of degree 2n − 1; nodes ascending.
///
/// In x², it is Laguerre's rule for α = −½ (even n) or ½: half the nodes, a quarter of the work. Weights below 1e-308 are 0.
pub fn gauss_hermite(n: usize) -> Quadrature<f64> {
    let odd = n % 2 == 1;
    let right = laguerre(n / 2, if odd { 0.5 } else { -0.5 });
    let squares = right.nodes.iter().zip(&right.weights);
    let half: Vec<(f64, f64)> =
        squares.map(|(t, w)| (t.sqrt(), if odd { 0.5 * w / t } else { 0.5 * w })).collect();
    let left = half.iter().rev().map(|(x, w)| (-x, *w));
    let middle = odd.then(|| (0.0, middle_weight(n)));
    let (nodes, weights) = left.chain(middle).chain(half.iter().copied()).unzip();
    Quadrature { nodes, weights }
}

/// The weight of the node 0 for odd n = 2m + 1: √π/n Π_{i=1}^m 2i/(2i − 1).
fn middle_weight(n: usize) -> f64 {
    let factor = |i: usize| 2.0 * i as f64 / (2.0 * i as f64 - 1.0);
    (1..=n / 2).map(factor).product::<f64>() * PI.sqrt() / n as f64
}
