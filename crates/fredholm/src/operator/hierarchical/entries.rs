//! F_ij where i and j are places in the tree's order: blocks of a [`Coupling`], whose clusters are ranges there.

use crate::discretize::Coupling;
use crate::operator::NotFinite;
use std::ops::Range;

/// The entries of a coupling, in the order of a tree.
pub(super) struct Entries<'a, C> {
    coupling: &'a C,
    order: &'a [usize],
    /// Whether places are numbers, as on a line: then parts of rows are asked for at once.
    ordered: bool,
}

impl<'a, C: Coupling> Entries<'a, C> {
    pub(super) fn new(coupling: &'a C, order: &'a [usize]) -> Self {
        let ordered = order.iter().enumerate().all(|(place, number)| place == *number);
        Self { coupling, order, ordered }
    }

    /// F_ij.
    pub(super) fn at(&self, i: usize, j: usize) -> Result<f64, NotFinite> {
        let value = self.coupling.entry(self.order[i], self.order[j]);
        if value.is_finite() { Ok(value) } else { Err(self.told(i, j, value)) }
    }

    /// Row i, from the first column of `columns` to the last.
    pub(super) fn row(&self, i: usize, columns: Range<usize>, row: &mut [f64]) -> Result<(), NotFinite> {
        if self.ordered {
            self.coupling.row(i, columns.start, row);
        } else {
            let of_row = self.order[i];
            let entries = row.iter_mut().zip(&self.order[columns.clone()]);
            entries.for_each(|(entry, j)| *entry = self.coupling.entry(of_row, *j));
        }
        match row.iter().position(|value| !value.is_finite()) {
            Some(k) => Err(self.told(i, columns.start + k, row[k])),
            None => Ok(()),
        }
    }

    /// Column j, from the first row of `rows` to the last.
    pub(super) fn column(&self, rows: Range<usize>, j: usize, column: &mut [f64]) -> Result<(), NotFinite> {
        column.iter_mut().zip(rows).try_for_each(|(entry, i)| self.at(i, j).map(|value| *entry = value))
    }

    fn told(&self, i: usize, j: usize, value: f64) -> NotFinite {
        NotFinite { row: self.order[i], column: self.order[j], value }
    }
}

/// A number that looks like chance and is the same every time: the k-th of a stream (splitmix64; Steele, Lea & Flood 2014).
pub(super) fn hashed(stream: u64, k: usize) -> u64 {
    let mut z = stream
        .wrapping_mul(0xD134_2543_DE82_EF95)
        .wrapping_add((k as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15));
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

/// One of 0, …, n − 1.
pub(super) fn chosen(stream: u64, k: usize, n: usize) -> usize {
    ((u128::from(hashed(stream, k)) * n as u128) >> 64) as usize
}
