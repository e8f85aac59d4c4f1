//! Gauss–Legendre on [−1, 1] as a place to interpolate, and to see whether a function is resolved.

use crate::equation::Scalar;
use crate::quadrature::gauss_legendre;
use std::sync::LazyLock;

/// The n-point Gauss–Legendre rule on [−1, 1] with the barycentric weights of its nodes.
#[derive(Debug)]
pub(crate) struct Reference {
    /// ξ_i, ascending.
    pub(crate) nodes: Vec<f64>,
    /// w_i.
    pub(crate) weights: Vec<f64>,
    barycentric: Vec<f64>,
    /// Row k: the functional g ↦ coefficient n − 1 − k of g's Legendre series.
    tail: [Vec<f64>; 3],
}

/// Nodes of a panel, where the equation is solved.
pub(crate) static COARSE: LazyLock<Reference> = LazyLock::new(|| Reference::new(16));

/// Nodes of a panel, where the solution is put to the test: none of them is a node of [`COARSE`].
pub(crate) static FINE: LazyLock<Reference> = LazyLock::new(|| Reference::new(24));

/// Nodes towards a singularity.
pub(crate) static SINGULAR: LazyLock<Reference> = LazyLock::new(|| Reference::new(40));

impl Reference {
    fn new(n: usize) -> Self {
        let rule = gauss_legendre(n, -1.0, 1.0);
        // Barycentric weights of Gauss–Legendre nodes: (−1)^i √((1 − ξ²) w) (Wang & Xiang 2012).
        let barycentric = (rule.nodes.iter().zip(&rule.weights).enumerate())
            .map(|(i, (x, w))| if i % 2 == 0 { 1.0 } else { -1.0 } * ((1.0 - x * x) * w).sqrt())
            .collect();
        let functional = |k: usize| {
            let term = |(x, w): (&f64, &f64)| (k as f64 + 0.5) * w * legendre(k, *x);
            rule.nodes.iter().zip(&rule.weights).map(term).collect()
        };
        let tail = [functional(n - 1), functional(n - 2), functional(n - 3)];
        Self { nodes: rule.nodes, weights: rule.weights, barycentric, tail }
    }

    /// The number of nodes.
    pub(crate) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// The largest of the last three Legendre coefficients of the function with these values at the nodes: what is
    /// left out of the series is of that size when the coefficients decay, and larger values tell that they do not.
    pub(crate) fn unresolved<T: Scalar>(&self, values: &[T]) -> f64 {
        let coefficient =
            |functional: &Vec<f64>| functional.iter().zip(values).map(|(c, v)| *v * *c).sum::<T>().modulus();
        self.tail.iter().map(coefficient).fold(0.0, f64::max)
    }

    /// The values at ξ of the polynomials that are 1 at one node and 0 at the others.
    pub(crate) fn basis_at(&self, xi: f64, basis: &mut [f64]) {
        let mut sum = 0.0;
        for ((value, node), weight) in basis.iter_mut().zip(&self.nodes).zip(&self.barycentric) {
            *value = weight / (xi - node);
            sum += *value;
        }
        if sum.is_finite() {
            basis.iter_mut().for_each(|value| *value /= sum);
        } else {
            // ξ is a node, or closer to one than doubles can tell.
            basis.iter_mut().zip(&self.nodes).for_each(|(value, node)| {
                *value = if (xi - node).abs() < f64::MIN_POSITIVE.sqrt() { 1.0 } else { 0.0 };
            });
        }
    }

    /// The polynomial through these values, at ξ.
    pub(crate) fn interpolate<T: Scalar>(&self, values: &[T], xi: f64) -> T {
        let (mut above, mut below) = (T::ZERO, 0.0);
        for ((value, node), weight) in values.iter().zip(&self.nodes).zip(&self.barycentric) {
            let ratio = weight / (xi - node);
            if !ratio.is_finite() {
                return *value;
            }
            above += *value * ratio;
            below += ratio;
        }
        above * (1.0 / below)
    }
}

/// P_k(x) by the three-term recurrence (paper, (4.14)).
fn legendre(k: usize, x: f64) -> f64 {
    let (mut before, mut p) = (0.0, 1.0);
    for j in 1..=k {
        let j = j as f64;
        (before, p) = (p, ((2.0 * j - 1.0) * x * p - (j - 1.0) * before) / j);
    }
    p
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_interpolated_and_their_last_coefficients_seen() {
        let p = |x: f64| x.powi(15) - 3.0 * x.powi(7) + 0.5;
        let values: Vec<f64> = COARSE.nodes.iter().map(|x| p(*x)).collect();
        let mut basis = vec![0.0; COARSE.len()];
        for xi in [-1.0, -0.3, COARSE.nodes[3], 0.77, 1.0] {
            assert!((COARSE.interpolate(&values, xi) - p(xi)).abs() < 1e-14);
            COARSE.basis_at(xi, &mut basis);
            let sum: f64 = basis.iter().zip(&values).map(|(l, v)| l * v).sum();
            assert!((sum - p(xi)).abs() < 1e-14);
        }
        // 3 P₁₄ + P₀.
        let series: Vec<f64> = COARSE.nodes.iter().map(|x| 3.0 * legendre(14, *x) + 1.0).collect();
        assert!((COARSE.unresolved(&series) - 3.0).abs() < 1e-13);
        let smooth: Vec<f64> = COARSE.nodes.iter().map(|x| x.exp()).collect();
        // (2k + 1) i_k(1) = (2k + 1) / (2k + 1)!! (1 + 1/(2(2k + 3)) + …), i_k being a spherical Bessel function, for k = 13.
        let exact = (1..=12).map(|k| 1.0 / f64::from(2 * k + 1)).product::<f64>() * (1.0 + 1.0 / 58.0);
        assert!((COARSE.unresolved(&smooth) / exact - 1.0).abs() < 0.01);
    }
}
