//! Nyström: F_ij = K(x_i, x_j) w_j, the integral replaced by a rule (paper, §1.2.3, (1.27)).

use super::Coupling;
use crate::kernel::Kernel;
use crate::quadrature::Quadrature;
use crate::value::Value;

/// A kernel sampled at the nodes of a quadrature rule.
#[derive(Clone, Debug)]
pub struct Nystrom<K, P> {
    kernel: K,
    rule: Quadrature<P>,
}

impl<P: Sync, K: Kernel<P>> Nystrom<K, P> {
    /// The operator ∫ K(x, y) φ(y) dy with `rule` for the integral.
    pub fn new(kernel: K, rule: Quadrature<P>) -> Self {
        Self { kernel, rule }
    }

    /// The kernel.
    pub fn kernel(&self) -> &K {
        &self.kernel
    }

    /// The nodes x_i, where the unknowns u_i are values of φ.
    pub fn nodes(&self) -> &[P] {
        &self.rule.nodes
    }

    /// Σ_j K(x, x_j) w_j u_j at any point x. With it, Nyström's interpolant (1.29) of a solution u is
    /// φ(x) = f(x) + ρ(x) · `apply_at(x, u)`, which passes through the u_i. Radiosity calls it final gather.
    pub fn apply_at<V: Value>(&self, x: &P, u: &[V]) -> V {
        let terms = self.rule.nodes.iter().zip(&self.rule.weights).zip(u);
        terms.fold(V::splat(0.0), |sum, ((y, w), u)| sum + *u * (self.kernel.at(x, y) * w))
    }
}

impl<P: Sync, K: Kernel<P>> Coupling for Nystrom<K, P> {
    fn dim(&self) -> usize {
        self.rule.nodes.len()
    }

    fn entry(&self, i: usize, j: usize) -> f64 {
        self.kernel.at(&self.rule.nodes[i], &self.rule.nodes[j]) * self.rule.weights[j]
    }

    /// w_i K(x_i, x_j) w_j is symmetric when K is: the rule's weights are those of reciprocity.
    fn reciprocity(&self) -> Option<&[f64]> {
        self.kernel.is_symmetric().then_some(&self.rule.weights)
    }
}
