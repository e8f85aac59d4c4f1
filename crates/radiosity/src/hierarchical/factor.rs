//! F_iC = 1/A_i ∫_{P_i} ∫_C K(x, y) dy dx, from a patch to a cluster: its size by formula, what of it arrives by rays.

use super::clusters::Clusters;
use super::cut::SMALL;
use super::random::Random;
use crate::form_factor::{contour, lambert};
use crate::kernel;
use crate::polygon::Polygon;
use crate::visibility::Visibility;
use fredholm::operator::hierarchical::Cluster;
use glam::DVec3;
use std::f64::consts::PI;

/// Where form factors to clusters come from.
pub(super) struct Factors<'a> {
    pub clusters: &'a Clusters,
    pub visibility: &'a Visibility,
    /// Other rays with another one.
    pub seed: u64,
    /// Whether to take the mean over four points of a patch, in place of its middle, of what comes from clusters, and from patches
    /// that are three times as far away.
    pub fine: bool,
    /// How bright each cluster is, if its parts count by that.
    pub shape: Option<&'a [f64]>,
}

/// What some patches side by side gather from.
pub(super) struct Link {
    /// The place of the first of them in the order of the tree.
    pub first: usize,
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
    rays: Vec<Ray>,
}

/// A ray of a patch, by its number in the column.
struct Ray {
    patch: usize,
    random: Random,
    /// Where on the sender, as a place in the order of the tree.
    place: usize,
    ends: Option<[DVec3; 2]>,
}

/// A patch this many times the size of both away is a point.
const POINT: f64 = 4.0;

/// A patch nearer than their size is integrated over its outline.
const NEAR: f64 = 0.6;

/// Rays between two patches: most, and least if they are near and what they exchange is more than this part of what is worth one.
const MOST_RAYS: u32 = 16;
const LEAST_RAYS: u32 = 8;
const NEAR_MATTERS: f64 = 0.25;

/// How often a ray is drawn anew that would leave or arrive at a back.
const TRIES: usize = 4;

/// The golden section: its multiples lie evenly between 0 and 1, however many there are.
const GOLDEN: f64 = 0.618_033_988_749_895;

/// One element of area of a sender.
#[derive(Clone, Copy)]
struct Element {
    centre: DVec3,
    /// Its normal times its area, and times how bright it is beside the whole.
    front: DVec3,
}

