//! What of a face is seen from another: all, nothing, or a part, with what hides the rest.
//!
//! Where the plane of a convex body's side cuts the face that is looked from, the body has two outlines: the face is cut
//! along it, and each part looks on its own.

use super::hider::{Edge, Hider, MOST_EDGES, Scene, TooMuch};
use super::outline::Outline;
use super::piece::Piece;
use crate::polygon::Polygon;
use crate::visibility::blockers::Blockers;
use crate::visibility::solid::{Plane, Solid};
use glam::DVec3;
use smallvec::SmallVec;
use std::borrow::Cow;

/// What is seen of a target.
pub(super) enum Sight {
    Clear,
    Hidden,
    Partly(Vec<View>),
}

/// From a part of the outer polygon: what of the target hides behind what. Where there is nothing, nothing is hidden.
pub(super) struct View {
    pub eyes: Piece,
    pub target: Outline,
    pub hiders: Vec<Hider>,
    /// A length that no distance here is far above.
    pub reach: f64,
}

/// A body with more planes that cut the outer polygon is looked at side by side.
const MOST_CUTS: usize = 4;

/// Heights below this part of all lengths are rounding.
const ROUNDING: f64 = 1e-12;

/// What was found between two polygons, with the convex body that stands for it if it may be taken as a whole; mostly one.
type Bodies<'a> = SmallVec<[(u32, Option<&'a Solid>); 4]>;

/// Two polygons, and what may be between them.
pub(super) struct Look<'a> {
    pub blockers: &'a Blockers,
    /// The face that is looked from, by its number.
    pub face: usize,
    pub outer: &'a Polygon,
    pub target: &'a Polygon,
    pub found: &'a [u32],
}

impl Look<'_> {
    /// What is seen.
    pub fn sight(&self) -> Sight {
        let (a, b) = (self.outer, self.target);
        let reach = a.centroid().distance(b.centroid()) + a.diameter() + b.diameter();
        let bodies: Bodies<'_> = self.found.iter().map(|&id| (id, self.solid(id, reach))).collect();
        let (mut views, mut hidden) = (Vec::new(), true);
        // Mostly the whole is in front, and need not be copied.
        let whole = a.vertices().iter().all(|v| b.height_of(*v) >= 0.0);
        let parts = if whole { Cow::Borrowed(std::slice::from_ref(a)) } else { Cow::Owned(a.in_front_of(b)) };
        for part in parts.iter() {
            let mut target = Outline::new(b.vertices());
            target.keep_above(|v| part.height_of(v));
            if target.is_empty() {
                continue;
            }
            from_one_side(Piece::new(part.vertices()), &bodies, reach, |eyes| {
                let hiders = self.hiders(&bodies, &Scene::new(eyes.corners(), &target, reach));
                hidden &= matches!(hiders.as_slice(), [hider] if hider.hides_all());
                if !hiders.is_empty() {
                    views.push(View { eyes, target, hiders, reach });
                }
            });
        }
        match () {
            () if views.is_empty() => Sight::Clear,
            () if hidden => Sight::Hidden,
            () => Sight::Partly(views),
        }
    }

    /// The convex body that a polygon stands for, if it may be taken as a whole: it is in front of the target's plane, and
    /// the outer polygon is outside of it.
    fn solid(&self, id: u32, reach: f64) -> Option<&Solid> {
        let body = self.blockers.body[id as usize]?;
        let solid = self.blockers.solids[body as usize].as_ref()?;
        let in_front = || solid.vertices.iter().all(|v| self.target.height_of(*v) >= -ROUNDING * reach);
        (self.blockers.is_outside(self.face, self.outer, body) && in_front()).then_some(solid)
    }

    /// Whether the outer polygon is a side of the convex body that another stands for: it hides nothing from there.
    fn is_own(&self, id: u32) -> bool {
        let body = self.blockers.body[id as usize];
        body.is_some_and(|body| {
            self.blockers.is_convex[body as usize] && self.blockers.body_of_face[self.face] == Some(body)
        })
    }

    /// What hides something of the target; one that hides all is alone.
    fn hiders(&self, bodies: &Bodies<'_>, scene: &Scene<'_>) -> Vec<Hider> {
        let mut hiders = Vec::new();
        let mut polygons = Vec::new();
        for &(id, solid) in bodies.iter().filter(|(id, _)| !self.is_own(*id)) {
            let hiding = match solid {
                Some(solid) => Hider::of_solid(solid, scene),
                None => Err(TooMuch),
            };
            match hiding {
                Ok(None) => (),
                Ok(Some(hider)) if hider.hides_all() => return vec![hider],
                Ok(Some(hider)) => hiders.push(hider),
                Err(TooMuch) => polygons.extend(self.blockers.sides(id)),
            }
        }
        let screens: Vec<Screen> = polygons.into_iter().filter_map(|id| self.screen(id, scene)).collect();
        for screen in &screens {
            match screen.hider(&screens, scene) {
                Some(hider) if hider.hides_all() => return vec![hider],
                hider => hiders.extend(hider),
            }
        }
        hiders.sort_by_key(|hider| hider.body);
        hiders
    }

    /// What is in front of the target of a polygon that hides something.
    fn screen(&self, id: u32, scene: &Scene<'_>) -> Option<Screen> {
        let polygon = &self.blockers.polygons[id as usize];
        let body = self.blockers.body[id as usize];
        let one_sided = body.is_some_and(|body| self.blockers.is_clear_of(self.face, self.outer, body));
        let behind =
            |end: &Polygon| polygon.vertices().iter().all(|v| end.height_of(*v) <= ROUNDING * scene.reach);
        if behind(self.outer) || behind(self.target) {
            return None;
        }
        let plane = Plane { normal: polygon.normal(), offset: polygon.normal().dot(polygon.vertices()[0]) };
        let in_front = is_before(scene.eyes, &plane, scene.reach);
        if one_sided && in_front == Some(false) {
            return None;
        }
        let mut outline = Outline::new(polygon.vertices());
        outline.keep_above(|v| self.target.height_of(v));
        let is_whole = body.is_some_and(|body| one_sided && self.blockers.is_convex[body as usize]);
        (!outline.is_empty()).then_some(Screen {
            outline,
            plane,
            in_front,
            one_sided,
            body: body.filter(|_| is_whole),
        })
    }
}

