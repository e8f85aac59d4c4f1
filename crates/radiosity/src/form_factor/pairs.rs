//! A_i F_ij = ∫_{P_i} ∫_{P_j} cosθ cosθ′ V / (π r²), each with its error: in full sight by formula, in part by clipping.

use super::exchange::{Facing, Unoccluded};
use super::partly::Partly;
use super::rules::Pair;
use super::shadow::Room;
use super::sight::{Look, Sight, View};
use crate::polygon::Polygon;
use crate::view_factors::Exchange;
use crate::visibility::blockers::Blockers;
use crate::visibility::screens::{Found, Screens};
use crate::visibility::{Count, End};

/// The exchanges between the faces of a scene.
#[derive(Debug)]
pub struct Pairs<'a> {
    faces: &'a [Polygon],
    area: f64,
    tolerance: f64,
    unoccluded: Unoccluded,
    blockers: Blockers,
    screens: Screens,
    ends: Vec<End>,
    rules: Pair,
    counts: [Count; 3],
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
        let screens = screens(&blockers);
        Self {
            faces,
            area: faces.iter().map(Polygon::area).sum(),
            tolerance,
            unoccluded: Unoccluded::new(faces, IN_SIGHT * tolerance),
            blockers,
            ends: faces.iter().map(|face| screens.end(face)).collect(),
            screens,
            rules: Pair::new(tolerance),
            counts: Default::default(),
        }
    }

    /// The pairs asked for so far.
    pub fn counts(&self) -> Counts {
        let [clear, hidden, partly] = self.counts.each_ref().map(Count::total);
        Counts { clear, hidden, partly }
    }

    /// The exchange of two faces, the same for (i, j) and (j, i).
    pub fn exchange(&self, i: usize, j: usize) -> Exchange {
        let (i, j) = (i.min(j), i.max(j));
        let facing = Facing::new(&self.faces[i], &self.faces[j]).filter(|_| i != j);
        let Some(facing) = facing else { return Exchange::default() };
        let areas = [i, j].map(|k| self.faces[k].area());
        let (outer, target) = if areas[0] <= areas[1] { (i, j) } else { (j, i) };
        let mut found = Found::new();
        let sight = self.sight(outer, target, &mut found);
        let whole = || self.unoccluded.facing(self.faces, i, j, facing);
        let (kind, exchange) = match sight {
            Sight::Clear => (0, whole()),
            Sight::Hidden => (1, Exchange::default()),
            Sight::Partly(views) => (2, self.partly(outer, target, whole(), &views)),
        };
        self.counts[kind].add(1);
        exchange
    }

    /// What of a face is seen from another.
    fn sight(&self, outer: usize, target: usize, found: &mut Found) -> Sight {
        let ends = [outer, target].map(|k| &self.ends[k]);
        self.screens.between(ends, found);
        let look = |found: &[u32]| {
            let (blockers, outer_polygon) = (&self.blockers, &self.faces[outer]);
            Look { blockers, face: outer, outer: outer_polygon, target: &self.faces[target], found }.sight()
        };
        if found.is_empty() {
            return Sight::Clear;
        }
        match look(found) {
            // Few bodies are seen past only by a plane that touches no ridge of theirs.
            Sight::Partly(_) if self.screens.narrow(ends, found) => look(found),
            sight => sight,
        }
    }

    fn partly(&self, outer: usize, target: usize, whole: Exchange, views: &[View]) -> Exchange {
        let (a, b) = (&self.faces[outer], &self.faces[target]);
        let scale = whole.value.max(0.1 * a.area() * b.area() / self.area);
        let tolerance = PARTLY * self.tolerance * scale / a.area();
        let mut room = Room::default();
        let mut hidden = Exchange::default();
        for view in views {
            let partly = Partly {
                outer: view.eyes,
                normal: a.normal(),
                target: view.target,
                hiders: &view.hiders,
                reach: view.reach,
                whole: whole.value / a.area(),
                rules: &self.rules,
            };
            let Exchange { value, error } = partly.hidden(tolerance * view.eyes.area(), &mut room);
            hidden.value += value;
            hidden.error += error;
        }
        let rest = whole.value - hidden.value;
        // What rounding leaves of a whole that is hidden is nothing: files of sparse matrices are for zeros.
        let value = if rest > ROUNDING * whole.value { rest } else { 0.0 };
        Exchange { value, error: (whole.error + hidden.error).min(whole.value) }
    }
}

/// How many times the tolerance exchanges in full sight may be said to err by, relative to themselves, and those in part
/// relative to what they were in full sight.
const IN_SIGHT: f64 = 0.1;
const PARTLY: f64 = 0.8;

/// A difference of two sums of some hundred terms is of rounding below this part of them.
const ROUNDING: f64 = 1e-13;

/// The polygons that hide, with one side of each convex body standing for all.
pub(super) fn screens(blockers: &Blockers) -> Screens {
    let solid = |k: u32| blockers.body[k as usize].filter(|&body| blockers.solids[body as usize].is_some());
    let mut first = vec![None; blockers.solids.len()];
    let stands_for: Vec<u32> = (0..blockers.polygons.len() as u32)
        .map(|k| solid(k).map_or(k, |body| *first[body as usize].get_or_insert(k)))
        .collect();
    Screens::new(&blockers.polygons, &stands_for, |k| {
        let solid = solid(k).and_then(|body| blockers.solids[body as usize].as_ref());
        solid.map_or(&[], |solid| solid.vertices.as_slice())
    })
}
