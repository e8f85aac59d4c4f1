//! The segments between two convex polygons fill their convex hull; what a plane keeps out of it hides nothing.

use super::bvh::{Node, Query};
use super::facet::{Facet, ON_PLANE};
use super::packet::Packet;
use glam::{DVec3, Vec3};
use std::ops::ControlFlow;
use wide::f32x8;

/// How far a gap, or a breach of a touched plane, is from rounding, in the scene's unit.
const ROUNDING: f64 = 1e-12;

/// How many reflections the search for a separating axis gets: four in five that it finds take at most 4.
const SEARCH: usize = 10;

/// All x with normal·x ≤ offset.
#[derive(Clone, Copy)]
struct HalfSpace {
    normal: DVec3,
    offset: f64,
}

impl HalfSpace {
    fn excludes(&self, vertices: &[DVec3]) -> bool {
        vertices.iter().all(|v| self.normal.dot(*v) > self.offset)
    }
}

/// The hull of two polygons in front of each other, and half-spaces that contain it.
pub(super) struct Shaft<'a> {
    facets: &'a [Facet],
    a: &'a Facet,
    b: &'a Facet,
    low: DVec3,
    high: DVec3,
    /// The fronts of both polygons, then a tube of eight sides about the line of centroids.
    sides: [HalfSpace; 10],
    pub(super) clear: bool,
}

impl<'a> Shaft<'a> {
    pub(super) fn new(facets: &'a [Facet], a: &'a Facet, b: &'a Facet) -> Self {
        let vertices = || a.vertices().iter().chain(b.vertices());
        let low = vertices().fold(DVec3::INFINITY, |m, &v| m.min(v)) - ROUNDING;
        let high = vertices().fold(DVec3::NEG_INFINITY, |m, &v| m.max(v)) + ROUNDING;
        // Open segments that end on a front lie before it: what only touches the plane is out of their way.
        let front = |f: &Facet| HalfSpace { normal: -f.normal, offset: -f.offset - ROUNDING };
        let mut sides = [front(a); 10];
        sides[1] = front(b);
        let axis = (b.centroid() - a.centroid()).try_normalize().unwrap_or(DVec3::Z);
        let (u, v) = axis.any_orthonormal_pair();
        for (k, across) in [u, v, u + v, u - v].into_iter().enumerate() {
            let along = |w: DVec3| vertices().fold(f64::NEG_INFINITY, |m, x| m.max(w.dot(*x))) + ROUNDING;
            sides[2 + 2 * k] = HalfSpace { normal: across, offset: along(across) };
            sides[3 + 2 * k] = HalfSpace { normal: -across, offset: along(-across) };
        }
        Self { facets, a, b, low, high, sides, clear: true }
    }

    /// Whether the facet is proved to cut no segment between the polygons.
    fn misses(&self, facet: &Facet) -> bool {
        let vertices = facet.vertices();
        (0..3).any(|k| {
            vertices.iter().all(|v| v[k] < self.low[k]) || vertices.iter().all(|v| v[k] > self.high[k])
        }) || self.sides.iter().any(|side| side.excludes(vertices))
            || self.on_one_side_of(facet)
            || self.has_separating_axis(facet)
    }

    /// Whether both polygons lie on one closed side of the facet's plane.
    fn on_one_side_of(&self, facet: &Facet) -> bool {
        let (lowest, highest) = self
            .hull()
            .map(|v| facet.height_of(v))
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
        lowest >= ROUNDING - ON_PLANE || highest <= ON_PLANE - ROUNDING
    }

    fn hull(&self) -> impl Iterator<Item = DVec3> {
        self.a.vertices().iter().chain(self.b.vertices()).copied()
    }

    /// Chung and Wang's search (1996): reflect the axis at the pair of vertices that refutes it.
    ///
    /// Whatever the axis came from, `gap` is measured over all vertices: a positive one is a proof.
    fn has_separating_axis(&self, facet: &Facet) -> bool {
        let (from, to) = (self.a.centroid(), self.b.centroid());
        let target = facet.centroid();
        let along = (target - from).dot(to - from) / from.distance_squared(to);
        let mut axis = (target - from.lerp(to, along.clamp(0.0, 1.0))).normalize_or_zero();
        for _ in 0..SEARCH {
            let near = furthest(facet.vertices().iter().copied(), -axis);
            let far = furthest(self.hull(), axis);
            let between = near - far;
            if axis.dot(between) > ROUNDING {
                return true;
            }
            let Some(direction) = between.try_normalize() else { return false };
            axis -= 2.0 * axis.dot(direction) * direction;
        }
        false
    }
}

fn furthest(points: impl Iterator<Item = DVec3>, axis: DVec3) -> DVec3 {
    let further = |best: (f64, DVec3), p: DVec3| {
        let height = axis.dot(p);
        if height > best.0 { (height, p) } else { best }
    };
    points.fold((f64::NEG_INFINITY, DVec3::ZERO), further).1
}

impl Query for Shaft<'_> {
    #[inline(always)]
    fn select(&self, node: &Node) -> u32 {
        let mut inside = f32x8::ZERO.simd_eq(f32x8::ZERO);
        for k in 0..3 {
            let (low, high) = (rounded_down(self.low[k]), -rounded_down(-self.high[k]));
            inside &=
                node.bounds[k].simd_le(f32x8::splat(high)) & node.bounds[k + 3].simd_ge(f32x8::splat(low));
        }
        for side in &self.sides {
            let normal: Vec3 = side.normal.as_vec3();
            let mut lowest = f32x8::ZERO;
            for k in 0..3 {
                let face = node.bounds[if normal[k] < 0.0 { k + 3 } else { k }];
                lowest = face.mul_add(f32x8::splat(normal[k]), lowest);
            }
            inside &= lowest.simd_le(f32x8::splat(-rounded_down(-side.offset)));
        }
        inside.to_bitmask()
    }

    #[inline(always)]
    fn visit(&mut self, packet: &Packet) -> ControlFlow<()> {
        self.clear = packet.distinct().all(|k| self.misses(&self.facets[k as usize]));
        if self.clear { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    }
}

/// Below the number by more than f32 can be wrong by in three products with coordinates up to ½.
fn rounded_down(x: f64) -> f32 {
    let margin = 8.0 * f64::from(f32::EPSILON) * (1.0 + x.abs());
    (x - margin) as f32
}
