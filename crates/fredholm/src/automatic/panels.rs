//! φ_n(x) = Σ_j φ_n(x_j) u_j(x) on each of the panels that the interval is cut into: polynomials of degree 15 (paper, §1.3.2).

use crate::equation::Scalar;
use crate::product::{COARSE, Change, FINE, Reference};
use std::sync::LazyLock;

/// Panels from edge to edge, in the variable t of a [`Change`].
#[derive(Clone, Debug)]
pub(crate) struct Panels {
    edges: Vec<f64>,
}

impl Panels {
    /// `count` equal panels.
    pub(crate) fn equal((from, to): (f64, f64), count: usize) -> Self {
        let edge = |k: usize| from + (to - from) * (k as f64 / count as f64);
        let mut edges: Vec<f64> = (0..count).map(edge).collect();
        edges.push(to);
        Self { edges }
    }

    pub(crate) fn len(&self) -> usize {
        self.edges.len() - 1
    }

    /// Where panels begin and end, ascending.
    pub(crate) fn edges(&self) -> &[f64] {
        &self.edges
    }

    pub(crate) fn ends(&self, panel: usize) -> (f64, f64) {
        (self.edges[panel], self.edges[panel + 1])
    }

    /// The part of the interval that a panel takes.
    pub(crate) fn share(&self, panel: usize) -> f64 {
        let (low, high) = self.ends(panel);
        (high - low) / (self.edges[self.len()] - self.edges[0])
    }

    /// The nodes of all panels.
    pub(crate) fn nodes(&self, reference: &Reference) -> Vec<f64> {
        let nodes = |panel: usize| {
            let (low, high) = self.ends(panel);
            let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
            reference.nodes.iter().map(move |xi| middle + half * xi)
        };
        (0..self.len()).flat_map(nodes).collect()
    }

    /// The weights of ∫ dx at these nodes.
    pub(crate) fn weights(&self, reference: &Reference, change: Change) -> Vec<f64> {
        let nodes = self.nodes(reference);
        let weight = |(k, t): (usize, &f64)| {
            let (low, high) = self.ends(k / reference.len());
            0.5 * (high - low) * reference.weights[k % reference.len()] * change.slope(*t)
        };
        nodes.iter().enumerate().map(weight).collect()
    }

    /// The panel that t is in, and where, from −1 to 1.
    pub(crate) fn locate(&self, t: f64) -> (usize, f64) {
        let panel = self.edges.partition_point(|edge| *edge <= t).clamp(1, self.len()) - 1;
        let (low, high) = self.ends(panel);
        (panel, ((t - low) - (high - t)) / (high - low))
    }

    /// Each panel cut into `parts(panel)` equal ones.
    pub(crate) fn cut(&self, parts: impl Fn(usize) -> usize) -> Self {
        let mut edges = vec![self.edges[0]];
        for panel in 0..self.len() {
            let (low, high) = self.ends(panel);
            let count = parts(panel);
            edges.extend((1..count).map(|k| low + (high - low) * (k as f64 / count as f64)));
            edges.push(high);
        }
        Self { edges }
    }
}

/// The values at the nodes of [`FINE`] of what is given at those of [`COARSE`], panel by panel.
pub(crate) fn refined<T: Scalar>(values: &[T]) -> Vec<T> {
    static MATRIX: LazyLock<Vec<f64>> = LazyLock::new(|| COARSE.basis_at_all(&FINE.nodes));
    transferred(values, &MATRIX, COARSE.len())
}

/// The values at the nodes of [`COARSE`] of what is given at those of [`FINE`], panel by panel.
pub(crate) fn coarsened<T: Scalar>(values: &[T]) -> Vec<T> {
    static MATRIX: LazyLock<Vec<f64>> = LazyLock::new(|| FINE.basis_at_all(&COARSE.nodes));
    transferred(values, &MATRIX, FINE.len())
}

fn transferred<T: Scalar>(values: &[T], matrix: &[f64], n: usize) -> Vec<T> {
    let row = |panel: &[T], row: &[f64]| row.iter().zip(panel).map(|(l, v)| *v * *l).sum();
    values.chunks(n).flat_map(|panel| matrix.chunks(n).map(move |l| row(panel, l))).collect()
}
