//! What a cluster of patches gathers from: clusters as large as the error allows, seen from it.

use super::clusters::{Clusters, Whole};
use super::random::Random;
use crate::kernel;
use crate::visibility::Visibility;
use fredholm::operator::hierarchical::Cluster;

/// Cuts through the tree, each for the patches of one receiving cluster.
///
/// What may come from a cluster, the bound of its form factor times its brightness, is the energy of the link. It may be no more
/// than a part of all that arrives, or else the cluster is cut; one that is near is cut unless it sends next to nothing.
#[derive(Debug)]
pub(super) struct Cuts<'a> {
    pub clusters: &'a Clusters,
    pub visibility: &'a Visibility,
    /// How bright each cluster is.
    pub brightness: &'a [f64],
    /// How far brightness is from that within each cluster: the standard deviation.
    pub deviation: &'a [f64],
    /// What arrives at each cluster, at least.
    pub arriving: &'a [f64],
    /// The part of what arrives that one link may bring.
    pub part: f64,
}

/// A cluster is far whose box has half a diagonal of at most this part of its distance: its form factor is found from four parts
/// of it, each of at most a quarter of the distance.
const FAR: f64 = 0.5;

/// The least cosine between the normals of a cluster and their mean: what it sends is that of its parts, each with a mean normal.
const ALIKE: f64 = 0.9;

/// The part of what one link may bring by which it may be *wrong*, as noise is not: since the cluster is near, or its patches are
/// not alike and some are hidden. Errors of that kind add up.
const WRONG: f64 = 0.02;

/// Rays that tell how much of a cluster is seen whose middle is not.
const PROBES: u64 = 64;

/// How many of these would be expected to arrive if it were as much as counts.
const SURE: f64 = 4.0;

/// Another seed than that of any links.
const SEED: u64 = 0xc075;

impl Cuts<'_> {
    /// The clusters, in the order of the tree, of which some may be single patches.
    pub fn of(&self, receiver: Cluster, found: &mut Vec<Cluster>) {
        found.clear();
        let here = self.clusters.whole(receiver);
        let most = self.part * self.arriving[receiver.index()];
        let mut stack: Vec<Cluster> = self.clusters.tree.root().into_iter().collect();
        while let Some(cluster) = stack.pop() {
            let there = self.clusters.whole(cluster);
            let factor = here.most(there);
            let energy = factor * self.brightness[cluster.index()];
            if energy == 0.0 {
                continue;
            }
            let is_far = || there.turn.0 >= ALIKE && there.radius() <= FAR * here.distance(there);
            // How many times more than it may a link brings, or is wrong.
            let wrong = factor * self.deviation[cluster.index()] / WRONG;
            let excess = energy.max(wrong).max(if is_far() { 0.0 } else { energy / WRONG }) / most;
            let blocker = self.blocker(here, there);
            if blocker.is_some_and(|id| self.hides(id, here, there)) {
                continue;
            }
            let counts =
                || excess > 1.0 && (blocker.is_none() || self.is_seen(receiver, cluster, excess.recip()));
            match self.clusters.tree.children(cluster) {
                Some([a, b]) if counts() => stack.extend([b, a]),
                _ => found.push(cluster),
            }
        }
    }

    /// What is between the middles of two clusters.
    fn blocker(&self, here: &Whole, there: &Whole) -> Option<u32> {
        let apart = self.visibility.hides_anything() && here.distance(there) > 0.0;
        if apart { self.visibility.blocker(here.middle, there.middle) } else { None }
    }

    /// Whether one polygon is proved to hide all of one cluster from all of the other.
    fn hides(&self, id: u32, here: &Whole, there: &Whole) -> bool {
        self.visibility.certainly_blocks_hulls(id, &here.corners(), &there.corners())
    }

    /// Whether more than a part of what a cluster sends to another seems to arrive: a ray does, of as many as would be expected to.
    fn is_seen(&self, receiver: Cluster, sender: Cluster, part: f64) -> bool {
        let rays = (SURE * part.recip()).ceil() as u64;
        let ends =
            [receiver, sender].map(|cluster| &self.clusters.polygons[self.clusters.tree.range(cluster)]);
        let mut random = Random::new(SEED, receiver.index() as u64, sender.index() as u64);
        rays > PROBES
            || (0..rays).any(|_| {
                let [x, y] = ends.map(|patches| {
                    let patch = (random.next() * patches.len() as f64) as usize;
                    random.point(&patches[patch])
                });
                kernel::unoccluded(&x, &y) > 0.0 && self.visibility.unoccluded(x.position, y.position)
            })
    }
}
