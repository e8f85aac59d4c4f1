//! Rows, columns and actions of F̃: F̃_ij = F_iC A_j/A_C, for the cluster C of the cut of i that j is in.

use super::Hierarchical;
use super::relaxed::{Gathering, Shooting};
use fredholm::operator::hierarchical::Cluster;
use fredholm::operator::{Columns, Gather, Line, Rows, Shoot};
use fredholm::value::Value;
use rayon::prelude::*;

/// Blocks whose transposed action is summed by one thread: the sums have their order whatever the number of threads.
const TOGETHER: usize = 8192;

impl Hierarchical {
    /// Adds what comes from each patch of a cluster of which `factor` comes in all.
    fn spread(&self, sender: Cluster, factor: f64, row: &mut [f64]) {
        let density = factor / self.clusters.whole(sender).area;
        for &patch in self.clusters.tree.members(sender) {
            row[patch] = density * self.clusters.areas[patch];
        }
    }

    /// `out` = F̃ᵀ u.
    fn shoot<V: Value>(&self, u: &[V], out: &mut [V]) {
        let clusters = self.clusters.wholes.len();
        let parts: Vec<Vec<V>> = self
            .numbers
            .par_chunks(TOGETHER)
            .map(|numbers| {
                let mut sums = vec![V::splat(0.0); clusters];
                for block in numbers.iter().map(|at| self.block_at(at)) {
                    let members = self.clusters.tree.members(block.receiver());
                    for (sender, column) in block.columns() {
                        let sum = &mut sums[sender.index()];
                        column.iter().zip(members).for_each(|(f, i)| *sum += u[*i] * f64::from(*f));
                    }
                }
                sums
            })
            .collect();
        let mut densities = vec![V::splat(0.0); clusters];
        for cluster in self.clusters.tree.top_down() {
            let k = cluster.index();
            let own = parts.iter().fold(V::splat(0.0), |sum, part| sum + part[k]);
            densities[k] += own * self.clusters.whole(cluster).area.recip();
            let density = densities[k];
            match self.clusters.tree.children(cluster) {
                Some(halves) => halves.iter().for_each(|half| densities[half.index()] = density),
                None => {
                    let patch = self.clusters.tree.members(cluster)[0];
                    out[patch] = density * self.clusters.areas[patch];
                }
            }
        }
    }
}

impl Rows for Hierarchical {
    fn row<'a>(&'a self, i: usize, buffer: &'a mut Vec<f64>) -> Line<'a> {
        buffer.clear();
        buffer.resize(self.places.len(), 0.0);
        let (block, place) = self.places[i];
        for (sender, column) in self.block(block).columns() {
            self.spread(sender, f64::from(column[place as usize]), buffer);
        }
        Line::Full(buffer)
    }

    fn act<V: Value>(&self, u: &[V], out: &mut [V]) {
        self.gather(u, out);
    }

    fn gathering<'a, V: Value>(&'a self) -> Option<Box<dyn Gather<V> + 'a>> {
        Some(Box::new(Gathering::new(self)))
    }
}

impl Columns for Hierarchical {
    fn column<'a>(&'a self, j: usize, buffer: &'a mut Vec<f64>) -> Line<'a> {
        buffer.clear();
        buffer.resize(self.places.len(), 0.0);
        let place = self.order_of[j] as usize;
        for block in self.blocks() {
            let Some((sender, column)) = block.column_with(|sender| self.clusters.tree.range(sender), place)
            else {
                continue;
            };
            let part = self.clusters.areas[j] / self.clusters.whole(sender).area;
            for (factor, patch) in column.iter().zip(self.clusters.tree.members(block.receiver())) {
                buffer[*patch] = part * f64::from(*factor);
            }
        }
        Line::Full(buffer)
    }

    fn act_transposed<V: Value>(&self, u: &[V], out: &mut [V]) {
        self.shoot(u, out);
    }

    fn shooting<'a, V: Value>(&'a self) -> Option<Box<dyn Shoot<V> + 'a>> {
        Some(Box::new(Shooting::new(self)))
    }
}
