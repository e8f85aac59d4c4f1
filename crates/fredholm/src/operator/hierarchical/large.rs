//! Σ_l σ_l p_l q_lᵀ over more than one strip of rows or of columns.

use super::action::Way;
use super::block::{Content, Made};
use super::side::{Factor, Side};
use super::strips::Strips;
use std::ops::Range;

/// Whether a block is one of these.
pub(super) fn is_large(made: &Made, strips: &Strips) -> bool {
    matches!(made.content, Content::LowRank(_))
        && strips.across(&made.rows).len() + strips.across(&made.columns).len() > 2
}

/// All of them.
#[derive(Clone, Debug)]
pub(super) struct LargeBlocks {
    /// σ_l, block by block.
    values: Vec<f64>,
    /// Where those of each begin; after the last one their number.
    firsts: Vec<usize>,
    rows: Side,
    columns: Side,
}

impl LargeBlocks {
    /// No block yet.
    pub(super) fn new(strips: &Strips) -> Self {
        let [rows, columns] = [(); 2].map(|()| Side::new(strips));
        Self { values: Vec::new(), firsts: vec![0], rows, columns }
    }

    /// Puts blocks after the others.
    pub(super) fn extend(&mut self, blocks: &[Made], strips: &Strips) {
        let (mut left, mut right) = (Vec::new(), Vec::new());
        for Made { rows, columns, content, full } in blocks {
            let Content::LowRank(singular) = content else { continue };
            let (rank, full) = (singular.values.len(), *full);
            left.push(Factor { range: rows, columns: &singular.left, rank, full });
            right.push(Factor { range: columns, columns: &singular.right, rank, full });
            self.values.extend_from_slice(&singular.values);
            self.firsts.push(self.values.len());
        }
        self.rows.extend(&left, strips);
        self.columns.extend(&right, strips);
    }

    /// Gives back what was taken for blocks that did not come.
    pub(super) fn close(&mut self) {
        self.rows.close();
        self.columns.close();
    }

    /// How many there are.
    pub(super) fn len(&self) -> usize {
        self.firsts.len() - 1
    }

    /// σ_l of all blocks.
    pub(super) fn values(&self) -> &[f64] {
        &self.values
    }

    /// Where a block's are among them.
    pub(super) fn span(&self, block: usize) -> Range<usize> {
        self.firsts[block]..self.firsts[block + 1]
    }

    /// The rows and the columns of a block.
    pub(super) fn outline(&self, block: usize) -> (&Range<usize>, &Range<usize>) {
        (self.rows.range(block), self.columns.range(block))
    }

    /// The sides that values come from and go to.
    pub(super) fn sides(&self, way: Way) -> (&Side, &Side) {
        match way {
            Way::Forward => (&self.columns, &self.rows),
            Way::Transposed => (&self.rows, &self.columns),
        }
    }

    /// Bytes of their numbers, and of what is needed to find them.
    pub(super) fn bytes(&self) -> usize {
        let lists = size_of_val(&*self.values) + size_of_val(&*self.firsts);
        lists + self.rows.bytes() + self.columns.bytes()
    }
}
