//! F_iC = 1/A_i ∫_{P_i} ∫_C K(x, y) dy dx, from a patch to a cluster: its size by formula, what of it arrives by rays.

use super::clusters::{Clusters, Sender};
use super::cut::{ALIKE, SMALL};
use super::eyes::{Eyes, LANES, QUARTERS};
use super::random::Random;
use crate::form_factor::{contour, lambert};
use crate::kernel;
use crate::polygon::Polygon;
use crate::visibility::Visibility;
use fredholm::operator::hierarchical::Cluster;
use glam::DVec3;
use std::f64::consts::PI;
use std::hint::black_box;
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
    parts: &'a [Polygon],
    /// The place of the first of them in the order of the tree.
    first: usize,
    eyes: Vec<Eyes>,
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
    shares: Vec<f64>,
    elements: Vec<Element>,
    rays: Vec<Ray>,
}

/// A ray of a patch, by its number in the column.
struct Ray {
    patch: usize,
    random: Random,
    /// The part of the sender that it goes to, how far into what that sends, and the place of the patch there.
    part: Cluster,
    u: f64,
    place: usize,
    ends: Option<[DVec3; 2]>,
}

/// A patch nearer than their size is integrated over its outline.
const NEAR: f64 = 0.6;

/// Rays between two patches: most, and least if they are near and what they exchange is more than this part of what is worth one.
const MOST_RAYS: u32 = 16;
const LEAST_RAYS: u32 = 8;
const NEAR_MATTERS: f64 = 0.25;

/// Another seed than that of rays.
const COLUMN: u64 = 0xc01a;

/// How often a ray is drawn anew that would leave or arrive at a back.
const TRIES: usize = 4;

/// The golden section: its multiples lie evenly between 0 and 1, however many there are.
const GOLDEN: f64 = 0.618_033_988_749_895;

/// The most parts of a sender that are an element of area each: four if their normals are alike.
const MOST_PARTS: usize = 16;

/// A part of a sender as an element of area.
#[derive(Clone, Copy)]
struct Element {
    part: Cluster,
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

    /// Lets arrive what rays do.
    ///
    /// To each place of a cluster go as many of them as light comes from there: what is near or bright sends more, and less of it is
    /// hidden, as what lies under others is dark.
    fn cast(&self, receivers: &Receivers<'_>, link: &Link, column: &mut Column) {
        let Column { factors, rays, cast, shares, elements } = column;
        let &Receivers { parts, first, ref eyes } = receivers;
        rays.clear();
        let mut random = Random::new(self.seed ^ COLUMN, first as u64, link.number);
        let begin = random.next();
        let most = factors.iter().fold(0.0, |most: f64, factor| most.max(*factor));
        let chance = most / (SMALL * link.worth);
        if chance < 1.0 && !self.fine {
            if random.next() >= chance {
                return factors.fill(0.0);
            }
            factors.iter_mut().for_each(|whole| *whole *= chance.recip());
        }
        // Where all rays go is looked up before the first is cast, and what a lookup reads is asked for before that: so they wait for
        // memory together.
        for (k, (whole, part)) in
            factors.iter_mut().zip(parts).enumerate().filter(|(_, (whole, _))| **whole > 0.0)
        {
            let wanted = ((*whole / link.worth).ceil() as u32).clamp(1, MOST_RAYS);
            if *whole > NEAR_MATTERS * link.worth && self.is_near(part, link.sender) {
                let near = wanted.max(LEAST_RAYS);
                *whole *= self.seen_near(receivers, link, (k, near), cast);
                continue;
            }
            let shares = shares.iter().skip(k).step_by(LANES * eyes.len()).copied();
            for ray in 0..wanted {
                let u = (begin + GOLDEN * rays.len() as f64).fract();
                let (part, u) =
                    share(shares.clone(), u).map_or((link.sender, u), |(k, u)| (elements[k].part, u));
                let random = self.random(receivers, link, k, ray);
                black_box(self.before[self.likely(part, u)]);
                rays.push(Ray { patch: k, part, u, place: 0, random, ends: None });
            }
        }
        for ray in rays.iter_mut() {
            ray.place = self.at(ray.part, ray.u);
            black_box(self.clusters.spots.at(ray.place));
        }
        for ray in rays.iter_mut() {
            // Of a cluster, or beyond a horizon, not all faces the patch: what turns its back has no part in the formula either.
            for _ in 0..TRIES {
                let spot = self.clusters.spots.at(ray.place);
                let ends =
                    [ray.random.point(&parts[ray.patch]), self.clusters.spots.point(&spot, &mut ray.random)];
                if kernel::unoccluded(&ends[0], &ends[1]) > 0.0 {
                    ray.ends = Some(ends.map(|end| end.position));
                    break;
                }
                ray.place = self.at(ray.part, ray.random.next());
            }
        }
        for rays in rays.chunk_by(|a, b| a.patch == b.patch) {
            let drawn = rays.iter().filter_map(|ray| ray.ends);
            let (mut all, mut clear) = (0_u32, 0);
            for [x, y] in drawn {
                all += 1;
                clear += u32::from(self.visibility.unoccluded(x, y));
            }
            *cast += u64::from(all);
            factors[rays[0].patch] *= if all > 0 { f64::from(clear) / f64::from(all) } else { 0.0 };
        }
    }

    /// The place that [`at`](Self::at) finds if all patches of the cluster send alike, as they mostly do.
    fn likely(&self, cluster: Cluster, u: f64) -> usize {
        let range = self.clusters.tree.range(cluster);
        range.start + (u * range.len() as f64) as usize
    }

