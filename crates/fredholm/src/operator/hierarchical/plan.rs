//! What will be done, and what memory it takes, before it is done.

use super::block::Block;
use super::build::{Builder, compressed, dense_in_full, in_full};
use super::cluster::ClusterTree;
use super::entries::{Entries, chosen};
use super::options::{HierarchicalError, Options};
use super::partition::{Pair, partition};
use super::strips::Strips;
use super::{Hierarchical, Parts};
use crate::discretize::Coupling;
use crate::operator::NotFinite;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

/// The blocks of a hierarchical operator that is not made yet.
#[derive(Debug)]
pub struct Plan<'a, C, const D: usize> {
    coupling: &'a C,
    options: Options,
    tree: ClusterTree<D>,
    pairs: Vec<Pair>,
    bytes: u64,
}

/// A part of the matrix that two ranges of places span.
type Span = (Range<usize>, Range<usize>);

/// Blocks of one size that are looked at, and the rows and columns of each.
const LOOKS: (usize, usize) = (4, 256);

impl<'a, C: Coupling, const D: usize> Plan<'a, C, D> {
    /// Plans to keep `coupling`, whose unknown i is at `points[i]` (a node, or the middle of an element).
    ///
    /// # Errors
    ///
    /// [`HierarchicalError`] where options or points make no sense, or the coupling has an entry that is not finite.
    pub fn new(coupling: &'a C, points: &[[f64; D]], options: Options) -> Result<Self, HierarchicalError> {
        options.check()?;
        if points.len() != coupling.dim() {
            return Err(HierarchicalError::Sizes { points: points.len(), unknowns: coupling.dim() });
        }
        let tree = ClusterTree::new(points, options.leaf)?;
        let pairs = partition(&tree, options.eta);
        let mut plan = Self { coupling, options, tree, pairs, bytes: 0 };
        plan.bytes = plan.estimate()?;
        Ok(plan)
    }

    /// An estimate of the bytes that will be taken at most, from the ranks of a few blocks of each size. What is kept in the
    /// end is told by [`super::Statistics::bytes`].
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// The tree of the unknowns.
    pub fn tree(&self) -> &ClusterTree<D> {
        &self.tree
    }

    /// Makes the operator, on all cores. `progress` is told how many entries of F more are settled, n² in all, from any
    /// thread.
    ///
    /// # Errors
    ///
    /// [`HierarchicalError::Memory`] where more is needed than [`Options::memory`] allows: before anything is taken where
    /// the estimate says so, and else when that much is taken; [`HierarchicalError::Entry`] for an entry that is not finite.
    pub fn assemble(&self, progress: impl Fn(usize) + Sync) -> Result<Hierarchical, HierarchicalError> {
        self.allow(self.bytes)?;
        let strips = Strips::new(&self.tree);
        let entries = Entries::new(self.coupling, self.tree.order());
        let builder = Builder {
            entries: &entries,
            tree: &self.tree,
            strips: &strips,
            tolerance: self.options.tolerance,
        };
        let taken = AtomicU64::new(0);
        let made = self.largest_first().into_par_iter().with_max_len(1).map(|number| {
            let blocks = builder.build(self.pairs[number])?;
            let bytes = blocks.iter().map(Block::bytes).sum::<usize>() as u64;
            self.allow(taken.fetch_add(bytes, Ordering::Relaxed) + bytes)?;
            let (rows, columns) = self.span(&self.pairs[number]);
            progress(rows.len() * columns.len());
            Ok((number, blocks))
        });
        let mut made = made.collect::<Result<Vec<_>, HierarchicalError>>()?;
        made.sort_unstable_by_key(|(number, _)| *number);
        let blocks = made.into_iter().flat_map(|(_, blocks)| blocks).collect();
        let parts = Parts { order: self.tree.order().to_vec(), strips, blocks };
        Ok(Hierarchical::new(parts, &entries, self.options.tolerance)?)
    }

    fn allow(&self, needed: u64) -> Result<(), HierarchicalError> {
        match self.options.memory {
            Some(allowed) if needed > allowed => Err(HierarchicalError::Memory {
                unknowns: self.tree.order().len(),
                tolerance: self.options.tolerance,
                needed,
                allowed,
            }),
            _ => Ok(()),
        }
    }

    /// The blocks' numbers, those that take longest first: then no core waits for the last one.
    fn largest_first(&self) -> Vec<usize> {
        let work = |pair: &Pair| {
            let (rows, columns) = self.span(pair);
            rows.len() + columns.len()
        };
        let mut numbers: Vec<usize> = (0..self.pairs.len()).collect();
        numbers.sort_by_key(|number| std::cmp::Reverse(work(&self.pairs[*number])));
        numbers
    }

    fn span(&self, pair: &Pair) -> Span {
        (self.tree.range(pair.rows), self.tree.range(pair.columns))
    }

    /// Bytes of the dense blocks, and of the others by the mean of what a few of their size take for each row and column.
    fn estimate(&self) -> Result<u64, NotFinite> {
        let overhead = size_of::<Block>() + 4 * size_of::<usize>();
        let entry = if dense_in_full(self.options.tolerance) { 8 } else { 4 };
        let (mut bytes, mut sizes) =
            (6 * size_of::<usize>() * self.tree.order().len(), Vec::<Vec<Span>>::new());
        for pair in &self.pairs {
            let (rows, columns) = self.span(pair);
            bytes += overhead;
            if !pair.far {
                bytes += entry * rows.len() * columns.len();
                continue;
            }
            let size = (rows.len() + columns.len()).ilog2() as usize;
            sizes.resize(sizes.len().max(size + 1), Vec::new());
            sizes[size].push((rows, columns));
        }
        let mut work = 0;
        for (size, spans) in sizes.iter().enumerate().filter(|(_, spans)| !spans.is_empty()) {
            let looks = (0..LOOKS.0.min(spans.len())).map(|k| &spans[chosen(size as u64, k, spans.len())]);
            let looks = looks.map(|span| self.bytes_per_line(span)).collect::<Result<Vec<_>, _>>()?;
            let mean = looks.iter().sum::<f64>() / looks.len() as f64;
            let lines: usize = spans.iter().map(|(rows, columns)| rows.len() + columns.len()).sum();
            bytes += (mean * lines as f64) as usize;
            // While a block is made: crosses and their orthogonal factors, all in double precision.
            work = (4.0 * mean * (2_usize << size) as f64) as usize;
        }
        Ok((bytes + work * rayon::current_num_threads()) as u64)
    }

    /// What a far block takes for each of its rows and columns, by a part of it that is spread over all of it.
    fn bytes_per_line(&self, (rows, columns): &Span) -> Result<f64, NotFinite> {
        let (m, n) = (rows.len().min(LOOKS.1), columns.len().min(LOOKS.1));
        let spread = |range: &Range<usize>, count: usize, k: usize| {
            self.tree.order()[range.start + (2 * k + 1) * range.len() / (2 * count)]
        };
        let some = (0..m).map(|k| spread(rows, m, k)).chain((0..n).map(|k| spread(columns, n, k)));
        let order: Vec<usize> = some.collect();
        let entries = Entries::new(self.coupling, &order);
        let found = compressed(&entries, (0..m, m..m + n), self.options.tolerance, m * n / (m + n))?;
        Ok(match found {
            Some(singular) => {
                let full = in_full(&singular.values, self.options.tolerance);
                (4 * full + 4 * singular.values.len()) as f64
            }
            None => (8 * rows.len() * columns.len()) as f64 / (rows.len() + columns.len()) as f64,
        })
    }
}
