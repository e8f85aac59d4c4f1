//! Segments from about one place to about another, which go through the tree together: what no one of them can meet is passed
//! by once for all.
//!
//! With starts in a box [s₋, s₊] and ends in another [t₋, t₊], all are between s₋ + τ(t₋ − s₋) and s₊ + τ(t₊ − s₊) at τ, axis by axis.
//! A box that some of them meet is at some τ below the second line and above the first along all axes: six bounds of τ, each linear
//! as those of one ray are.

use super::bvh::{LEAF, Node, Query};
use super::facet::{Facet, Frame, Plane};
use super::packet::{BOX_MARGIN, MARGIN, Packet, SLOWEST, Segments, Triangles, cross, dot};
use super::ray::{bits, blocker};
use glam::{DVec3, Vec3};
use std::ops::ControlFlow;
use wide::{f32x8, f64x8};

/// The most segments of a beam: eight times eight.
pub(super) const MOST: usize = 64;

/// The box around points that are eight side by side, axis by axis.
#[derive(Clone, Copy)]
struct Hull {
    low: [f32x8; 3],
    high: [f32x8; 3],
}

impl Hull {
    const EMPTY: Self =
        Self { low: [f32x8::new([f32::INFINITY; 8]); 3], high: [f32x8::new([f32::NEG_INFINITY; 8]); 3] };

    /// With eight points more, of which those count that `used` says.
    #[inline(always)]
    fn add(&mut self, points: &[f32x8; 3], used: f32x8) {
        for ((low, high), point) in self.low.iter_mut().zip(&mut self.high).zip(points) {
            *low = low.fast_min(used.select(*point, *low));
            *high = high.fast_max(used.select(*point, *high));
        }
    }

    fn low(&self) -> Vec3 {
        self.low.map(|lanes| lanes.to_array().into_iter().fold(f32::INFINITY, f32::min)).into()
    }

    fn high(&self) -> Vec3 {
        self.high.map(|lanes| lanes.to_array().into_iter().fold(f32::NEG_INFINITY, f32::max)).into()
    }
}

/// Up to eight segments between points in metres; an unused lane is NaN.
///
/// All of eight are carried to the scene's unit at once: point by point a beam took a third longer in a small scene.
#[inline(always)]
fn side_by_side(frame: &Frame, ends: &[[DVec3; 2]]) -> Segments {
    let mut padded = [[DVec3::NAN; 2]; 8];
    let eight: &[[DVec3; 2]; 8] = ends.first_chunk().unwrap_or_else(|| {
        padded[..ends.len()].copy_from_slice(ends);
        &padded
    });
    let along = |end: usize, axis: usize| frame.along(axis, std::array::from_fn(|k| eight[k][end][axis]));
    let single = |lanes: f64x8| f32x8::new(lanes.to_array().map(|x| x as f32));
    let (mut origin, mut direction) = ([f32x8::ZERO; 3], [f32x8::ZERO; 3]);
    for axis in 0..3 {
        let (s, t) = (along(0, axis), along(1, axis));
        (origin[axis], direction[axis]) = (single(s), single(t - s));
    }
    Segments::new(origin, direction)
}

/// One of the six bounds of the parameter at which segments are in a box: (plane − start)/direction of one of the two lines.
#[derive(Clone, Copy)]
struct Bound {
    /// Where in [`Node::bounds`] the plane is.
    plane: usize,
    inverse: f32x8,
    /// What is taken from plane·inverse.
    start: f32x8,
    /// Whether it is a least one.
    enters: bool,
}

/// What boxes are tried by of eight segments, axis by axis: plane·inverse − start, give or take a pad, is the parameter at a plane.
#[derive(Clone, Copy)]
struct Slabs {
    inverse: [f32x8; 3],
    start: [f32x8; 3],
    pad: [f32x8; 3],
}

/// Eight segments side by side.
pub(super) struct Eight {
    segments: Segments,
    slabs: Slabs,
}

/// Segments on their way through the tree.
pub(super) struct Beam<'a> {
    facets: &'a [Facet],
    frame: &'a Frame,
    /// In metres.
    ends: &'a [[DVec3; 2]],
    eights: &'a [Eight],
    /// A bit for each segment that nothing was found to cut so far, of those that go anywhere.
    open: u64,
    hidden: u64,
    bounds: [Bound; 6],
    /// The middles of the boxes around the starts and around the ends, and half of their sides.
    hulls: [[[f32x8; 3]; 2]; 2],
    end_margin: f32x8,
    /// The same for volumes, in a triangle's size.
    edge_margin: f32x8,
    nodes: usize,
    /// Tests of eight made so far, and how many are worth making together.
    work: usize,
    patience: usize,
}

/// The starts and the ends of a beam spread by no more than this part of the way between them.
const NARROW: f32 = 1.0;

