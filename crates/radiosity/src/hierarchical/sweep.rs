//! out = F̃ u, at what reading the links takes: means up the tree, then block by block what patches gather from them.
//!
//! Both are done by all cores, each on a range of its own, and without a list for every block.

use super::Hierarchical;
use super::clusters::{Whole, up_to};
use fredholm::operator::hierarchical::{Cluster, ClusterTree};
use fredholm::value::Value;
use rayon::prelude::*;
use std::ops::Range;

/// Two halves of a cluster, the second of which is numbered next to the first.
#[derive(Clone, Copy, Debug)]
struct Pair {
    cluster: u32,
    first: u32,
    /// The part of the area that the first half has.
    part: f64,
}

/// All that is below a cluster, which one thread goes up.
#[derive(Debug)]
struct Part {
    clusters: Range<usize>,
    pairs: Vec<Pair>,
}

/// The way up the tree.
#[derive(Debug)]
pub(super) struct Ascent {
    /// The patch that each cluster is, or [`SEVERAL`].
    patches: Vec<u32>,
    parts: Vec<Part>,
    /// The clusters that the parts are below, and all above.
    top: Vec<Pair>,
}

/// No patch has this number.
const SEVERAL: u32 = u32::MAX;

/// Patches of the largest clusters that one thread goes up.
const TOGETHER: usize = 1024;

impl Ascent {
    pub fn new(tree: &ClusterTree<6>, wholes: &[Whole]) -> Self {
        let halves = |cluster: Cluster| {
            tree.children(cluster).map(|[a, _]| Pair {
                cluster: cluster.index() as u32,
                first: a.index() as u32,
                part: wholes[a.index()].area / wholes[cluster.index()].area,
            })
        };
        let clusters: Vec<Cluster> = tree.top_down().collect();
        let patch = |cluster: &Cluster| match tree.children(*cluster) {
            None => tree.members(*cluster)[0] as u32,
            Some(_) => SEVERAL,
        };
        // There are 2 m - 2 clusters below one of m patches, numbered from its first half on.
        let part = |cluster: Cluster| {
            let [first, _] = tree.children(cluster)?;
            let below = first.index()..first.index() + 2 * tree.range(cluster).len() - 2;
            let pairs = clusters[below.clone()].iter().copied().filter_map(halves).collect();
            Some(Part { clusters: below, pairs })
        };
        let roots = up_to(tree, TOGETHER);
        let above = clusters.iter().copied().filter(|cluster| tree.range(*cluster).len() > TOGETHER);
        Self {
            patches: clusters.iter().map(patch).collect(),
            top: above.chain(roots.iter().copied()).filter_map(halves).collect(),
            parts: roots.into_iter().filter_map(part).collect(),
        }
    }

    /// The mean over each cluster of what is given by patch, weighted by area.
    pub fn means<V: Value>(&self, values: &[V]) -> Vec<V> {
        // Of a single patch there is nothing below; all other means are found.
        let Some(only) = values.first() else { return Vec::new() };
        let mut means = vec![*only; self.patches.len()];
        let (mut rest, mut begin) = (&mut means[..], 0);
        let mut parts = Vec::with_capacity(self.parts.len());
        for Part { clusters, pairs } in &self.parts {
            let (part, after) = rest.split_at_mut(clusters.end - begin);
            parts.push((&mut part[clusters.start - begin..], clusters.start, pairs));
            (rest, begin) = (after, clusters.end);
        }
        parts.into_par_iter().for_each(|(means, first, pairs)| {
            for (mean, patch) in means.iter_mut().zip(&self.patches[first..]) {
                if let Some(value) = values.get(*patch as usize) {
                    *mean = *value;
                }
            }
            rise(means, first, pairs);
        });
        rise(&mut means, 0, &self.top);
        means
    }
}

/// The means over clusters, from those over their halves; the first of the slice has the number `begin`.
fn rise<V: Value>(means: &mut [V], begin: usize, pairs: &[Pair]) {
    for Pair { cluster, first, part } in pairs.iter().rev() {
        let (cluster, first) = (*cluster as usize - begin, *first as usize - begin);
        means[cluster] = means[first] * *part + means[first + 1] * (1.0 - *part);
    }
}

/// Receivers that one thread goes through without looking for other work.
const IN_A_ROW: usize = 32;

impl Hierarchical {
    /// `out` = F̃ u.
    pub(super) fn gather<V: Value>(&self, u: &[V], out: &mut [V]) {
        self.gather_means(&self.clusters.means(u), out);
    }

    /// What each patch gathers from means over clusters.
    pub(super) fn gather_means<V: Value>(&self, means: &[V], out: &mut [V]) {
        let mut in_order = vec![V::splat(0.0); out.len()];
        let mut rest = &mut in_order[..];
        let mut tasks = Vec::with_capacity(self.numbers.len().div_ceil(IN_A_ROW));
        for numbers in self.numbers.chunks(IN_A_ROW) {
            let patches = numbers.iter().map(|at| self.block_at(at).patches()).sum();
            let (own, after) = rest.split_at_mut(patches);
            tasks.push((numbers, own));
            rest = after;
        }
        tasks.into_par_iter().for_each(|(numbers, mut own)| {
            for at in numbers {
                let block = self.block_at(at);
                let (sums, after) = std::mem::take(&mut own).split_at_mut(block.patches());
                block.gather(means, sums);
                own = after;
            }
        });
        out.par_iter_mut().zip(&self.order_of).for_each(|(value, place)| *value = in_order[*place as usize]);
    }
}
