//! F_b ≈ Σ_l u_l v_lᵀ from a few of its rows and columns: adaptive cross approximation (Bebendorf 2000; Bebendorf 2008, §3.4).
//!
//! In step l the residual of one row, divided by its largest entry, is v_l, and the residual of that entry's column is u_l. What
//! says that this is enough, |u_l| |v_l| ≤ ε |F_b|, sees only rows and columns that the crosses met: a block in two parts, or one
//! with rows of zeros, fools it. So entries in every row and in every column have the last word, and where one of them is
//! not small, its row is next.

use super::entries::{Entries, chosen};
use crate::discretize::Coupling;
use crate::operator::NotFinite;
use std::ops::Range;

/// U Vᵀ, column after column.
#[derive(Clone, Debug, Default)]
pub(super) struct Cross {
    pub(super) rank: usize,
    pub(super) u: Vec<f64>,
    pub(super) v: Vec<f64>,
}

/// The block to be approximated and how.
pub(super) struct Approximation<'a, C> {
    pub(super) entries: &'a Entries<'a, C>,
    pub(super) rows: Range<usize>,
    pub(super) columns: Range<usize>,
    /// Of the block's Frobenius norm.
    pub(super) tolerance: f64,
    /// Of a higher rank nothing is made.
    pub(super) most: usize,
}

/// What is left of an entry by rounding, as part of the block's largest entries.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

impl<C: Coupling> Approximation<'_, C> {
    /// The crosses; `None` where they would be too many.
    pub(super) fn cross(&self) -> Result<Option<Cross>, NotFinite> {
        let (m, n) = (self.rows.len(), self.columns.len());
        let mut crossing = Crossing::new(m, n);
        let mut next = Some(m / 2);
        let mut round = 0;
        while let Some(i) = next {
            let step = self.step(&mut crossing, i)?;
            next = match step {
                Some((row, false)) => Some(row),
                // Enough as it seems, or a row of nothing: ask everywhere.
                _ => {
                    round += 1;
                    self.missed(&crossing, round)?
                }
            };
            if next.is_some() && crossing.cross.rank >= self.most {
                return Ok(None);
            }
        }
        Ok(Some(crossing.cross))
    }

    /// A cross through row i: the row for the next one, and whether this one was small. `None` where the row has nothing left.
    fn step(&self, crossing: &mut Crossing, i: usize) -> Result<Option<(usize, bool)>, NotFinite> {
        let (m, n) = (self.rows.len(), self.columns.len());
        let mut row = vec![0.0; n];
        self.entries.row(self.rows.start + i, self.columns.clone(), &mut row)?;
        let size = largest(&row).1;
        crossing.cross.subtract_row(i, &mut row);
        crossing.met[i] = true;
        let (j, pivot) = largest(&row);
        if pivot <= ROUNDING * size {
            return Ok(None);
        }
        let mut column = vec![0.0; m];
        self.entries.column(self.rows.clone(), self.columns.start + j, &mut column)?;
        crossing.cross.subtract_column(j, &mut column);
        let scale = row[j].recip();
        row.iter_mut().for_each(|entry| *entry *= scale);
        let next = crossing.unmet(&column);
        let share = crossing.add(&column, &row);
        let small = share <= self.tolerance * crossing.norm2.sqrt();
        Ok(next.map(|next| (next, small)).or(Some((0, true))))
    }

    /// The row in which most was missed, if that is too much: an entry of each row and one of each column are looked at.
    fn missed(&self, crossing: &Crossing, round: u64) -> Result<Option<usize>, NotFinite> {
        let (m, n) = (self.rows.len(), self.columns.len());
        let stream = (self.rows.start as u64) << 32 ^ self.columns.start as u64 ^ round << 58;
        let in_row = |k: usize| (k, chosen(stream, k, n));
        let in_column = |k: usize| (chosen(!stream, k, m), k);
        let (mut sum, mut size2, mut worst) = (0.0, 0.0, (None, 0.0));
        for (i, j) in (0..m).map(in_row).chain((0..n).map(in_column)) {
            let entry = self.entries.at(self.rows.start + i, self.columns.start + j)?;
            let missed = (entry - crossing.cross.at(i, j)).abs();
            (sum, size2) = (sum + missed * missed, size2 + entry * entry);
            if missed > worst.1 && !crossing.met[i] {
                worst = (Some(i), missed);
            }
        }
        let per_sample = (m * n) as f64 / (m + n) as f64;
        // Where the crosses see nothing of a block, its samples tell how large it is.
        let norm2 = crossing.norm2.max(size2 * per_sample);
        let allowed = self.tolerance.max(ROUNDING);
        Ok(if sum * per_sample > allowed * allowed * norm2 { worst.0 } else { None })
    }
}

/// The crosses so far, and what the search for more must know.
struct Crossing {
    cross: Cross,
    /// The rows that are in a cross, or have nothing to give.
    met: Vec<bool>,
    m: usize,
    n: usize,
    /// ‖U Vᵀ‖_F².
    norm2: f64,
}

impl Crossing {
    fn new(m: usize, n: usize) -> Self {
        Self { cross: Cross::default(), met: vec![false; m], m, n, norm2: 0.0 }
    }

    /// The row not met in which this column is largest.
    fn unmet(&self, column: &[f64]) -> Option<usize> {
        let mut best = (None, -1.0);
        for (i, entry) in column.iter().enumerate() {
            if !self.met[i] && entry.abs() > best.1 {
                best = (Some(i), entry.abs());
            }
        }
        best.0
    }

    /// Takes a cross in; |u| |v|.
    fn add(&mut self, u: &[f64], v: &[f64]) -> f64 {
        let share2 = dot(u, u) * dot(v, v);
        let others = self.cross.u.chunks_exact(self.m).zip(self.cross.v.chunks_exact(self.n));
        let mixed: f64 = others.map(|(other_u, other_v)| dot(u, other_u) * dot(v, other_v)).sum();
        self.norm2 = (self.norm2 + 2.0 * mixed + share2).max(0.0);
        self.cross.u.extend_from_slice(u);
        self.cross.v.extend_from_slice(v);
        self.cross.rank += 1;
        share2.sqrt()
    }
}

impl Cross {
    /// (U Vᵀ)_ij.
    fn at(&self, i: usize, j: usize) -> f64 {
        let (m, n) = (self.u.len() / self.rank.max(1), self.v.len() / self.rank.max(1));
        (0..self.rank).map(|l| self.u[l * m + i] * self.v[l * n + j]).sum()
    }

    fn subtract_row(&self, i: usize, row: &mut [f64]) {
        let m = self.u.len() / self.rank.max(1);
        for (l, v) in self.v.chunks_exact(row.len()).enumerate() {
            let u = self.u[l * m + i];
            row.iter_mut().zip(v).for_each(|(entry, v)| *entry -= u * v);
        }
    }

    fn subtract_column(&self, j: usize, column: &mut [f64]) {
        let n = self.v.len() / self.rank.max(1);
        for (l, u) in self.u.chunks_exact(column.len()).enumerate() {
            let v = self.v[l * n + j];
            column.iter_mut().zip(u).for_each(|(entry, u)| *entry -= v * u);
        }
    }
}

/// The place of the largest absolute value, and that.
fn largest(line: &[f64]) -> (usize, f64) {
    let mut best = (0, 0.0);
    for (k, entry) in line.iter().enumerate() {
        if entry.abs() > best.1 {
            best = (k, entry.abs());
        }
    }
    best
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    crate::operator::Line::Full(a).dot(b)
}