/// So many tests of eight a segment would take by itself, and little more.
const ALONE: usize = 12;

/// After so many nodes boxes are tried by each segment too: the beam is wide, or there is much in its way that is small.
const WIDE: usize = 4;

/// So few segments are not worth a look at what all of them do.
const FEW: u32 = 8;

impl<'a> Beam<'a> {
    /// Of up to [`MOST`] segments between points in metres; `None` where they do not go from about one place to about another.
    ///
    /// `eights` is room for them, taken once for many beams: a beam is made in less time than its kilobytes are moved.
    pub(super) fn new(
        facets: &'a [Facet],
        frame: &'a Frame,
        ends: &'a [[DVec3; 2]],
        eights: &'a mut Vec<Eight>,
    ) -> Option<Self> {
        let (mut open, mut margin) = (0, f32x8::ZERO);
        let (mut starts, mut stops) = (Hull::EMPTY, Hull::EMPTY);
        eights.clear();
        for (ends, k) in ends.chunks(8).zip(0..) {
            let segments = side_by_side(frame, ends);
            let Segments { origin, direction, end_margin, .. } = &segments;
            let square = dot(direction, direction);
            let used = square.simd_gt(f32x8::ZERO) & square.simd_lt(f32x8::splat(f32::INFINITY));
            open |= u64::from(used.to_bitmask()) << (8 * k);
            margin = margin.fast_max(used.select(*end_margin, f32x8::ZERO));
            starts.add(origin, used);
            stops.add(&std::array::from_fn(|axis| origin[axis] + direction[axis]), used);
            eights.push(Eight { slabs: Slabs::new(&segments), segments });
        }
        let [[low, high], [far_low, far_high]] = [starts, stops].map(|hull| [hull.low(), hull.high()]);
        if (high - low + far_high - far_low).length() > NARROW * (far_low + far_high - low - high).length() {
            return None;
        }
        let margin = margin.to_array().into_iter().fold(0.0, f32::max);
        let far = far_low.abs().max(far_high.abs()).max_element();
        // The margin of a ray is 256 roundoffs of its reach: a sixteenth is more than what is lost in a bound.
        let pad = margin / 16.0 * (1.0 + far);
        let bounds = std::array::from_fn(|k| match k {
            0..3 => Bound::new(k + 3, low[k] - pad, far_low[k] - pad, false),
            _ => Bound::new(k - 3, high[k - 3] + pad, far_high[k - 3] + pad, true),
        });
        let hulls = [[low, high], [far_low, far_high]].map(|[low, high]| {
            [0.5 * (low + high), 0.5 * (high - low)].map(|v| v.to_array().map(f32x8::splat))
        });
        Some(Self {
            facets,
            frame,
            ends,
            eights,
            open,
            hidden: 0,
            bounds,
            hulls,
            end_margin: f32x8::splat(margin),
            // As a ray's, with the distance of ends from a corner, 1.8 at most in a scene and as much more as they are outside, for
            // the length of its direction; and as much again for the corner that is a sum.
            edge_margin: f32x8::splat(2.0 * margin * (1.0 + far)),
            nodes: 0,
            work: 0,
            patience: ALONE * open.count_ones() as usize,
        })
    }

    /// A bit for each segment that is cut, once the tree has been walked.
    pub(super) fn hidden(&self) -> u64 {
        self.hidden
    }

    /// A bit for each segment of which that is not known: they have not enough in common for it to be found together.
    pub(super) fn unknown(&self) -> u64 {
        if self.work <= self.patience { 0 } else { self.open }
    }

