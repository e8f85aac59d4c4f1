//! F(x, P) = ∫_P K(x, y) dy from the points x of one face to parts P of the others: what hides them is clipped away.
//!
//! Which polygons can hide something of another face is asked once for all points of a face. From a point each of them hides
//! what is between the planes through the point and its edges; a part keeps those that reach into it, and a part of that
//! part has no others to ask. Where more hide than that is worth, rays tell which share of a part is in sight.

use super::exchange::may_see;
use super::outline::Outline;
use super::pairs::screens;
use crate::polygon::Polygon;
use crate::visibility::blockers::Blockers;
use crate::visibility::screens::{Found, Screens};
use crate::visibility::solid::{Plane, Solid};
use crate::visibility::{End, Visibility};
use glam::DVec3;
use std::collections::HashMap;
use std::sync::Arc;

/// The faces of a scene, and what may be between them.
#[derive(Debug)]
pub(crate) struct Outlooks<'a> {
    faces: &'a [Polygon],
    blockers: Blockers,
    screens: Screens,
    ends: Vec<End>,
    /// How far from a plane counts as on it, in metres.
    touch: f64,
    rays: Arc<Visibility>,
}

/// What the points of a face see of the others.
#[derive(Debug)]
pub(crate) struct Outlook {
    pub(super) normal: DVec3,
    /// The faces not all hidden, in their order, with what may hide some of them, in `hiders`.
    pub seen: Vec<(u32, Hiders)>,
    pub(super) rays: Arc<Visibility>,
    pub(super) hiders: Vec<Hider>,
    /// The bodies among them that stand on the face.
    standing: Vec<u32>,
    pub(super) touch: f64,
}

/// What may hide some of a face.
#[derive(Debug)]
pub(crate) enum Hiders {
    Few(Vec<u32>),
    /// More than it is worth to clip by.
    Many,
}

/// As many as it is worth to clip by: each asks 10 ns of every part, and the rays of a penumbra take some µs.
const MANY: usize = 48;

/// What hides: a convex body, or a convex polygon.
#[derive(Debug)]
pub(super) enum Hider {
    Body(Solid),
    Side(Box<Side>),
}

#[derive(Debug)]
pub(super) struct Side {
    outline: Outline,
    plane: Plane,
    /// Whether it hides from its front alone: it is of a body, whose other faces hide the rest.
    one_sided: bool,
}

/// Which body, or which polygon, and the face in front of whose plane it hides, where it reaches through that.
type Key = (u32, Option<usize>);

impl<'a> Outlooks<'a> {
    pub fn new(faces: &'a [Polygon]) -> Self {
        let blockers = Blockers::new(faces);
        let screens = screens(&blockers);
        let ends = faces.iter().map(|face| screens.end(face)).collect();
        let vertices = || faces.iter().flat_map(|face| face.vertices());
        let low = vertices().fold(DVec3::INFINITY, |low, v| low.min(*v));
        let extent = vertices().fold(0.0, |extent: f64, v| extent.max((*v - low).max_element()));
        let rays = Arc::new(Visibility::new(faces));
        Self { faces, blockers, screens, ends, touch: TOUCH * extent, rays }
    }

    /// What casts rays between the faces.
    pub fn rays(&self) -> &Visibility {
        &self.rays
    }

    /// What is seen from a face.
    pub fn from(&self, face: usize) -> Outlook {
        let outer = &self.faces[face];
        let mut outlook = Outlook {
            normal: outer.normal(),
            seen: Vec::new(),
            hiders: Vec::new(),
            standing: Vec::new(),
            touch: self.touch,
            rays: self.rays.clone(),
        };
        // Digits that are rounded put some corners of a convex body before its faces, but it hides nothing from any of them.
        let own =
            self.blockers.body_of_face[face].filter(|&body| self.blockers.solids[body as usize].is_some());
        let (mut known, mut found) = (HashMap::new(), Found::new());
        for (other, target) in self.faces.iter().enumerate() {
            if other != face && may_see(outer, target) {
                self.screens.between([&self.ends[face], &self.ends[other]], &mut found);
                found.retain(|id| own.is_none() || self.blockers.body[*id as usize] != own);
                let keys: Vec<Key> = found.iter().flat_map(|&id| self.names(id, other)).collect();
                if keys.len() > MANY {
                    outlook.seen.push((other as u32, Hiders::Many));
                    continue;
                }
                let hiders = keys.into_iter().map(|key| {
                    *known.entry(key).or_insert_with(|| {
                        outlook.hiders.push(self.hider(face, key));
                        outlook.hiders.len() as u32 - 1
                    })
                });
                let mut hiders: Vec<u32> = hiders.collect();
                hiders.retain(|&k| !outlook.hiders[k as usize].is_empty());
                outlook.seen.push((other as u32, Hiders::Few(hiders)));
            }
        }
        let stands = |hider: &Hider| match hider {
            Hider::Body(solid) => solid.vertices.iter().any(|v| outer.height_of(*v) <= self.touch),
            Hider::Side(_) => false,
        };
        let all = outlook.hiders.iter().zip(0..);
        outlook.standing = all.filter(|(hider, _)| stands(hider)).map(|(_, k)| k).collect();
        outlook
    }