    /// The place of the patch of a cluster that a part `u` of what comes from it does from, 0 ≤ u < 1.
    fn at(&self, cluster: Cluster, u: f64) -> usize {
        let range = self.clusters.tree.range(cluster);
        let (from, to) = (self.before[range.start], self.before[range.end]);
        let sent = from + u * (to - from);
        // It is looked for from where it is likely to be, farther and farther away.
        let likely = self.likely(cluster, u);
        let is_before = |place: usize| self.before[place] <= sent;
        let (mut low, mut high, mut step) = (likely, likely + 1, 1);
        while low > range.start && !is_before(low) {
            (low, high) = (low.saturating_sub(step).max(range.start), low);
            step *= 2;
        }
        while high < range.end && is_before(high) {
            (low, high) = (high, (high + step).min(range.end));
            step *= 2;
        }
        low + self.before[low + 1..high].partition_point(|before| *before <= sent)
    }

    /// Numbers for a ray of a patch.
    fn random(&self, receivers: &Receivers<'_>, link: &Link, k: usize, ray: u32) -> Random {
        Random::new(self.seed, (receivers.first + k) as u64, link.number << 5 | u64::from(ray))
    }

    /// What a patch sees of one that is near, as a part: near patches see each other from where the kernel is large, or do not: rays
    /// are weighed by it, and one tells nothing.
    fn seen_near(
        &self,
        receivers: &Receivers<'_>,
        link: &Link,
        (k, rays): (usize, u32),
        cast: &mut u64,
    ) -> f64 {
        let (mut all, mut clear) = (0.0, 0.0);
        let part = &receivers.parts[k];
        let there = &self.clusters.polygons[self.clusters.tree.range(link.sender).start];
        for ray in 0..rays {
            let mut random = self.random(receivers, link, k, ray);
            let drawn = (0..TRIES).find_map(|_| {
                let ends = [part, there].map(|polygon| random.point(polygon));
                let kernel = kernel::unoccluded(&ends[0], &ends[1]);
                // The kernel is infinite where two patches touch: one point of many.
                (kernel > 0.0 && kernel.is_finite()).then_some((ends, kernel))
            });
            if let Some(([x, y], kernel)) = drawn {
                *cast += 1;
                all += kernel;
                clear += if self.visibility.unoccluded(x.position, y.position) { kernel } else { 0.0 };
            }
        }
        if all > 0.0 { clear / all } else { 0.0 }
    }

    /// Whether a cluster is a patch that is no further than twice the size of the larger of both.
    fn is_near(&self, here: &Polygon, sender: Cluster) -> bool {
        let Some(other) = self.clusters.leaf(sender) else { return false };
        let there = &self.clusters.polygons[other];
        let size = here.area().max(there.area()).sqrt();
        here.centroid().distance_squared(there.centroid()) < 4.0 * size * size
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

/// The share that a part `u` of the sum of all is in, 0 ≤ u < 1, and how far in; none if there are no shares.
fn share(shares: impl Iterator<Item = f64> + Clone, u: f64) -> Option<(usize, f64)> {
    let mut rest = u * shares.clone().sum::<f64>();
    let mut last = None;
    for (k, share) in shares.enumerate().filter(|(_, share)| *share > 0.0) {
        if rest < share {
            return Some((k, rest / share));
        }
        rest -= share;
        last = Some((k, ALMOST_ONE));
    }
    last
}

/// The largest part of a whole that is none.
const ALMOST_ONE: f64 = 1.0 - f64::EPSILON;

#[cfg(test)]
mod tests {
    use super::super::clusters::cornell_clusters;
    use super::*;

    #[test]
    fn rays_go_to_where_light_comes_from() {
        let (visibility, clusters) = cornell_clusters(0.1);
        // Some patches are a thousand times as bright as their neighbours, some are black.
        let brightness: Vec<f64> = (0..clusters.wholes.len())
            .map(|k| [0.0, 1.0, 1000.0, 2.0][(4.0 * Random::new(1, k as u64, 0).next()) as usize])
            .collect();
        let factors = Factors::new(&clusters, &visibility, &brightness, 0);
        let sent = |place: usize| factors.before[place + 1] - factors.before[place];
        for cluster in clusters.tree.top_down() {
            let range = clusters.tree.range(cluster);
            let all: f64 = range.clone().map(sent).sum();
            if all == 0.0 {
                continue;
            }
            for k in 0..64 {
                let u = (f64::from(k) + 0.5) / 64.0;
                let place = factors.at(cluster, u);
                let before: f64 = (range.start..place).map(sent).sum();
                let is_there =
                    before <= u * all * (1.0 + 1e-12) && u * all <= (before + sent(place)) * (1.0 + 1e-12);
                assert!(range.contains(&place) && is_there, "{place} of {range:?} for {u}");
            }
        }
    }

    #[test]
    fn a_share_is_found_by_its_size() {
        let shares = [0.0, 1.0, 0.0, 3.0, 0.0];
        let at = |u: f64| share(shares.into_iter(), u);
        assert_eq!(at(0.0), Some((1, 0.0)));
        assert_eq!(at(0.125), Some((1, 0.5)));
        assert_eq!(at(0.25), Some((3, 0.0)));
        assert_eq!(at(0.625), Some((3, 0.5)));
        assert_eq!(at(ALMOST_ONE).map(|(k, _)| k), Some(3));
        assert_eq!(share(std::iter::empty(), 0.5), None);
        assert_eq!(share(std::iter::once(0.0), 0.5), None);
    }

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
