//! F_iC = 1/A_i ∫_{P_i} ∫_C K(x, y) dy dx, from a patch to a cluster: its size by formula; what of it arrives by rays (`sight`).

use super::clusters::{Clusters, Sender};
use super::cut::ALIKE;
use super::eyes::{Eyes, LANES, QUARTERS};
use super::sight::Sight;
use crate::form_factor::{contour, lambert};
use crate::polygon::Polygon;
use crate::visibility::Visibility;
use fredholm::operator::hierarchical::Cluster;
use glam::DVec3;
use std::f64::consts::PI;
use wide::f64x8;

/// Where form factors to clusters come from.
pub(super) struct Factors<'a> {
    pub clusters: &'a Clusters,
    pub visibility: &'a Visibility,
    /// Other rays with another one.
    pub seed: u64,
    /// Whether to take the mean over four points of a patch, in place of its middle, of what comes from clusters, and of the exact form
    /// factors of patches that are no points, in place of some points of theirs.
    pub fine: bool,
    /// How bright each cluster is.
    pub brightness: &'a [f64],
    /// Whether the parts of a cluster send by how bright they are beside the whole.
    pub shaped: bool,
    /// What comes from all patches before each place in the order of the tree, and from all: area times brightness.
    pub before: Vec<f64>,
}

/// Patches side by side, or parts of them, that gather.
pub(super) struct Receivers<'a> {
    pub parts: &'a [Polygon],
    /// The place of the first of them in the order of the tree.
    pub first: usize,
    pub eyes: Vec<Eyes>,
}

/// What they gather from.
pub(super) struct Link {
    pub sender: Cluster,
    /// What its factors are multiplied by: how many links it speaks for.
    pub weight: f64,
    /// Its number among the receiver's links.
    pub number: u64,
    /// Whether nothing is between.
    pub clear: bool,
    /// The form factor that is worth one ray: a single patch that sends more has more.
    pub worth: f64,
}

/// The factors of a link, with room to find them in.
#[derive(Default)]
pub(super) struct Column {
    /// Of each patch.
    pub factors: Vec<f64>,
    /// Rays cast for them.
    pub cast: u64,
    /// What comes from each part of the sender to each patch, by its brightness: where rays go. Part by part, eights of patches.
    pub shares: Vec<f64>,
    pub elements: Vec<Element>,
    pub sight: Sight,
}

/// A patch nearer than their size is integrated over its outline.
const NEAR: f64 = 0.6;

/// The most parts of a sender that are an element of area each: four if their normals are alike.
const MOST_PARTS: usize = 16;

/// A part of a sender as an element of area.
#[derive(Clone, Copy)]
pub(super) struct Element {
    pub part: Cluster,
    sender: Sender,
    /// How bright it is beside the whole.
    beside: f64,
}

impl<'a> Factors<'a> {
    /// From light that is so bright, by cluster.
    pub fn new(clusters: &'a Clusters, visibility: &'a Visibility, brightness: &'a [f64], seed: u64) -> Self {
        let tree = &clusters.tree;
        let sent = |(leaf, patch): (Cluster, &usize)| brightness[leaf.index()] * clusters.areas[*patch];
        let before = tree.leaves().zip(tree.order()).map(sent).scan(0.0, |sum, sent| {
            *sum += sent;
            Some(*sum)
        });
        let before = std::iter::once(0.0).chain(before).collect();
        Self { clusters, visibility, seed, fine: false, brightness, shaped: false, before }
    }

    /// Patches side by side, or parts of them, from the place of the first in the order of the tree on.
    pub fn receivers<'b>(&self, parts: &'b [Polygon], first: usize) -> Receivers<'b> {
        let eyes = parts.chunks(LANES).map(|patches| Eyes::new(patches, self.fine));
        Receivers { parts, first, eyes: eyes.collect() }
    }

    /// The form factors of a link.
    pub fn column(&self, receivers: &Receivers<'_>, link: &Link, column: &mut Column) {
        column.cast = 0;
        column.factors.clear();
        column.shares.clear();
        column.elements.clear();
        match self.clusters.leaf(link.sender) {
            Some(place) => {
                let sender = (self.clusters.sender(link.sender), place, link.worth);
                self.to_patch(receivers, sender, &mut column.factors);
            }
            None => {
                self.add_elements(link.sender, &mut column.elements);
                self.to_elements(receivers, column);
            }
        }
        if link.weight != 1.0 {
            column.factors.iter_mut().for_each(|factor| *factor *= link.weight);
        }
        if !link.clear {
            self.cast(receivers, link, column);
        }
    }

    /// Four parts of a cluster, each as one element of area; more where normals are not alike, which in one element would cancel each
    /// other.
    fn add_elements(&self, cluster: Cluster, elements: &mut Vec<Element>) {
        let children = |part: Cluster| self.clusters.tree.children(part);
        let element = |part: Cluster| {
            let beside = self.brightness[part.index()] / self.brightness[cluster.index()];
            Element { part, sender: *self.clusters.sender(part), beside }
        };
        for half in children(cluster).into_iter().flatten() {
            match children(half) {
                Some(quarters) => elements.extend(quarters.map(element)),
                None => elements.push(element(half)),
            }
        }
        let mut next = 0;
        while next < elements.len() && elements.len() < MOST_PARTS {
            let Element { part, sender, .. } = elements[next];
            match children(part) {
                Some(halves) if sender.alike < ALIKE => {
                    elements.swap_remove(next);
                    elements.extend(halves.map(element));
                }
                _ => next += 1,
            }
        }
    }

    /// To elements of area: their sum, and what comes from each, by its brightness.
    fn to_elements(&self, receivers: &Receivers<'_>, column: &mut Column) {
        let Column { factors, shares, elements, .. } = column;
        let eyes = &receivers.eyes;
        shares.resize(elements.len() * LANES * eyes.len(), 0.0);
        for (eights, eyes) in eyes.iter().enumerate() {
            let mut sum = f64x8::ZERO;
            let shares = shares.chunks_exact_mut(LANES).skip(eights).step_by(receivers.eyes.len());
            for (element, shares) in elements.iter().zip(shares) {
                let factor = eyes.to_element(&element.sender);
                let share = factor * f64x8::splat(element.beside);
                sum += if self.shaped { share } else { factor };
                shares.copy_from_slice(share.as_array());
            }
            factors.extend(sum.as_array());
        }
        factors.truncate(receivers.parts.len());
    }

    /// To a patch at a place in the order of the tree, of which a factor is `needed` to be worth a ray.
    fn to_patch(
        &self,
        receivers: &Receivers<'_>,
        (sender, place, needed): (&Sender, usize, f64),
        factors: &mut Vec<f64>,
    ) {
        let there = &self.clusters.polygons[place];
        for (eyes, parts) in receivers.eyes.iter().zip(receivers.parts.chunks(LANES)) {
            let seen = eyes.to_patch(sender, there, self.fine);
            let or_near = |(here, factor): (&Polygon, Option<f64>)| {
                factor.unwrap_or_else(|| to_near_patch(here, there, needed))
            };
            factors.extend(parts.iter().zip(seen).map(or_near));
        }
        if let Some(own) = place.checked_sub(receivers.first).and_then(|own| factors.get_mut(own)) {
            *own = 0.0;
        }
    }
}

