//! ‖F − F̃‖_F² ≈ Σ_b mn/s Σ_k (F_b − F̃_b)²_{i_k j_k}: what the operator is like, and how far from F, by entries that had no part in
//! making it.

use super::Parts;
use super::action::Way;
use super::block::{Kept, Small};
use super::entries::{Entries, chosen};
use super::large::LargeBlocks;
use super::strips::Strips;
use crate::discretize::Coupling;
use crate::operator::NotFinite;
use rayon::prelude::*;
use std::ops::Range;

/// What a hierarchical operator is like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Statistics {
    /// n.
    pub unknowns: usize,
    /// Blocks kept as they are.
    pub dense_blocks: usize,
    /// Blocks of low rank.
    pub low_rank_blocks: usize,
    /// The least, the mean and the greatest rank of the latter; zeros where there are none.
    pub ranks: (usize, f64, usize),
    /// Bytes of all that is kept.
    pub bytes: u64,
    /// ‖F − F̃‖_F, estimated, with three standard deviations and a fifth added; the spectral norm is no larger.
    pub error: f64,
    /// ‖F̃‖_F.
    pub norm: f64,
}

impl Statistics {
    /// ‖F − F̃‖_F / ‖F̃‖_F; 0 for F̃ = F.
    pub fn relative_error(&self) -> f64 {
        if self.error == 0.0 { 0.0 } else { self.error / self.norm }
    }

    /// Bytes as part of the 8 n² of the dense matrix.
    pub fn compression(&self) -> f64 {
        self.bytes as f64 / (8.0 * (self.unknowns as f64).powi(2))
    }
}

/// Entries of a block that are looked at, at most. Blocks are many: what one of them does not show, the others do.
const SAMPLES: usize = 1024;

/// How many standard deviations are added to the squared error.
const DEVIATIONS: f64 = 3.0;

/// What the estimate is multiplied by: samples that miss the few entries of a block where most is missed underestimate the error
/// and their own deviation at once. Without it one estimate in forty was too small, by a quarter of a per cent; half as much more
/// would say more of chance than of F̃.
const MARGIN: f64 = 1.2;

/// Of other entries than those by which crosses were judged.
const SEED: u64 = 0x5EED_0BAD_CAFE_F00D;

/// Of the squared error, of its variance and of the squared norm, a block's part.
#[derive(Clone, Copy, Debug)]
struct Part {
    /// `None` for a dense block.
    rank: Option<usize>,
    error2: f64,
    variance: f64,
    norm2: f64,
}

/// Looks at all blocks; bytes are filled in later.
pub(super) fn statistics<C: Coupling>(
    parts: &Parts,
    entries: &Entries<'_, C>,
) -> Result<Statistics, NotFinite> {
    let looks = Looks { entries, strips: &parts.strips, large: &parts.large };
    let small = parts.shelves.par_iter().enumerate().with_max_len(1).map(|(strip, shelf)| {
        let blocks = shelf.blocks().enumerate();
        blocks
            .map(|(k, block)| looks.small(block, (strip as u64) << 32 | k as u64))
            .collect::<Result<Vec<_>, _>>()
    });
    let large = (0..parts.large.len()).into_par_iter().map(|block| looks.large(block, !(block as u64)));
    let (small, large) = (small.collect::<Result<Vec<_>, _>>()?, large.collect::<Result<Vec<_>, _>>()?);
    let all: Vec<Part> = small.into_iter().flatten().chain(large).collect();
    let sum = |of: fn(&Part) -> f64| all.iter().map(of).sum::<f64>();
    let error2 = sum(|part| part.error2) + DEVIATIONS * sum(|part| part.variance).sqrt();
    let ranks: Vec<usize> = all.iter().filter_map(|part| part.rank).collect();
    let mean = ranks.iter().sum::<usize>() as f64 / ranks.len().max(1) as f64;
    let ends = (ranks.iter().min().copied(), ranks.iter().max().copied());
    Ok(Statistics {
        unknowns: parts.order.len(),
        dense_blocks: all.len() - ranks.len(),
        low_rank_blocks: ranks.len(),
        ranks: (ends.0.unwrap_or(0), mean, ends.1.unwrap_or(0)),
        bytes: 0,
        error: MARGIN * error2.sqrt(),
        norm: sum(|part| part.norm2).sqrt(),
    })
}

struct Looks<'a, C> {
    entries: &'a Entries<'a, C>,
    strips: &'a Strips,
    large: &'a LargeBlocks,
}

impl<C: Coupling> Looks<'_, C> {
    fn small(&self, block: Small<'_>, stream: u64) -> Result<Part, NotFinite> {
        let (rows, columns) = (block.rows, block.columns);
        match block.kept {
            Kept::LowRank { left, values, right } => {
                let p = |i: usize, p: &mut [f64]| left.row(i - rows.start, rows.len(), p);
                let q = |j: usize, q: &mut [f64]| right.row(j - columns.start, columns.len(), q);
                self.low_rank((rows, columns), values, (p, q), stream)
            }
            Kept::Dense(entries) => {
                let norm2 = entries.norm2();
                // Entries are kept, or rounded to within half a unit of the last place.
                let rounding = if entries.packed.is_empty() { 0.0 } else { f64::from(f32::EPSILON) / 2.0 };
                Ok(Part { error2: rounding * rounding * norm2, variance: 0.0, norm2, rank: None })
            }
        }
    }

    fn large(&self, block: usize, stream: u64) -> Result<Part, NotFinite> {
        let (columns, rows) = self.large.sides(Way::Forward);
        let p = |i: usize, p: &mut [f64]| rows.row(block, i, self.strips, p);
        let q = |j: usize, q: &mut [f64]| columns.row(block, j, self.strips, q);
        let values = &self.large.values()[self.large.span(block)];
        self.low_rank(self.large.outline(block), values, (p, q), stream)
    }

    /// Of Σ_l σ_l p_l q_lᵀ, by entries in all parts of its rows in turn.
    fn low_rank(
        &self,
        (rows, columns): (&Range<usize>, &Range<usize>),
        values: &[f64],
        (left, right): (impl Fn(usize, &mut [f64]), impl Fn(usize, &mut [f64])),
        stream: u64,
    ) -> Result<Part, NotFinite> {
        let (m, n) = (rows.len(), columns.len());
        let samples = (m + n).min(SAMPLES);
        let (mut p, mut q) = (vec![0.0; values.len()], vec![0.0; values.len()]);
        let (mut sum, mut squares) = (0.0, 0.0);
        for k in 0..samples {
            let i = rows.start + (k * m + chosen(SEED ^ stream, 2 * k, m)) / samples;
            let j = columns.start + chosen(SEED ^ stream, 2 * k + 1, n);
            left(i, &mut p);
            right(j, &mut q);
            let kept: f64 = p.iter().zip(values).zip(&q).map(|((p, value), q)| p * value * q).sum();
            let missed2 = (self.entries.at(i, j)? - kept).powi(2);
            (sum, squares) = (sum + missed2, squares + missed2 * missed2);
        }
        let (count, size) = (samples as f64, (m * n) as f64);
        let mean = sum / count;
        let variance = size * size * (squares / count - mean * mean).max(0.0) / (count - 1.0);
        let norm2 = values.iter().map(|value| value * value).sum();
        Ok(Part { error2: size * mean, variance, norm2, rank: Some(values.len()) })
    }
}
