//! Sums over the pairs that may exchange something, on all threads and in an order that their number does not change.

use crate::view_factors::ViewFactors;
use crate::view_factors::packed::row_start;
use rayon::prelude::*;
use std::ops::Range;

/// Blocks of rows with about as many pairs each: a fixed number, so that the same sums are added up whatever the
/// number of threads, and enough of them for many threads to be busy until the end.
const BLOCKS: usize = 64;

/// The pairs of faces that are not certainly without exchange.
pub(super) struct Pairs<'a> {
    factors: &'a ViewFactors,
    blocks: Vec<Range<usize>>,
}

/// A pair i ≤ j: the exchange as it was computed, and A_i A_j.
pub(super) struct Pair {
    pub i: usize,
    pub j: usize,
    pub value: f64,
    pub areas: f64,
}

/// y_i = Σ_j term_ij for a symmetric term, and Σ_{i≤j} of another.
pub(super) struct Sums {
    pub rows: Vec<f64>,
    pub total: f64,
}

impl<'a> Pairs<'a> {
    pub(super) fn new(factors: &'a ViewFactors) -> Self {
        let n = factors.len();
        // Row i has n − i pairs, so that the rows from i on have (n − i)²/2: a root gives where a block ends.
        let end = |block: usize| {
            let left = 1.0 - block as f64 / BLOCKS as f64;
            n - (n as f64 * left.sqrt()).round() as usize
        };
        let blocks = (0..BLOCKS).map(|block| end(block)..end(block + 1)).filter(|rows| !rows.is_empty());
        Self { factors, blocks: blocks.collect() }
    }

    pub(super) fn areas(&self) -> &[f64] {
        self.factors.areas()
    }

    /// Adds up the two numbers that `term` gives for a pair: by rows, and in all.
    pub(super) fn sums(&self, term: impl Fn(&Pair) -> (f64, f64) + Sync) -> Sums {
        let parts: Vec<Sums> = self.blocks.par_iter().map(|rows| self.block(rows.clone(), &term)).collect();
        let mut sums = Sums { rows: vec![0.0; self.factors.len()], total: 0.0 };
        for part in parts {
            sums.total += part.total;
            for (sum, part) in sums.rows.iter_mut().zip(part.rows) {
                *sum += part;
            }
        }
        sums
    }

    fn block(&self, rows: Range<usize>, term: &impl Fn(&Pair) -> (f64, f64)) -> Sums {
        let ViewFactors { areas, values, errors, .. } = self.factors;
        let n = areas.len();
        let mut sums = Sums { rows: vec![0.0; n], total: 0.0 };
        for i in rows {
            let mut own = 0.0;
            for (place, j) in (row_start(n, i)..).zip(i..n) {
                // No error, no value: certainly 0.
                if errors[place] == 0 {
                    continue;
                }
                let pair = Pair { i, j, value: values.get(place), areas: areas[i] * areas[j] };
                let (part, whole) = term(&pair);
                own += part;
                if i != j {
                    sums.rows[j] += part;
                }
                sums.total += whole;
            }
            sums.rows[i] += own;
        }
        sums
    }
}
