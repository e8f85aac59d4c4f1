//! u_j(x) = (w_j / (x − x_j)) / Σ_i w_i / (x − x_i): Lagrange's polynomials, stable for any degree (paper, §1.3.2).

use std::f64::consts::PI;

/// Nodes on [−1, 1], ascending, with their barycentric weights (up to a common factor).
#[derive(Clone, Debug)]
pub(super) struct Barycentric {
    pub nodes: Vec<f64>,
    weights: Vec<f64>,
}

impl Barycentric {
    /// The n roots of Chebyshev's polynomial T_n. They leave out the ends, where a source may be singular.
    pub fn chebyshev(n: usize) -> Self {
        let angle = |k: usize| (k as f64 + 0.5) * PI / n as f64;
        Self {
            // The sine of an angle from the middle keeps the nodes symmetric and exact about 0.
            nodes: (0..n).map(|k| (PI * (2 * k + 1) as f64 / (2 * n) as f64 - PI / 2.0).sin()).collect(),
            weights: (0..n).map(|k| sign(k) * angle(k).sin()).collect(),
        }
    }

    /// The roots x_j of Legendre's P_n, whose Lagrange polynomials are orthogonal: ⟨u_i, u_j⟩ = λ_j δ_ij with the weights
    /// λ of Gauss's rule. The barycentric weights are (−1)^j √((1 − x_j²) λ_j).
    pub fn legendre(n: usize) -> Self {
        let rule = crate::quadrature::gauss_legendre(n, -1.0, 1.0);
        let weight = |k: usize| sign(k) * ((1.0 - rule.nodes[k].powi(2)) * rule.weights[k]).sqrt();
        Self { weights: (0..n).map(weight).collect(), nodes: rule.nodes }
    }

    /// All u_j(t), written to `values`.
    pub fn values(&self, t: f64, values: &mut Vec<f64>) {
        values.clear();
        if let Some(node) = self.nodes.iter().position(|node| *node == t) {
            values.resize(self.nodes.len(), 0.0);
            values[node] = 1.0;
            return;
        }
        values.extend(self.nodes.iter().zip(&self.weights).map(|(node, weight)| weight / (t - node)));
        let sum: f64 = values.iter().sum();
        values.iter_mut().for_each(|value| *value /= sum);
    }
}

fn sign(k: usize) -> f64 {
    if k.is_multiple_of(2) { 1.0 } else { -1.0 }
}
