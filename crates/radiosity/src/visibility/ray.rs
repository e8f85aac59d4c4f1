//! s + τ(t − s), τ ∈ [0, 1], against boxes in f32, and what is asked of the polygons on its way.

use super::bvh::{Node, Query};
use super::facet::Facet;
use super::packet::{BOX_MARGIN, HALF, MARGIN, Packet, SLOWEST, Segments};
use glam::{DVec3, Vec3A};
use std::ops::ControlFlow;
use wide::f32x8;

/// A segment, with margins for what f32 may be wrong by (see [`Segments`]).
pub(super) struct Ray {
    origin: Vec3A,
    direction: Vec3A,
    inverse: Vec3A,
    /// Of each axis, what is added to plane·inverse to have the parameter there, a little too early.
    entry: Vec3A,
    /// The same, a little too late.
    exit: Vec3A,
    end: f32,
    side_margin: f32,
    end_margin: f32,
    /// A bit for each axis along which the ray goes down.
    down: u32,
}

impl Ray {
    /// None where there is no direction: a zero length, an infinity or a NaN.
    #[inline(always)]
    pub(super) fn new(s: DVec3, t: DVec3) -> Option<Self> {
        let d = t - s;
        let length = d.length_squared();
        if !(length > 0.0 && length < f64::INFINITY) {
            return None;
        }
        let (origin, direction) = (s.as_vec3a(), d.as_vec3a());
        let reach = origin.abs().max_element() + HALF;
        let end_margin = MARGIN * reach;
        let speed = direction.abs();
        let inverse = speed.max(Vec3A::splat(SLOWEST)).copysign(direction).recip();
        // Moved by the margin before the division is done: the first box waits for this.
        let pad = Vec3A::splat(BOX_MARGIN * reach).copysign(direction);
        Some(Self {
            origin,
            direction,
            inverse,
            entry: (-origin - pad) * inverse,
            exit: (pad - origin) * inverse,
            end: 1.0,
            side_margin: end_margin * speed.max_element(),
            end_margin,
            down: direction.is_negative_bitmask(),
        })
    }

    /// The segment, eight times.
    #[inline(always)]
    fn segment(&self) -> Segments {
        Segments {
            origin: splat(self.origin),
            direction: splat(self.direction),
            end: f32x8::splat(self.end),
            side_margin: f32x8::splat(self.side_margin),
            end_margin: f32x8::splat(self.end_margin),
        }
    }

    /// A bit for each box that the ray may meet before its end.
    #[inline(always)]
    fn select(&self, node: &Node) -> u32 {
        let [inverse, entry, exit] = [self.inverse, self.entry, self.exit].map(splat);
        // Where in the bounds the ray enters along an axis, and where it leaves.
        let far = |k: usize| if self.backwards(k) { k } else { k + 3 };
        let near = |k: usize| if self.backwards(k) { k + 3 } else { k };
        let enters: [f32x8; 3] = std::array::from_fn(|k| node.bounds[near(k)].mul_add(inverse[k], entry[k]));
        let leaves: [f32x8; 3] = std::array::from_fn(|k| node.bounds[far(k)].mul_add(inverse[k], exit[k]));
        let first = enters[0].fast_max(enters[1]).fast_max(enters[2].fast_max(f32x8::ZERO));
        let last = leaves[0].fast_min(leaves[1]).fast_min(leaves[2].fast_min(f32x8::splat(self.end)));
        first.simd_le(last).to_bitmask()
    }

    #[inline(always)]
    fn backwards(&self, axis: usize) -> bool {
        self.down >> axis & 1 == 1
    }
}

/// Each component eight times.
#[inline(always)]
fn splat(v: Vec3A) -> [f32x8; 3] {
    v.to_array().map(f32x8::splat)
}

/// Which bits are set.
#[inline(always)]
pub(super) fn bits(mut of: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let bit = of.trailing_zeros() as usize;
        of &= of.wrapping_sub(1);
        (bit < 64).then_some(bit)
    })
}

/// A polygon of a packet that cuts the segment from s to t, which is in all lanes of `segment`.
#[inline(always)]
pub(super) fn blocker(
    packet: &Packet,
    segment: &Segments,
    facets: &[Facet],
    [s, t]: [DVec3; 2],
) -> Option<u32> {
    let candidates = packet.triangles.candidates(segment);
    if let Some(lane) = bits(candidates.certain.into()).next() {
        return Some(packet.polygons[lane]);
    }
    for lane in bits(candidates.possible.into()) {
        let polygon = packet.polygons[lane];
        if packet.planes[lane].parts(s, t).is_some() && facets[polygon as usize].cut(s, t).is_some() {
            return Some(polygon);
        }
    }
    None
}

/// Any polygon that cuts the segment from s to t.
pub(super) struct Blocker<'a> {
    pub(super) facets: &'a [Facet],
    pub(super) s: DVec3,
    pub(super) t: DVec3,
    pub(super) ray: Ray,
    pub(super) found: Option<u32>,
}

impl Query for Blocker<'_> {
    #[inline(always)]
    fn select(&mut self, node: &Node) -> u32 {
        self.ray.select(node)
    }

    #[inline(always)]
    fn visit(&mut self, packet: &Packet, _: (&Node, usize)) -> ControlFlow<()> {
        self.found = blocker(packet, &self.ray.segment(), self.facets, [self.s, self.t]);
        if self.found.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    #[inline(always)]
    fn backwards(&self, axis: usize) -> bool {
        self.ray.backwards(axis)
    }
}

/// The polygon that cuts the segment from s to t nearest to s, with the parameter there.
pub(super) struct Nearest<'a> {
    pub(super) facets: &'a [Facet],
    pub(super) s: DVec3,
    pub(super) t: DVec3,
    pub(super) ray: Ray,
    pub(super) found: Option<(u32, f64)>,
}

impl Nearest<'_> {
    /// Whether one find is nearer than another; of two in one place, as the faces of a sheet are, the one whose front
    /// the ray meets.
    fn comes_before(&self, (polygon, at): (u32, f64), (other, best): (u32, f64)) -> bool {
        let meets_front = |polygon: u32| self.facets[polygon as usize].height_of(self.s) > 0.0;
        let together = (at - best).abs() <= ONE_PLACE;
        if together && meets_front(polygon) != meets_front(other) { meets_front(polygon) } else { at < best }
    }
}

/// Parameters of a ray closer than this are of one place: some roundings of a ray as long as the scene.
const ONE_PLACE: f64 = 1e-14;

impl Query for Nearest<'_> {
    #[inline(always)]
    fn select(&mut self, node: &Node) -> u32 {
        self.ray.select(node)
    }

    #[inline(always)]
    fn visit(&mut self, packet: &Packet, _: (&Node, usize)) -> ControlFlow<()> {
        for lane in bits(packet.triangles.candidates(&self.ray.segment()).possible.into()) {
            let polygon = packet.polygons[lane];
            let Some(at) = self.facets[polygon as usize].cut(self.s, self.t) else { continue };
            if self.found.is_none_or(|best| self.comes_before((polygon, at), best)) {
                self.found = Some((polygon, at));
                self.ray.end = at as f32 * (1.0 + 4.0 * f32::EPSILON);
            }
        }
        ControlFlow::Continue(())
    }

    #[inline(always)]
    fn backwards(&self, axis: usize) -> bool {
        self.ray.backwards(axis)
    }
}
