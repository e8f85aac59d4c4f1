//! The links of the patches of one cluster: a dense matrix, a column for each cluster that they gather from.

use fredholm::operator::hierarchical::Cluster;
use fredholm::value::Value;
use std::ops::Range;

/// F_iC for the patches i of a cluster and the clusters C of its cut.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Block {
    receiver: Cluster,
    patches: usize,
    senders: Box<[Cluster]>,
    /// Column by column: of all patches from the first sender, then from the next.
    factors: Box<[f32]>,
}

impl Block {
    /// From senders and their factors, column by column.
    pub fn from_parts(receiver: Cluster, patches: usize, senders: Vec<Cluster>, factors: Vec<f32>) -> Self {
        Self { receiver, patches, senders: senders.into(), factors: factors.into() }
    }

    /// From columns, of which those are left out that nothing comes from.
    pub fn new(
        receiver: Cluster,
        patches: usize,
        columns: impl Iterator<Item = (Cluster, Vec<f32>)>,
    ) -> Self {
        let (mut senders, mut factors) = (Vec::new(), Vec::new());
        for (sender, column) in columns.filter(|(_, column)| column.iter().any(|factor| *factor != 0.0)) {
            senders.push(sender);
            factors.extend(column);
        }
        Self::from_parts(receiver, patches, senders, factors)
    }

    /// The cluster of its patches.
    pub fn receiver(&self) -> Cluster {
        self.receiver
    }

    /// How many patches it has factors of: all of the cluster's, or one that stands for them.
    pub fn patches(&self) -> usize {
        self.patches
    }

    /// Each sender, with the factors of all patches.
    pub fn columns(&self) -> impl Iterator<Item = (Cluster, &[f32])> {
        self.senders.iter().copied().zip(self.factors.chunks_exact(self.patches.max(1)))
    }

    /// The factors of all patches from a sender, by its number.
    pub fn column(&self, k: usize) -> &[f32] {
        &self.factors[k * self.patches..(k + 1) * self.patches]
    }

    /// The senders that have places of the tree among their own that are in `here`, with the factors of all patches.
    pub fn columns_within(
        &self,
        range: impl Fn(Cluster) -> Range<usize>,
        here: &Range<usize>,
    ) -> impl Iterator<Item = (Cluster, &[f32])> {
        let first = self.senders.partition_point(|sender| range(*sender).end <= here.start);
        let end = here.end;
        let within = (first..self.senders.len()).take_while(move |k| range(self.senders[*k]).start < end);
        within.map(|k| (self.senders[k], self.column(k)))
    }

    /// The sender that has a place of the tree among its own, with the factors of all patches; senders ascend in the tree.
    pub fn column_with(
        &self,
        range: impl Fn(Cluster) -> Range<usize>,
        place: usize,
    ) -> Option<(Cluster, &[f32])> {
        let k = self.senders.partition_point(|sender| range(*sender).end <= place);
        let sender = *self.senders.get(k).filter(|sender| range(**sender).contains(&place))?;
        Some((sender, self.column(k)))
    }

    /// How many factors are not 0.
    pub fn links(&self) -> u64 {
        self.factors.iter().filter(|factor| **factor != 0.0).count() as u64
    }

    /// Bytes that it takes.
    pub fn bytes(&self) -> u64 {
        (size_of::<Self>() + size_of_val(&*self.senders) + size_of_val(&*self.factors)) as u64
    }

    /// What each patch gathers, from the means over all clusters.
    pub fn gather<V: Value>(&self, means: &[V]) -> Vec<V> {
        let mut sums = vec![V::splat(0.0); self.patches];
        for (sender, column) in self.columns() {
            let mean = means[sender.index()];
            for (sum, factor) in sums.iter_mut().zip(column) {
                *sum += mean * f64::from(*factor);
            }
        }
        sums
    }
}