    /// Where a segment starts and where it ends.
    #[inline(always)]
    fn ends(&self, k: usize) -> [DVec3; 2] {
        self.ends[k].map(|v| self.frame.point(v))
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

    /// A bit for each open segment that may meet a box of a node.
    #[inline(always)]
    fn inside(&self, (node, lane): (&Node, usize)) -> u64 {
        let planes: [f32x8; 6] = std::array::from_fn(|k| f32x8::splat(node.bounds[k].to_array()[lane]));
        let of_eight = |slabs: &Slabs| {
            let (mut enters, mut leaves) = (f32x8::ZERO, f32x8::ONE);
            for k in 0..3 {
                let [a, b] =
                    [planes[k], planes[k + 3]].map(|plane| plane.mul_sub(slabs.inverse[k], slabs.start[k]));
                enters = enters.fast_max(a.fast_min(b) - slabs.pad[k]);
                leaves = leaves.fast_min(a.fast_max(b) + slabs.pad[k]);
            }
            u64::from(enters.simd_le(leaves).to_bitmask())
        };
        let found = self
            .eights
            .iter()
            .map(|eight| of_eight(&eight.slabs))
            .rev()
            .fold(0, |bits, eight| bits << 8 | eight);
        found & self.open
    }

    /// Whether a plane has all starts on it, or all ends: those of the patches that light goes between have, and cut nothing.
    #[inline(always)]
    fn ends_on(&self, plane: &Plane) -> bool {
        [0, 1].iter().any(|end| self.ends.iter().all(|ends| plane.is_at(self.frame.point(ends[*end]))))
    }

    /// Looks which of some segments a packet hides, segment by segment.
    fn meet_each(&mut self, packet: &Packet, segments: u64) {
        self.work += segments.count_ones() as usize;
        for k in bits(segments) {
            let segment = self.eights[k / 8].segments.lane(k % 8);
            let hidden = blocker(packet, &segment, self.facets, self.ends(k)).is_some();
            self.hidden |= u64::from(hidden) << k;
        }
        self.open &= !self.hidden;
    }

    /// Looks which of the open segments a triangle of a packet hides.
    fn meet_all(&mut self, packet: &Packet, lane: usize) {
        let triangle = packet.triangles.lane(lane);
        let (plane, facet) = (&packet.planes[lane], &self.facets[packet.polygons[lane] as usize]);
        self.work += self.eights.len();
        for (Eight { segments, .. }, shift) in self.eights.iter().zip((0..).step_by(8)) {
            let open = (self.open >> shift) as u32 & 0xff;
            if open == 0 {
                continue;
            }
            let candidates = triangle.candidates(segments);
            let mut hidden = candidates.certain & open;
            for lane in bits(u64::from(candidates.possible & open & !hidden)) {
                let [s, t] = self.ends(shift + lane);
                let cuts = plane.parts(s, t).is_some() && facet.cut(s, t).is_some();
                hidden |= u32::from(cuts) << lane;
            }
            self.hidden |= u64::from(hidden) << shift;
        }
        self.open &= !self.hidden;
    }
}

impl Slabs {
    fn new(segments: &Segments) -> Self {
        let inverse = segments.direction.map(|way| {
            let sign = way & f32x8::splat(-0.0);
            f32x8::ONE / (way.abs().fast_max(f32x8::splat(SLOWEST)) | sign)
        });
        let part = f32x8::splat(BOX_MARGIN / MARGIN);
        let pad = inverse.map(|inverse| inverse.abs() * segments.end_margin * part);
        Self { inverse, start: std::array::from_fn(|k| segments.origin[k] * inverse[k]), pad }
    }
}

impl Bound {
    /// Of the line from start to end, above a plane or below it.
    fn new(plane: usize, start: f32, end: f32, above: bool) -> Self {
        let way = end - start;
        let inverse = way.abs().max(SLOWEST).copysign(way).recip();
        let [inverse_8, start] = [inverse, start * inverse].map(f32x8::splat);
        Self { plane, inverse: inverse_8, start, enters: above == (inverse > 0.0) }
    }
}

impl Query for Beam<'_> {
    #[inline(always)]
    fn select(&mut self, node: &Node) -> u32 {
        let (mut enters, mut leaves) = (f32x8::ZERO, f32x8::ONE);
        for bound in &self.bounds {
            let at = node.bounds[bound.plane].mul_sub(bound.inverse, bound.start);
            if bound.enters {
                enters = enters.fast_max(at);
            } else {
                leaves = leaves.fast_min(at);
            }
        }
        let mut selected = enters.simd_le(leaves).to_bitmask();
        self.nodes += 1;
        self.work += 1;
        if self.work > self.patience {
            return 0;
        }
        if self.nodes > WIDE {
            for lane in bits(u64::from(selected)).filter(|&lane| node.children[lane] & LEAF == 0) {
                self.work += 1;
                selected &= !(u32::from(self.inside((node, lane)) == 0) << lane);
            }
        }
        selected
    }

    #[inline(always)]
    fn visit(&mut self, packet: &Packet, within: (&Node, usize)) -> ControlFlow<()> {
        self.work += 1;
        let inside = self.inside(within);
        if inside.count_ones() <= FEW {
            self.meet_each(packet, inside);
        } else {
            let [met, all] = self.sort(&packet.triangles);
            let in_the_way = |&lane: &usize| !self.ends_on(&packet.planes[lane]);
            if all != 0 {
                self.hidden |= self.open;
                self.open = 0;
                return ControlFlow::Break(());
            }
            let met = bits(met.into()).filter(in_the_way).fold(0_u32, |met, lane| met | 1 << lane);
            if inside.count_ones() <= met.count_ones() * self.eights.len() as u32 {
                self.meet_each(packet, inside);
            } else {
                bits(u64::from(met)).for_each(|lane| self.meet_all(packet, lane));
            }
        }
        if self.open == 0 || self.work > self.patience {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}
