//! out = F̃ u, at what reading the links takes: means up the tree, then block by block what patches gather from them.
//!
//! Both are done by all cores, each on a range of its own, and without a list for every block.

use super::Hierarchical;
use super::clusters::{Whole, up_to};
use fredholm::operator::hierarchical::{Cluster, ClusterTree};
use fredholm::value::Value;
use rayon::prelude::*;

/// What the mean over a cluster is made of: nothing else of the tree is read on the way up.
#[derive(Clone, Copy, Debug)]
enum Mean {
    /// A patch.
    Of(u32),
    /// Two halves, and the part of the area that the first has.
    Between([u32; 2], f64),
}

/// The way up the tree.
#[derive(Debug)]
pub(super) struct Ascent {
    means: Vec<Mean>,
    /// The first and the last number of clusters that are gone up by one thread each.
    parts: Vec<(usize, usize)>,
}

/// Patches of the largest clusters that one thread goes up.
const TOGETHER: usize = 1024;

impl Ascent {
    pub fn new(tree: &ClusterTree<6>, wholes: &[Whole]) -> Self {
        let mean = |cluster: Cluster| match tree.children(cluster) {
            None => Mean::Of(tree.members(cluster)[0] as u32),
            Some([a, b]) => {
                let part = wholes[a.index()].area / wholes[cluster.index()].area;
                Mean::Between([a, b].map(|half| half.index() as u32), part)
            }
        };
        // A cluster's halves and theirs are numbered next to it: the last of them is found going down the second halves.
        let last = |cluster: Cluster| {
            std::iter::successors(Some(cluster), |at| tree.children(*at).map(|[_, b]| b))
                .last()
                .unwrap_or(cluster)
        };
        let parts = up_to(tree, TOGETHER).into_iter().map(|part| (part.index(), last(part).index()));
        Self { means: tree.top_down().map(mean).collect(), parts: parts.collect() }
    }

    /// The mean over each cluster of what is given by patch, weighted by area.
    pub fn means<V: Value>(&self, values: &[V]) -> Vec<V> {
        let mut means = vec![V::splat(0.0); self.means.len()];
        let mut rest = &mut means[..];
        let mut begin = 0;
        let mut parts = Vec::with_capacity(self.parts.len());
        for (first, last) in &self.parts {
            let (part, after) = rest.split_at_mut(last + 1 - begin);
            parts.push((*first, &mut part[first - begin..]));
            (rest, begin) = (after, last + 1);
        }
        parts.into_par_iter().for_each(|(first, part)| {
            for k in (0..part.len()).rev() {
                part[k] = self.mean(first + k, values, |half| part[half - first]);
            }
        });
        let mut next = self.parts.iter().rev().peekable();
        let mut k = self.means.len();
        while k > 0 {
            k -= 1;
            if let Some((first, _)) = next.next_if(|(_, last)| *last == k) {
                k = *first;
            } else {
                means[k] = self.mean(k, values, |half| means[half]);
            }
        }
        means
    }

    fn mean<V: Value>(&self, cluster: usize, values: &[V], of: impl Fn(usize) -> V) -> V {
        match self.means[cluster] {
            Mean::Of(patch) => values[patch as usize],
            Mean::Between([a, b], part) => of(a as usize) * part + of(b as usize) * (1.0 - part),
        }
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
