//! Gathering and shooting at what links cost: means over clusters are kept up to date patch by patch, and what patches send waits in
//! the clusters above them.
//!
//! A step δ of patch j changes the mean of each cluster C that it is in by δ A_j/A_C: as many as the tree is deep. So a sweep of
//! Gauss–Seidel reads each link once. A shot would be received by all that see j, by O(n) patches; held in the clusters until it is
//! as large as what is left to shoot, light from about all patches of C is received at once.

use super::Hierarchical;
use fredholm::operator::hierarchical::Cluster;
use fredholm::operator::{Gather, Gathered, Shoot};
use fredholm::relax::Largest;
use fredholm::value::Value;

/// Which clusters each patch is in.
#[derive(Debug)]
struct Ancestry<'a> {
    links: &'a Hierarchical,
    /// The cluster that is a patch.
    leaves: Vec<Cluster>,
    /// The cluster that each is half of; the root is its own.
    parents: Vec<Cluster>,
}

impl<'a> Ancestry<'a> {
    fn new(links: &'a Hierarchical) -> Self {
        let tree = &links.clusters.tree;
        let mut parents: Vec<Cluster> = tree.top_down().collect();
        for cluster in tree.top_down() {
            let halves = tree.children(cluster).into_iter().flatten();
            halves.for_each(|half| parents[half.index()] = cluster);
        }
        let in_order: Vec<Cluster> = tree.leaves().collect();
        let leaves = links.order_of.iter().map(|place| in_order[*place as usize]).collect();
        Self { links, leaves, parents }
    }

    /// The clusters that a patch is in, itself first, each with the patch's part of its area.
    fn above(&self, patch: usize) -> impl Iterator<Item = (Cluster, f64)> {
        let up = |at: &Cluster| Some(self.parents[at.index()]).filter(|above| above != at);
        let area = self.links.clusters.areas[patch];
        std::iter::successors(Some(self.leaves[patch]), up)
            .map(move |at| (at, area / self.links.clusters.whole(at).area))
    }
}

/// What patches gather while they change, receiver by receiver.
#[derive(Debug)]
pub(super) struct Gathering<'a, V> {
    links: &'a Hierarchical,
    ancestry: Ancestry<'a>,
    /// Of u, by cluster.
    means: Vec<V>,
    sums: Vec<V>,
    inside: Vec<f64>,
}

impl<'a, V: Value> Gathering<'a, V> {
    pub fn new(links: &'a Hierarchical) -> Self {
        let ancestry = Ancestry::new(links);
        Self { links, ancestry, means: Vec::new(), sums: Vec::new(), inside: Vec::new() }
    }
}

impl<V: Value> Gather<V> for Gathering<'_, V> {
    fn groups(&self) -> usize {
        self.links.numbers.len()
    }

    fn group(&mut self, group: usize, u: &[V]) -> Gathered<'_, V> {
        let clusters = &self.links.clusters;
        if group == 0 {
            self.means = self.links.clusters.means(u);
        }
        let block = self.links.block(group as u32);
        let unknowns = clusters.tree.members(block.receiver());
        self.sums.resize(unknowns.len(), V::splat(0.0));
        block.gather(&self.means, &mut self.sums);
        self.inside.clear();
        self.inside.resize(unknowns.len() * unknowns.len(), 0.0);
        let here = clusters.tree.range(block.receiver());
        for (sender, column) in block.columns_within(|sender| clusters.tree.range(sender), &here) {
            let (from, area) = (clusters.tree.range(sender), clusters.whole(sender).area);
            for place in from.start.max(here.start)..from.end.min(here.end) {
                let k = place - here.start;
                let part = self.links.clusters.areas[unknowns[k]] / area;
                for (i, factor) in column.iter().enumerate() {
                    self.inside[i * unknowns.len() + k] = f64::from(*factor) * part;
                }
            }
        }
        Gathered { unknowns, sums: &self.sums, inside: &self.inside }
    }

    fn changed(&mut self, group: usize, steps: &[V]) {
        let links = self.links;
        let unknowns = links.clusters.tree.members(links.block(group as u32).receiver());
        for (patch, step) in unknowns.iter().zip(steps) {
            for (cluster, part) in self.ancestry.above(*patch) {
                self.means[cluster.index()] += *step * part;
            }
        }
    }
}

/// What patches have sent and others not yet received, in the clusters that links come from.
#[derive(Debug)]
pub(super) struct Shooting<'a, V> {
    links: &'a Hierarchical,
    ancestry: Ancestry<'a>,
    /// By cluster: the mean of what is held, and its size.
    held: Vec<V>,
    sizes: Largest,
    /// By cluster: where its links begin in `receivers`.
    begins: Vec<u32>,
    /// The block and the column of each sender, cluster by cluster.
    receivers: Vec<(u32, u32)>,
    received: Vec<V>,
}

impl<'a, V: Value> Shooting<'a, V> {
    pub fn new(links: &'a Hierarchical) -> Self {
        let clusters = links.clusters.wholes.len();
        let senders = || {
            let blocks = (0_u32..).zip(links.blocks());
            blocks.flat_map(|(number, block)| {
                (0_u32..)
                    .zip(block.columns())
                    .map(move |(column, (sender, _))| (sender.index(), (number, column)))
            })
        };
        let mut begins = vec![0_u32; clusters + 1];
        senders().for_each(|(sender, _)| begins[sender + 1] += 1);
        (0..clusters).for_each(|k| begins[k + 1] += begins[k]);
        let mut next = begins.clone();
        let mut receivers = vec![(0, 0); begins[clusters] as usize];
        for (sender, receiver) in senders() {
            receivers[next[sender] as usize] = receiver;
            next[sender] += 1;
        }
        Self {
            links,
            ancestry: Ancestry::new(links),
            held: vec![V::splat(0.0); clusters],
            sizes: Largest::new((0..clusters).map(|_| 0.0)),
            begins,
            receivers,
            received: Vec::new(),
        }
    }
}

impl<V: Value> Shoot<V> for Shooting<'_, V> {
    fn send(&mut self, j: usize, step: V) {
        for (cluster, part) in self.ancestry.above(j) {
            let k = cluster.index();
            if self.begins[k] < self.begins[k + 1] {
                self.held[k] += step * part;
                self.sizes.set(k, self.held[k].magnitude());
            }
        }
    }

    /// A patch receives from disjoint clusters by factors that add up to about 1 or less, and links hold no more than the largest mean.
    fn held(&self) -> f64 {
        self.sizes.size()
    }

    fn deliver(&mut self, receive: &mut dyn FnMut(&[usize], &[V])) {
        let k = self.sizes.first();
        let held = std::mem::replace(&mut self.held[k], V::splat(0.0));
        self.sizes.set(k, 0.0);
        for (number, column) in &self.receivers[self.begins[k] as usize..self.begins[k + 1] as usize] {
            let block = self.links.block(*number);
            self.received.clear();
            self.received
                .extend(block.column(*column as usize).iter().map(|factor| held * f64::from(*factor)));
            receive(self.links.clusters.tree.members(block.receiver()), &self.received);
        }
    }

    fn outstanding(&self) -> Vec<V> {
        let mut out = vec![V::splat(0.0); self.links.places.len()];
        self.links.gather_means(&self.held, &mut out);
        out
    }
}
