//! u_i ← u_i + r_i / (1 − ρ_i F_ii) for the i of the largest |r_i| w_i: Southwell (paper, §3.4.4, (3.10)).

use super::{Relaxation, step};
use crate::neumann::estimated_rest;
use crate::operator::Columns;
use crate::system::System;
use crate::value::{Value, max_norm};

/// Southwell's method from u = 0, shooting along columns: with areas for weights it is the progressive radiosity
/// algorithm (paper, §3.5.2), whose picture is u + r.
///
/// A sweep relaxes one unknown. Its residual update costs O(n) and one column of F, which may be computed for the
/// purpose and forgotten: the memory is O(n).
#[derive(Debug)]
pub struct Southwell<'a, V, F> {
    system: System<'a, V, F>,
    weights: &'a [f64],
    ambient: bool,
    solution: Vec<V>,
    residual: Vec<V>,
    gathered: Vec<V>,
    buffer: Vec<f64>,
}

impl<'a, V: Value, F: Columns> Southwell<'a, V, F> {
    /// Starts from u = 0; `weights` are positive, one per unknown: ones for Southwell's own choice of i.
    pub fn new(system: System<'a, V, F>, weights: &'a [f64]) -> Self {
        assert_eq!(weights.len(), system.source.len(), "one weight per unknown");
        Self {
            system,
            weights,
            ambient: false,
            solution: vec![V::splat(0.0); system.source.len()],
            residual: system.source.to_vec(),
            gathered: vec![V::splat(0.0); system.source.len()],
            buffer: Vec::new(),
        }
    }

    /// Adds to previews the ambient estimate: ρ times the [`estimated_rest`] of the Neumann series.
    pub fn with_ambient(mut self) -> Self {
        self.ambient = true;
        self
    }

    /// F u, carried along with the residual: what each unknown has gathered.
    pub fn gathered(&self) -> &[V] {
        &self.gathered
    }

    /// The unknown with the largest weighted residual, the first of equals; a NaN is chosen at once.
    fn choose(&self) -> usize {
        let mut best = (0, -1.0);
        for (i, (r, w)) in self.residual.iter().zip(self.weights).enumerate() {
            let size = r.magnitude() * w;
            if size.is_nan() {
                return i;
            }
            if size > best.1 {
                best = (i, size);
            }
        }
        best.0
    }
}

impl<V: Value, F: Columns> Relaxation<V> for Southwell<'_, V, F> {
    fn sweep(&mut self) -> f64 {
        if self.residual.is_empty() {
            return 0.0;
        }
        let i = self.choose();
        let column = self.system.operator.column(i, &mut self.buffer);
        let step = step(self.residual[i], self.system.coefficient[i], column.get(i));
        self.solution[i] += step;
        let receivers = self.residual.iter_mut().zip(&mut self.gathered).zip(self.system.coefficient);
        for (((r, gathered), rho), entry) in receivers.zip(column.iter()) {
            let received = step * entry;
            *gathered += received;
            *r += *rho * received;
        }
        self.residual[i] = V::splat(0.0);
        max_norm(&self.residual)
    }

    fn solution(&self) -> Vec<V> {
        self.solution.clone()
    }

    fn residual(&self) -> Vec<V> {
        self.residual.clone()
    }

    fn preview(&self) -> Vec<V> {
        let rho = self.system.coefficient;
        let rest = match self.ambient {
            true => estimated_rest(&self.residual, rho, self.weights),
            false => V::splat(0.0),
        };
        let shown = self.solution.iter().zip(&self.residual).zip(rho);
        shown.map(|((u, r), rho)| *u + *r + *rho * rest).collect()
    }
}
