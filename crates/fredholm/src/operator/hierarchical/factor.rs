//! A matrix of m rows and k columns, kept so that its action streams memory: strip after strip, and in a strip by tiles.

use super::kernels::{column, gather, in_tiles, row, spread};
use super::strips::Strips;
use crate::value::Value;
use std::ops::Range;

/// Columns over a range of places: first those in double precision, then those for which single precision is enough.
#[derive(Clone, Debug)]
pub(super) struct Factor {
    range: Range<usize>,
    full: Vec<f64>,
    packed: Vec<f32>,
}

/// The rows of a factor that are in one strip.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece<'a> {
    pub(super) full: &'a [f64],
    pub(super) packed: &'a [f32],
}

impl Factor {
    /// From columns one after another, of which the first `full` are kept in double precision.
    pub(super) fn new(range: Range<usize>, columns: &[f64], full: usize, strips: &Strips) -> Self {
        let (first, others) = columns.split_at(full * range.len());
        let mut factor =
            Self { full: Vec::with_capacity(first.len()), packed: Vec::with_capacity(others.len()), range };
        for strip in strips.across(&factor.range) {
            let places = strips.part(&factor.range, strip);
            factor.full.extend(in_tiles(&some_rows(first, &factor.range, &places), places.len()));
            let packed = some_rows(others, &factor.range, &places);
            factor.packed.extend(in_tiles(&packed, places.len()).map(|number| number as f32));
        }
        factor
    }

    /// The places of its rows.
    pub(super) fn range(&self) -> &Range<usize> {
        &self.range
    }

    /// Bytes of its numbers.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(self.full.as_slice()) + size_of_val(self.packed.as_slice())
    }

    /// The rows at `places`, which are all of its own in one strip.
    pub(super) fn piece(&self, places: &Range<usize>) -> Piece<'_> {
        let (before, size, m) = (places.start - self.range.start, places.len(), self.range.len());
        let (full, packed) = (self.full.len() / m, self.packed.len() / m);
        Piece {
            full: &self.full[full * before..][..full * size],
            packed: &self.packed[packed * before..][..packed * size],
        }
    }

    /// Row `place`, written to `row` (length k).
    pub(super) fn row(&self, place: usize, strips: &Strips, row: &mut [f64]) {
        let places = strips.part(&self.range, strips.of(place));
        self.piece(&places).row(place - places.start, places.len(), row);
    }
}

/// Of columns over `range`, the rows at `places`.
fn some_rows(columns: &[f64], range: &Range<usize>, places: &Range<usize>) -> Vec<f64> {
    let rows = places.start - range.start..places.end - range.start;
    columns.chunks_exact(range.len()).flat_map(|column| &column[rows.clone()]).copied().collect()
}

impl Piece<'_> {
    /// `image` += P x, for k values x.
    pub(super) fn spread<V: Value>(self, x: &[V], image: &mut [V]) {
        let (first, others) = x.split_at(self.full.len() / image.len());
        spread(self.full, first, image);
        spread(self.packed, others, image);
    }

    /// `sums` += Pᵀ u, for k values `sums`.
    pub(super) fn gather<V: Value>(self, u: &[V], sums: &mut [V]) {
        let (first, others) = sums.split_at_mut(self.full.len() / u.len());
        gather(self.full, u, first);
        gather(self.packed, u, others);
    }

    /// Row i of m, written to `line`.
    pub(super) fn row(self, i: usize, m: usize, line: &mut [f64]) {
        let full = row(self.full, i, (m, self.full.len() / m)).copied();
        let packed = row(self.packed, i, (m, self.packed.len() / m)).map(|number| f64::from(*number));
        line.iter_mut().zip(full.chain(packed)).for_each(|(entry, number)| *entry = number);
    }

    /// Column l, written to `line`.
    pub(super) fn column(self, l: usize, line: &mut [f64]) {
        let m = line.len();
        let (full, packed) = (self.full.len() / m, self.packed.len() / m);
        match l.checked_sub(full) {
            None => line
                .iter_mut()
                .zip(column(self.full, l, (m, full)))
                .for_each(|(entry, number)| *entry = *number),
            Some(l) => {
                let numbers = column(self.packed, l, (m, packed));
                line.iter_mut().zip(numbers).for_each(|(entry, number)| *entry = f64::from(*number));
            }
        }
    }

    /// The sum of the squares of its numbers.
    pub(super) fn norm2(self) -> f64 {
        let packed = self.packed.iter().map(|number| f64::from(*number));
        self.full.iter().copied().chain(packed).map(|number| number * number).sum()
    }
}
