//! The segments between two convex polygons fill their convex hull; what a plane keeps out of it hides nothing.

use super::bvh::{Node, Query};
use super::facet::{Facet, ON_PLANE};
use super::packet::Packet;
use glam::{DVec3, Vec3};
use std::ops::ControlFlow;
use wide::f32x8;

/// How far a gap, or a breach of a touched plane, is from rounding, in the scene's unit.
const ROUNDING: f64 = 1e-12;

/// The square of 1e-12: edges and distances are 1e-4 and more of the scene in anything that is lit.
const SMALLEST_NORMAL: f64 = 1e-24;

/// How many reflections the search for a separating axis gets: it finds one in its first few, or seldom at all.
const SEARCH: usize = 4;

/// All x with normal·x ≤ offset.
#[derive(Clone, Copy)]
struct HalfSpace {
    normal: DVec3,
    offset: f64,
}

impl HalfSpace {
    const EVERYTHING: Self = Self { normal: DVec3::ZERO, offset: 1e30 };

    /// Where the polygon with this plane has its front.
    fn front(facet: &Facet) -> Self {
        Self { normal: -facet.normal, offset: -facet.offset }
    }

    /// The side of the hull that goes through the edge pq of a polygon and touches the one before its front.
    fn side(p: DVec3, q: DVec3, opposite: &[DVec3]) -> Self {
        let turn = |normal: DVec3, v: &DVec3| {
            let from = v - p;
            let is_first = normal == DVec3::ZERO;
            if is_first || normal.dot(from) > 0.0 { (q - p).cross(from) } else { normal }
        };
        let normal = opposite.iter().fold(DVec3::ZERO, turn);
        Self { normal, offset: normal.dot(p) }
    }

    /// What rounding may add to normal·x.
    fn rounding(&self) -> f64 {
        ROUNDING * self.normal.abs().element_sum()
    }

    fn contains(&self, vertices: &[DVec3]) -> bool {
        let bound = self.offset + self.rounding();
        vertices.iter().all(|&v| self.normal.dot(v) <= bound)
    }

    /// Whether the vertices are all outside, or on the boundary.
    fn excludes(&self, vertices: &[DVec3]) -> bool {
        let bound = self.offset - self.rounding();
        vertices.iter().all(|&v| self.normal.dot(v) >= bound)
    }
}

/// The hull of two polygons in front of each other, and the half-spaces that it is the intersection of.
pub(super) struct Shaft<'a> {
    facets: &'a [Facet],
    a: &'a Facet,
    b: &'a Facet,
    low: DVec3,
    high: DVec3,
    /// The fronts of both polygons, then the sides through the edges of either.
    sides: [HalfSpace; 10],
    pub(super) clear: bool,
}

impl<'a> Shaft<'a> {
    pub(super) fn new(facets: &'a [Facet], a: &'a Facet, b: &'a Facet) -> Self {
        let vertices = || a.vertices().iter().chain(b.vertices());
        let low = vertices().fold(DVec3::INFINITY, |m, &v| m.min(v));
        let high = vertices().fold(DVec3::NEG_INFINITY, |m, &v| m.max(v));
        let mut sides = [HalfSpace::EVERYTHING; 10];
        (sides[0], sides[1]) = (HalfSpace::front(a), HalfSpace::front(b));
        for (k, (own, other)) in
            [(a.vertices(), b.vertices()), (b.vertices(), a.vertices())].into_iter().enumerate()
        {
            for (i, &p) in own.iter().enumerate() {
                let side = HalfSpace::side(p, own[if i + 1 == own.len() { 0 } else { i + 1 }], other);
                // Not so where the other polygon reaches the plane of this one, or a normal is mere rounding.
                if side.normal.length_squared() > SMALLEST_NORMAL
                    && side.contains(own)
                    && side.contains(other)
                {
                    sides[2 + 4 * k + i] = side;
                }
            }
        }
        Self { facets, a, b, low, high, sides, clear: true }
    }

    /// Whether the facet is proved to cut no segment between the polygons.
    ///
    /// The quick refutation, that it cuts the line of centroids, spares the search that could not succeed.
    fn misses(&self, facet: &Facet) -> bool {
        self.sides.iter().any(|side| side.excludes(facet.vertices()))
            || self.on_one_side_of(facet)
            || (facet.cut(self.a.centroid(), self.b.centroid()).is_none() && self.has_separating_axis(facet))
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
            let gap = near - far;
            if axis.dot(gap) > ROUNDING {
                return true;
            }
            let Some(direction) = gap.try_normalize() else { return false };
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
            let (low, high) = (-raised(-self.low[k], 1.0), raised(self.high[k], 1.0));
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
            let highest = raised(side.offset, side.normal.abs().element_sum());
            inside &= lowest.simd_le(f32x8::splat(highest));
        }
        inside.to_bitmask()
    }

    #[inline(always)]
    fn visit(&mut self, packet: &Packet) -> ControlFlow<()> {
        self.clear = packet.distinct().all(|k| self.misses(&self.facets[k as usize]));
        if self.clear { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    }
}

/// Above the number by more than f32 can be wrong by in normal·x, for a point of the scene and the normal's size.
fn raised(x: f64, size: f64) -> f32 {
    (x + 4.0 * f64::from(f32::EPSILON) * (size + x.abs())) as f32
}
