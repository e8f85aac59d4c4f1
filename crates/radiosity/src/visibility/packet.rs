//! Eight triangles side by side, tried in f32 by Möller and Trumbore's test with margins: none is missed.

use super::facet::{Facet, Plane};
use glam::DVec3;
use wide::f32x8;

/// Triangles side by side, each with corner a and edges b − a, c − a; an unused lane is NaN, which meets nothing.
#[derive(Clone, Debug)]
pub(super) struct Triangles {
    pub(super) corner: [f32x8; 3],
    pub(super) edges: [[f32x8; 3]; 2],
}

/// Up to eight triangles, and all that mostly decides about them in one place, eight lines of memory: where there are many, memory is
/// what a ray waits for.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(super) struct Packet {
    pub(super) triangles: Triangles,
    /// The plane of each triangle's polygon: a ray starts on one and ends on one, which by their planes are not in its way.
    pub(super) planes: [Plane; 8],
    /// The polygon of each triangle; unused lanes repeat the last.
    pub(super) polygons: [u32; 8],
}

/// The unit roundoff of f32.
const ROUNDOFF: f32 = 0.5 * f32::EPSILON;

/// Half the longest side that a scene may have in its unit.
pub(super) const HALF: f32 = 0.5;

/// What a packet is tried with, in the reach |s| + ½ of a segment that starts at s.
pub(super) const MARGIN: f32 = 256.0 * ROUNDOFF;

/// What a box is tried with: twice 3|plane − s| + 2|s| roundoffs.
pub(super) const BOX_MARGIN: f32 = 10.0 * ROUNDOFF;

/// A component of zero becomes one that moves nothing measurable: no infinity, so no NaN, in a product with its inverse.
pub(super) const SLOWEST: f32 = 1e-20;

/// Segments side by side, or one eight times, with margins for what f32 may be wrong by.
///
/// To first order in the roundoff ε, with max norms |·|, each of the products by which a packet finds u and v
/// is off by at most 48 ε |d| (|s| + ½) |e|, that for τ by 48 ε (|s| + ½) |e|², and the determinant by
/// 36 ε |d| |e|². u + v − determinant with a determinant of doubtful sign takes 2·48 + 3·36 = 204 of these.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segments {
    pub(super) origin: [f32x8; 3],
    pub(super) direction: [f32x8; 3],
    /// Where they end, as a parameter: 1, or a little beyond the nearest hit so far.
    pub(super) end: f32x8,
    pub(super) side_margin: f32x8,
    pub(super) end_margin: f32x8,
}

impl Segments {
    /// From where they start and where they go to.
    #[inline(always)]
    pub(super) fn new(origin: [f32x8; 3], direction: [f32x8; 3]) -> Self {
        let largest = |v: &[f32x8; 3]| v[0].abs().fast_max(v[1].abs()).fast_max(v[2].abs());
        let end_margin = (largest(&origin) + f32x8::splat(HALF)) * f32x8::splat(MARGIN);
        let side_margin = end_margin * largest(&direction);
        Self { origin, direction, end: f32x8::ONE, side_margin, end_margin }
    }

    /// The segment of one lane, eight times.
    pub(super) fn lane(&self, k: usize) -> Self {
        let splat = |lanes: &f32x8| f32x8::splat(lanes.to_array()[k]);
        Self {
            origin: self.origin.each_ref().map(splat),
            direction: self.direction.each_ref().map(splat),
            end: splat(&self.end),
            side_margin: splat(&self.side_margin),
            end_margin: splat(&self.end_margin),
        }
    }
}

impl Packet {
    /// The packet of one to eight triangles with the polygons that they are part of, by their numbers among the facets.
    pub(super) fn new(triangles: &[([DVec3; 3], u32)], facets: &[Facet]) -> Self {
        let count = triangles.len();
        let lanes = |f: &dyn Fn(&[DVec3; 3]) -> f64| {
            f32x8::new(std::array::from_fn(|k| triangles.get(k).map_or(f32::NAN, |(t, _)| f(t) as f32)))
        };
        let edge = |k: usize| std::array::from_fn(|axis| lanes(&|t| t[k][axis] - t[0][axis]));
        Self {
            triangles: Triangles {
                corner: std::array::from_fn(|axis| lanes(&|t| t[0][axis])),
                edges: [edge(1), edge(2)],
            },
            planes: std::array::from_fn(|k| {
                triangles.get(k).map_or(Plane::NONE, |(_, p)| facets[*p as usize].plane())
            }),
            polygons: std::array::from_fn(|k| triangles[k.min(count - 1)].1),
        }
    }

