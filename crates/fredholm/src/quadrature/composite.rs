//! ∫_a^b g ≈ Σ_i (α_{i+1} − α_i) Σ_j ω_j g(ξ_ij): one elementary rule on each of m panels (paper, §4.1, (4.2)).

use super::{Quadrature, QuadratureError, check_size, newton_cotes, newton_cotes_open};

impl Quadrature<f64> {
    /// The composite of an elementary rule on [0, 1]: on `panels` equal parts of [a, b]. Nodes at the joints, which two
    /// panels share, are kept once.
    ///
    /// # Errors
    ///
    /// When there is no panel.
    pub fn composite(&self, a: f64, b: f64, panels: usize) -> Result<Self, QuadratureError> {
        check_size("composite rule", panels, 1, usize::MAX)?;
        let edge = |k: usize| if k == panels { b } else { a + (b - a) * (k as f64 / panels as f64) };
        let width = (b - a) / panels as f64;
        let shared = self.nodes.len() > 1 && self.nodes[0] == 0.0 && self.nodes[self.nodes.len() - 1] == 1.0;
        let mut rule = Self { nodes: Vec::new(), weights: Vec::new() };
        for panel in 0..panels {
            let mut points = self.nodes.iter().zip(&self.weights);
            if shared && panel > 0 {
                // The last node so far is this panel's first.
                let joint = points.next().map_or(0.0, |(_, w)| w * width);
                rule.weights.last_mut().into_iter().for_each(|w| *w += joint);
            }
            for (x, w) in points {
                let inside = if *x == 1.0 { edge(panel + 1) } else { edge(panel) + width * x };
                rule.nodes.push(inside);
                rule.weights.push(w * width);
            }
        }
        Ok(rule)
    }
}

/// The composite midpoint rule on [a, b], of order 1.
///
/// # Errors
///
/// When there is no panel.
pub fn midpoint(a: f64, b: f64, panels: usize) -> Result<Quadrature<f64>, QuadratureError> {
    newton_cotes_open(1, 0.0, 1.0)?.composite(a, b, panels)
}

/// The composite trapezoidal rule on [a, b], of order 1 (4.34).
///
/// # Errors
///
/// When there is no panel.
pub fn trapezoid(a: f64, b: f64, panels: usize) -> Result<Quadrature<f64>, QuadratureError> {
    newton_cotes(1, 0.0, 1.0)?.composite(a, b, panels)
}

/// Simpson's composite rule on [a, b], of order 3; each panel has a node in its middle.
///
/// # Errors
///
/// When there is no panel.
pub fn simpson(a: f64, b: f64, panels: usize) -> Result<Quadrature<f64>, QuadratureError> {
    newton_cotes(2, 0.0, 1.0)?.composite(a, b, panels)
}

/// Boole's composite rule on [a, b], of order 5; each panel has three nodes inside.
///
/// # Errors
///
/// When there is no panel.
pub fn boole(a: f64, b: f64, panels: usize) -> Result<Quadrature<f64>, QuadratureError> {
    newton_cotes(4, 0.0, 1.0)?.composite(a, b, panels)
}

/// The trapezoidal rule for functions of period b − a: `n` equal weights at a + k (b − a)/n. It is exact for the
/// frequencies below n, and converges faster than any power for a function that is smooth all round.
///
/// `n = 0` gives the empty rule.
pub fn periodic_trapezoid(n: usize, a: f64, b: f64) -> Quadrature<f64> {
    let step = (b - a) / n.max(1) as f64;
    Quadrature {
        nodes: (0..n).map(|k| a + (b - a) * (k as f64 / n as f64)).collect(),
        weights: vec![step; n],
    }
}
