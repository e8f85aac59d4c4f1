//! F_iC = 1/A_i ∫_{P_i} ∫_C K(x, y) dy dx, from a patch to a cluster: its size by formula, what of it arrives by rays.

use super::clusters::Clusters;
use super::random::Random;
use crate::form_factor::{contour, lambert};
use crate::kernel::{self, SurfacePoint};
use crate::polygon::Polygon;
use crate::visibility::Visibility;
use fredholm::operator::hierarchical::Cluster;
use glam::DVec3;
use std::f64::consts::PI;

/// Where form factors to clusters come from.
pub(super) struct Factors<'a> {
    pub clusters: &'a Clusters,
    pub polygons: &'a [Polygon],
    pub visibility: &'a Visibility,
    /// Other rays with another one.
    pub seed: u64,
    /// Whether to take the mean over four points of a patch, in place of its middle, of what comes from clusters, and from patches
    /// that are three times as far away.
    pub fine: bool,
    /// How bright each cluster is, if its parts count by that.
    pub shape: Option<&'a [f64]>,
}

/// Where the patches of a receiver gather from.
pub(super) struct Link {
    pub sender: Cluster,
    /// Its number among the receiver's links.
    pub number: u64,
    /// Whether nothing is between.
    pub clear: bool,
    /// The form factor that is worth one ray: a single patch that sends more has more.
    pub worth: f64,
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

impl Factors<'_> {
    /// Whether it is proved that nothing is between a polygon and a cluster.
    pub fn clear(&self, from: Option<&Polygon>, to: Cluster) -> bool {
        let hull = || self.clusters.hull(to, self.polygons);
        !self.visibility.hides_anything()
            || from.zip(hull()).is_some_and(|(a, b)| self.visibility.certainly_clear(a, &b))
    }

    /// The form factor from a patch, with the rays cast for it.
    pub fn factor(&self, patch: usize, link: &Link) -> (f64, u32) {
        self.factor_from(patch, &self.polygons[patch], link)
    }

    /// The form factor from a part of a patch, with the rays cast for it.
    pub fn factor_from(&self, patch: usize, part: &Polygon, link: &Link) -> (f64, u32) {
        let to_cluster = |x: DVec3| self.to_cluster(x, part.normal(), link.sender);
        let whole = match self.clusters.patch(link.sender) {
            Some(other) if other == patch => 0.0,
            Some(other) => self.to_patch(part, &self.polygons[other], link.worth),
            None if self.fine => {
                QUARTERS.iter().map(|[s, t]| to_cluster(part.point(*s, *t))).sum::<f64>() / 4.0
            }
            None => to_cluster(part.centroid()),
        };
        if whole <= 0.0 || link.clear {
            return (whole.max(0.0), 0);
        }
        // Near patches see each other from where the kernel is large, or do not: rays are weighed by it, and one tells nothing.
        let near = whole > NEAR_MATTERS * link.worth && self.is_near(part, link.sender);
        let least = if near { LEAST_RAYS } else { 1 };
        let rays = ((whole / link.worth).ceil() as u32).clamp(least, MOST_RAYS);
        let (mut all, mut clear) = (0.0, 0.0);
        for ray in 0..rays {
            let mut random = Random::new(self.seed, patch as u64, link.number << 5 | u64::from(ray));
            let mut tries = (0..TRIES).map(|_| {
                let ends = self.ends(part, link, &mut random);
                (ends, kernel::unoccluded(&ends[0], &ends[1]))
            });
            // Of a cluster, or beyond a horizon, not all faces the patch: what turns its back has no part in the formula either. The
            // kernel is infinite where two patches touch: one point of many.
            if let Some(([x, y], kernel)) = tries.find(|(_, kernel)| *kernel > 0.0 && kernel.is_finite()) {
                let weight = if near { kernel } else { 1.0 };
                all += weight;
                clear += if self.visibility.unoccluded(x.position, y.position) { weight } else { 0.0 };
            }
        }
        (if all > 0.0 { whole * clear / all } else { 0.0 }, rays)
    }

    /// Whether a cluster is a patch that is no further than twice the size of the larger of both.
    fn is_near(&self, here: &Polygon, sender: Cluster) -> bool {
        let Some(other) = self.clusters.patch(sender) else { return false };
        let there = &self.polygons[other];
        let size = here.area().max(there.area()).sqrt();
        here.centroid().distance_squared(there.centroid()) < 4.0 * size * size
    }

    /// From a point to four parts of a cluster, each as one element of area, and as bright as it is beside the whole.
    fn to_cluster(&self, x: DVec3, n: DVec3, cluster: Cluster) -> f64 {
        let beside = |part: Cluster| self.shape.map_or(1.0, |b| b[part.index()] / b[cluster.index()]);
        let element = |cluster: Cluster| {
            let whole = self.clusters.whole(cluster);
            let between = whole.centre - x;
            let square = between.length_squared();
            let (leaves, arrives) = (between.dot(n), -between.dot(whole.front));
            let facing = leaves > 0.0 && arrives > 0.0;
            if facing { beside(cluster) * leaves * arrives / (PI * square * square) } else { 0.0 }
        };
        let parts = |cluster: Cluster| self.clusters.tree.children(cluster);
        let half = |cluster: Cluster| match parts(cluster) {
            Some([a, b]) => element(a) + element(b),
            None => element(cluster),
        };
        parts(cluster).map_or_else(|| element(cluster), |[a, b]| half(a) + half(b))
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

    /// A point of a part of a patch and one of the sender.
    fn ends(&self, part: &Polygon, link: &Link, random: &mut Random) -> [SurfacePoint; 2] {
        let other = self.clusters.at(link.sender, random.next());
        [part, &self.polygons[other]].map(|polygon| random.point(polygon))
    }
}

const QUARTERS: [[f64; 2]; 4] = [[0.25, 0.25], [0.25, 0.75], [0.75, 0.25], [0.75, 0.75]];