    /// What a polygon that may hide something of a face stands for: its body as one, or some sides.
    fn names(&self, id: u32, target: usize) -> Vec<Key> {
        let face = &self.faces[target];
        let in_front = |vertices: &[DVec3]| vertices.iter().all(|v| face.height_of(*v) >= -self.touch);
        let solid =
            self.blockers.body[id as usize].and_then(|body| self.blockers.solids[body as usize].as_ref());
        if solid.is_some_and(|solid| in_front(&solid.vertices)) {
            return vec![(id, None)];
        }
        let side = |id: u32| {
            let whole = in_front(self.blockers.polygons[id as usize].vertices()) && solid.is_none();
            (id, if whole { None } else { Some(target) })
        };
        // A face cut in two by rounded digits is one blocker, whose halves are a little before each other.
        let rises = |vertices: &[DVec3]| vertices.iter().any(|v| face.height_of(*v) > self.touch);
        let sides =
            self.blockers.sides(id).filter(|&id| rises(self.blockers.polygons[id as usize].vertices()));
        sides.map(side).collect()
    }

    fn hider(&self, face: usize, (id, target): Key) -> Hider {
        let body = self.blockers.body[id as usize];
        let solid = body.and_then(|body| self.blockers.solids[body as usize].as_ref());
        if let (Some(solid), None) = (solid, target) {
            return Hider::Body(solid.clone());
        }
        let outer = &self.faces[face];
        let polygon = &self.blockers.polygons[id as usize];
        let mut outline = Outline::new(polygon.vertices());
        outline.keep_above(|v| outer.height_of(v));
        if let Some(target) = target.filter(|_| !outline.is_empty()) {
            outline.keep_above(|v| self.faces[target].height_of(v));
        }
        let plane = Plane { normal: polygon.normal(), offset: polygon.normal().dot(polygon.vertices()[0]) };
        let one_sided = body.is_some_and(|body| self.blockers.is_clear_of(face, outer, body));
        Hider::Side(Box::new(Side { outline, plane, one_sided }))
    }
}

/// Heights over planes below this part of the scene are rounding, or the thickness of what only touches.
const TOUCH: f64 = 1e-9;

impl Outlook {
    /// What may hide some of a face; `None` for a face of which nothing is seen.
    pub fn hiders_of(&self, face: u32) -> Option<&Hiders> {
        self.seen.binary_search_by_key(&face, |(face, _)| *face).ok().map(|k| &self.seen[k].1)
    }

    /// Whether bodies stand on the face.
    pub fn is_stood_on(&self) -> bool {
        !self.standing.is_empty()
    }

    /// Whether a point is under a body that stands on the face, and sees nothing but its inside.
    pub fn is_buried(&self, x: DVec3) -> bool {
        self.standing.iter().any(|&k| match &self.hiders[k as usize] {
            Hider::Body(solid) => solid.in_front(x, self.touch) == 0,
            Hider::Side(_) => false,
        })
    }
}

/// Of a plane without a direction nothing is on the inner side.
const NOTHING: DVec3 = DVec3::ZERO;

impl Hider {
    fn is_empty(&self) -> bool {
        matches!(self, Self::Side(side) if side.outline.is_empty())
    }

    /// The inward normals of the planes through x and the edges, seen from x, of what it hides.
    pub fn shadow(&self, x: DVec3, touch: f64, planes: &mut Vec<DVec3>) {
        match self {
            Self::Body(solid) => {
                let in_front = solid.in_front(x, touch);
                let outline =
                    solid.ridges.iter().filter_map(|ridge| ridge.on_outline(|k| in_front >> k & 1 == 1));
                planes.extend(outline.map(|[from, to]| (to - x).cross(from - x)));
            }
            Self::Side(side) => {
                let Side { outline, plane, one_sided } = &**side;
                let height = plane.height_of(x);
                if height.abs() <= touch || (*one_sided && height < 0.0) {
                    planes.push(NOTHING);
                } else {
                    planes
                        .extend(outline.edges().map(|(from, to)| (to - x).cross(from - x) * height.signum()));
                }
            }
        }
    }
}
