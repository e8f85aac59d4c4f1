//! GMRES: the u in u₀ + span{r, Ar, A²r, …}, A = I − ρF, with the smallest residual (Saad & Schultz 1986).

use crate::operator::Operator;
use crate::relax::Relaxation;
use crate::system::System;
use crate::value::{Value, max_norm};
use rayon::prelude::*;

/// Restarted GMRES, all channels in lockstep: every scalar of the method is a [`Value`], so that each channel
/// has its own Krylov space while F is applied to all of them at once.
#[derive(Debug)]
pub struct Gmres<'a, V, F> {
    system: System<'a, V, F>,
    start: Vec<V>,
    /// Orthonormal basis of the Krylov space, by channel.
    basis: Vec<Vec<V>>,
    /// Columns of the upper triangular R of the Hessenberg matrix's QR factorisation.
    triangle: Vec<Vec<V>>,
    /// Givens rotations (cosine, sine).
    rotations: Vec<(V, V)>,
    /// Rotated right-hand side; the last entry is the norm of the residual.
    rotated: Vec<V>,
}

/// Vectors kept before a restart. Second-kind equations need 10 to 30; 60 vectors of 10⁵ colours take 144 MB.
const RESTART: usize = 60;

/// Below this part of its length before orthogonalisation a new vector is rounding: the channel's space is complete.
const BREAKDOWN: f64 = 1e-14;

/// Below this part of the first residual the estimated one is rounding: only a new start can get on from there.
const COMPLETE: f64 = 1e-15;

impl<'a, V: Value, F: Operator<V>> Gmres<'a, V, F> {
    /// Starts from u = f.
    pub fn new(system: System<'a, V, F>) -> Self {
        let mut gmres = Self {
            system,
            start: system.source.to_vec(),
            basis: Vec::new(),
            triangle: Vec::new(),
            rotations: Vec::new(),
            rotated: Vec::new(),
        };
        gmres.restart();
        gmres
    }

    fn restart(&mut self) {
        let residual = self.system.residual(&self.start);
        let norm = norm(&residual);
        self.basis = vec![scaled(&residual, reciprocal(norm))];
        self.rotated = vec![norm];
        self.triangle.clear();
        self.rotations.clear();
    }

    /// A v orthogonalised against the basis: (the column of the Hessenberg matrix, the new unit vector).
    fn arnoldi(&self) -> (Vec<V>, Vec<V>) {
        let newest = &self.basis[self.basis.len() - 1];
        let transported = self.system.transport(newest);
        let mut w: Vec<V> = newest.iter().zip(&transported).map(|(v, t)| *v - *t).collect();
        let before = norm(&w);
        let mut column = vec![V::splat(0.0); self.basis.len() + 1];
        // Twice is enough (Kahan): the second pass removes what rounding left of the first.
        for _ in 0..2 {
            for (h, v) in column.iter_mut().zip(&self.basis) {
                let part = inner(v, &w);
                *h += part;
                w.par_iter_mut().zip(v).for_each(|(w, v)| *w -= *v * part);
            }
        }
        let mut length = norm(&w);
        for (length, before) in length.channels_mut().iter_mut().zip(before.channels()) {
            if *length <= BREAKDOWN * before {
                *length = 0.0;
            }
        }
        column[self.basis.len()] = length;
        (column, scaled(&w, reciprocal(length)))
    }

    /// Brings a column of the Hessenberg matrix to triangular form and the right-hand side along with it.
    fn rotate(&mut self, mut column: Vec<V>) {
        for (k, &(c, s)) in self.rotations.iter().enumerate() {
            (column[k], column[k + 1]) =
                (c * column[k] + s * column[k + 1], c * column[k + 1] - s * column[k]);
        }
        let k = self.rotations.len();
        let length = (column[k] * column[k] + column[k + 1] * column[k + 1]).map(f64::sqrt);
        // A channel that is done (length 0) keeps its residual: its cosine is 0, and its sine −1.
        let sine = column[k + 1].zip(length, |h, length| if length == 0.0 { -1.0 } else { h / length });
        let (c, s) = (column[k] * reciprocal(length), sine);
        let last = self.rotated[k];
        self.rotated[k] = c * last;
        self.rotated.push(s * last * -1.0);
        column[k] = length;
        column.truncate(k + 1);
        self.triangle.push(column);
        self.rotations.push((c, s));
    }

    /// y with R y = rotated right-hand side, by back substitution.
    fn coordinates(&self) -> Vec<V> {
        let n = self.triangle.len();
        let mut y = self.rotated[..n].to_vec();
        for i in (0..n).rev() {
            let known = (i + 1..n).fold(y[i], |sum, j| sum - self.triangle[j][i] * y[j]);
            y[i] = known * reciprocal(self.triangle[i][i]);
        }
        y
    }
}

impl<V: Value, F: Operator<V>> Relaxation<V> for Gmres<'_, V, F> {
    /// One step of Arnoldi's process. The norm returned is the 2-norm, which is never below the ∞-norm.
    fn sweep(&mut self) -> f64 {
        let estimate = max_norm(&self.rotated[self.rotated.len() - 1..]);
        if self.triangle.len() == RESTART || estimate <= COMPLETE * max_norm(&self.rotated[..1]) {
            self.start = self.solution();
            self.restart();
        }
        let (column, vector) = self.arnoldi();
        self.rotate(column);
        self.basis.push(vector);
        max_norm(&self.rotated[self.rotated.len() - 1..])
    }

    fn solution(&self) -> Vec<V> {
        let mut u = self.start.clone();
        for (y, v) in self.coordinates().iter().zip(&self.basis) {
            u.iter_mut().zip(v).for_each(|(u, v)| *u += *v * *y);
        }
        u
    }

    fn residual(&self) -> Vec<V> {
        self.system.residual(&self.solution())
    }
}

/// Σ_i a_i b_i by channel, always in the same order.
fn inner<V: Value>(a: &[V], b: &[V]) -> V {
    a.iter().zip(b).fold(V::splat(0.0), |sum, (a, b)| sum + *a * *b)
}

fn norm<V: Value>(a: &[V]) -> V {
    inner(a, a).map(f64::sqrt)
}

fn scaled<V: Value>(a: &[V], factor: V) -> Vec<V> {
    a.iter().map(|a| *a * factor).collect()
}

/// 1/x by channel, and 0 where x is: a channel whose space is complete takes no further part.
fn reciprocal<V: Value>(x: V) -> V {
    x.map(|x| if x == 0.0 { 0.0 } else { 1.0 / x })
}
