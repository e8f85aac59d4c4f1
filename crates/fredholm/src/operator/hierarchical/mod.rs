//! F ≈ F̃: blocks Σ_l σ_l p_l q_lᵀ of low rank where clusters of unknowns are far apart, and dense ones where they are near.
//!
//! Where K is smooth away from x = y, as ln |x − y| and 1/|x − y| are, what a cluster of unknowns sends to one far from it needs
//! few numbers. With a tree of clusters F takes O(n log n) memory and its action as much time (Hackbusch, *Hierarchical
//! Matrices*, 2015; Bebendorf, *Hierarchical Matrices*, 2008). Unknowns need nothing but a place.
//!
//! ```
//! use fredholm::discretize::Nystrom;
//! use fredholm::krylov::Gmres;
//! use fredholm::operator::hierarchical::{Options, Plan};
//! use fredholm::quadrature::gauss_legendre;
//! use fredholm::relax::{Outcome, Stop, relax};
//! use fredholm::system::System;
//!
//! // ∫₋₁¹ φ(y) dy / (1 + 100 |x − y|), 3000 nodes.
//! let kernel = |x: &f64, y: &f64| 1.0 / (1.0 + 100.0 * (x - y).abs());
//! let nystrom = Nystrom::new(kernel, gauss_legendre(3000, -1.0, 1.0));
//! let points: Vec<[f64; 1]> = nystrom.nodes().iter().map(|x| [*x]).collect();
//!
//! let plan = Plan::new(&nystrom, &points, Options { tolerance: 1e-8, ..Options::default() })?;
//! assert!(plan.bytes() < 20_000_000); // told before it is taken: the dense matrix has 72 MB
//! let operator = plan.assemble(|_| ())?;
//! let told = operator.statistics();
//! assert!(told.relative_error() < 1e-8 && told.compression() < 0.2);
//!
//! let (source, coefficient) = (vec![1.0; 3000], vec![1.0; 3000]);
//! let system = System::new(&source, &coefficient, &operator)?;
//! let report = relax(&mut Gmres::new(system), Stop { residual: 1e-10, sweeps: 100 }, |_, _, _| true);
//! assert_eq!(report.outcome, Outcome::Converged);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod action;
mod block;
mod build;
mod cluster;
mod cross;
mod entries;
mod kernels;
mod large;
mod lines;
mod options;
mod partition;
mod picture;
mod piece;
mod plan;
mod recompress;
mod shelf;
mod side;
mod statistics;
mod strips;

pub use cluster::{Bounds, Cluster, ClusterError, ClusterTree};
pub use options::{HierarchicalError, Options};
pub use plan::Plan;
pub use statistics::Statistics;

use crate::discretize::Coupling;
use crate::operator::NotFinite;
use block::{Kept, Small};
use entries::Entries;
use large::LargeBlocks;
use shelf::Shelf;
use strips::Strips;

/// F̃ in blocks, made by [`Plan::assemble`].
#[derive(Clone, Debug)]
pub struct Hierarchical {
    /// The unknown at each place.
    order: Vec<usize>,
    /// The place of each unknown.
    place: Vec<usize>,
    strips: Strips,
    /// By strip of rows: the blocks of it and one strip of columns.
    shelves: Vec<Shelf>,
    /// By strip of columns: the shelves and the numbers of those blocks.
    beside: Vec<Vec<(u32, u32)>>,
    /// The other blocks.
    large: LargeBlocks,
    diagonal: Vec<f64>,
    statistics: Statistics,
}

/// What a plan has made.
struct Parts {
    order: Vec<usize>,
    strips: Strips,
    shelves: Vec<Shelf>,
    large: LargeBlocks,
}

impl Hierarchical {
    fn new<C: Coupling>(parts: Parts, entries: &Entries<'_, C>) -> Result<Self, NotFinite> {
        let statistics = statistics::statistics(&parts, entries)?;
        let Parts { order, strips, shelves, large } = parts;
        let mut place = vec![0; order.len()];
        order.iter().enumerate().for_each(|(k, number)| place[*number] = k);
        let (diagonal, beside) = (diagonal(&shelves, &order), beside(&shelves, &strips));
        let mut operator = Self { order, place, strips, shelves, beside, large, diagonal, statistics };
        operator.statistics.bytes = operator.bytes() as u64;
        Ok(operator)
    }

    /// Sizes, ranks, memory and the estimated error.
    pub fn statistics(&self) -> &Statistics {
        &self.statistics
    }

    /// Bytes of all that is kept.
    fn bytes(&self) -> usize {
        let blocks = self.shelves.iter().map(Shelf::bytes).sum::<usize>() + self.large.bytes();
        let beside: usize = self.beside.iter().map(|list| size_of_val(list.as_slice())).sum();
        let lists = self.order.len() + self.place.len() + self.diagonal.len();
        blocks + beside + size_of::<usize>() * lists
    }

    /// The small blocks that have columns in a strip.
    fn beside(&self, strip: usize) -> impl Iterator<Item = Small<'_>> {
        self.beside[strip].iter().map(|(shelf, k)| self.shelves[*shelf as usize].block(*k as usize))
    }
}

/// F̃_ii by unknown: blocks on the diagonal are dense.
fn diagonal(shelves: &[Shelf], order: &[usize]) -> Vec<f64> {
    let mut diagonal = vec![0.0; order.len()];
    let mut row = Vec::new();
    for Small { rows, columns, kept } in shelves.iter().flat_map(Shelf::blocks) {
        let Kept::Dense(entries) = kept else { continue };
        row.resize(columns.len(), 0.0);
        for place in rows.clone().filter(|place| columns.contains(place)) {
            entries.row(place - rows.start, rows.len(), &mut row);
            diagonal[order[place]] = row[place - columns.start];
        }
    }
    diagonal
}

/// By strip of columns, which blocks of which shelf are in it.
fn beside(shelves: &[Shelf], strips: &Strips) -> Vec<Vec<(u32, u32)>> {
    let mut beside = vec![Vec::new(); strips.len()];
    for (shelf, blocks) in shelves.iter().enumerate() {
        for (k, block) in blocks.blocks().enumerate() {
            beside[strips.of(block.columns.start)].push((shelf as u32, k as u32));
        }
    }
    beside
}