/// The parts of a piece of the outer polygon from each of which bodies have one outline.
fn from_one_side(piece: Piece, bodies: &Bodies<'_>, reach: f64, mut visit: impl FnMut(Piece)) {
    let eyes = piece.corners();
    let across = |plane: &&Plane| is_before(eyes, plane, reach).is_none();
    let mut cuts: Vec<&Plane> = Vec::new();
    for solid in bodies.iter().filter_map(|(_, solid)| *solid) {
        let own = solid.planes.iter().filter(across);
        if own.clone().count() <= MOST_CUTS && cuts.len() <= MOST_CUTS {
            cuts.extend(own);
        }
    }
    if cuts.is_empty() {
        return visit(piece);
    }
    let mut parts = vec![piece];
    for plane in cuts {
        for k in 0..parts.len() {
            if let Some([above, below]) = parts[k].divided(|x| plane.height_of(x)) {
                parts[k] = above;
                parts.push(below);
            }
        }
    }
    parts.into_iter().for_each(&mut visit);
}

/// Whether all points are before a plane, or in it or behind; none where there are some on either side.
pub(super) fn is_before(points: &[DVec3], plane: &Plane, reach: f64) -> Option<bool> {
    let rounding = ROUNDING * reach;
    let heights = points.iter().map(|x| plane.height_of(*x));
    let (low, high) = heights.fold((0.0_f64, 0.0_f64), |(low, high), h| (low.min(h), high.max(h)));
    match (low < -rounding, high > rounding) {
        (true, true) => None,
        (_, before) => Some(before),
    }
}

/// A polygon that hides.
struct Screen {
    outline: Outline,
    plane: Plane,
    in_front: Option<bool>,
    one_sided: bool,
    body: Option<u32>,
}

impl Screen {
    /// What it hides, among others of which some share an edge with it.
    fn hider(&self, screens: &[Self], scene: &Scene<'_>) -> Option<Hider> {
        let edges = self.outline.edges().map(|(from, to)| {
            let inner =
                self.in_front.is_some() && screens.iter().any(|other| other.continues(self, from, to));
            if self.in_front == Some(false) {
                Edge { from: to, to: from, inner }
            } else {
                Edge { from, to, inner }
            }
        });
        let mut hider = match self.in_front {
            None => Hider::straddled(edges, self.plane),
            Some(_) => Hider::of_edges(edges, scene).ok()??,
        };
        (hider.one_sided, hider.body) = (self.one_sided, self.body);
        Some(hider)
    }

    /// Whether it goes on beyond an edge of another, seen from the same side.
    fn continues(&self, other: &Self, from: DVec3, to: DVec3) -> bool {
        let near = 1e-18 * from.distance_squared(to);
        self.in_front == other.in_front
            && self
                .outline
                .edges()
                .any(|(v, w)| v.distance_squared(to) <= near && w.distance_squared(from) <= near)
    }
}

// A polygon of four corners, cut by the plane of the target, has at most five, and all its edges find room.
const _: () = assert!(MOST_EDGES >= 5);