impl Factors<'_> {
    /// Whether it is proved that nothing is between a polygon and a cluster.
    pub fn clear(&self, from: Option<&Polygon>, to: Cluster) -> bool {
        let hull = || self.clusters.hull(to);
        !self.visibility.hides_anything()
            || from.zip(hull()).is_some_and(|(a, b)| self.visibility.certainly_clear(a, &b))
    }

    /// The form factors from patches side by side, or from parts of them.
    pub fn column(&self, parts: &[Polygon], link: &Link, column: &mut Column) {
        column.cast = 0;
        column.factors.clear();
        match self.clusters.leaf(link.sender) {
            Some(place) => {
                let there = &self.clusters.polygons[place];
                let factor = |(k, part): (usize, &Polygon)| {
                    if link.first + k == place { 0.0 } else { self.to_patch(part, there, link.worth) }
                };
                column.factors.extend(parts.iter().enumerate().map(factor));
            }
            None => {
                let (elements, count) = self.elements(link.sender);
                let elements = &elements[..count];
                let factor = |part: &Polygon| {
                    let at = |x: DVec3| to_elements(x, part.normal(), elements);
                    if self.fine {
                        QUARTERS.iter().map(|[s, t]| at(part.point(*s, *t))).sum::<f64>() / 4.0
                    } else {
                        at(part.centroid())
                    }
                };
                column.factors.extend(parts.iter().map(factor));
            }
        }
        if link.weight != 1.0 {
            column.factors.iter_mut().for_each(|factor| *factor *= link.weight);
        }
        if !link.clear {
            self.cast(parts, link, column);
        }
    }

    /// Lets arrive what rays do.
    ///
    /// Where all of them go is looked up before the first is cast: so they wait for memory together.
    fn cast(&self, parts: &[Polygon], link: &Link, column: &mut Column) {
        let Column { factors, rays, cast } = column;
        rays.clear();
        let mut random = Random::new(self.seed, link.first as u64, link.number);
        let begin = random.next();
        let most = factors.iter().fold(0.0, |most: f64, factor| most.max(*factor));
        let chance = most / (SMALL * link.worth);
        if chance < 1.0 && !self.fine {
            let factor = if random.next() < chance { chance.recip() } else { 0.0 };
            factors.iter_mut().for_each(|whole| *whole *= factor);
        }
        for (k, (whole, part)) in
            factors.iter_mut().zip(parts).enumerate().filter(|(_, (whole, _))| **whole > 0.0)
        {
            let wanted = ((*whole / link.worth).ceil() as u32).clamp(1, MOST_RAYS);
            if *whole > NEAR_MATTERS * link.worth && self.is_near(part, link.sender) {
                let near = wanted.max(LEAST_RAYS);
                *whole *= self.seen_near(part, link, k, near);
                *cast += u64::from(near);
                continue;
            }
            for ray in 0..wanted {
                let u = (begin + GOLDEN * rays.len() as f64).fract();
                let place = self.clusters.at(link.sender, u);
                rays.push(Ray { patch: k, place, random: self.random(link, k, ray), ends: None });
            }
        }
        *cast += rays.len() as u64;
        for ray in rays.iter_mut() {
            // Of a cluster, or beyond a horizon, not all faces the patch: what turns its back has no part in the formula either.
            for _ in 0..TRIES {
                let ends =
                    [&parts[ray.patch], &self.clusters.polygons[ray.place]].map(|on| ray.random.point(on));
                if kernel::unoccluded(&ends[0], &ends[1]) > 0.0 {
                    ray.ends = Some(ends.map(|end| end.position));
                    break;
                }
                ray.place = self.clusters.at(link.sender, ray.random.next());
            }
        }
        for rays in rays.chunk_by(|a, b| a.patch == b.patch) {
            let drawn = rays.iter().filter_map(|ray| ray.ends);
            let (mut all, mut clear) = (0, 0);
            for [x, y] in drawn {
                all += 1;
                clear += u32::from(self.visibility.unoccluded(x, y));
            }
            factors[rays[0].patch] *= if all > 0 { f64::from(clear) / f64::from(all) } else { 0.0 };
        }
    }

    /// Numbers for a ray of a patch.
    fn random(&self, link: &Link, k: usize, ray: u32) -> Random {
        Random::new(self.seed, (link.first + k) as u64, link.number << 5 | u64::from(ray))
    }

    /// What a patch sees of one that is near, as a part: near patches see each other from where the kernel is large, or do not: rays
    /// are weighed by it, and one tells nothing.
    fn seen_near(&self, part: &Polygon, link: &Link, k: usize, rays: u32) -> f64 {
        let (mut all, mut clear) = (0.0, 0.0);
        let there = &self.clusters.polygons[self.clusters.tree.range(link.sender).start];
        for ray in 0..rays {
            let mut random = self.random(link, k, ray);
            let drawn = (0..TRIES).find_map(|_| {
                let ends = [part, there].map(|polygon| random.point(polygon));
                let kernel = kernel::unoccluded(&ends[0], &ends[1]);
                // The kernel is infinite where two patches touch: one point of many.
                (kernel > 0.0 && kernel.is_finite()).then_some((ends, kernel))
            });
            if let Some(([x, y], kernel)) = drawn {
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

    /// Four parts of a cluster, each as one element of area.
    fn elements(&self, cluster: Cluster) -> ([Element; 4], usize) {
        let mut elements = [Element { centre: DVec3::ZERO, front: DVec3::ZERO }; 4];
        let mut count = 0;
        let beside = |part: Cluster| self.shape.map_or(1.0, |b| b[part.index()] / b[cluster.index()]);
        let mut add = |part: Cluster| {
            let whole = self.clusters.whole(part);
            elements[count] = Element { centre: whole.centre, front: whole.front * beside(part) };
            count += 1;
        };
        let parts = |cluster: Cluster| self.clusters.tree.children(cluster);
        for half in parts(cluster).unwrap_or([cluster; 2]) {
            match parts(half) {
                Some(quarters) => quarters.into_iter().for_each(&mut add),
                None => add(half),
            }
        }
        (elements, count)
    }

    fn to_patch(&self, here: &Polygon, there: &Polygon, needed: f64) -> f64 {
        let between = there.centroid() - here.centroid();
        let size = (here.area().sqrt()).max(there.area().sqrt());
        let distance = between.length();
        if distance > if self.fine { 3.0 * POINT } else { POINT } * size {
            let square = distance * distance;
            let (leaves, arrives) = (between.dot(here.normal()), -between.dot(there.normal()));
            let facing = leaves > 0.0 && arrives > 0.0;
            return if facing { leaves * arrives * there.area() / (PI * square * square) } else { 0.0 };
        }
        // Two planes that meet at an angle β see each other by (1 − cos β)/2 at most.
        let most = 0.5 * (1.0 - here.normal().dot(there.normal()));
        let in_front = |a: &Polygon, b: &Polygon| a.vertices().iter().all(|v| b.height_of(*v) >= 0.0);
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
}

/// From a point to elements of area.
fn to_elements(x: DVec3, n: DVec3, elements: &[Element]) -> f64 {
    let factor = |Element { centre, front }: &Element| {
        let between = *centre - x;
        let square = between.length_squared();
        let (leaves, arrives) = (between.dot(n), -between.dot(*front));
        if leaves > 0.0 && arrives > 0.0 { leaves * arrives / (PI * square * square) } else { 0.0 }
    };
    elements.iter().map(factor).sum()
}

const QUARTERS: [[f64; 2]; 4] = [[0.25, 0.25], [0.25, 0.75], [0.75, 0.25], [0.75, 0.75]];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patches::Patches;
    use crate::scene::cornell_box;

    /// Seeds, of which one in ten draws.
    const SEEDS: u64 = 5000;

    #[test]
    fn links_that_are_drawn_count_for_those_that_are_not() {
        let scene = cornell_box();
        let patches = Patches::new(&scene, 0.1).unwrap_or_else(|error| unreachable!("{error}"));
        let visibility = Visibility::new(&scene.polygons());
        let clusters = Clusters::new(&patches, &visibility);
        let factors =
            |seed| Factors { clusters: &clusters, visibility: &visibility, seed, fine: false, shape: None };
        let leaves: Vec<Cluster> = clusters.tree.leaves().collect();
        let pairs = (0..leaves.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
        let sees = |(i, j): &(usize, usize)| {
            let [a, b] = [i, j].map(|k| &clusters.polygons[*k]);
            visibility.certainly_clear(a, b) && a.centroid().distance(b.centroid()) > 0.5
        };
        let seen = pairs.filter(sees).find_map(|(i, j)| {
            let parts = &clusters.polygons[i..=i];
            let mut column = Column::default();
            let link = Link { first: i, sender: leaves[j], weight: 1.0, number: 0, clear: true, worth: 1.0 };
            factors(0).column(parts, &link, &mut column);
            let whole = column.factors[0];
            (whole > 0.0).then_some((parts, link, whole))
        });
        let Some((parts, link, whole)) = seen else { panic!("two patches see each other") };
        let link = Link { clear: false, worth: 10.0 * whole / SMALL, ..link };
        let (mut sum, mut drawn, mut column) = (0.0, 0, Column::default());
        for seed in 0..SEEDS {
            factors(seed).column(parts, &link, &mut column);
            sum += column.factors[0];
            drawn += u64::from(column.factors[0] > 0.0);
        }
        assert!((drawn as f64 / SEEDS as f64 - 0.1).abs() < 0.02, "{drawn} of {SEEDS} are drawn");
        let mean = sum / SEEDS as f64;
        assert!((mean / whole - 1.0).abs() < 0.2, "{mean} in the mean of {whole}");
    }
}
