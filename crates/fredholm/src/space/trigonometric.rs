//! u_j(x) = (−1)^j csc(t − t_j) / Σ_i (−1)^i csc(t − t_i), t = π(x − a)/(b − a): trigonometric interpolation at equidistant
//! nodes (paper, §1.3.3). For an even number of nodes the cotangent takes the place of the cosecant (Henrici 1979).

use super::{Basis, equal_parts};
use std::f64::consts::PI;

/// The trigonometric polynomials with n coefficients, of period b − a: for n = 2m + 1 those of degree m; for n = 2m also
/// cos(2πm(x − a)/(b − a)).
#[derive(Clone, Debug)]
pub struct Trigonometric {
    period: f64,
    nodes: Vec<f64>,
    breaks: Vec<f64>,
}

impl Trigonometric {
    /// Dimension n on [a, b), with nodes a + j(b − a)/n.
    pub fn new(a: f64, b: f64, n: usize) -> Self {
        let mut nodes = equal_parts(a, b, n);
        nodes.pop();
        // The highest frequency turns by ±c, c = πn/(2 pieces), on a piece: see `Polynomial` for c = 3/2.
        let pieces = (n as f64 * PI / 3.0).ceil() as usize;
        Self { period: b - a, nodes, breaks: equal_parts(a, b, pieces) }
    }
}

impl Basis for Trigonometric {
    fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    fn values(&self, x: f64, values: &mut Vec<f64>) -> usize {
        values.clear();
        for (j, node) in self.nodes.iter().enumerate() {
            // Within half a period of the node: the sine of a large angle would lose digits.
            let turns = (x - node) / self.period;
            let half = PI * (turns - turns.round());
            if half == 0.0 {
                values.fill(0.0);
                values.resize(self.nodes.len(), 0.0);
                values[j] = 1.0;
                return 0;
            }
            // Half a turn more changes the sign of the cosecant, not of the cotangent.
            let (inverse, flips) = if self.nodes.len().is_multiple_of(2) {
                (1.0 / half.tan(), false)
            } else {
                (1.0 / half.sin(), turns.round() % 2.0 != 0.0)
            };
            values.push(if j.is_multiple_of(2) == flips { -inverse } else { inverse });
        }
        let sum: f64 = values.iter().sum();
        values.iter_mut().for_each(|value| *value /= sum);
        0
    }
}
