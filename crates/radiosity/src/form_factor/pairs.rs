//! A_i F_ij = ∫_{P_i} ∫_{P_j} cosθ cosθ′ V / (π r²), each with its error: in full sight by formula, in part by clipping.

use super::exchange::{Side, Unoccluded, side_of};
use super::outline::Outline;
use super::partly::{Pair, Partly};
use super::shadow::Hider;
use crate::polygon::Polygon;
use crate::view_factors::Exchange;
use crate::visibility::blockers::Blockers;
use crate::visibility::{End, Visibility};
use glam::DVec3;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// The exchanges between the faces of a scene.
#[derive(Debug)]
pub struct Pairs<'a> {
    faces: &'a [Polygon],
    boxes: Vec<[DVec3; 2]>,
    area: f64,
    tolerance: f64,
    unoccluded: Unoccluded,
    blockers: Blockers,
    visibility: Visibility,
    ends: Vec<End>,
    rules: Pair,
    counts: [AtomicU64; 3],
}

/// How many pairs of faces that face each other are how.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// In full sight.
    pub clear: u64,
    /// Out of sight.
    pub hidden: u64,
    /// Neither, or not proved to be.
    pub partly: u64,
}

impl<'a> Pairs<'a> {
    /// For these faces, so that the errors of all exchanges of a face add up to less than `tolerance` times its area.
    pub fn new(faces: &'a [Polygon], tolerance: f64) -> Self {
        let blockers = Blockers::new(faces);
        let visibility = Visibility::new(&blockers.polygons);
        Self {
            faces,
            boxes: faces.iter().map(bounds).collect(),
            area: faces.iter().map(Polygon::area).sum(),
            tolerance,
            unoccluded: Unoccluded::new(faces, IN_SIGHT * tolerance),
            blockers,
            ends: faces.iter().map(|face| visibility.end(face)).collect(),
            visibility,
            rules: Pair::new(tolerance),
            counts: Default::default(),
        }
    }

    /// The pairs asked for so far.
    pub fn counts(&self) -> Counts {
        let [clear, hidden, partly] = self.counts.each_ref().map(|count| count.load(Relaxed));
        Counts { clear, hidden, partly }
    }

    /// The exchange of two faces, the same for (i, j) and (j, i).
    pub fn exchange(&self, i: usize, j: usize) -> Exchange {
        let whole = self.unoccluded.between(self.faces, i.min(j), i.max(j));
        if i == j || whole.value == 0.0 {
            return whole;
        }
        let (a, b) = (&self.ends[i], &self.ends[j]);
        let mut found = Vec::new();
        self.visibility.between(a, b, &mut found);
        if found.is_empty() {
            self.counts[0].fetch_add(1, Relaxed);
            return whole;
        }
        if found.iter().any(|&id| self.visibility.blocks(id, a, b)) {
            self.counts[1].fetch_add(1, Relaxed);
            return Exchange::default();
        }
        self.counts[2].fetch_add(1, Relaxed);
        let areas = [i, j].map(|k| self.faces[k].area());
        let smaller = areas[0] < areas[1] || (areas[0] == areas[1] && i < j);
        let (outer, target) = if smaller { (i, j) } else { (j, i) };
        self.partly(outer, target, whole, &found)
    }

    fn partly(&self, outer: usize, target: usize, whole: Exchange, found: &[u32]) -> Exchange {
        let (a, b) = (&self.faces[outer], &self.faces[target]);
        let scale = whole.value.max(0.1 * a.area() * b.area() / self.area);
        let tolerance = PARTLY * self.tolerance * scale;
        let mut hidden = Exchange::default();
        for part in a.in_front_of(b) {
            let mut aim = Outline::new(b.vertices());
            aim.keep_above(|v| part.height_of(v));
            if aim.is_empty() {
                continue;
            }
            let hiders = self.hiders(outer, &part, b, found);
            if hiders.is_empty() {
                continue;
            }
            let partly = Partly {
                outer: &part,
                target: aim,
                hiders: &hiders,
                whole: whole.value / a.area(),
                rules: &self.rules,
            };
            let Exchange { value, error } = partly.hidden(tolerance);
            hidden.value += value;
            hidden.error += error;
        }
        let rest = whole.value - hidden.value;
        // What rounding leaves of a whole that is hidden is nothing: files of sparse matrices are for zeros.
        let value = if rest > ROUNDING * whole.value { rest } else { 0.0 };
        Exchange { value, error: (whole.error + hidden.error).min(whole.value) }
    }

    /// What hides something of `target` from points of `outer`, cut off at the planes of both.
    fn hiders(&self, face: usize, outer: &Polygon, target: &Polygon, found: &[u32]) -> Vec<Hider> {
        let mut hiders: Vec<Hider> = found
            .iter()
            .filter_map(|&id| {
                let polygon = &self.blockers.polygons[id as usize];
                let body = self.blockers.body[id as usize];
                let one_sided = body.is_some_and(|body| self.is_outside(face, body));
                let side = side_of(polygon, outer);
                if side == Side::Behind && one_sided {
                    return None;
                }
                let mut outline = Outline::new(polygon.vertices());
                outline.keep_above(|v| outer.height_of(v));
                if !outline.is_empty() {
                    outline.keep_above(|v| target.height_of(v));
                }
                let normal = polygon.normal();
                (!outline.is_empty()).then(|| Hider {
                    outline,
                    normal,
                    offset: normal.dot(polygon.vertices()[0]),
                    in_front: side == Side::Before,
                    straddled: side == Side::Across,
                    one_sided,
                    body: body.filter(|&body| one_sided && self.blockers.is_convex[body as usize]),
                })
            })
            .collect();
        hiders.sort_by_key(|hider| hider.body);
        hiders
    }

    /// Whether no point of a face is in a body.
    fn is_outside(&self, face: usize, body: u32) -> bool {
        let ([low, high], [least, most]) = (self.boxes[face], self.blockers.bodies[body as usize]);
        self.blockers.body_of_face[face] == Some(body)
            || (0..3).any(|k| low[k] >= most[k] || high[k] <= least[k])
    }
}

/// How many times the tolerance exchanges in full sight may be said to err by, relative to themselves, and those in part
/// relative to what they were in full sight.
const IN_SIGHT: f64 = 0.1;
const PARTLY: f64 = 0.8;

/// A difference of two sums of some hundred terms is of rounding below this part of them.
const ROUNDING: f64 = 1e-13;

fn bounds(polygon: &Polygon) -> [DVec3; 2] {
    let start = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    polygon.vertices().iter().fold(start, |[low, high], v| [low.min(*v), high.max(*v)])
}
