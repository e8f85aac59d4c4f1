//! Segments from about one place to about another, which go through the tree together: what no one of them can meet is passed
//! by once for all.
//!
//! Between starts in [o₋, o₊] and directions in [d₋, d₊] of one sign, all enter the slab of a box at a parameter of at least
//! min (near − o)/d, and leave it at one of at most max (far − o)/d, over the corners of these intervals.

use super::bvh::{Node, Query};
use super::facet::{Facet, Plane};
use super::packet::{Packet, Segments, Triangles, cross, dot};
use super::ray::Ray;
use glam::{DVec3, Vec3};
use std::ops::ControlFlow;
use wide::f32x8;

/// The most segments of a beam: eight times eight.
pub(super) const MOST: usize = 64;

/// The interval of a quantity over all segments, axis by axis.
#[derive(Clone, Copy)]
struct Interval {
    low: Vec3,
    high: Vec3,
}

impl Interval {
    const EMPTY: Self = Self { low: Vec3::INFINITY, high: Vec3::NEG_INFINITY };

    fn with(self, v: Vec3) -> Self {
        Self { low: self.low.min(v), high: self.high.max(v) }
    }

    fn union(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }
}

/// What is known of the parameters at which segments go through planes across one axis, along which all go the same way.
#[derive(Clone, Copy)]
struct Slab {
    /// Where in [`Node::bounds`] they enter, and where they leave.
    near: usize,
    far: usize,
    /// 1, or −1 where they go down.
    sign: f32x8,
    /// What is taken from the near and from the far plane.
    starts: [f32x8; 2],
    /// 1/|d| of the fastest and of the slowest.
    inverse: [f32x8; 2],
}

/// Segments on their way through the tree.
pub(super) struct Beam<'a> {
    facets: &'a [Facet],
    ends: [[DVec3; 2]; MOST],
    /// Eight to a packet.
    segments: [Segments; MOST / 8],
    packets: usize,
    /// A bit for each segment that nothing was found to cut so far, of those that go anywhere.
    open: u64,
    hidden: u64,
    /// The box around all, wide enough for f32.
    low: [f32x8; 3],
    high: [f32x8; 3],
    slabs: [Option<Slab>; 3],
    /// The middles of the boxes around the starts and around the ends, and half of their sides.
    hulls: [[[f32x8; 3]; 2]; 2],
    end_margin: f32x8,
    /// The same for volumes, in a triangle's size.
    edge_margin: f32x8,
    /// Tests of eight made so far, and how many are worth making together.
    work: usize,
    patience: usize,
}

/// So many tests of eight triangles a segment would take by itself, boxes and all; a few more where there are many triangles.
const ALONE: usize = 12;

impl<'a> Beam<'a> {
    /// Of up to [`MOST`] segments.
    pub(super) fn new(facets: &'a [Facet], segments: impl Iterator<Item = [DVec3; 2]>) -> Self {
        let mut beam = Self::nowhere(facets);
        let (mut starts, mut ends, mut directions) = (Interval::EMPTY, Interval::EMPTY, Interval::EMPTY);
        let mut lanes = [[[f32::NAN; 8]; 8]; MOST / 8];
        let mut margin = 0.0_f32;
        for (k, [s, t]) in segments.take(MOST).enumerate() {
            beam.ends[k] = [s, t];
            beam.packets = k / 8 + 1;
            let Some(lane) = Ray::lane(s, t) else { continue };
            beam.open |= 1 << k;
            let [origin, direction, [_, end_margin, _]] = lane;
            for (to, from) in lanes[k / 8].iter_mut().zip(lane.as_flattened()) {
                to[k % 8] = *from;
            }
            starts = starts.with(origin.into());
            ends = ends.with(t.as_vec3());
            directions = directions.with(direction.into());
            margin = margin.max(end_margin);
        }
        for (packet, lanes) in beam.segments.iter_mut().zip(lanes) {
            let [ox, oy, oz, dx, dy, dz, side_margin, end_margin] = lanes.map(f32x8::new);
            let (origin, direction) = ([ox, oy, oz], [dx, dy, dz]);
            *packet = Segments { origin, direction, end: f32x8::ONE, side_margin, end_margin };
        }
        if beam.open != 0 {
            beam.surround(starts, ends, directions, margin);
        }
        beam
    }

