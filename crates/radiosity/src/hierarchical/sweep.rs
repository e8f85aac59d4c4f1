//! out = F̃ u, at what reading the links takes: means up the tree, then block by block what patches gather from them.
//!
//! Both are done by all cores, each on a range of its own, and without a list for every block.

use super::Hierarchical;
use super::clusters::{Whole, up_to};
use fredholm::operator::hierarchical::{Cluster, ClusterTree};
use fredholm::value::Value;
use rayon::prelude::*;
use std::ops::Range;

/// Two halves of a cluster: the first is numbered next to it.
#[derive(Clone, Copy, Debug)]
struct Pair {
    cluster: u32,
    second: u32,
    /// The part of the area that the first half has.
    part: f64,
}

/// A cluster and all below, which one thread goes up.
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
    /// What is above the parts.
    top: Vec<Pair>,
}

/// No patch has this number.
const SEVERAL: u32 = u32::MAX;

/// Patches of the largest clusters that one thread goes up.
const TOGETHER: usize = 1024;

impl Ascent {
    pub fn new(tree: &ClusterTree<6>, wholes: &[Whole]) -> Self {
        let halves = |cluster: Cluster| {
            tree.children(cluster).map(|[a, b]| Pair {
                cluster: cluster.index() as u32,
                second: b.index() as u32,
                part: wholes[a.index()].area / wholes[cluster.index()].area,
            })
        };
        let clusters: Vec<Cluster> = tree.top_down().collect();
        let patch = |cluster: &Cluster| match tree.children(*cluster) {
            None => tree.members(*cluster)[0] as u32,
            Some(_) => SEVERAL,
        };
        // Those below a cluster are numbered next to it: the last of them is found going down the second halves.
        let last = |cluster: Cluster| {
            std::iter::successors(Some(cluster), |at| tree.children(*at).map(|[_, b]| b))
                .last()
                .unwrap_or(cluster)
        };
        let part = |cluster: Cluster| {
            let below = cluster.index()..last(cluster).index() + 1;
            Part {
                pairs: clusters[below.clone()].iter().copied().filter_map(halves).collect(),
                clusters: below,
            }
        };
        let is_above = |cluster: &Cluster| tree.range(*cluster).len() > TOGETHER;
        Self {
            patches: clusters.iter().map(patch).collect(),
            parts: up_to(tree, TOGETHER).into_iter().map(part).collect(),
            top: clusters.iter().copied().filter(is_above).filter_map(halves).collect(),
        }
    }

    /// The mean over each cluster of what is given by patch, weighted by area.
    pub fn means<V: Value>(&self, values: &[V]) -> Vec<V> {
        let patches = self.patches.par_iter().with_min_len(TOGETHER);
        let value = |patch: &u32| values.get(*patch as usize).copied().unwrap_or(V::splat(0.0));
        let mut means: Vec<V> = patches.map(value).collect();
        let (mut rest, mut begin) = (&mut means[..], 0);
        let mut parts = Vec::with_capacity(self.parts.len());
        for Part { clusters, pairs } in &self.parts {
            let (part, after) = rest.split_at_mut(clusters.end - begin);
            parts.push((&mut part[clusters.start - begin..], clusters.start, pairs));
            (rest, begin) = (after, clusters.end);
        }
        parts.into_par_iter().for_each(|(means, first, pairs)| rise(means, first, pairs));
        rise(&mut means, 0, &self.top);
        means
    }
}

/// The means over clusters, from those over their halves; the first of the slice has the number `first`.
fn rise<V: Value>(means: &mut [V], first: usize, pairs: &[Pair]) {
    for Pair { cluster, second, part } in pairs.iter().rev() {
        let (cluster, second) = (*cluster as usize - first, *second as usize - first);
        means[cluster] = means[cluster + 1] * *part + means[second] * (1.0 - *part);
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
        let tree = &self.clusters.tree;
        let mut in_order = vec![V::splat(0.0); out.len()];
        let mut rest = &mut in_order[..];
        let mut tasks = Vec::with_capacity(self.numbers.len().div_ceil(IN_A_ROW));
        for numbers in self.numbers.chunks(IN_A_ROW) {
            let range = |k: usize| tree.range(self.block_at(&numbers[k]).receiver());
            let (own, after) = rest.split_at_mut(range(numbers.len() - 1).end - range(0).start);
            tasks.push((numbers, own));
            rest = after;
        }
        tasks.into_par_iter().for_each(|(numbers, mut own)| {
            for at in numbers {
                let block = self.block_at(at);
                let (sums, after) = std::mem::take(&mut own).split_at_mut(tree.range(block.receiver()).len());
                block.gather(means, sums);
                own = after;
            }
        });
        out.par_iter_mut().zip(&self.order_of).for_each(|(value, place)| *value = in_order[*place as usize]);
    }
}
