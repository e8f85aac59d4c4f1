//! Σ_l σ_l p_l q_lᵀ over more than one strip.

use super::block::Made;
use super::factor::Factor;
use super::recompress::Singular;
use super::strips::Strips;

/// A block of low rank over more than one strip of rows or of columns.
#[derive(Clone, Debug)]
pub(super) struct Large {
    pub(super) left: Factor,
    pub(super) values: Vec<f64>,
    pub(super) right: Factor,
}

impl Large {
    /// From the singular values and vectors of a block.
    pub(super) fn new(made: &Made, singular: &Singular, strips: &Strips) -> Self {
        Self {
            left: Factor::new(made.rows.clone(), &singular.left, made.full, strips),
            values: singular.values.clone(),
            right: Factor::new(made.columns.clone(), &singular.right, made.full, strips),
        }
    }

    /// Bytes of its numbers, and of what is needed to find them.
    pub(super) fn bytes(&self) -> usize {
        size_of::<Self>() + self.left.bytes() + size_of_val(self.values.as_slice()) + self.right.bytes()
    }
}
