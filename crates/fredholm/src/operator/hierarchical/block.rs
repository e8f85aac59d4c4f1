//! A block of F̃: D, or Σ_l σ_l p_l q_lᵀ with σ_l in double precision and those p_l, q_l that need it.

use super::piece::Piece;
use super::recompress::Singular;
use std::ops::Range;

/// A block as it is made.
#[derive(Clone, Debug)]
pub(super) struct Made {
    pub(super) rows: Range<usize>,
    pub(super) columns: Range<usize>,
    pub(super) content: Content,
    /// How many columns of D, or pairs p_l, q_l, are to be kept in double precision; the others follow them.
    pub(super) full: usize,
}

/// The numbers of a block.
#[derive(Clone, Debug)]
pub(super) enum Content {
    /// D, column after column.
    Dense(Vec<f64>),
    LowRank(Singular),
}

impl Made {
    /// Bytes that its numbers will be kept in.
    pub(super) fn bytes(&self) -> usize {
        let (m, n) = (self.rows.len(), self.columns.len());
        match &self.content {
            Content::Dense(_) => m * (4 * n + 4 * self.full),
            Content::LowRank(singular) => {
                let rank = singular.values.len();
                8 * rank + (m + n) * (4 * rank + 4 * self.full)
            }
        }
    }
}

/// A block of one strip of rows and one of columns, as it is kept.
#[derive(Clone, Copy, Debug)]
pub(super) struct Small<'a> {
    pub(super) rows: &'a Range<usize>,
    pub(super) columns: &'a Range<usize>,
    pub(super) kept: Kept<'a>,
}

/// The numbers of a block of one strip of rows and one of columns.
#[derive(Clone, Copy, Debug)]
pub(super) enum Kept<'a> {
    Dense(Piece<'a>),
    LowRank { left: Piece<'a>, values: &'a [f64], right: Piece<'a> },
}
