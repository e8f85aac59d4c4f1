//! P_k: continuous and of degree k on each of n equal elements, by values at barycentric nodes (paper, §3.2.1, (3.1)).

use super::{Basis, equal_parts};

/// Piecewise polynomials of degree k on n equal elements: continuous, of dimension nk + 1, for k ≥ 1; constants on each
/// element, of dimension n, for k = 0.
#[derive(Clone, Debug)]
pub struct Piecewise {
    degree: usize,
    nodes: Vec<f64>,
    breaks: Vec<f64>,
}

impl Piecewise {
    /// Degree `degree` on `elements` equal elements of [a, b].
    pub fn new(a: f64, b: f64, degree: usize, elements: usize) -> Self {
        let breaks = equal_parts(a, b, elements);
        let nodes = match degree {
            0 => breaks.windows(2).map(|edge| 0.5 * (edge[0] + edge[1])).collect(),
            _ => equal_parts(a, b, degree * elements),
        };
        Self { degree, nodes, breaks }
    }
}

/// Which of the pieces between the `breaks` holds x.
pub(super) fn piece(breaks: &[f64], x: f64) -> usize {
    breaks.partition_point(|edge| *edge <= x).clamp(1, breaks.len() - 1) - 1
}

impl Basis for Piecewise {
    fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    fn values(&self, x: f64, values: &mut Vec<f64>) -> usize {
        let first = self.degree * piece(&self.breaks, x);
        values.clear();
        if self.degree == 0 {
            values.push(1.0);
            return piece(&self.breaks, x);
        }
        let nodes = &self.nodes[first..=first + self.degree];
        values.extend(nodes.iter().map(|node| {
            let others = nodes.iter().filter(|other| *other != node);
            others.map(|other| (x - other) / (node - other)).product::<f64>()
        }));
        first
    }
}
