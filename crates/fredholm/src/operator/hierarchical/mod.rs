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
mod factor;
mod lines;
mod options;
mod partition;
mod plan;
mod recompress;
mod side;
mod statistics;
mod strips;

pub use cluster::{Bounds, Cluster, ClusterError, ClusterTree};
pub use options::{HierarchicalError, Options};
pub use plan::Plan;
pub use statistics::Statistics;

use crate::discretize::Coupling;
use crate::operator::NotFinite;
use block::Block;
use entries::Entries;
use side::Side;
use strips::Strips;

/// F̃ in blocks, made by [`Plan::assemble`].
#[derive(Clone, Debug)]
pub struct Hierarchical {
    /// The unknown at each place.
    order: Vec<usize>,
    /// The place of each unknown.
    place: Vec<usize>,
    strips: Strips,
    blocks: Vec<Block>,
    /// By block: where its moments begin among those of all; after the last one their number.
    firsts: Vec<usize>,
    rows: Side,
    columns: Side,
    diagonal: Vec<f64>,
    statistics: Statistics,
}

/// What a plan has made.
struct Parts {
    order: Vec<usize>,
    strips: Strips,
    blocks: Vec<Block>,
}

impl Hierarchical {
    fn new<C: Coupling>(
        Parts { order, strips, blocks }: Parts,
        entries: &Entries<'_, C>,
        tolerance: f64,
    ) -> Result<Self, NotFinite> {
        let mut place = vec![0; order.len()];
        order.iter().enumerate().for_each(|(k, number)| place[*number] = k);
        let mut firsts = vec![0];
        blocks.iter().for_each(|block| firsts.push(firsts[firsts.len() - 1] + block.rank().unwrap_or(0)));
        let (rows, columns) =
            (Side::new(&blocks, &strips, Block::rows), Side::new(&blocks, &strips, Block::columns));
        let diagonal = diagonal(&blocks, &order, &strips);
        let besides =
            8 * (order.len() + place.len() + firsts.len() + diagonal.len()) + rows.bytes() + columns.bytes();
        let statistics =
            statistics::statistics(&blocks, entries, &strips, tolerance, (order.len(), besides))?;
        Ok(Self { order, place, strips, blocks, firsts, rows, columns, diagonal, statistics })
    }

    /// Sizes, ranks, memory and the estimated error.
    pub fn statistics(&self) -> &Statistics {
        &self.statistics
    }
}

/// F̃_ii by unknown: blocks on the diagonal are dense.
fn diagonal(blocks: &[Block], order: &[usize], strips: &Strips) -> Vec<f64> {
    let mut diagonal = vec![0.0; order.len()];
    let mut row = Vec::new();
    for block in blocks {
        let Block::Dense { entries, columns } = block else { continue };
        row.resize(columns.len(), 0.0);
        for place in entries.range().clone().filter(|place| columns.contains(place)) {
            entries.row(place, strips, &mut row);
            diagonal[order[place]] = row[place - columns.start];
        }
    }
    diagonal
}
