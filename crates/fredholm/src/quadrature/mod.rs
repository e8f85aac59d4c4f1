//! ∫ g ≈ Σ_k w_k g(x_k): a quadrature rule is data, its nodes and its weights (paper, chapter 4).

mod gauss;

pub use gauss::gauss_legendre;

/// Nodes x_k and weights w_k. The weights carry the measure of the domain: they add up to its length or area.
#[derive(Clone, Debug, PartialEq)]
pub struct Quadrature<P> {
    /// The nodes.
    pub nodes: Vec<P>,
    /// The weights, as many as nodes.
    pub weights: Vec<f64>,
}

impl<P> Quadrature<P> {
    /// Σ_k w_k g(x_k).
    pub fn integrate(&self, integrand: impl Fn(&P) -> f64) -> f64 {
        self.nodes.iter().zip(&self.weights).map(|(x, w)| w * integrand(x)).sum()
    }

    /// The rule on another domain: each node and weight through `map`, which multiplies the weight by its Jacobian.
    pub fn map<Q>(&self, map: impl Fn(&P, f64) -> (Q, f64)) -> Quadrature<Q> {
        let (nodes, weights) = self.nodes.iter().zip(&self.weights).map(|(x, w)| map(x, *w)).unzip();
        Quadrature { nodes, weights }
    }
}

impl Quadrature<f64> {
    /// The tensor product of the rule with itself: from an interval to a square.
    pub fn squared(&self) -> Quadrature<[f64; 2]> {
        let pairs = || (0..self.nodes.len()).flat_map(|i| (0..self.nodes.len()).map(move |j| (i, j)));
        Quadrature {
            nodes: pairs().map(|(i, j)| [self.nodes[i], self.nodes[j]]).collect(),
            weights: pairs().map(|(i, j)| self.weights[i] * self.weights[j]).collect(),
        }
    }
}
