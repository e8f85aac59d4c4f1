//! Some rows of a matrix of k columns, in tiles: first the columns in double precision, then those for which single is enough.

use super::kernels::{column, gather, row, spread};
use crate::value::Value;

/// The numbers of both kinds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece<'a> {
    pub(super) full: &'a [f64],
    pub(super) packed: &'a [f32],
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
