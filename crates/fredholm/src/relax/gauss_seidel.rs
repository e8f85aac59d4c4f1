//! u_i ← (f_i + ρ_i Σ_{j≠i} F_ij u_j) / (1 − ρ_i F_ii), i after i: Gauss–Seidel (paper, §3.4.3, (3.9) mended).

use super::{Relaxation, step};
use crate::operator::Rows;
use crate::system::System;
use crate::value::Value;
use rayon::prelude::*;

/// Gauss–Seidel from u = f, gathering along rows: the classical radiosity algorithm (paper, §3.5.1).
///
/// Rows are read by all cores, a block at a time: each row of the block is summed with the values at the block's
/// start, and what changes inside the block is corrected as the unknowns are updated one after the other. The
/// result is Gauss–Seidel's own up to rounding, and the same for any number of threads.
#[derive(Debug)]
pub struct GaussSeidel<'a, V, F> {
    system: System<'a, V, F>,
    solution: Vec<V>,
}

/// Rows in a block: enough to share among the cores, few enough that the corrections (a block's square) cost
/// nothing beside the rows.
const BLOCK: usize = 64;

impl<'a, V: Value, F: Rows> GaussSeidel<'a, V, F> {
    /// Starts from u = f.
    pub fn new(system: System<'a, V, F>) -> Self {
        Self { system, solution: system.source.to_vec() }
    }

    /// (F u)_i and F_ik for k in the block, of each row i of a block.
    fn gather(&self, block: std::ops::Range<usize>) -> Vec<(V, [f64; BLOCK])> {
        let gathered = block.clone().into_par_iter().map_init(Vec::new, |buffer, i| {
            let row = self.system.operator.row(i, buffer);
            let mut inside = [0.0; BLOCK];
            inside.iter_mut().zip(block.clone()).for_each(|(entry, k)| *entry = row.get(k));
            (row.dot(&self.solution), inside)
        });
        gathered.collect()
    }

    /// Updates the unknowns of a block; returns the largest residual met.
    fn update(&mut self, block: std::ops::Range<usize>) -> f64 {
        let start = block.start;
        let mut steps = [V::splat(0.0); BLOCK];
        let mut largest = 0.0_f64;
        for (k, (gathered, inside)) in self.gather(block).into_iter().enumerate() {
            let i = start + k;
            let (f, rho) = (self.system.source[i], self.system.coefficient[i]);
            let changed = (0..k).fold(gathered, |sum, l| sum + steps[l] * inside[l]);
            let residual = f + rho * changed - self.solution[i];
            steps[k] = step(residual, rho, inside[k]);
            self.solution[i] += steps[k];
            let size = residual.magnitude();
            largest = if size.is_nan() { size } else { largest.max(size) };
        }
        largest
    }
}

impl<V: Value, F: Rows> Relaxation<V> for GaussSeidel<'_, V, F> {
    fn sweep(&mut self) -> f64 {
        let n = self.system.dim();
        let starts = (0..n).step_by(BLOCK);
        starts
            .map(|start| self.update(start..(start + BLOCK).min(n)))
            .fold(0.0, |a, b| if b.is_nan() || b > a { b } else { a })
    }

    fn solution(&self) -> Vec<V> {
        self.solution.clone()
    }

    fn residual(&self) -> Vec<V> {
        self.system.residual(&self.solution)
    }
}
