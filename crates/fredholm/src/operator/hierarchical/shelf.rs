//! The blocks of one strip of rows and one of columns each, by strips of rows: one after another in memory, in the order in which
//! the action goes through them.

use super::block::{Content, Kept, Made, Small};
use super::kernels::add_tiles;
use super::piece::Piece;
use std::ops::Range;

/// The blocks in a strip of rows.
#[derive(Clone, Debug, Default)]
pub(super) struct Shelf {
    full: Vec<f64>,
    packed: Vec<f32>,
    blocks: Vec<Entry>,
}

#[derive(Clone, Debug)]
struct Entry {
    rows: Range<usize>,
    columns: Range<usize>,
    /// `None` for a dense block.
    rank: Option<usize>,
    /// How many columns are in double precision, of all there are.
    full: usize,
    /// Where its numbers begin: of double precision, and of single.
    at: (usize, usize),
}

impl Shelf {
    /// Puts a block after the others.
    pub(super) fn push(&mut self, made: Made) {
        let Made { rows, columns, content, full } = made;
        let at = (self.full.len(), self.packed.len());
        let rank = match content {
            Content::Dense(numbers) => {
                self.add(&numbers, rows.len(), full);
                None
            }
            Content::LowRank(singular) => {
                self.full.extend_from_slice(&singular.values);
                self.add(&singular.right, columns.len(), full);
                self.add(&singular.left, rows.len(), full);
                Some(singular.values.len())
            }
        };
        self.blocks.push(Entry { rows, columns, rank, full, at });
    }

    /// Keeps columns of m rows, the first `full` of them in double precision.
    fn add(&mut self, columns: &[f64], m: usize, full: usize) {
        let (full, packed) = columns.split_at(full * m);
        add_tiles(&mut self.full, (full, m), 0..m, |number| number);
        add_tiles(&mut self.packed, (packed, m), 0..m, |number| number as f32);
    }

    /// Gives back what was taken for blocks that did not come.
    pub(super) fn close(&mut self) {
        self.full.shrink_to_fit();
        self.packed.shrink_to_fit();
        self.blocks.shrink_to_fit();
    }

    /// How many blocks there are.
    pub(super) fn len(&self) -> usize {
        self.blocks.len()
    }

    /// Block k.
    pub(super) fn block(&self, k: usize) -> Small<'_> {
        let Entry { rows, columns, rank, full, at } = &self.blocks[k];
        let numbers = (&self.full[at.0..], &self.packed[at.1..]);
        let kept = match rank {
            None => Kept::Dense(piece(numbers, rows.len(), (*full, columns.len())).0),
            Some(rank) => {
                let (values, others) = numbers.0.split_at(*rank);
                let (right, numbers) = piece((others, numbers.1), columns.len(), (*full, *rank));
                let (left, _) = piece(numbers, rows.len(), (*full, *rank));
                Kept::LowRank { left, values, right }
            }
        };
        Small { rows, columns, kept }
    }

    /// All blocks, in order.
    pub(super) fn blocks(&self) -> impl Iterator<Item = Small<'_>> {
        (0..self.len()).map(|k| self.block(k))
    }

    /// Bytes of its numbers, and of what is needed to find them.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(self.full.as_slice())
            + size_of_val(self.packed.as_slice())
            + size_of_val(self.blocks.as_slice())
    }
}

/// Numbers of double precision, and of single.
type Numbers<'a> = (&'a [f64], &'a [f32]);

/// The first numbers as m rows of `columns`, of which `full` are in double precision; and the numbers after them.
fn piece<'a>(numbers: Numbers<'a>, m: usize, (full, columns): (usize, usize)) -> (Piece<'a>, Numbers<'a>) {
    let (first, packed) = (numbers.0.split_at(full * m), numbers.1.split_at((columns - full) * m));
    (Piece { full: first.0, packed: packed.0 }, (first.1, packed.1))
}
