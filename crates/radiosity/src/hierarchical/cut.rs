//! What a cluster of patches gathers from: clusters as large as the error allows, seen from it.

use super::clusters::{Clusters, Whole};
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
            let unlike = factor * self.deviation[cluster.index()];
            if factor > 0.0 && self.is_hidden(here, there) {
                continue;
            }
            match self.clusters.tree.children(cluster) {
                Some([a, b])
                    if energy > most || unlike > WRONG * most || (energy > WRONG * most && !is_far()) =>
                {
                    stack.extend([b, a]);
                }
                _ => found.push(cluster),
            }
        }
    }

    /// Whether one polygon is proved to hide all of one cluster from all of the other.
    fn is_hidden(&self, here: &Whole, there: &Whole) -> bool {
        if !self.visibility.hides_anything() || here.distance(there) == 0.0 {
            return false;
        }
        let blocker = self.visibility.blocker(here.middle, there.middle);
        blocker
            .is_some_and(|id| self.visibility.certainly_blocks_hulls(id, &here.corners(), &there.corners()))
    }
}
