//! H = Σ_a H_a φ_a on each patch: the polynomials P2 and Q2 of [`elements`](crate::elements), whose nodes lie inside, and
//! whose iterated solution converges at the doubled order where light is smooth.

use super::domain::Domain;
use super::links::{Link, Looks};
use super::tree::{Node, Tree};
use crate::elements::{Degree, Local, Reference};
use crate::polygon::Polygon;
use fredholm::value::Value;
use glam::DVec3;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::LazyLock;

/// The points of a patch besides its nodes in which the residual is looked at: the middles of its quarters.
pub(super) const CHECKS: usize = 4;

/// The reference element.
#[derive(Debug)]
pub(super) struct Element {
    reference: Reference,
    pub checks: [[f64; 2]; CHECKS],
    /// The means of the φ_a over each leaf, in the order of [`Tree::leaves_of`].
    leaves: Vec<Local>,
}

static TRIANGLE: LazyLock<Element> = LazyLock::new(|| {
    let corners = Polygon::triangle(DVec3::ZERO, DVec3::X, DVec3::Y);
    Element::new(Reference::triangle(Degree::Quadratic), &corners)
});
static SQUARE: LazyLock<Element> = LazyLock::new(|| {
    let corners = Polygon::quadrilateral(DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y, DVec3::Y);
    Element::new(Reference::square(Degree::Quadratic), &corners)
});

impl Element {
    fn new(reference: Reference, whole: &Polygon) -> Self {
        let tree = Tree::new(std::slice::from_ref(whole), f64::INFINITY);
        let mean = |leaf: u32| {
            let mut mean = Local::default();
            for (at, weight) in reference.nodes.iter().zip(&reference.weights) {
                let [x, y, _] = point(&tree.node(leaf).polygon, *at).to_array();
                mean.iter_mut()
                    .zip(reference.values([x, y]))
                    .for_each(|(mean, value)| *mean += weight * value);
            }
            mean
        };
        let checks = whole.quarters().map(|quarter| {
            let [x, y, _] = quarter.centroid().to_array();
            [x, y]
        });
        Self { leaves: tree.leaves_of(0).map(mean).collect(), checks, reference }
    }

    /// That of a patch.
    pub fn of(patch: &Polygon) -> &'static Self {
        if patch.vertices().len() == 3 { &TRIANGLE } else { &SQUARE }
    }

    /// The points of a patch from which it looks: its nodes, then its checks.
    pub fn points(&self, patch: &Polygon) -> impl Iterator<Item = DVec3> {
        self.reference.nodes.iter().chain(&self.checks).map(|&at| point(patch, at))
    }

    /// What a quarter sees, of whose points one may be a check of the whole.
    pub fn around(&self, check: Vec<Link>) -> Looks {
        // The middle of a square is a node; those of a triangle's rule leave the middle out.
        let middle = self.reference.nodes.iter().position(|&[s, t]| (s, t) == (0.5, 0.5));
        middle.map_or(Looks::new(), |k| std::iter::repeat_n(Vec::new(), k).chain([check]).collect())
    }

    /// How many nodes it has.
    pub fn dim(&self) -> usize {
        self.reference.nodes.len()
    }
}

/// The point of a polygon with these coordinates on the reference element.
fn point(polygon: &Polygon, [s, t]: [f64; 2]) -> DVec3 {
    match *polygon.vertices() {
        [a, b, c] => a + (b - a) * s + (c - a) * t,
        _ => polygon.point(s, t),
    }
}

/// The space on a mesh.
#[derive(Debug)]
pub(super) struct Space {
    /// The patches, in the order of their unknowns.
    pub patches: Vec<u32>,
    first: Vec<usize>,
    /// Of patches on which something stands, the weights of the nodes for each leaf.
    holed: HashMap<u32, Vec<Local>>,
}

impl Space {
    pub fn new<V: Value>(domain: &Domain<'_, V>, tree: &Tree) -> Self {
        let patches: Vec<u32> = tree.patches().collect();
        let mut first = vec![0];
        for &patch in &patches {
            first.push(first[first.len() - 1] + Element::of(&tree.node(patch).polygon).dim());
        }
        let holed =
            patches.iter().filter_map(|&patch| Some((patch, nearest(domain, tree, patch)?))).collect();
        Self { patches, first, holed }
    }

    /// The number of unknowns.
    pub fn dim(&self) -> usize {
        self.first[self.patches.len()]
    }

    /// The unknowns of the k-th patch.
    pub fn range(&self, k: usize) -> Range<usize> {
        self.first[k]..self.first[k + 1]
    }

    /// Whether something stands on a patch: there H is no polynomial.
    pub fn is_holed(&self, patch: u32) -> bool {
        self.holed.contains_key(&patch)
    }

    /// Σ_a u_a φ_a at a point of the k-th patch.
    pub fn at<V: Value>(&self, u: &[V], k: usize, patch: &Node, point: DVec3) -> V {
        let weights = Element::of(&patch.polygon).reference.values(patch.local(point).to_array());
        combined(&weights, &u[self.range(k)])
    }

    /// The mean of u over every node of the tree.
    pub fn means<V: Value>(&self, tree: &Tree, u: &[V]) -> Vec<V> {
        let mut means = vec![V::splat(0.0); tree.nodes.len()];
        for (k, &patch) in self.patches.iter().enumerate() {
            let weights = self.holed.get(&patch);
            let weights = weights.unwrap_or(&Element::of(&tree.node(patch).polygon).leaves);
            for (leaf, weights) in tree.leaves_of(patch).zip(weights) {
                means[leaf as usize] = combined(weights, &u[self.range(k)]);
            }
        }
        average(tree, &mut means);
        means
    }
}

fn combined<V: Value>(weights: &Local, values: &[V]) -> V {
    values.iter().zip(weights).fold(V::splat(0.0), |sum, (value, weight)| sum + *value * *weight)
}

/// If something stands on a patch: for each leaf the nearest node beside it.
fn nearest<V: Value>(domain: &Domain<'_, V>, tree: &Tree, patch: u32) -> Option<Vec<Local>> {
    let Node { ref polygon, face, .. } = *tree.node(patch);
    let leaves: Vec<DVec3> = tree.leaves_of(patch).map(|leaf| tree.node(leaf).polygon.centroid()).collect();
    let element = Element::of(polygon);
    let points: Vec<DVec3> = element.points(polygon).collect();
    if !domain.is_stood_on(face) || !points.iter().chain(&leaves).any(|x| domain.is_buried(face, *x)) {
        return None;
    }
    let in_sight: Vec<usize> = (0..element.dim()).filter(|&a| !domain.is_buried(face, points[a])).collect();
    let weights = leaves.iter().map(|leaf| {
        let mut weights = Local::default();
        let distance = |a: &usize| points[*a].distance(*leaf);
        let nearest = in_sight.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        nearest.into_iter().for_each(|a| weights[*a] = 1.0);
        weights
    });
    Some(weights.collect())
}

/// The mean over what is in sight of every node, of what is given for the leaves.
pub(super) fn average<V: Value>(tree: &Tree, values: &mut [V]) {
    for (k, node) in tree.nodes.iter().enumerate().rev().filter(|(_, node)| !node.parts.is_empty()) {
        let parts = || node.parts.clone().map(|part| (values[part as usize], tree.node(part)));
        let exposed: f64 = parts().map(|(_, part)| part.exposed).sum();
        let sum = parts().fold(V::splat(0.0), |sum, (value, part)| sum + value * part.exposed);
        values[k] = if exposed > 0.0 { sum * (1.0 / exposed) } else { V::splat(0.0) };
    }
}
