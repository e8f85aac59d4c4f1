//! What a cluster of patches gathers from: clusters as large as the error allows, seen from it.

use super::clusters::{Clusters, Whole};
use super::random::Random;
use crate::kernel;
use crate::polygon::Polygon;
use crate::visibility::Visibility;
use fredholm::operator::hierarchical::Cluster;
use prefetch_index::prefetch_index;
use std::collections::HashMap;
use std::ops::Range;

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
    /// Of what hardly counts some clusters are drawn that speak for the others, by this seed; `None` is for all.
    pub draws: Option<u64>,
}

/// A cluster of a cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Found {
    pub cluster: Cluster,
    /// How many of its kind it speaks for.
    pub weight: f64,
    /// Whether it is proved that nothing is between: then it costs no rays.
    pub clear: bool,
}

/// Links that bring less than this part of what one may are drawn if they cost rays: these would be half of all.
pub(super) const SMALL: f64 = 1.0 / 128.0;

/// What a link may bring is first told by that of its middle, before anything of it is computed; it counts as no less than this part of
/// its bound, since elsewhere it may bring more.
const LIKELY: f64 = 0.1;

/// A cluster is far whose box has half a diagonal of at most this part of its distance: its form factor is found from four parts
/// of it, each of at most a quarter of the distance.
const FAR: f64 = 0.5;

/// The least cosine between the normals of a cluster and their mean: what it sends is that of its parts, each with a mean normal.
pub(super) const ALIKE: f64 = 0.9;

/// The part of what one link may bring by which it may be *wrong*, as noise is not: since the cluster is near, or its patches are
/// not alike and some are hidden. Errors of that kind add up.
const WRONG: f64 = 0.02;

/// How many rays would be expected to arrive from a cluster whose middle is hidden if it brought as much as counts: of so many that it
/// takes, one does, or it seems hidden.
const SURE: f64 = 3.0;

/// The most rays that ask it. They are those of receivers near each other, once for all of them: a receiver that asked for itself
/// would take longer to find what is hidden than its links take.
const PROBES: u64 = 256;

/// So many patches of a cluster, one from each part, are looked from and at.
const PARTS: usize = 16;

/// Another seed than that of any links.
const SEED: u64 = 0xc075;

/// What seems hidden from a cluster, of what somebody in it asked about.
#[derive(Debug)]
pub(super) struct Hidden {
    from: Cluster,
    /// How many rays to a cluster found nothing, or which was the first that did: the answer is the same whoever asks before.
    known: HashMap<usize, Looked>,
}

#[derive(Clone, Copy, Debug)]
enum Looked {
    InVain(u64),
    Seen(u64),
}

impl Hidden {
    /// Nothing yet.
    pub fn from(from: Cluster) -> Self {
        Self { from, known: HashMap::new() }
    }
}

