//! The segments between two convex polygons fill their convex hull; what a plane keeps out of it hides nothing.

use super::bvh::{Node, Query};
use super::facet::{Facet, ON_PLANE};
use super::packet::Packet;
use glam::DVec3;
use std::ops::ControlFlow;
use wide::{f32x8, f64x4};

/// How far a gap, or a breach of a touched plane, is from rounding, in the scene's unit.
pub(super) const ROUNDING: f64 = 1e-12;

/// The square of 1e-12: edges and distances are 1e-4 and more of the scene in anything that is lit.
const SMALLEST_NORMAL: f64 = 1e-24;

/// Four points side by side.
#[derive(Clone, Copy)]
struct Points([f64x4; 3]);

impl Points {
    fn new(points: &[DVec3; 4]) -> Self {
        Self(std::array::from_fn(|axis| f64x4::new(points.map(|p| p[axis]))))
    }

    fn dot(&self, v: DVec3) -> f64x4 {
        let [x, y, z] = self.0;
        x.mul_add(f64x4::splat(v.x), y.mul_add(f64x4::splat(v.y), z * f64x4::splat(v.z)))
    }
}

/// Four half-spaces {x : normal·x ≤ offset} side by side; a normal of zero with a large offset contains everything.
#[derive(Clone, Copy)]
struct HalfSpaces {
    normals: Points,
    offsets: f64x4,
    /// What rounding may add to normal·x.
    rounding: f64x4,
}

impl HalfSpaces {
    const UNBOUNDED: f64 = 1e30;

    fn new(normals: Points, offsets: f64x4) -> Self {
        let [x, y, z] = normals.0.map(f64x4::abs);
        Self { normals, offsets, rounding: f64x4::splat(ROUNDING) * (x + y + z) }
    }

    /// Where two polygons have their fronts.
    fn fronts(a: &Facet, b: &Facet) -> Self {
        let normals = Points::new(&[-a.normal, -b.normal, DVec3::ZERO, DVec3::ZERO]);
        Self::new(normals, f64x4::new([-a.offset, -b.offset, Self::UNBOUNDED, Self::UNBOUNDED]))
    }

    /// The sides of the hull that go through an edge of a polygon and touch the one before its front.
    fn sides(own: &[DVec3; 4], opposite: &[DVec3; 4]) -> Self {
        let [a, b, c, d] = *own;
        let starts = Points::new(own);
        let ends = Points::new(&[b, c, d, a]);
        let edges: [f64x4; 3] = std::array::from_fn(|k| ends.0[k] - starts.0[k]);
        let mut normals = cross(&edges, &towards(opposite[0], &starts));
        for &v in &opposite[1..] {
            let from = towards(v, &starts);
            let beyond = dot(&normals, &from).simd_gt(f64x4::ZERO);
            let turned = cross(&edges, &from);
            normals = std::array::from_fn(|k| beyond.select(turned[k], normals[k]));
        }
        let found = Self::new(Points(normals), dot(&normals, &starts.0));
        // Not so where the other polygon reaches the plane of this one, or where a normal is mere rounding.
        let sound = own
            .iter()
            .chain(opposite)
            .fold(dot(&normals, &normals).simd_gt(f64x4::splat(SMALLEST_NORMAL)), |sound, &v| {
                sound & found.normals.dot(v).simd_le(found.offsets + found.rounding)
            });
        let normals = found.normals.0.map(|n| sound.select(n, f64x4::ZERO));
        Self::new(Points(normals), sound.select(found.offsets, f64x4::splat(Self::UNBOUNDED)))
    }

    /// Whether one of the four has all points outside or on its boundary.
    fn exclude(&self, points: &[DVec3]) -> bool {
        let bound = self.offsets - self.rounding;
        let everywhere = f64x4::ZERO.simd_eq(f64x4::ZERO);
        points.iter().fold(everywhere, |out, &v| out & self.normals.dot(v).simd_ge(bound)).any()
    }
}

fn towards(v: DVec3, from: &Points) -> [f64x4; 3] {
    std::array::from_fn(|k| f64x4::splat(v[k]) - from.0[k])
}

fn cross(a: &[f64x4; 3], b: &[f64x4; 3]) -> [f64x4; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: &[f64x4; 3], b: &[f64x4; 3]) -> f64x4 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The hull of two polygons in front of each other, and the half-spaces that it is the intersection of.
pub(super) struct Shaft<'a> {
    facets: &'a [Facet],
    polygons: [&'a [DVec3]; 2],
    /// The vertices of both; a triangle repeats its last.
    hull: [Points; 2],
    low: DVec3,
    high: DVec3,
    /// The fronts of both polygons, then the sides through the edges of either.
    sides: [HalfSpaces; 3],
    centroids: [DVec3; 2],
    pub(super) clear: bool,
}

