//! What will be done, and what memory it takes, before it is done.

use super::block::Made;
use super::build::{Builder, compressed, dense_in_full, in_full};
use super::cluster::ClusterTree;
use super::entries::{Entries, chosen};
use super::large::{LargeBlocks, is_large};
use super::options::{HierarchicalError, Options};
use super::partition::{Pair, partition};
use super::shelf::Shelf;
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
        let builder = Builder { entries: &entries, tree: &self.tree, tolerance: self.options.tolerance };
        let taken = AtomicU64::new(0);
        let build = |pair: &Pair| -> Result<Vec<Made>, HierarchicalError> {
            let blocks = builder.build(*pair)?;
            let bytes = blocks.iter().map(Made::bytes).sum::<usize>() as u64;
            self.allow(taken.fetch_add(bytes, Ordering::Relaxed) + bytes)?;
            let (rows, columns) = self.span(pair);
            progress(rows.len() * columns.len());
            Ok(blocks)
        };
        let (small, tasks) = self.tasks(&strips);
        // The large ones first: then no core waits for the last of them. Some are made and put in their strips before the next, so that
        // not all of their numbers are twice in memory.
        let (mut large, mut cut) = (LargeBlocks::new(&strips), Vec::new());
        for some in tasks.chunks(AT_ONCE * rayon::current_num_threads()) {
            let made = in_order(some.len(), |k| build(&self.pairs[some[k]]))?;
            // Parts of a block that was cut may be of one strip of rows and one of columns.
            let (found, small): (Vec<_>, Vec<_>) =
                made.into_iter().flatten().partition(|made| is_large(made, &strips));
            large.extend(&found, &strips);
            cut.extend(small);
        }
        large.close();
        let mut shelves = in_order(strips.len(), |strip| {
            let mut shelf = Shelf::default();
            for pair in &small[strip] {
                build(&self.pairs[*pair])?.into_iter().for_each(|made| shelf.push(made));
            }
            Ok(shelf)
        })?;
        cut.into_iter().for_each(|made| shelves[strips.of(made.rows.start)].push(made));
        shelves.iter_mut().for_each(Shelf::close);
        let parts = Parts { order: self.tree.order().to_vec(), strips, shelves, large };
        Ok(Hierarchical::new(parts, &entries)?)
    }

    /// The numbers of the pairs of one strip of rows and one of columns, by strips of rows; and of the others, from the largest.
    fn tasks(&self, strips: &Strips) -> (Vec<Vec<usize>>, Vec<usize>) {
        let (mut small, mut large) = (vec![Vec::new(); strips.len()], Vec::new());
        for (number, pair) in self.pairs.iter().enumerate() {
            let (rows, columns) = self.span(pair);
            match strips.across(&rows).len() == 1 && strips.across(&columns).len() == 1 {
                true => small[strips.of(rows.start)].push(number),
                false => large.push(number),
            }
        }
        let size = |number: &usize| {
            let (rows, columns) = self.span(&self.pairs[*number]);
            rows.len() + columns.len()
        };
        large.sort_by_key(|number| std::cmp::Reverse(size(number)));
        (small, large)
    }

    fn allow(&self, needed: u64) -> Result<(), HierarchicalError> {
        let Options { tolerance, memory: allowed, .. } = self.options;
        let unknowns = self.tree.order().len();
        match needed > allowed {
            true => Err(HierarchicalError::Memory { unknowns, tolerance, needed, allowed }),
            false => Ok(()),
        }
    }

    fn span(&self, pair: &Pair) -> Span {
        (self.tree.range(pair.rows), self.tree.range(pair.columns))
    }

    /// Bytes of the dense blocks, and of the others by the mean of what a few of their size take for each row and column.
    fn estimate(&self) -> Result<u64, NotFinite> {
        let overhead = size_of::<Made>();
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

/// Large blocks that each thread makes before they are put in their strips.
const AT_ONCE: usize = 16;

/// What `task` makes of 0, …, n − 1, on all cores.
fn in_order<T: Send>(
    n: usize,
    task: impl Fn(usize) -> Result<T, HierarchicalError> + Sync,
) -> Result<Vec<T>, HierarchicalError> {
    (0..n).into_par_iter().with_max_len(1).map(&task).collect()
}