impl Cuts<'_> {
    /// The clusters, in the order of the tree, of which some may be single patches; `hidden` is of a cluster that the receiver is a
    /// part of, or of itself.
    pub fn of(&self, receiver: Cluster, hidden: &mut Hidden, found: &mut Vec<Found>) {
        found.clear();
        let here = self.clusters.whole(receiver);
        let (hull, centre) = (self.clusters.hull(receiver), self.clusters.sender(receiver).centre);
        let most = self.part * self.arriving[receiver.index()];
        let own = self.clusters.tree.range(receiver);
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
            let rays = (SURE * excess).ceil() as u64;
            let children = self.clusters.tree.children(cluster);
            // A cluster that is cut in two whether or not it seems hidden is too large, mostly, for one polygon to hide: its halves will tell.
            let is_cut = rays > PROBES && children.is_some();
            let blocker = if is_cut { None } else { self.blocker(here, there) };
            if blocker.is_some_and(|id| self.hides(id, here, there)) {
                continue;
            }
            let counts = excess > 1.0 && (blocker.is_none() || !self.seems_hidden(cluster, rays, hidden));
            match children {
                Some(halves) if counts || self.overlaps(cluster, &own) => {
                    halves.iter().for_each(|half| self.fetch(*half));
                    let [a, b] = halves;
                    stack.extend([b, a]);
                }
                _ => {
                    let clear = blocker.is_none() && self.is_clear(hull.as_deref(), cluster);
                    let likely = || {
                        let factor = self.clusters.sender(cluster).seen_from(centre, here.axis);
                        (factor * self.brightness[cluster.index()]).max(LIKELY * energy)
                    };
                    let chance = if clear { 1.0 } else { likely() / (SMALL * most) };
                    let weight = self.drawn(receiver, cluster, chance);
                    found.extend(weight.map(|weight| Found { cluster, weight, clear }));
                }
            }
        }
    }

    /// Asks for all that is read of a cluster, so that it is near when its turn comes.
    fn fetch(&self, cluster: Cluster) {
        self.clusters.fetch(cluster);
        prefetch_index(self.brightness, cluster.index());
        prefetch_index(self.deviation, cluster.index());
    }

    /// Whether a cluster has some of these places: no patch gathers from what it is a part of.
    fn overlaps(&self, cluster: Cluster, places: &Range<usize>) -> bool {
        let range = self.clusters.tree.range(cluster);
        range.start < places.end && places.start < range.end
    }

    /// Whether it is proved that nothing is between a polygon and a cluster.
    fn is_clear(&self, from: Option<&Polygon>, to: Cluster) -> bool {
        let hull = || self.clusters.hull(to);
        !self.visibility.hides_anything()
            || from.zip(hull()).is_some_and(|(a, b)| self.visibility.certainly_clear(a, &b))
    }

    /// How many clusters one speaks for that is drawn with a chance below 1; `None` where it is not.
    fn drawn(&self, receiver: Cluster, cluster: Cluster, chance: f64) -> Option<f64> {
        match self.draws {
            Some(seed) if chance < 1.0 => {
                let mut random = Random::new(seed ^ SEED, receiver.index() as u64, cluster.index() as u64);
                (random.next() < chance).then(|| chance.recip())
            }
            _ => Some(1.0),
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

    /// Whether none arrives of as many rays as it takes, if these are not too many.
    fn seems_hidden(&self, sender: Cluster, rays: u64, Hidden { from, known }: &mut Hidden) -> bool {
        if rays > PROBES {
            return false;
        }
        let looked = known.entry(sender.index()).or_insert(Looked::InVain(0));
        if let Looked::InVain(cast) = *looked {
            let seen = (cast..rays).find(|ray| self.arrives(*from, sender, *ray));
            *looked = seen.map_or(Looked::InVain(cast.max(rays)), Looked::Seen);
        }
        match *looked {
            Looked::InVain(_) => true,
            Looked::Seen(first) => first >= rays,
        }
    }

    /// Whether a ray between two clusters does: from some patch of one to some of the other, of a few that are in a cache for the
    /// next that asks.
    fn arrives(&self, receiver: Cluster, sender: Cluster, ray: u64) -> bool {
        let mut random = Random::new(SEED + ray, receiver.index() as u64, sender.index() as u64);
        let [x, y] = [receiver, sender].map(|cluster| {
            let patches = self.clusters.tree.range(cluster);
            let part = (random.next() * PARTS as f64) as usize;
            let place = patches.start + (2 * part + 1) * patches.len() / (2 * PARTS);
            self.clusters.spots.point(&self.clusters.spots.at(place), &mut random)
        });
        kernel::unoccluded(&x, &y) > 0.0 && self.visibility.unoccluded(x.position, y.position)
    }
}

#[cfg(test)]
mod tests {
    use super::super::clusters::{cornell_clusters, up_to};
    use super::*;

    const SEEDS: u64 = 50;

    #[test]
    fn clusters_that_are_drawn_speak_for_those_that_are_not() {
        let (visibility, clusters) = cornell_clusters(0.05);
        let (ones, zeros) = (vec![1.0; clusters.wholes.len()], vec![0.0; clusters.wholes.len()]);
        let part = 0.3;
        let [brightness, arriving, deviation] = [&ones, &ones, &zeros];
        let receivers = up_to(&clusters.tree, 16);
        // How many clusters are found that may be drawn, and what all of them bring.
        let drawable = |draws: Option<u64>| {
            let (clusters, visibility) = (&clusters, &visibility);
            let cuts = Cuts { clusters, visibility, brightness, deviation, arriving, part, draws };
            let (mut count, mut sum, mut found) = (0, 0.0, Vec::new());
            for receiver in &receivers {
                cuts.of(*receiver, &mut Hidden::from(*receiver), &mut found);
                for Found { cluster, weight, .. } in &found {
                    let energy = clusters.whole(*receiver).most(clusters.whole(*cluster));
                    if energy * LIKELY < SMALL * part {
                        count += 1;
                        sum += weight * energy;
                    }
                }
            }
            (count, sum)
        };
        let (all, whole) = drawable(None);
        let drawn: Vec<(usize, f64)> = (0..SEEDS).map(|seed| drawable(Some(seed))).collect();
        let count = drawn.iter().map(|(count, _)| *count as f64).sum::<f64>() / SEEDS as f64;
        let mean = drawn.iter().map(|(_, sum)| *sum).sum::<f64>() / SEEDS as f64;
        assert!(count < 0.95 * all as f64, "{count} of {all}");
        assert!((mean / whole - 1.0).abs() < 0.02, "{mean} in the mean of {whole}");
    }

    #[test]
    fn no_patch_gathers_from_what_it_is_a_part_of_however_dark_that_is() {
        let (visibility, clusters) = cornell_clusters(0.1);
        let (dark, ones) = (vec![1e-9; clusters.wholes.len()], vec![1.0; clusters.wholes.len()]);
        let (clusters, visibility) = (&clusters, &visibility);
        let [brightness, deviation, arriving] = [&dark, &dark, &ones];
        let cuts = Cuts { clusters, visibility, brightness, deviation, arriving, part: 0.3, draws: None };
        let (mut found, mut large) = (Vec::new(), 0);
        for receiver in up_to(&clusters.tree, 16) {
            cuts.of(receiver, &mut Hidden::from(receiver), &mut found);
            let own = clusters.tree.range(receiver);
            for Found { cluster, .. } in &found {
                let size = clusters.tree.range(*cluster).len();
                assert!(
                    size == 1 || !cuts.overlaps(*cluster, &own),
                    "{size} patches of which some are {own:?}"
                );
                large = large.max(size);
            }
        }
        assert!(large > 100, "the others stay together: {large}");
    }
}