    /// The polygons, without immediate repetitions: the two halves of a quadrilateral are neighbours.
    pub(super) fn distinct(&self) -> impl Iterator<Item = u32> {
        let used = &self.polygons;
        (0..used.len()).filter(|&k| k == 0 || used[k] != used[k - 1]).map(|k| used[k])
    }
}

impl Triangles {
    /// The triangle of one lane, eight times.
    pub(super) fn lane(&self, k: usize) -> Self {
        let splat = |lanes: &[f32x8; 3]| std::array::from_fn(|axis| f32x8::splat(lanes[axis].to_array()[k]));
        Self { corner: splat(&self.corner), edges: [splat(&self.edges[0]), splat(&self.edges[1])] }
    }

    /// The largest component of the edges.
    #[inline(always)]
    pub(super) fn size(&self) -> f32x8 {
        let [e, f] = self.edges.map(|edge| edge[0].abs().fast_max(edge[1].abs()).fast_max(edge[2].abs()));
        e.fast_max(f)
    }

    /// A bit for each lane in which the segment may meet the triangle before its end, and for each in which it surely does.
    ///
    /// With a the corner and e, f the edges, the ray s + τd meets the plane at a + ue + vf where
    /// (u, v, τ) = (T·(d×f), d·(T×e), f·(T×e)) / (e·(d×f)), T = s − a. The margins bound all rounding from
    /// above (see [`Segments`]), also that of the determinant's sign: where that is in doubt, so small a
    /// determinant makes the other three as small, for a true hit. What passes with the margins against it is
    /// a hit beyond doubt, farther from the ends than [`ON_PLANE`](super::facet::ON_PLANE).
    #[inline(always)]
    pub(super) fn candidates(&self, ray: &Segments) -> Candidates {
        let [e, f] = &self.edges;
        let d = &ray.direction;
        let across = cross(d, f);
        let determinant = dot(e, &across);
        let sign = determinant & f32x8::splat(-0.0);
        let from: [f32x8; 3] = std::array::from_fn(|k| ray.origin[k] - self.corner[k]);
        let around = cross(&from, e);
        let (u, v) = (dot(&from, &across) ^ sign, dot(d, &around) ^ sign);
        let along = dot(f, &around) ^ sign;
        let determinant = determinant ^ sign;
        let size = self.size();
        let margin = size * ray.side_margin;
        let end_margin = size * size * ray.end_margin;
        let (least, sum) = (u.fast_min(v), u + v);
        let end = determinant * ray.end;
        let possible = (least + margin).simd_ge(f32x8::ZERO)
            & sum.simd_le(determinant + margin)
            & (along + end_margin).simd_ge(f32x8::ZERO)
            & along.simd_le(end + end_margin);
        let certain = least.simd_gt(margin)
            & sum.simd_lt(determinant - margin)
            & along.simd_gt(end_margin)
            & along.simd_lt(end - end_margin);
        Candidates { possible: possible.to_bitmask(), certain: certain.to_bitmask() }
    }
}

/// Where a segment meets a triangle, a bit for each lane: what is certain is possible.
pub(super) struct Candidates {
    pub(super) possible: u32,
    pub(super) certain: u32,
}

pub(super) fn cross(a: &[f32x8; 3], b: &[f32x8; 3]) -> [f32x8; 3] {
    [a[1].mul_sub(b[2], a[2] * b[1]), a[2].mul_sub(b[0], a[0] * b[2]), a[0].mul_sub(b[1], a[1] * b[0])]
}

pub(super) fn dot(a: &[f32x8; 3], b: &[f32x8; 3]) -> f32x8 {
    a[0].mul_add(b[0], a[1].mul_add(b[1], a[2] * b[2]))
}