    fn nowhere(facets: &'a [Facet]) -> Self {
        let nan = [f32x8::splat(f32::NAN); 3];
        let none =
            Segments { origin: nan, direction: nan, end: nan[0], side_margin: nan[0], end_margin: nan[0] };
        Self {
            facets,
            ends: [[DVec3::ZERO; 2]; MOST],
            segments: [none; MOST / 8],
            packets: 0,
            open: 0,
            hidden: 0,
            low: nan,
            high: nan,
            slabs: [None; 3],
            hulls: [[nan; 2]; 2],
            end_margin: nan[0],
            edge_margin: nan[0],
            work: 0,
            patience: 0,
        }
    }

    fn surround(&mut self, starts: Interval, ends: Interval, directions: Interval, margin: f32) {
        // The margin of a ray is 256 roundoffs of its reach: a sixteenth is more than what is lost in a difference of coordinates.
        let pad = margin / 16.0;
        let all = starts.union(ends);
        for k in 0..3 {
            self.low[k] = f32x8::splat(all.low[k] - pad);
            self.high[k] = f32x8::splat(all.high[k] + pad);
            self.slabs[k] =
                Slab::new(k, (starts.low[k], starts.high[k]), (directions.low[k], directions.high[k]), pad);
        }
        self.hulls = [starts, ends].map(|hull| {
            let (middle, half) = (0.5 * (hull.low + hull.high), 0.5 * (hull.high - hull.low));
            [middle, half].map(|v| v.to_array().map(f32x8::splat))
        });
        self.end_margin = f32x8::splat(margin);
        // As a ray's, with the distance of ends from a corner, 1.8 at most in a scene and as much more as they are outside, for the
        // length of its direction; and as much again for the corner that is a sum.
        let far = ends.low.abs().max(ends.high.abs()).max_element();
        self.edge_margin = f32x8::splat(2.0 * margin * (1.0 + far));
        self.patience = ALONE * self.open.count_ones() as usize;
    }

    /// Whether nothing cuts a segment, once the tree has been walked; `None` where the segments have not enough in common for that
    /// to be found together.
    pub(super) fn is_clear(&self, k: usize) -> Option<bool> {
        let hidden = self.hidden >> k & 1 == 1;
        let open = self.open >> k & 1 == 1;
        (hidden || !open || self.work <= self.patience).then_some(!hidden)
    }

    /// A bit for each triangle that some segment may meet, and for each that surely all do.
    ///
    /// A line from s to t passes all edges p → p + g of a triangle on one side where the volumes (s − p)·((t − p) × g) have one
    /// sign. With s and t in boxes each is known up to what half of their sides make of it.
    #[inline(always)]
    fn sort(&self, triangles: &Triangles) -> [u32; 2] {
        let ([e, f], a) = (&triangles.edges, &triangles.corner);
        let size = triangles.size();
        let [starts, ends] = self.heights(triangles, size * size * self.end_margin);
        let same_side = (starts[1].simd_gt(f32x8::ZERO) & ends[1].simd_gt(f32x8::ZERO))
            | (starts[0].simd_lt(f32x8::ZERO) & ends[0].simd_lt(f32x8::ZERO));
        let parted = (starts[1].simd_gt(f32x8::ZERO) & ends[0].simd_lt(f32x8::ZERO))
            | (starts[0].simd_lt(f32x8::ZERO) & ends[1].simd_gt(f32x8::ZERO));
        let margin = size * self.edge_margin;
        let (b, g): ([f32x8; 3], [f32x8; 3]) =
            (std::array::from_fn(|k| a[k] + e[k]), std::array::from_fn(|k| f[k] - e[k]));
        let turned = f.map(|x| -x);
        let edges = [self.volume(a, e, margin), self.volume(&b, &g, margin), self.volume(a, &turned, margin)];
        let [ab, bc, ca] = edges.map(|[volume, spread]| [volume.simd_gt(spread), volume.simd_lt(-spread)]);
        let (any_left, all_left) = (ab[0] | bc[0] | ca[0], ab[0] & bc[0] & ca[0]);
        let (any_right, all_right) = (ab[1] | bc[1] | ca[1], ab[1] & bc[1] & ca[1]);
        let used = a[0].simd_eq(a[0]);
        let missed = same_side | (any_left & any_right);
        [used.to_bitmask() & !missed.to_bitmask(), (parted & (all_left | all_right)).to_bitmask()]
    }

    /// The greatest and the least height of starts and of ends over the planes of triangles.
    #[inline(always)]
    fn heights(&self, triangles: &Triangles, margin: f32x8) -> [[f32x8; 2]; 2] {
        let [e, f] = &triangles.edges;
        let normal = cross(e, f);
        self.hulls.map(|[middle, half]| {
            let from: [f32x8; 3] = std::array::from_fn(|k| middle[k] - triangles.corner[k]);
            let height = dot(&normal, &from);
            let spread = dot(&normal.map(f32x8::abs), &half) + margin;
            [height + spread, height - spread]
        })
    }

