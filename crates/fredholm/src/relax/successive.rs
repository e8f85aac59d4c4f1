//! u ← u + r, r ← ρ ⊙ (F r): successive approximations, the Neumann series term by term (paper, §1.2.2).

use super::Relaxation;
use crate::operator::Operator;
use crate::system::System;
use crate::value::{Value, max_norm};

/// Successive approximations u ← f + ρ ⊙ (F u) from u = 0. It converges when the spectral radius of ρF is below 1.
///
/// The residual after k sweeps is the next term (ρF)^k f of the Neumann series. In radiosity each sweep is one
/// bounce of light: after one sweep u is the emission, after two the light that has bounced once.
#[derive(Debug)]
pub struct SuccessiveApproximation<'a, V, F> {
    system: System<'a, V, F>,
    solution: Vec<V>,
    term: Vec<V>,
}

impl<'a, V: Value, F: Operator<V>> SuccessiveApproximation<'a, V, F> {
    /// Starts from u = 0.
    pub fn new(system: System<'a, V, F>) -> Self {
        Self { system, solution: vec![V::splat(0.0); system.dim()], term: system.source.to_vec() }
    }
}

impl<V: Value, F: Operator<V>> Relaxation<V> for SuccessiveApproximation<'_, V, F> {
    fn sweep(&mut self) -> f64 {
        self.solution.iter_mut().zip(&self.term).for_each(|(u, term)| *u += *term);
        self.term = self.system.transport(&self.term);
        max_norm(&self.term)
    }

    fn solution(&self) -> Vec<V> {
        self.solution.clone()
    }

    fn residual(&self) -> Vec<V> {
        self.term.clone()
    }
}
