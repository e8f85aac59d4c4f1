//! Gauss–Jacobi: ∫_a^b (b − x)^α (x − a)^β g(x) dx ≈ Σ_k w_k g(x_k), of order 2n − 1 (paper, §4.3.2); and from it the
//! rules of Radau and Lobatto, with one and both ends among the nodes.

use super::end_form::{EndForm, Root};
use super::orthogonal::Recurrence;
use super::reference::{Node, mapped, mirrored};
use super::scaled::{Scaled, normalised};
use super::tridiagonal::eigenvalues;
use super::{Quadrature, QuadratureError, check_size};

/// Beyond it the weight's integral 2^(α+β+1) B(α + 1, β + 1) leaves the range of numbers.
const MOST: f64 = 500.0;

/// The `n`-point Gauss–Jacobi rule for ∫_a^b (b − x)^α (x − a)^β g(x) dx, exact for g of degree 2n − 1; nodes ascending.
///
/// O(n²) operations; nodes and weights to rounding, relative to the distance from the nearer end.
///
/// # Errors
///
/// When α or β is not above −1, or above 500.
pub fn gauss_jacobi(
    n: usize,
    alpha: f64,
    beta: f64,
    a: f64,
    b: f64,
) -> Result<Quadrature<f64>, QuadratureError> {
    for given in [alpha, beta] {
        if !(given > -1.0 && given <= MOST) {
            return Err(QuadratureError::Exponent { rule: "Gauss–Jacobi", given, most: MOST });
        }
    }
    let mut rule = mapped(&nodes(n, alpha, beta), a, b);
    let scale = (0.5 * (b - a)).powf(alpha + beta);
    rule.weights.iter_mut().for_each(|w| *w *= scale);
    Ok(rule)
}

/// The `n`-point Gauss–Radau rule on [a, b]: its first node is `a`, and it is exact for degree 2n − 2.
///
/// # Errors
///
/// When n = 0.
pub fn gauss_radau(n: usize, a: f64, b: f64) -> Result<Quadrature<f64>, QuadratureError> {
    check_size("Gauss–Radau", n, 1, usize::MAX)?;
    let end = Node { x: -1.0, t: 0.0, weight: 2.0 / (n as f64).powi(2) };
    // The other nodes are Gauss's for the weight 1 + x.
    let inner = nodes(n - 1, 0.0, 1.0).into_iter().map(|node| {
        let from_left = if node.x < 0.0 { node.t } else { 2.0 - node.t };
        Node { weight: node.weight / from_left, ..node }
    });
    Ok(mapped(&[end].into_iter().chain(inner).collect::<Vec<_>>(), a, b))
}

/// The `n`-point Gauss–Lobatto rule on [a, b]: both ends are nodes, and it is exact for degree 2n − 3.
///
/// # Errors
///
/// When n < 2.
pub fn gauss_lobatto(n: usize, a: f64, b: f64) -> Result<Quadrature<f64>, QuadratureError> {
    check_size("Gauss–Lobatto", n, 2, usize::MAX)?;
    let end = Node { x: -1.0, t: 0.0, weight: 2.0 / (n as f64 * (n as f64 - 1.0)) };
    // The other nodes are Gauss's for the weight 1 − x².
    let inner = nodes(n - 2, 1.0, 1.0).into_iter();
    let inner = inner.map(|node| Node { weight: node.weight / (node.t * (2.0 - node.t)), ..node });
    let all: Vec<Node> = [end].into_iter().chain(inner).chain([end.mirrored()]).collect();
    Ok(mapped(&all, a, b))
}

/// The nodes on [−1, 1], ascending: each half as seen from its own end.
fn nodes(n: usize, alpha: f64, beta: f64) -> Vec<Node> {
    let recurrence = Recurrence::jacobi(n, alpha, beta);
    let guesses = eigenvalues(&recurrence.diagonal, &recurrence.beside[1.min(n)..]);
    let middle = guesses.partition_point(|x| *x < 0.0);
    if alpha == beta {
        let right: Vec<f64> = guesses[n / 2..].iter().rev().map(|x| 1.0 - x).collect();
        let right = EndForm::jacobi(n, alpha, beta).roots(&right);
        // The node in the middle counts once, all others twice.
        let count = |k: usize| if 2 * k + 1 == n { 1.0 } else { 2.0 };
        let raw: Vec<Scaled> = right.iter().map(scaled).collect();
        let weights = normalised(&raw, count, recurrence.mass);
        let right = right.iter().zip(weights).map(|(root, weight)| Node::from_right(root.t, weight));
        return mirrored(n, right.collect());
    }
    let left: Vec<f64> = guesses[..middle].iter().map(|x| 1.0 + x).collect();
    let right: Vec<f64> = guesses[middle..].iter().map(|x| 1.0 - x).collect();
    let left = EndForm::jacobi(n, beta, alpha).roots(&left);
    let right = EndForm::jacobi(n, alpha, beta).roots(&right);
    // Each half's polynomial is 1 at its own end; the ratio of their values there makes the two halves one.
    let ratio = ends(n, alpha, beta);
    let raw: Vec<Scaled> =
        left.iter().map(|root| scaled(root).times(ratio)).chain(right.iter().map(scaled)).collect();
    let mut weights = normalised(&raw, |_| 1.0, recurrence.mass).into_iter();
    let left = left.iter().map(|root| Node { x: root.t - 1.0, t: root.t, weight: 0.0 });
    let right = right.iter().map(|root| Node::from_right(root.t, 0.0));
    left.chain(right).map(|node| Node { weight: weights.next().unwrap_or(0.0), ..node }).collect()
}

fn scaled(root: &Root) -> Scaled {
    Scaled::new(root.weight, root.exponent)
}

/// (P_n(1) / P_n(−1))² = Π ((k + α)/(k + β))².
fn ends(n: usize, alpha: f64, beta: f64) -> Scaled {
    let factor = |k: usize| ((k as f64 + alpha) / (k as f64 + beta)).powi(2);
    (1..=n).fold(Scaled::new(1.0, 0), |product, k| product.times(Scaled::new(factor(k), 0)))
}
