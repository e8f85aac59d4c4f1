//! F kept whole, row by row, in single or double precision: n² numbers.

use super::{Columns, Line, Matrix, Rows};
use crate::discretize::Coupling;
use rayon::prelude::*;

/// A number as a matrix stores it: `f64`, or `f32` for half the memory.
pub trait Entry: Copy + Send + Sync + Default + Into<f64> {
    /// The nearest number that can be stored.
    fn round(number: f64) -> Self;

    /// Stored numbers as a [`Line`].
    fn line(entries: &[Self]) -> Line<'_>;
}

impl Entry for f64 {
    fn round(number: f64) -> Self {
        number
    }
    fn line(entries: &[Self]) -> Line<'_> {
        Line::Full(entries)
    }
}

impl Entry for f32 {
    fn round(number: f64) -> Self {
        number as f32
    }
    fn line(entries: &[Self]) -> Line<'_> {
        Line::Packed(entries)
    }
}

/// A dense matrix, stored by rows.
#[derive(Clone, Debug)]
pub struct Dense<T> {
    dim: usize,
    entries: Vec<T>,
}

/// An entry of F that is infinite or NaN: the kernel is singular where the rule samples it, or its arguments are wrong.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("F[{row}, {column}] is {value}: the kernel is not finite where the rule samples it")]
pub struct NotFinite {
    /// The row i.
    pub row: usize,
    /// The column j.
    pub column: usize,
    /// The value: infinite or NaN.
    pub value: f64,
}

impl<T: Entry> Dense<T> {
    /// Computes all entries on all cores; half of them where the coupling has reciprocity.
    ///
    /// `progress` is told the number of entries newly computed, from any thread.
    pub fn assemble<C: Coupling>(coupling: &C, progress: impl Fn(usize) + Sync) -> Result<Self, NotFinite> {
        let dim = coupling.dim();
        let mut matrix = Self { dim, entries: vec![T::default(); dim * dim] };
        let weights = coupling.reciprocity();
        matrix.fill(coupling, weights.is_some(), progress)?;
        if let Some(weights) = weights {
            matrix.mirror(weights);
        }
        Ok(matrix)
    }

    /// All entries, or those of the diagonal and right of it, by bands of rows that are found together.
    fn fill(
        &mut self,
        coupling: &impl Coupling,
        upper: bool,
        progress: impl Fn(usize) + Sync,
    ) -> Result<(), NotFinite> {
        let dim = self.dim;
        self.bands(coupling).into_par_iter().with_max_len(1).try_for_each_init(
            Vec::new,
            |buffer, (first, band)| {
                let from = if upper { first } else { 0 };
                let width = dim - from;
                buffer.resize(band.len() / dim * width, 0.0);
                coupling.rows(first, from, buffer);
                for (k, (numbers, row)) in buffer.chunks(width).zip(band.chunks_mut(dim)).enumerate() {
                    let left = if upper { k } else { 0 };
                    progress(width - left);
                    store(&numbers[left..], &mut row[from + left..], first + k, from + left)?;
                }
                Ok(())
            },
        )
    }

    /// The places of the rows, cut into the coupling's bands, each with its first row.
    fn bands(&mut self, coupling: &impl Coupling) -> Vec<(usize, &mut [T])> {
        let (mut bands, mut first, mut rest) = (Vec::new(), 0, self.entries.as_mut_slice());
        while first < self.dim {
            let rows = coupling.band(first).clamp(1, self.dim - first);
            let (band, below) = rest.split_at_mut(rows * self.dim);
            bands.push((first, band));
            (first, rest) = (first + rows, below);
        }
        bands
    }

    /// F_ij = F_ji w_j / w_i for j < i.
    fn mirror(&mut self, weights: &[f64]) {
        // Rows in bands: those above a band are finished and can be read while the band is written.
        const BAND: usize = 64;
        for start in (0..self.dim).step_by(BAND) {
            let end = (start + BAND).min(self.dim);
            let dim = self.dim;
            let (above, below) = self.entries.split_at_mut(start * dim);
            let band = &mut below[..(end - start) * dim];
            band.par_chunks_mut(dim).enumerate().for_each(|(k, row)| {
                let i = start + k;
                for j in 0..start {
                    row[j] = T::round(above[j * dim + i].into() * weights[j] / weights[i]);
                }
            });
            for i in start..end {
                for j in start..i {
                    let mirrored = band[(j - start) * dim + i].into() * weights[j] / weights[i];
                    band[(i - start) * dim + j] = T::round(mirrored);
                }
            }
        }
    }
}

/// Rounds the numbers of row i, from column `first` on, into their place.
fn store<T: Entry>(numbers: &[f64], row: &mut [T], i: usize, first: usize) -> Result<(), NotFinite> {
    for (k, (&value, place)) in numbers.iter().zip(row).enumerate() {
        if !value.is_finite() {
            return Err(NotFinite { row: i, column: first + k, value });
        }
        *place = T::round(value);
    }
    Ok(())
}

impl<T: Entry> Matrix for Dense<T> {
    fn dim(&self) -> usize {
        self.dim
    }

    fn diagonal(&self, i: usize) -> f64 {
        self.entries[i * self.dim + i].into()
    }
}

impl<T: Entry> Rows for Dense<T> {
    fn row<'a>(&'a self, i: usize, _buffer: &'a mut Vec<f64>) -> Line<'a> {
        T::line(&self.entries[i * self.dim..][..self.dim])
    }
}

impl<T: Entry> Columns for Dense<T> {
    fn column<'a>(&'a self, j: usize, buffer: &'a mut Vec<f64>) -> Line<'a> {
        buffer.clear();
        buffer.extend((0..self.dim).map(|i| self.entries[i * self.dim + j].into()));
        Line::Full(buffer)
    }
}
