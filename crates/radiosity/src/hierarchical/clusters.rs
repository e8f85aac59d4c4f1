//! Clusters of patches: near each other, and facing alike. Of each what is needed to bound and to compute what it sends.

use super::spot::Spots;
use super::sweep::Ascent;
use crate::patches::Patches;
use crate::polygon::Polygon;
use crate::visibility::Visibility;
use fredholm::operator::hierarchical::{Bounds, Cluster, ClusterTree};
use fredholm::value::Value;
use glam::DVec3;
use prefetch_index::prefetch_index;
use rayon::prelude::*;
use std::borrow::Cow;

/// How far apart two normals are that are opposite, as a part of the scene's extent: patches of two walls of a room that meet
/// are of two clusters from about an eighth of its size on.
const TURN: f64 = 0.25;

/// A cluster as an element of area, which links are computed from: one line of memory.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct Sender {
    /// The centre of mass.
    pub centre: DVec3,
    /// ∫ n dA, in m².
    pub front: DVec3,
    /// How alike normals are: the cosine of the largest angle of one to `front`; past a right angle −1.
    pub alike: f64,
}

/// What bounds a cluster.
#[derive(Clone, Copy, Debug)]
pub(super) struct Whole {
    /// In m².
    pub area: f64,
    /// The middle of the box around it, and half of its sides.
    pub middle: DVec3,
    pub half: DVec3,
    /// The mean direction of normals, and how far they are from it: cosine and sine of the largest angle.
    pub axis: DVec3,
    pub turn: (f64, f64),
}

impl Whole {
    /// Of a patch that counts for an area.
    fn of_patch(polygon: &Polygon, area: f64) -> Self {
        let corners = polygon.vertices().iter();
        let (low, high) = corners
            .fold((DVec3::MAX, DVec3::MIN), |(low, high): (DVec3, DVec3), v| (low.min(*v), high.max(*v)));
        Self {
            area,
            middle: 0.5 * (low + high),
            half: 0.5 * (high - low),
            axis: polygon.normal(),
            turn: (1.0, 0.0),
        }
    }

    /// Of two, with an axis.
    fn union(a: &Self, b: &Self, axis: DVec3) -> Self {
        let low = (a.middle - a.half).min(b.middle - b.half);
        let high = (a.middle + a.half).max(b.middle + b.half);
        Self {
            area: a.area + b.area,
            middle: 0.5 * (low + high),
            half: 0.5 * (high - low),
            axis,
            turn: wider(a.turned(axis), b.turned(axis)),
        }
    }

    /// The largest angle of a normal to another axis, as cosine and sine; past a right angle it is half a turn.
    fn turned(&self, axis: DVec3) -> (f64, f64) {
        let cosine = self.axis.dot(axis).clamp(-1.0, 1.0);
        let sine = (1.0 - cosine * cosine).sqrt();
        let (c, s) = self.turn;
        let sum = (cosine * c - sine * s, sine * c + cosine * s);
        if cosine <= 0.0 || sum.0 <= 0.0 { (-1.0, 0.0) } else { sum }
    }

    /// How far it reaches along a direction from its middle.
    fn reach(&self, direction: DVec3) -> f64 {
        direction.abs().dot(self.half)
    }

    /// Half of the diagonal of its box.
    pub fn radius(&self) -> f64 {
        self.half.length()
    }

    /// The corners of its box.
    pub fn corners(&self) -> [DVec3; 8] {
        std::array::from_fn(|k| {
            let sign = |bit: usize| if k >> bit & 1 == 1 { 1.0 } else { -1.0 };
            self.middle + self.half * DVec3::new(sign(0), sign(1), sign(2))
        })
    }

    /// A rectangle around patches of one plane that has an axis of space for normal; `None` for others.
    pub fn rectangle(&self) -> Option<Polygon> {
        let n = self.axis;
        if self.turn.0 < 1.0 - FLAT || self.reach(n) > FLAT * self.radius() {
            return None;
        }
        // Along an axis of space where there is one in the plane: then it is no larger than it need be.
        let u = n.cross(if n.x.abs() < 0.5 { DVec3::X } else { DVec3::Y }).normalize();
        let v = n.cross(u);
        let (a, b) = (u * self.reach(u), v * self.reach(v));
        let corner = |s: f64, t: f64| self.middle + s * a + t * b;
        Some(Polygon::quadrilateral(
            corner(-1.0, -1.0),
            corner(1.0, -1.0),
            corner(1.0, 1.0),
            corner(-1.0, 1.0),
        ))
    }

