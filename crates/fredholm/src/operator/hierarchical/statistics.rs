//! ‖F − F̃‖_F² ≈ Σ_b mn/s Σ_k (F_b − F̃_b)²_{i_k j_k}: what the operator is like, and how far from F, by entries that had no part in
//! making it.

use super::block::Block;
use super::build::dense_in_full;
use super::entries::{Entries, chosen};
use super::strips::Strips;
use crate::discretize::Coupling;
use crate::operator::NotFinite;
use rayon::prelude::*;

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
    /// ‖F − F̃‖_F, estimated with three standard deviations added; the spectral norm is no larger.
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

/// How many standard deviations are added: by chance alone, one estimate in 700 is then too small.
const DEVIATIONS: f64 = 3.0;

/// Of the squared error, of its variance and of the squared norm, a block's part.
#[derive(Clone, Copy, Debug, Default)]
struct Part {
    error2: f64,
    variance: f64,
    norm2: f64,
}

/// Looks at `blocks`; `besides` are bytes of what is kept besides them.
pub(super) fn statistics<C: Coupling>(
    blocks: &[Block],
    entries: &Entries<'_, C>,
    strips: &Strips,
    tolerance: f64,
    (unknowns, besides): (usize, usize),
) -> Result<Statistics, NotFinite> {
    let parts = blocks.par_iter().enumerate().with_max_len(16);
    let parts = parts.map(|(number, block)| part(block, number, entries, strips, tolerance));
    let parts = parts.collect::<Result<Vec<_>, _>>()?;
    let sum = |of: fn(&Part) -> f64| parts.iter().map(of).sum::<f64>();
    let error2 = sum(|part| part.error2) + DEVIATIONS * sum(|part| part.variance).sqrt();
    let ranks: Vec<usize> = blocks.iter().filter_map(Block::rank).collect();
    let mean = ranks.iter().sum::<usize>() as f64 / ranks.len().max(1) as f64;
    let ends = (ranks.iter().min().copied(), ranks.iter().max().copied());
    Ok(Statistics {
        unknowns,
        dense_blocks: blocks.len() - ranks.len(),
        low_rank_blocks: ranks.len(),
        ranks: (ends.0.unwrap_or(0), mean, ends.1.unwrap_or(0)),
        bytes: (besides + blocks.iter().map(Block::bytes).sum::<usize>()) as u64,
        error: error2.sqrt(),
        norm: sum(|part| part.norm2).sqrt(),
    })
}

fn part<C: Coupling>(
    block: &Block,
    number: usize,
    entries: &Entries<'_, C>,
    strips: &Strips,
    tolerance: f64,
) -> Result<Part, NotFinite> {
    let (left, values, right) = match block {
        Block::LowRank { left, values, right } => (left, values, right),
        Block::Dense { entries, .. } => {
            let norm2 = entries.norm2();
            // Entries are kept, or rounded to within half a unit of the last place.
            let rounding = if dense_in_full(tolerance) { 0.0 } else { f64::from(f32::EPSILON) / 2.0 };
            return Ok(Part { error2: rounding * rounding * norm2, variance: 0.0, norm2 });
        }
    };
    let (rows, columns) = (left.range(), right.range());
    let (m, n) = (rows.len(), columns.len());
    let samples = (m + n).min(SAMPLES);
    let (mut p, mut q) = (vec![0.0; values.len()], vec![0.0; values.len()]);
    let (mut sum, mut squares) = (0.0, 0.0);
    let stream = 0x5EED_0000_0000_0000 ^ number as u64;
    for k in 0..samples {
        // In turn from all parts of the rows.
        let i = rows.start + (k * m + chosen(stream, 2 * k, m)) / samples;
        let j = columns.start + chosen(stream, 2 * k + 1, n);
        left.row(i, strips, &mut p);
        right.row(j, strips, &mut q);
        let kept: f64 = p.iter().zip(values).zip(&q).map(|((p, value), q)| p * value * q).sum();
        let missed2 = (entries.at(i, j)? - kept).powi(2);
        (sum, squares) = (sum + missed2, squares + missed2 * missed2);
    }
    let (count, size) = (samples as f64, (m * n) as f64);
    let mean = sum / count;
    let variance = size * size * (squares / count - mean * mean).max(0.0) / (count - 1.0);
    Ok(Part { error2: size * mean, variance, norm2: values.iter().map(|value| value * value).sum() })
}
