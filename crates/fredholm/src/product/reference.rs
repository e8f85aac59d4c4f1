//! g(x) = Σ_j g(x_j) u_j(x) at the nodes of Gauss–Legendre on [−1, 1]: a place to interpolate, and to see whether a function is
//! resolved (paper, §1.3.2, §4.3.2).

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
    /// Row by row, the basis polynomials at the nodes of [`COARSE`] of the left half and of the right one.
    halves: [Vec<f64>; 2],
    /// The basis polynomials at −1 and at 1.
    ends: [Vec<f64>; 2],
}

/// The nodes of a panel, where the equation is solved.
pub(crate) const POINTS: usize = 16;

/// Nodes of a panel, where the equation is solved.
pub(crate) static COARSE: LazyLock<Reference> = LazyLock::new(|| Reference::new(POINTS));

/// Nodes of a panel, where the solution is put to the test: none of them is a node of [`COARSE`].
pub(crate) static FINE: LazyLock<Reference> = LazyLock::new(|| Reference::new(24));

/// Nodes towards a singularity.
pub(crate) static SINGULAR: LazyLock<Reference> = LazyLock::new(|| Reference::new(MOST));

/// Nodes of the largest reference.
const MOST: usize = 40;

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
        let (halves, ends) = ([Vec::new(), Vec::new()], [Vec::new(), Vec::new()]);
        let mut reference =
            Self { nodes: rule.nodes, weights: rule.weights, barycentric, tail, halves, ends };
        reference.ends = [-1.0, 1.0].map(|end| reference.basis_at_all(&[end]));
        reference.halves = [-0.5, 0.5].map(|middle| {
            let nodes = gauss_legendre(POINTS, middle - 0.5, middle + 0.5).nodes;
            reference.basis_at_all(&nodes)
        });
        reference
    }

    /// Row by row, the basis polynomials at these ξ.
    pub(crate) fn basis_at_all(&self, xi: &[f64]) -> Vec<f64> {
        let mut matrix = vec![0.0; xi.len() * self.len()];
        let rows = matrix.chunks_exact_mut(self.len());
        rows.zip(xi).for_each(|(row, xi)| self.spread(*xi, 1.0, row));
        matrix
    }

    /// Adds to `row` what weights at the nodes of [`COARSE`] of the two halves amount to for a polynomial given here.
    pub(crate) fn gather<T: Scalar>(&self, left: &[T; POINTS], right: &[T; POINTS], row: &mut [T]) {
        for (weights, matrix) in [left, right].into_iter().zip(&self.halves) {
            for (weight, basis) in weights.iter().zip(matrix.chunks_exact(self.len())) {
                row.iter_mut().zip(basis).for_each(|(entry, l)| *entry += *weight * *l);
            }
        }
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

    /// Adds to `row` what a weight at ξ amounts to for a polynomial given at the nodes: weight · u_j(ξ).
    pub(crate) fn spread<T: Scalar>(&self, xi: f64, weight: T, row: &mut [T]) {
        let mut ratios = [0.0; MOST];
        let ratios = &mut ratios[..self.len()];
        let terms = self.nodes.iter().zip(&self.barycentric);
        ratios.iter_mut().zip(terms).for_each(|(ratio, (node, weight))| *ratio = weight / (xi - node));
        let sum: f64 = ratios.iter().sum();
        if sum.is_finite() {
            let factor = weight * (1.0 / sum);
            row.iter_mut().zip(ratios).for_each(|(entry, ratio)| *entry += factor * *ratio);
        } else if let Some(j) = self.nodes.iter().position(|node| *node == xi) {
            // 1/0: ξ is a node.
            row[j] += weight;
        }
    }

    /// The polynomial through these values, at −1 and at 1.
    pub(crate) fn at_ends<T: Scalar>(&self, values: &[T]) -> [T; 2] {
        [0, 1].map(|end| self.ends[end].iter().zip(values).map(|(l, v)| *v * *l).sum())
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
        for xi in [-1.0, -0.3, COARSE.nodes[3], 0.77, 1.0] {
            assert!((COARSE.interpolate(&values, xi) - p(xi)).abs() < 1e-14);
            let sum: f64 = COARSE.basis_at_all(&[xi]).iter().zip(&values).map(|(l, v)| l * v).sum();
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
