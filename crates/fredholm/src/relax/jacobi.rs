//! u_i ← (f_i + ρ_i Σ_{j≠i} F_ij u_j) / (1 − ρ_i F_ii), all i at once: Jacobi (paper, §3.4.2, (3.8) mended).

use super::{Relaxation, step};
use crate::operator::Operator;
use crate::system::System;
use crate::value::{Value, max_norm};

/// Jacobi's method from u = 0. Where F has no diagonal it is [`super::SuccessiveApproximation`].
#[derive(Debug)]
pub struct Jacobi<'a, V, F> {
    system: System<'a, V, F>,
    solution: Vec<V>,
    residual: Vec<V>,
}

impl<'a, V: Value, F: Operator<V>> Jacobi<'a, V, F> {
    /// Starts from u = 0.
    pub fn new(system: System<'a, V, F>) -> Self {
        Self { system, solution: vec![V::splat(0.0); system.dim()], residual: system.source.to_vec() }
    }
}

impl<V: Value, F: Operator<V>> Relaxation<V> for Jacobi<'_, V, F> {
    fn sweep(&mut self) -> f64 {
        let System { coefficient, operator, .. } = self.system;
        for (i, u) in self.solution.iter_mut().enumerate() {
            *u += step(self.residual[i], coefficient[i], operator.diagonal(i));
        }
        self.residual = self.system.residual(&self.solution);
        max_norm(&self.residual)
    }

    fn solution(&self) -> Vec<V> {
        self.solution.clone()
    }

    fn residual(&self) -> Vec<V> {
        self.residual.clone()
    }
}
