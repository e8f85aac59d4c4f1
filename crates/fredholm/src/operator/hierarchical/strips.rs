//! {0, …, n − 1} = s₁ ∪ s₂ ∪ …: ranges of places whose values stay in the fastest cache while blocks stream past.

use super::cluster::{Cluster, ClusterTree};
use std::ops::Range;

/// Clusters of about as many places as are worth a task, one after another.
#[derive(Clone, Debug)]
pub(super) struct Strips {
    /// Where each begins, and after the last one n.
    starts: Vec<usize>,
}

/// Places of a strip, at most: 4 kB of numbers, an eighth of a small first-level cache, and of colours three eighths. With fewer, a
/// block is in more strips, and its pieces are shorter.
const MOST: usize = 512;

impl Strips {
    pub(super) fn new<const D: usize>(tree: &ClusterTree<D>) -> Self {
        let mut starts = Vec::new();
        if let Some(root) = tree.root() {
            cut(tree, root, &mut starts);
        }
        starts.push(tree.order().len());
        Self { starts }
    }

    /// How many there are.
    pub(super) fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// The places of a strip.
    pub(super) fn range(&self, strip: usize) -> Range<usize> {
        self.starts[strip]..self.starts[strip + 1]
    }

    /// The strip that has a place.
    pub(super) fn of(&self, place: usize) -> usize {
        self.starts.partition_point(|start| *start <= place) - 1
    }

    /// The strips that a range has places in.
    pub(super) fn across(&self, range: &Range<usize>) -> Range<usize> {
        if range.is_empty() { 0..0 } else { self.of(range.start)..self.of(range.end - 1) + 1 }
    }

    /// The places of a range that are in a strip.
    pub(super) fn part(&self, range: &Range<usize>, strip: usize) -> Range<usize> {
        let places = self.range(strip);
        range.start.max(places.start)..range.end.min(places.end)
    }

    /// Values over all places, a slice for each strip.
    pub(super) fn split<'a, V>(&self, mut values: &'a mut [V]) -> Vec<&'a mut [V]> {
        let cut = |strip| {
            let (part, rest) = std::mem::take(&mut values).split_at_mut(self.range(strip).len());
            values = rest;
            part
        };
        (0..self.len()).map(cut).collect()
    }
}

fn cut<const D: usize>(tree: &ClusterTree<D>, cluster: Cluster, starts: &mut Vec<usize>) {
    let range = tree.range(cluster);
    match tree.children(cluster) {
        Some(parts) if range.len() > MOST => parts.into_iter().for_each(|part| cut(tree, part, starts)),
        _ => starts.push(range.start),
    }
}
