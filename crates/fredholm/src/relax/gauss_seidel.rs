//! u_i ← (f_i + ρ_i Σ_{j≠i} F_ij u_j) / (1 − ρ_i F_ii), i after i: Gauss–Seidel (paper, §3.4.3, (3.9) mended).

use super::{Relaxation, step};
use crate::operator::{Gather, Gathered, Rows};
use crate::system::System;
use crate::value::Value;
use rayon::prelude::*;

/// Gauss–Seidel from u = f, gathering along rows: the classical radiosity algorithm (paper, §3.5.1).
///
/// Rows are read by all cores, a block at a time: each row of the block is summed with the values at the block's
/// start, and what changes inside the block is corrected as the unknowns are updated one after the other. The
/// result is Gauss–Seidel's own up to rounding, and the same for any number of threads. An operator that has its own way
/// of [`gathering`](Rows::gathering) says what the blocks are and in which order they come.
#[derive(Debug)]
pub struct GaussSeidel<'a, V, F> {
    system: System<'a, V, F>,
    solution: Vec<V>,
    gather: Option<Box<dyn Gather<V> + 'a>>,
}

/// Rows in a block: enough to share among the cores, few enough that the corrections (a block's square) cost
/// nothing beside the rows.
const BLOCK: usize = 64;

impl<'a, V: Value, F: Rows> GaussSeidel<'a, V, F> {
    /// Starts from u = f.
    pub fn new(system: System<'a, V, F>) -> Self {
        Self { system, solution: system.source.to_vec(), gather: system.operator.gathering() }
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

    /// Updates the unknowns of a block of rows; returns the largest residual met.
    fn update(&mut self, block: std::ops::Range<usize>) -> f64 {
        let start = block.start;
        let (sums, inside): (Vec<V>, Vec<[f64; BLOCK]>) = self.gather(block).into_iter().unzip();
        let mut steps = [V::splat(0.0); BLOCK];
        let steps = &mut steps[..sums.len()];
        relax_block(self.system, &mut self.solution, |k| start + k, &sums, |k| &inside[k], steps)
    }

    /// The same of all blocks that the operator gathers at once.
    fn update_all(&mut self, gather: &mut dyn Gather<V>) -> f64 {
        let (mut steps, mut largest) = (Vec::new(), 0.0);
        for group in 0..gather.groups() {
            let Gathered { unknowns, sums, inside } = gather.group(group, &self.solution);
            let m = unknowns.len();
            steps.clear();
            steps.resize(m, V::splat(0.0));
            let row = |k: usize| &inside[k * m..(k + 1) * m];
            let met = relax_block(self.system, &mut self.solution, |k| unknowns[k], sums, row, &mut steps);
            gather.changed(group, &steps);
            largest = larger(largest, met);
        }
        largest
    }
}

/// Updates the unknowns of a block one after the other, from what each gathers by the values at the block's start, and the
/// entries between them, row by row; returns the largest residual met.
fn relax_block<'m, V: Value, F>(
    system: System<'_, V, F>,
    solution: &mut [V],
    unknown: impl Fn(usize) -> usize,
    sums: &[V],
    inside: impl Fn(usize) -> &'m [f64],
    steps: &mut [V],
) -> f64 {
    let mut largest = 0.0_f64;
    for (k, gathered) in sums.iter().enumerate() {
        let (i, row) = (unknown(k), inside(k));
        let (f, rho) = (system.source[i], system.coefficient[i]);
        let changed = (0..k).fold(*gathered, |sum, l| sum + steps[l] * row[l]);
        let residual = f + rho * changed - solution[i];
        steps[k] = step(residual, rho, row[k]);
        solution[i] += steps[k];
        largest = larger(largest, residual.magnitude());
    }
    largest
}

/// The larger of two, and NaN once one is.
fn larger(a: f64, b: f64) -> f64 {
    if b.is_nan() || b > a { b } else { a }
}

impl<V: Value, F: Rows> Relaxation<V> for GaussSeidel<'_, V, F> {
    fn sweep(&mut self) -> f64 {
        if let Some(mut gather) = self.gather.take() {
            let largest = self.update_all(&mut *gather);
            self.gather = Some(gather);
            return largest;
        }
        let n = self.system.dim();
        (0..n).step_by(BLOCK).map(|start| self.update(start..(start + BLOCK).min(n))).fold(0.0, larger)
    }

    fn solution(&self) -> Vec<V> {
        self.solution.clone()
    }

    fn residual(&self) -> Vec<V> {
        self.system.residual(&self.solution)
    }
}
