//! F ≈ F̃ for very many patches: what reaches a patch comes from *clusters* of others, as large as the error allows.
//!
//! (F̃ u)_i = Σ_C F_iC ū_C, over a cut through a tree of clusters C, with ū_C the mean of u over C by area. Patches that are near
//! each other and face alike share a cut. A cluster is cut in two where its link could bring more than a part of all that arrives,
//! so there are as many links as the error asks for, whatever the number of patches: O(n) in all. F_iC is found by formula, and
//! what of it arrives by rays, one or more to a link, each from another point to another: what they miss is noise with a mean of 0. Of
//! links that hardly count some are drawn that count for all of these, which has the same mean.
//! (Hanrahan, Salzman & Aupperle 1991; Smits, Arvo & Greenberg 1994; Walter et al. 2005.)

mod block;
mod build;
mod clusters;
mod cut;
mod error;
mod eyes;
mod factor;
mod kept;
mod lines;
mod picture;
mod random;
mod relaxed;
mod sight;
mod spot;
mod sweep;

pub use build::{Light, Plan, clusters_bytes};
pub use error::Judged;
pub(crate) use error::told;
pub use kept::{Kept, KeptError};

use block::{Block, Blocks};
use clusters::Clusters;
use fredholm::operator::Matrix;
use std::sync::Arc;

/// F̃, as links from patches to clusters.
#[derive(Debug)]
pub struct Hierarchical {
    clusters: Arc<Clusters>,
    /// The links of each region, in the order of the tree.
    regions: Vec<Blocks>,
    /// The region that each block is in, and its number there.
    numbers: Vec<(u32, u32)>,
    /// The block that each patch receives in, and its place there.
    places: Vec<(u32, u32)>,
    /// The place of each patch in the order of the tree.
    order_of: Vec<u32>,
    statistics: Statistics,
}

/// How large it is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Patches.
    pub patches: usize,
    /// Clusters, single patches among them.
    pub clusters: usize,
    /// Clusters of patches that share a cut.
    pub receivers: usize,
    /// Links from a patch to a cluster that it sees something of.
    pub links: u64,
    /// Rays cast for them.
    pub rays: u64,
    /// Bytes of the links, which an action reads: of factors, those that are 0 since something hides the sender among them, and senders.
    pub link_bytes: u64,
    /// Bytes of the links, and of the tree.
    pub bytes: u64,
}

impl Hierarchical {
    fn new(
        clusters: Arc<Clusters>,
        regions: Vec<Blocks>,
        order_of: Vec<u32>,
        statistics: Statistics,
    ) -> Self {
        let numbers = (0..)
            .zip(&regions)
            .flat_map(|(region, blocks)| (0..blocks.len() as u32).map(move |k| (region, k)));
        let numbers = numbers.collect();
        let mut links = Self { clusters, regions, numbers, places: Vec::new(), order_of, statistics };
        let mut places = vec![(0, 0); links.order_of.len()];
        for (number, block) in (0..).zip(links.blocks()) {
            for (place, patch) in (0..).zip(links.clusters.tree.members(block.receiver())) {
                places[*patch] = (number, place);
            }
        }
        links.places = places;
        links
    }

    /// The links of one receiver after the other.
    fn blocks(&self) -> impl Iterator<Item = Block<'_>> {
        self.regions.iter().flat_map(Blocks::iter)
    }

    /// The links of a receiver.
    fn block(&self, number: u32) -> Block<'_> {
        self.block_at(&self.numbers[number as usize])
    }

    fn block_at(&self, (region, k): &(u32, u32)) -> Block<'_> {
        self.regions[*region as usize].get(*k as usize)
    }

    /// How large it is.
    pub fn statistics(&self) -> &Statistics {
        &self.statistics
    }

    /// All its links, to go on with another time.
    pub fn into_kept(self, digest: u64, light: Light) -> Kept {
        Kept { digest, light, regions: self.regions }
    }
}

impl Matrix for Hierarchical {
    fn dim(&self) -> usize {
        self.places.len()
    }

    /// A planar patch does not see itself.
    fn diagonal(&self, _: usize) -> f64 {
        0.0
    }
}