    /// How far apart the boxes are.
    pub fn distance(&self, other: &Self) -> f64 {
        ((self.middle - other.middle).abs() - self.half - other.half).max(DVec3::ZERO).length()
    }

    /// An upper bound of the cosine between a normal here and the direction to a point of another cluster, `near` and `far` being
    /// the least and the greatest distance.
    fn cosine_towards(&self, other: &Self, (near, far): (f64, f64)) -> f64 {
        let height =
            (other.middle - self.middle).dot(self.axis) + other.reach(self.axis) + self.reach(self.axis);
        let (cosine, sine) = self.turn;
        if cosine < 0.0 {
            return 1.0;
        }
        // (a·ω) cos σ + √(1 − (a·ω)²) sin σ at most, for a direction ω and normals within σ of the axis a.
        let along = height / if height > 0.0 { near.max(height) } else { far };
        (along * cosine + sine).min(1.0)
    }

    /// An upper bound of the form factor from any point of this cluster to another; 0 where they turn their backs.
    pub fn most(&self, other: &Self) -> f64 {
        let near = self.distance(other);
        let far = (self.middle - other.middle).length() + self.radius() + other.radius();
        let reach = (near, far);
        let (here, there) = (self.cosine_towards(other, reach), other.cosine_towards(self, reach));
        if here <= FLAT || there <= FLAT {
            return 0.0;
        }
        let bound = other.area * here * there / (std::f64::consts::PI * near * near);
        if bound < 1.0 { bound } else { 1.0 }
    }
}

impl Sender {
    /// Of a patch that counts for an area.
    fn of_patch(polygon: &Polygon, area: f64) -> Self {
        Self { centre: polygon.centroid(), front: polygon.normal() * area, alike: 1.0 }
    }
}

/// Both clusters together.
fn union([a, b]: [(&Whole, &Sender); 2]) -> (Whole, Sender) {
    let front = a.1.front + b.1.front;
    let whole = Whole::union(a.0, b.0, front.normalize_or_zero());
    let centre = (a.1.centre * a.0.area + b.1.centre * b.0.area) / whole.area;
    (whole, Sender { centre, front, alike: whole.turn.0 })
}

/// The part of its area that a patch counts for of which nothing is seen.
const BURIED: f64 = 1e-9;

/// Cosines below that are of patches in one plane, but for rounding.
const FLAT: f64 = 1e-9;

fn wider(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    if a.0 <= b.0 { a } else { b }
}

/// The tree of clusters, down to single patches.
#[derive(Debug)]
pub(super) struct Clusters {
    pub tree: ClusterTree<6>,
    pub wholes: Vec<Whole>,
    senders: Vec<Sender>,
    /// Where rays start and end, by places in the order of the tree.
    pub spots: Spots,
    /// The patches in the order of the tree: those that are asked for together lie side by side in memory.
    pub polygons: Vec<Polygon>,
    /// What each patch counts for, in m²: next to nothing where all of it is under something that stands there. Nobody sees that, and
    /// its darkness is no part of the mean of what is seen.
    pub areas: Vec<f64>,
    ascent: Ascent,
}

