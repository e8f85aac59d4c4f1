//! A block as it is kept: D, or Σ_l σ_l p_l q_lᵀ.

use super::factor::Factor;
use std::ops::Range;

/// A block of F̃ over ranges of places.
#[derive(Clone, Debug)]
pub(super) enum Block {
    /// All of its entries.
    Dense {
        /// The rows' places are those of the factor.
        entries: Factor,
        columns: Range<usize>,
    },
    /// Singular values and vectors.
    LowRank { left: Factor, values: Vec<f64>, right: Factor },
}

impl Block {
    /// The places of its rows.
    pub(super) fn rows(&self) -> &Range<usize> {
        match self {
            Self::Dense { entries, .. } => entries.range(),
            Self::LowRank { left, .. } => left.range(),
        }
    }

    /// The places of its columns.
    pub(super) fn columns(&self) -> &Range<usize> {
        match self {
            Self::Dense { columns, .. } => columns,
            Self::LowRank { right, .. } => right.range(),
        }
    }

    /// k; `None` for a dense block.
    pub(super) fn rank(&self) -> Option<usize> {
        match self {
            Self::Dense { .. } => None,
            Self::LowRank { values, .. } => Some(values.len()),
        }
    }

    /// Bytes of its numbers, and of what is needed to find them.
    pub(super) fn bytes(&self) -> usize {
        size_of::<Self>()
            + match self {
                Self::Dense { entries, .. } => entries.bytes(),
                Self::LowRank { left, values, right } => {
                    left.bytes() + size_of_val(values.as_slice()) + right.bytes()
                }
            }
    }
}
