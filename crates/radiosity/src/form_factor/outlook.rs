//! F(x, P) = ∫_P K(x, y) dy from the points x of one face to parts P of the others: what hides them is clipped away.
//!
//! Which polygons can hide something of another face is asked once for all points of a face. From a point each of them hides
//! what is between the planes through the point and its edges; a part keeps those that reach into it, and a part of that
//! part has no others to ask. Where more hide than that is worth, rays tell which share of a part is in sight.

use super::exchange::may_see;
use super::lambert::point_to_polygon;
use super::outline::{Inside, Outline};
use super::pairs::screens;
use crate::kernel::{SurfacePoint, unoccluded};
use crate::polygon::Polygon;
use crate::reconstruct::{Rotation, lattice};
use crate::visibility::blockers::Blockers;
use crate::visibility::screens::Screens;
use crate::visibility::solid::{Plane, Solid};
use crate::visibility::{End, Visibility};
use glam::DVec3;
use std::collections::HashMap;
use std::ops::Range;
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
    normal: DVec3,
    /// The faces not all hidden, in their order, with what may hide some of them, in `hiders`.
    pub seen: Vec<(u32, Hiders)>,
    rays: Arc<Visibility>,
    hiders: Vec<Hider>,
    /// The bodies among them that stand on the face.
    standing: Vec<u32>,
    touch: f64,
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
enum Hider {
    Body(Solid),
    Side(Box<Side>),
}