/// From a patch to another that is near.
fn to_near_patch(here: &Polygon, there: &Polygon, needed: f64) -> f64 {
    // Two planes that meet at an angle β see each other by (1 − cos β)/2 at most.
    let most = 0.5 * (1.0 - here.normal().dot(there.normal()));
    let in_front = |a: &Polygon, b: &Polygon| a.vertices().iter().all(|v| b.height_of(*v) >= 0.0);
    let distance = here.centroid().distance(there.centroid());
    if distance < NEAR * (here.diameter() + there.diameter())
        && most > needed
        && in_front(here, there)
        && in_front(there, here)
    {
        let tolerance = 0.01 * needed * here.area();
        return contour::exchange(here.vertices(), there.vertices(), tolerance).value / here.area();
    }
    let mean: f64 = QUARTERS
        .iter()
        .map(|[s, t]| lambert::point_to_polygon(here.point(*s, *t), here.normal(), there))
        .sum();
    mean / QUARTERS.len() as f64
}

impl Sender {
    /// From a point of a surface to the cluster as an element of area.
    pub fn seen_from(&self, x: DVec3, n: DVec3) -> f64 {
        let between = self.centre - x;
        let square = between.length_squared();
        let (leaves, arrives) = (between.dot(n), -between.dot(self.front));
        if leaves > 0.0 && arrives > 0.0 { leaves * arrives / (PI * square * square) } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::super::clusters::cornell_clusters;
    use super::super::cut::SMALL;
    use super::*;

    /// Seeds, of which one in ten draws.
    const SEEDS: u64 = 5000;

    #[test]
    fn links_that_are_drawn_count_for_those_that_are_not() {
        let (visibility, clusters) = cornell_clusters(0.1);
        let ones = vec![1.0; clusters.wholes.len()];
        let factors = |seed| Factors::new(&clusters, &visibility, &ones, seed);
        let leaves: Vec<Cluster> = clusters.tree.leaves().collect();
        let pairs = (0..leaves.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
        let sees = |(i, j): &(usize, usize)| {
            let [a, b] = [i, j].map(|k| &clusters.polygons[*k]);
            visibility.certainly_clear(a, b) && a.centroid().distance(b.centroid()) > 0.5
        };
        let seen = pairs.filter(sees).find_map(|(i, j)| {
            let parts = &clusters.polygons[i..=i];
            let mut column = Column::default();
            let link = Link { sender: leaves[j], weight: 1.0, number: 0, clear: true, worth: 1.0 };
            factors(0).column(&factors(0).receivers(parts, i), &link, &mut column);
            let whole = column.factors[0];
            (whole > 0.0).then_some((i, link, whole))
        });
        let Some((i, link, whole)) = seen else { panic!("two patches see each other") };
        let parts = &clusters.polygons[i..=i];
        let link = Link { clear: false, worth: 10.0 * whole / SMALL, ..link };
        let (mut sum, mut drawn, mut column) = (0.0, 0, Column::default());
        for seed in 0..SEEDS {
            factors(seed).column(&factors(seed).receivers(parts, i), &link, &mut column);
            sum += column.factors[0];
            drawn += u64::from(column.factors[0] > 0.0);
        }
        assert!((drawn as f64 / SEEDS as f64 - 0.1).abs() < 0.02, "{drawn} of {SEEDS} are drawn");
        let mean = sum / SEEDS as f64;
        assert!((mean / whole - 1.0).abs() < 0.2, "{mean} in the mean of {whole}");
    }
}
