//! A block from a coupling: crosses, recompressed; cut where there would be too many of them; dense where it is small or near.

use super::block::{Content, Made};
use super::cluster::{Cluster, ClusterTree};
use super::cross::{Approximation, Cross};
use super::entries::Entries;
use super::partition::{Pair, parts};
use super::recompress::Singular;
use crate::discretize::Coupling;
use crate::operator::NotFinite;
use std::ops::Range;

/// What the tolerance is spent on: crosses that are not made, singular values that are dropped, digits that are not kept.
const SHARES: [f64; 3] = [0.3, 0.5, 0.2];

/// Crosses after which a block that can be cut is cut: 1/|x − y| in the plane takes some 36 for twelve digits, and the time that
/// crosses take grows with the square of their number.
const MOST: usize = 256;

/// What single precision may lose of p_l and of q_l together, and of an entry.
const PACKED: [f64; 2] = [2.0 * f32::EPSILON as f64 / 2.0, f32::EPSILON as f64 / 2.0];

/// Makes blocks; each is one thread's.
pub(super) struct Builder<'a, C, const D: usize> {
    pub(super) entries: &'a Entries<'a, C>,
    pub(super) tree: &'a ClusterTree<D>,
    pub(super) tolerance: f64,
}

impl<C: Coupling, const D: usize> Builder<'_, C, D> {
    /// The blocks that a block of the partition becomes: mostly one.
    pub(super) fn build(&self, pair: Pair) -> Result<Vec<Made>, NotFinite> {
        let mut blocks = Vec::new();
        match pair.far {
            true => self.far(pair.rows, pair.columns, &mut blocks)?,
            false => blocks.push(self.dense(self.tree.range(pair.rows), self.tree.range(pair.columns))?),
        }
        Ok(blocks)
    }

    fn far(&self, rows: Cluster, columns: Cluster, blocks: &mut Vec<Made>) -> Result<(), NotFinite> {
        let (places, across) = (self.tree.range(rows), self.tree.range(columns));
        let worthwhile = places.len() * across.len() / (places.len() + across.len());
        let parts = parts(self.tree, rows, columns);
        let most = if parts.is_some() { MOST.min(worthwhile) } else { worthwhile };
        let found = compressed(self.entries, (places.clone(), across.clone()), self.tolerance, most)?;
        match (found, parts) {
            (Some(singular), _) => {
                let full = in_full(&singular.values, self.tolerance);
                blocks.push(Made {
                    rows: places,
                    columns: across,
                    content: Content::LowRank(singular),
                    full,
                });
            }
            (None, Some(parts)) => {
                parts.into_iter().try_for_each(|(rows, columns)| self.far(rows, columns, blocks))?;
            }
            (None, None) => blocks.push(self.dense(places, across)?),
        }
        Ok(())
    }

    fn dense(&self, rows: Range<usize>, columns: Range<usize>) -> Result<Made, NotFinite> {
        let (m, n) = (rows.len(), columns.len());
        let (mut numbers, mut row) = (vec![0.0; m * n], vec![0.0; n]);
        for (k, i) in rows.clone().enumerate() {
            self.entries.row(i, columns.clone(), &mut row)?;
            row.iter().enumerate().for_each(|(l, entry)| numbers[l * m + k] = *entry);
        }
        let largest = numbers.iter().fold(0.0, |largest: f64, entry| largest.max(entry.abs()));
        let full = if dense_in_full(self.tolerance) || !SINGLE.contains(&largest) { n } else { 0 };
        Ok(Made { rows, columns, content: Content::Dense(numbers), full })
    }
}

/// The singular values and vectors of a far block; `None` where there are more than `most`.
pub(super) fn compressed<C: Coupling>(
    entries: &Entries<'_, C>,
    (rows, columns): (Range<usize>, Range<usize>),
    tolerance: f64,
    most: usize,
) -> Result<Option<Singular>, NotFinite> {
    let (m, n) = (rows.len(), columns.len());
    let approximation = Approximation { entries, rows, columns, tolerance: SHARES[0] * tolerance, most };
    let decomposed = |cross: Cross| Singular::of(&cross, m, n, SHARES[1] * tolerance);
    Ok(approximation.cross()?.and_then(decomposed))
}

/// Blocks whose largest entry is in here keep their digits in single precision, which has no numbers far beyond.
const SINGLE: Range<f64> = 1e-30..1e38;

/// How many of the pairs p_l, q_l need double precision: the others lose less than their share of the tolerance.
pub(super) fn in_full(values: &[f64], tolerance: f64) -> usize {
    let norm = values.iter().map(|value| value * value).sum::<f64>().sqrt();
    let mut lost = 0.0;
    let packed = values.iter().rev().take_while(|value| {
        lost += PACKED[0] * **value;
        lost <= SHARES[2] * tolerance * norm
    });
    values.len() - packed.count()
}

/// Whether entries near the diagonal need double precision.
pub(super) fn dense_in_full(tolerance: f64) -> bool {
    PACKED[1] > SHARES[2] * tolerance
}