#[derive(Debug)]
struct Side {
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
        let (mut known, mut found) = (HashMap::new(), Vec::new());
        for (other, target) in self.faces.iter().enumerate() {
            if other != face && may_see(outer, target) {
                self.screens.between([&self.ends[face], &self.ends[other]], &mut found);
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
        self.blockers.sides(id).map(side).collect()
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

/// What a point of a face sees; made once, and moved from point to point.
#[derive(Debug, Default)]
pub(crate) struct View {
    x: DVec3,
    normal: DVec3,
    /// The shadow of each hider of the outlook.
    shadows: Vec<Shadow>,
    planes: Vec<DVec3>,
    /// Those that reach into some part, behind those that reach into what it is a part of.
    kept: Vec<u32>,
    pieces: Vec<Outline>,
    room: [Outline; 2],
}

/// What is between planes through the point: their inward normals, in `planes`; everything if there are none.
#[derive(Debug)]
struct Shadow(Range<usize>);

/// What is seen of a part.
pub(crate) enum Seen {
    Nothing,
    /// What these do not hide.
    Behind(Kept),
}

/// Which hiders of a [`View`] reach into a part.
#[derive(Clone, Debug)]
pub(crate) enum Kept {
    Few(Range<usize>),
    Many,
}

impl Kept {
    /// Whether nothing hides anything.
    pub fn is_empty(&self) -> bool {
        matches!(self, Self::Few(hiders) if hiders.is_empty())
    }
}

impl View {
    /// Goes to a point of the face of an outlook.
    pub fn go(&mut self, outlook: &Outlook, x: DVec3) {
        (self.x, self.normal) = (x, outlook.normal);
        self.kept.clear();
        self.planes.clear();
        self.shadows.clear();
        for hider in &outlook.hiders {
            let start = self.planes.len();
            hider.shadow(x, outlook.touch, &mut self.planes);
            self.shadows.push(Shadow(start..self.planes.len()));
        }
    }

    /// Which of `hiders` reach into a part of a face that is seen from its front.
    pub fn enter(&mut self, part: &Polygon, hiders: &Hiders) -> Seen {
        let Hiders::Few(hiders) = hiders else { return Seen::Behind(Kept::Many) };
        let start = self.kept.len();
        self.kept.extend_from_slice(hiders);
        self.filter(part, start)
    }

    /// Which of those that were kept do so.
    pub fn enter_further(&mut self, part: &Polygon, hiders: &Kept) -> Seen {
        let Kept::Few(hiders) = hiders else { return Seen::Behind(Kept::Many) };
        let start = self.kept.len();
        self.kept.extend_from_within(hiders.clone());
        self.filter(part, start)
    }

    fn filter(&mut self, part: &Polygon, start: usize) -> Seen {
        if self.kept.len() == start {
            return Seen::Behind(Kept::Few(start..start));
        }
        let part = Outline::new(part.vertices()).seen_from(self.x);
        let mut end = start;
        for k in start..self.kept.len() {
            let shadow = &self.shadows[self.kept[k] as usize];
            match part.lies(&self.planes[shadow.0.clone()]) {
                Some(true) => {
                    self.kept.truncate(start);
                    return Seen::Nothing;
                }
                Some(false) => (),
                None => {
                    self.kept[end] = self.kept[k];
                    end += 1;
                }
            }
        }
        self.kept.truncate(end);
        Seen::Behind(Kept::Few(start..end))
    }

    /// Forgets them, and all that came in later.
    pub fn leave(&mut self, hiders: &Kept) {
        if let Kept::Few(hiders) = hiders {
            self.kept.truncate(hiders.start);
        }
    }

    /// The form factor from the point to what is not hidden of a part.
    pub fn factor(&mut self, outlook: &Outlook, part: &Polygon, hiders: &Kept) -> f64 {
        let whole = point_to_polygon(self.x, self.normal, part);
        if whole == 0.0 || hiders.is_empty() {
            return whole;
        }
        let Kept::Few(hiders) = hiders else { return whole * self.share_of_rays(&outlook.rays, part) };
        let mut target = Outline::new(part.vertices()).seen_from(self.x);
        let normal = self.normal;
        target.keep_above(|v| v.dot(normal));
        let rest = self.rest(whole, target, hiders.clone());
        if rest > ROUNDING * whole { rest } else { 0.0 }
    }

    /// The share of a part that is in sight: few rays where they agree, more where they do not.
    fn share_of_rays(&self, visibility: &Visibility, part: &Polygon) -> f64 {
        let x = SurfacePoint { position: self.x, normal: self.normal };
        let rotation = Rotation::of(self.x.to_array().iter().fold(0, |bits, c| bits ^ c.to_bits() as usize));
        let share = |rays: usize| {
            let (mut all, mut arrived) = (0.0, 0.0);
            for (s, t) in lattice(rays, rotation) {
                let y = SurfacePoint { position: part.point(s, t), normal: part.normal() };
                let weight = unoccluded(&x, &y) * part.density(s, t);
                all += weight;
                if weight > 0.0 && visibility.unoccluded(x.position, y.position) {
                    arrived += weight;
                }
            }
            if all > 0.0 { arrived / all } else { 0.0 }
        };
        match share(PROBES) {
            certain @ (0.0 | 1.0) => certain,
            _ => share(RAYS),
        }
    }

    fn rest(&mut self, whole: f64, target: Outline, hiders: Range<usize>) -> f64 {
        let Self { shadows, planes, kept, pieces, room, normal, .. } = self;
        let shadow = |k: u32| &planes[shadows[k as usize].0.clone()];
        if let [one] = kept[hiders.clone()] {
            return whole - hidden(target, shadow(one), *normal, room);
        }
        pieces.clear();
        pieces.push(target);
        for &hider in &kept[hiders] {
            let planes = shadow(hider);
            let before = pieces.len();
            for k in 0..before {
                if pieces[k].lies(planes) == Some(false) {
                    pieces.push(pieces[k]);
                } else {
                    take_away(pieces[k], planes, pieces);
                }
            }
            pieces.drain(..before);
        }
        pieces.iter().map(|piece| piece.form_factor(*normal)).sum()
    }
}

/// Rays to a part, to see whether all or nothing of it is in sight, and where it is neither.
const PROBES: usize = 8;
const RAYS: usize = 48;

/// So many planes add few enough vertices to a piece.
const FEW: usize = 7;

/// The form factor of what is above all planes.
fn hidden(piece: Outline, planes: &[DVec3], normal: DVec3, room: &mut [Outline; 2]) -> f64 {
    let (now, later) = planes.split_at(planes.len().min(FEW));
    let part = match piece.inside(now, room) {
        Inside::Nothing => return 0.0,
        Inside::Part(part) => *part,
        Inside::All => piece,
    };
    if later.is_empty() {
        return part.form_factor(normal);
    }
    part.uncrowded()
        .into_iter()
        .filter(|half| !half.is_empty())
        .map(|half| hidden(half, later, normal, room))
        .sum()
}

/// Leaves what is not above all planes.
fn take_away(piece: Outline, planes: &[DVec3], left: &mut Vec<Outline>) {
    let mut inner = piece;
    for (k, plane) in planes.iter().enumerate() {
        let [inside, outside] = inner.divided(*plane);
        left.extend(outside.uncrowded().into_iter().filter(|part| !part.is_empty()));
        match inside.uncrowded() {
            [whole, other] if other.is_empty() => inner = whole,
            halves => return halves.into_iter().for_each(|half| take_away(half, &planes[k + 1..], left)),
        }
        if inner.is_empty() {
            break;
        }
    }
}

/// What rounding leaves of a factor that is hidden.
const ROUNDING: f64 = 1e-12;

/// Of a plane without a direction nothing is on the inner side.
const NOTHING: DVec3 = DVec3::ZERO;

impl Hider {
    fn is_empty(&self) -> bool {
        matches!(self, Self::Side(side) if side.outline.is_empty())
    }

    /// The inward normals of the planes through x and the edges, seen from x, of what it hides.
    fn shadow(&self, x: DVec3, touch: f64, planes: &mut Vec<DVec3>) {
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