    /// (s − p)·((t − p) × g) in the middle of starts and ends, and how far it is from that at most.
    #[inline(always)]
    fn volume(&self, p: &[f32x8; 3], g: &[f32x8; 3], margin: f32x8) -> [f32x8; 2] {
        let [[start, near], [end, far]] = self.hulls;
        let s: [f32x8; 3] = std::array::from_fn(|k| start[k] - p[k]);
        let t: [f32x8; 3] = std::array::from_fn(|k| end[k] - p[k]);
        let (across, around) = (cross(&t, g), cross(g, &s));
        let [gx, gy, gz] = g.map(f32x8::abs);
        let both = [
            far[1].mul_add(gz, far[2] * gy),
            far[2].mul_add(gx, far[0] * gz),
            far[0].mul_add(gy, far[1] * gx),
        ];
        let spread =
            dot(&near, &across.map(f32x8::abs)) + dot(&far, &around.map(f32x8::abs)) + dot(&near, &both);
        [dot(&s, &across), spread + margin]
    }

    /// Looks which of the open segments a polygon hides, by one of its triangles.
    fn meet(&mut self, triangle: &Triangles, plane: &Plane, polygon: u32) {
        self.work += self.packets;
        for (packet, shift) in self.segments[..self.packets].iter().zip((0..).step_by(8)) {
            let open = (self.open >> shift) as u32 & 0xff;
            if open == 0 {
                continue;
            }
            let candidates = triangle.candidates(packet);
            let mut hidden = candidates.certain & open;
            let mut doubtful = candidates.possible & open & !hidden;
            while doubtful != 0 {
                let lane = doubtful.trailing_zeros();
                doubtful &= doubtful - 1;
                let [s, t] = self.ends[(shift + lane) as usize];
                let cut = || self.facets[polygon as usize].cut(s, t).is_some();
                hidden |= u32::from(plane.parts(s, t).is_some() && cut()) << lane;
            }
            self.hidden |= u64::from(hidden) << shift;
        }
        self.open &= !self.hidden;
    }
}

impl Slab {
    /// None where the segments do not all go the same way along the axis.
    fn new(axis: usize, (low, high): (f32, f32), (slow, fast): (f32, f32), pad: f32) -> Option<Self> {
        let up = slow > 0.0;
        if slow <= SLOWEST && fast >= -SLOWEST {
            return None;
        }
        let (near, far) = if up { (axis, axis + 3) } else { (axis + 3, axis) };
        let (sign, starts) =
            if up { (1.0, [high + pad, low - pad]) } else { (-1.0, [-low + pad, -high - pad]) };
        let speeds = if up { [fast, slow] } else { [-slow, -fast] };
        Some(Self {
            near,
            far,
            sign: f32x8::splat(sign),
            starts: starts.map(f32x8::splat),
            inverse: speeds.map(|speed| f32x8::splat(speed.recip())),
        })
    }
}

/// What moves less along an axis does not move: 1 over it is far from infinite.
const SLOWEST: f32 = 1e-20;

impl Query for Beam<'_> {
    #[inline(always)]
    fn select(&self, node: &Node) -> u32 {
        let mut inside = f32x8::ZERO.simd_eq(f32x8::ZERO);
        let (mut enters, mut leaves) = (f32x8::ZERO, f32x8::ONE);
        for k in 0..3 {
            inside &= node.bounds[k].simd_le(self.high[k]) & node.bounds[k + 3].simd_ge(self.low[k]);
            if let Some(slab) = &self.slabs[k] {
                let near = node.bounds[slab.near].mul_sub(slab.sign, slab.starts[0]);
                let far = node.bounds[slab.far].mul_sub(slab.sign, slab.starts[1]);
                let [fast, slow] = slab.inverse;
                enters = enters.fast_max((near * fast).fast_min(near * slow));
                leaves = leaves.fast_min((far * fast).fast_max(far * slow));
            }
        }
        (inside & enters.simd_le(leaves)).to_bitmask()
    }

    #[inline(always)]
    fn visit(&mut self, packet: &Packet) -> ControlFlow<()> {
        let [mut met, all] = self.sort(&packet.triangles);
        if all != 0 {
            self.hidden |= self.open;
            self.open = 0;
        }
        while met != 0 && self.open != 0 {
            let lane = met.trailing_zeros() as usize;
            met &= met - 1;
            self.meet(&packet.triangles.lane(lane), &packet.planes[lane], packet.polygons[lane]);
        }
        self.work += 1;
        if self.open == 0 || self.work > self.patience {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}