impl Clusters {
    /// Of patches that have areas and finite corners.
    pub fn new<V: Value>(patches: &Patches<V>, visibility: &Visibility) -> Self {
        let polygons = &patches.polygons;
        let counted =
            |polygon: &Polygon| polygon.area() * if visibility.exposed(polygon) > 0.0 { 1.0 } else { BURIED };
        let areas: Vec<f64> = polygons.par_iter().map(counted).collect();
        let corners = || polygons.iter().flat_map(Polygon::vertices);
        let [low, high] = [DVec3::min, DVec3::max].map(|end| corners().copied().reduce(end));
        let turn = low.zip(high).map_or(0.0, |(low, high)| TURN * (high - low).max_element());
        let boxes: Vec<Bounds<6>> = polygons
            .iter()
            .map(|polygon| {
                let (c, n) = (polygon.centroid(), 0.5 * turn * polygon.normal());
                Bounds::of_point([c.x, c.y, c.z, n.x, n.y, n.z])
            })
            .collect();
        // Scenes are checked on loading: what is not finite does not come so far.
        let tree = ClusterTree::of_boxes(&boxes, 1)
            .unwrap_or_else(|error| unreachable!("patches have finite corners: {error}"));
        // Children first, each after those that come later in the tree.
        let (mut wholes, mut senders) = (Vec::with_capacity(tree.len()), Vec::with_capacity(tree.len()));
        for cluster in tree.bottom_up() {
            let (whole, sender) = match tree.children(cluster) {
                None => {
                    let patch = tree.members(cluster)[0];
                    (
                        Whole::of_patch(&polygons[patch], areas[patch]),
                        Sender::of_patch(&polygons[patch], areas[patch]),
                    )
                }
                Some(parts) => {
                    let [a, b] = parts.map(|part| tree.len() - 1 - part.index());
                    union([(&wholes[a], &senders[a]), (&wholes[b], &senders[b])])
                }
            };
            wholes.push(whole);
            senders.push(sender);
        }
        wholes.reverse();
        senders.reverse();
        let spots = Spots::new(patches, tree.order());
        let polygons = tree.order().iter().map(|patch| polygons[*patch].clone()).collect();
        Self { ascent: Ascent::new(&tree, &wholes), tree, wholes, senders, spots, polygons, areas }
    }

    pub fn whole(&self, cluster: Cluster) -> &Whole {
        &self.wholes[cluster.index()]
    }

    pub fn sender(&self, cluster: Cluster) -> &Sender {
        &self.senders[cluster.index()]
    }

    /// Asks for what is known of a cluster, so that it is near when it is looked at.
    pub fn fetch(&self, cluster: Cluster) {
        let k = cluster.index();
        // A whole is in two lines.
        prefetch_index(&self.wholes, k);
        prefetch_index(std::slice::from_ref(&self.wholes[k].turn), 0);
        prefetch_index(&self.senders, k);
    }

    /// The patch that a cluster is, if it is one.
    pub fn patch(&self, cluster: Cluster) -> Option<usize> {
        self.tree.children(cluster).is_none().then(|| self.tree.members(cluster)[0])
    }

    /// The place of a patch in the order of the tree, if a cluster is one.
    pub fn leaf(&self, cluster: Cluster) -> Option<usize> {
        self.tree.children(cluster).is_none().then(|| self.tree.range(cluster).start)
    }

    /// A polygon that all of its patches are in: the patch itself, or a rectangle around those of one plane.
    pub fn hull(&self, cluster: Cluster) -> Option<Cow<'_, Polygon>> {
        match self.leaf(cluster) {
            Some(place) => Some(Cow::Borrowed(&self.polygons[place])),
            None => self.whole(cluster).rectangle().map(Cow::Owned),
        }
    }

    /// The mean over each cluster of what is given by patch, weighted by area.
    pub fn means<V: Value>(&self, values: &[V]) -> Vec<V> {
        self.ascent.means(values)
    }
}

/// The largest clusters of at most so many patches.
pub(super) fn up_to(tree: &ClusterTree<6>, most: usize) -> Vec<Cluster> {
    let mut found = Vec::new();
    let mut stack: Vec<Cluster> = tree.root().into_iter().collect();
    while let Some(cluster) = stack.pop() {
        match tree.children(cluster) {
            Some([a, b]) if tree.range(cluster).len() > most => stack.extend([b, a]),
            _ => found.push(cluster),
        }
    }
    found
}

/// The Cornell box in patches of a size, in metres, for tests.
#[cfg(test)]
pub(super) fn cornell_clusters(size: f64) -> (Visibility, Clusters) {
    let scene = crate::scene::cornell_box();
    let patches = Patches::new(&scene, size).unwrap_or_else(|error| unreachable!("{error}"));
    let visibility = Visibility::new(&scene.polygons());
    let clusters = Clusters::new(&patches, &visibility);
    (visibility, clusters)
}
