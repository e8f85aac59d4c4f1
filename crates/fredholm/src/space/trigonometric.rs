//! u_j(x) = D_n(2π(x − x_j)/(b − a)): trigonometric interpolation at equidistant nodes, of period b − a (paper, §1.3.3).

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

/// sin(nt/2) / (n sin(t/2)) for odd n, sin(nt/2) / (n tan(t/2)) for even n.
fn dirichlet(n: usize, t: f64) -> f64 {
    let half = 0.5 * t;
    let sine = half.sin();
    if sine == 0.0 {
        return 1.0;
    }
    let kernel = (n as f64 * half).sin() / (n as f64 * sine);
    if n.is_multiple_of(2) { kernel * half.cos() } else { kernel }
}

impl Basis for Trigonometric {
    fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    fn values(&self, x: f64, values: &mut Vec<f64>) -> usize {
        let n = self.nodes.len();
        values.clear();
        values.extend(self.nodes.iter().map(|node| {
            // One period about 0: sin(nt/2) of a large t would lose digits, and t = 2π must count as 0.
            let turns = (x - node) / self.period;
            dirichlet(n, 2.0 * PI * (turns - turns.round()))
        }));
        0
    }
}
