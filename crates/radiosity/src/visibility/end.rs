//! A polygon from which, or to which, light goes: with what tells quickly that nothing is between it and another.

use super::bvh::Node;
use super::facet::Facet;
use glam::Vec3;
use wide::f32x8;

/// A polygon with the box and the ball around it, in the scene's unit.
#[derive(Clone, Debug)]
pub(crate) struct End {
    pub(super) facet: Facet,
    low: Vec3,
    high: Vec3,
    centre: Vec3,
    radius: f32,
}

/// What single precision is wrong by in a distance of points of the scene, with room to spare.
const MARGIN: f32 = 16.0 * f32::EPSILON;

impl End {
    pub(super) fn new(facet: Facet) -> Self {
        let centre = facet.centroid();
        let vertices = || facet.vertices().iter();
        let radius = vertices().fold(0.0, |r: f64, v| r.max(v.distance(centre))) as f32 + MARGIN;
        let low = vertices().fold(Vec3::INFINITY, |low, v| low.min(v.as_vec3())) - Vec3::splat(MARGIN);
        let high = vertices().fold(Vec3::NEG_INFINITY, |high, v| high.max(v.as_vec3())) + Vec3::splat(MARGIN);
        Self { low, high, centre: centre.as_vec3(), radius, facet }
    }

    /// A bit for each box of the node that reaches into the box around both, and that the segment between their centres meets
    /// once it is wider by the larger of their radii.
    ///
    /// The second is not implied by the first where the two are far apart on a slant.
    #[inline(always)]
    pub(super) fn met(&self, other: &Self, node: &Node) -> u32 {
        let (low, high) = (self.low.min(other.low), self.high.max(other.high));
        let along = other.centre - self.centre;
        let reach = self.radius.max(other.radius) + MARGIN;
        let mut meets = f32x8::ZERO.simd_eq(f32x8::ZERO);
        let (mut enters, mut leaves) = (f32x8::ZERO, f32x8::ONE);
        for k in 0..3 {
            let (least, most) = (node.bounds[k], node.bounds[k + 3]);
            meets &= least.simd_le(f32x8::splat(high[k])) & most.simd_ge(f32x8::splat(low[k]));
            // Along an axis on which the segment does not advance, its start decides: all times are ∓ many.
            let speed = if along[k].abs() < SLOWEST { SLOWEST } else { along[k] };
            let (first, last) = (self.centre[k] + reach, self.centre[k] - reach);
            let times = [(least - first) / speed, (most - last) / speed];
            enters = enters.fast_max(times[0].fast_min(times[1]));
            leaves = leaves.fast_min(times[0].fast_max(times[1]));
        }
        // An unused child has an empty box, of which nothing is true.
        (meets & enters.simd_le(leaves)).to_bitmask()
    }
}

/// A difference of coordinates that is none: 1 over it is far from infinite.
const SLOWEST: f32 = 1e-20;