impl<'a> Shaft<'a> {
    pub(super) fn new(facets: &'a [Facet], a: &'a Facet, b: &'a Facet) -> Self {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for &v in a.corners().iter().chain(b.corners()) {
            (low, high) = (low.min(v), high.max(v));
        }
        let sides = [
            HalfSpaces::fronts(a, b),
            HalfSpaces::sides(a.corners(), b.corners()),
            HalfSpaces::sides(b.corners(), a.corners()),
        ];
        let hull = [Points::new(a.corners()), Points::new(b.corners())];
        let polygons = [a.vertices(), b.vertices()];
        let centroids = [a.centroid(), b.centroid()];
        Self { facets, polygons, hull, low, high, sides, centroids, clear: true }
    }

    /// Whether the facet is proved to cut no segment between the polygons.
    ///
    /// The quick refutation, that it cuts the line of centroids, spares a try that could not succeed.
    pub(super) fn misses(&self, facet: u32) -> bool {
        let facet = &self.facets[facet as usize];
        self.excludes(facet.vertices())
            || self.on_one_side_of(facet)
            || (facet.cut(self.centroids[0], self.centroids[1]).is_none() && self.is_aside(facet))
    }

    /// Whether the hull of these points is on the outer side of one side of the hull of the polygons.
    pub(super) fn excludes(&self, points: &[DVec3]) -> bool {
        self.sides.iter().any(|sides| sides.exclude(points))
    }

    /// Whether both polygons lie on one closed side of the facet's plane.
    fn on_one_side_of(&self, facet: &Facet) -> bool {
        let [a, b] = self.hull.map(|points| points.dot(facet.normal) - f64x4::splat(facet.offset));
        let near = f64x4::splat(ON_PLANE - ROUNDING);
        (a.simd_le(near) & b.simd_le(near)).all() || (a.simd_ge(-near) & b.simd_ge(-near)).all()
    }

    /// Whether the direction from the line of centroids to the facet separates them.
    ///
    /// Further search along that line (Chung and Wang, 1996) finds a hundredth more, and costs as much as all else.
    fn is_aside(&self, facet: &Facet) -> bool {
        let [from, to] = self.centroids;
        let target = facet.centroid();
        let along = (target - from).dot(to - from) / from.distance_squared(to);
        let axis = (target - from.lerp(to, along.clamp(0.0, 1.0))).normalize_or_zero();
        let gap = furthest(facet.vertices(), -axis) - self.furthest(axis);
        axis.dot(gap) > ROUNDING
    }

    fn furthest(&self, axis: DVec3) -> DVec3 {
        let of_each = [furthest(self.polygons[0], axis), furthest(self.polygons[1], axis)];
        furthest(&of_each, axis)
    }
}

fn furthest(points: &[DVec3], axis: DVec3) -> DVec3 {
    let further = |best: DVec3, &p: &DVec3| if axis.dot(p - best) > 0.0 { p } else { best };
    points.iter().fold(points[0], further)
}

impl Shaft<'_> {
    /// A bit for each box that reaches into the hull.
    #[inline(always)]
    pub(super) fn reached(&self, node: &Node) -> u32 {
        let mut inside = f32x8::ZERO.simd_eq(f32x8::ZERO);
        for k in 0..3 {
            let (low, high) = (-raised(-self.low[k], 1.0), raised(self.high[k], 1.0));
            inside &=
                node.bounds[k].simd_le(f32x8::splat(high)) & node.bounds[k + 3].simd_ge(f32x8::splat(low));
        }
        for (sides, used) in self.sides.iter().zip([2, 4, 4]) {
            let ([x, y, z], offsets) = (sides.normals.0.map(f64x4::to_array), sides.offsets.to_array());
            for i in 0..used {
                let normal = DVec3::new(x[i], y[i], z[i]);
                inside &= lowest(node, normal)
                    .simd_le(f32x8::splat(raised(offsets[i], normal.abs().element_sum())));
            }
        }
        inside.to_bitmask()
    }
}

impl Query for Shaft<'_> {
    #[inline(always)]
    fn select(&mut self, node: &Node) -> u32 {
        self.reached(node)
    }

    #[inline(always)]
    fn visit(&mut self, packet: &Packet, _: (&Node, usize)) -> ControlFlow<()> {
        self.clear = packet.distinct().all(|k| self.misses(k));
        if self.clear { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    }
}

/// The least of normal·x over each box.
#[inline(always)]
fn lowest(node: &Node, normal: DVec3) -> f32x8 {
    (0..3).fold(f32x8::ZERO, |sum, k| {
        let face = node.bounds[if normal[k] < 0.0 { k + 3 } else { k }];
        face.mul_add(f32x8::splat(normal[k] as f32), sum)
    })
}

/// Above the number by more than f32 can be wrong by in normal·x, for a point of the scene and the normal's size.
fn raised(x: f64, size: f64) -> f32 {
    (x + 4.0 * f64::from(f32::EPSILON) * (size + x.abs())) as f32
}
