//! F(x, P) = ∫_P K(x, y) dy from the points x of one face to parts P of the others: what hides them is clipped away.
//!
//! Which polygons can hide something of another face is asked once for all points of a face. From a point each of them hides
//! what is between the planes through the point and its edges; a part keeps those that reach into it, and a part of that
//! part has no others to ask.

use super::exchange::may_see;
use super::lambert::point_to_polygon;
use super::outline::{Inside, MOST, Outline};
use crate::polygon::Polygon;
use crate::visibility::blockers::Blockers;
use crate::visibility::{End, Visibility};
use glam::DVec3;
use std::ops::Range;

/// The faces of a scene, and what may be between them.
#[derive(Debug)]
pub(crate) struct Outlooks<'a> {
    faces: &'a [Polygon],
    blockers: Blockers,
    visibility: Visibility,
    ends: Vec<End>,
}

/// What the points of a face see of the others.
#[derive(Debug)]
pub(crate) struct Outlook {
    normal: DVec3,
    /// The faces not all hidden, in their order, with what may hide some of them, in `hiders`.
    pub seen: Vec<(u32, Vec<u32>)>,
    hiders: Vec<Hider>,
}

/// A convex polygon that hides what is behind it.
#[derive(Debug)]
struct Hider {
    outline: Outline,
    normal: DVec3,
    offset: f64,
    /// Whether it hides from its front alone: it is of a body, whose other faces hide the rest.
    one_sided: bool,
    /// Hiders of one convex body hide no place twice.
    body: Option<u32>,
}

impl<'a> Outlooks<'a> {
    pub fn new(faces: &'a [Polygon]) -> Self {
        let blockers = Blockers::new(faces);
        let visibility = Visibility::new(&blockers.polygons);
        let ends = faces.iter().map(|face| visibility.end(face)).collect();
        Self { faces, blockers, visibility, ends }
    }

    /// What is seen from a face.
    pub fn from(&self, face: usize) -> Outlook {
        let outer = &self.faces[face];
        let mut outlook = Outlook { normal: outer.normal(), seen: Vec::new(), hiders: Vec::new() };
        let mut known = std::collections::HashMap::new();
        let mut found = Vec::new();
        for (other, target) in self.faces.iter().enumerate() {
            if other == face || !may_see(outer, target) {
                continue;
            }
            let (a, b) = (&self.ends[face], &self.ends[other]);
            self.visibility.between(a, b, &mut found);
            if found.iter().any(|&id| self.visibility.blocks(id, a, b)) {
                continue;
            }
            let mut hiders = Vec::new();
            for &id in &found {
                let polygon = &self.blockers.polygons[id as usize];
                let in_front = polygon.vertices().iter().all(|v| target.height_of(*v) >= 0.0);
                // What reaches through the target's plane hides with what is in front of it.
                let key = (id, if in_front { None } else { Some(other) });
                let next = outlook.hiders.len() as u32;
                let index = *known.entry(key).or_insert_with(|| {
                    outlook.hiders.push(self.hider(face, id, target));
                    next
                });
                if !outlook.hiders[index as usize].outline.is_empty() {
                    hiders.push(index);
                }
            }
            hiders.sort_by_key(|&k| outlook.hiders[k as usize].body);
            outlook.seen.push((other as u32, hiders));
        }
        outlook
    }

    fn hider(&self, face: usize, id: u32, target: &Polygon) -> Hider {
        let polygon = &self.blockers.polygons[id as usize];
        let mut outline = Outline::new(polygon.vertices());
        outline.keep_above(|v| self.faces[face].height_of(v));
        if !outline.is_empty() {
            outline.keep_above(|v| target.height_of(v));
        }
        let body = self.blockers.body[id as usize];
        let one_sided = body.is_some_and(|body| self.blockers.is_outside(face, &self.faces[face], body));
        let normal = polygon.normal();
        Hider {
            outline,
            normal,
            offset: normal.dot(polygon.vertices()[0]),
            one_sided,
            body: body.filter(|&body| one_sided && self.blockers.is_convex[body as usize]),
        }
    }
}

/// What a point of a face sees; made once, and moved from point to point.
#[derive(Debug, Default)]
pub(crate) struct View {
    x: DVec3,
    normal: DVec3,
    /// The shadow of each hider of the outlook.
    shadows: Vec<Shadow>,
    /// Those that reach into some part, behind those that reach into what it is a part of.
    kept: Vec<u32>,
    pieces: Vec<Outline>,
    room: [Outline; 2],
}

/// What is between planes through the point, whose normals point inwards.
#[derive(Debug)]
struct Shadow {
    planes: [DVec3; MOST],
    count: usize,
    body: Option<u32>,
}

/// What is seen of a part.
pub(crate) enum Seen {
    Nothing,
    /// What these do not hide.
    Behind(Range<usize>),
}

impl View {
    /// Goes to a point of the face of an outlook.
    pub fn go(&mut self, outlook: &Outlook, x: DVec3) {
        (self.x, self.normal) = (x, outlook.normal);
        self.kept.clear();
        self.shadows.clear();
        self.shadows.extend(outlook.hiders.iter().map(|hider| hider.shadow(x)));
    }

    /// Which of `hiders` reach into a part of a face that is seen from its front.
    pub fn enter(&mut self, part: &Polygon, hiders: &[u32]) -> Seen {
        let start = self.kept.len();
        self.kept.extend_from_slice(hiders);
        self.filter(part, start)
    }

    /// Which of those that were kept do so.
    pub fn enter_further(&mut self, part: &Polygon, hiders: Range<usize>) -> Seen {
        let start = self.kept.len();
        self.kept.extend_from_within(hiders);
        self.filter(part, start)
    }

    fn filter(&mut self, part: &Polygon, start: usize) -> Seen {
        if self.kept.len() == start {
            return Seen::Behind(start..start);
        }
        let part = Outline::new(part.vertices()).seen_from(self.x);
        let mut end = start;
        for k in start..self.kept.len() {
            let shadow = &self.shadows[self.kept[k] as usize];
            match part.lies(&shadow.planes[..shadow.count]) {
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
        Seen::Behind(start..end)
    }

    /// Forgets them, and all that came in later.
    pub fn leave(&mut self, hiders: &Range<usize>) {
        self.kept.truncate(hiders.start);
    }

    /// The form factor from the point to what is not hidden of a part.
    pub fn factor(&mut self, part: &Polygon, hiders: Range<usize>) -> f64 {
        let whole = point_to_polygon(self.x, self.normal, part);
        if whole == 0.0 || hiders.is_empty() {
            return whole;
        }
        let mut target = Outline::new(part.vertices()).seen_from(self.x);
        let normal = self.normal;
        target.keep_above(|v| v.dot(normal));
        let rest = self.rest(whole, target, hiders);
        if rest > ROUNDING * whole { rest } else { 0.0 }
    }

    fn rest(&mut self, whole: f64, target: Outline, hiders: Range<usize>) -> f64 {
        let Self { shadows, kept, pieces, room, normal, .. } = self;
        let shadows = || kept[hiders.clone()].iter().map(|&k| &shadows[k as usize]);
        let first = shadows().next().and_then(|shadow| shadow.body);
        if hiders.len() == 1 || (first.is_some() && shadows().all(|shadow| shadow.body == first)) {
            let hidden = |shadow: &Shadow| match target.inside(&shadow.planes[..shadow.count], room) {
                Inside::Nothing => 0.0,
                Inside::Part(part) => part.form_factor(*normal),
                Inside::All => whole,
            };
            return whole - shadows().map(hidden).sum::<f64>();
        }
        pieces.clear();
        pieces.push(target);
        for shadow in shadows() {
            let planes = &shadow.planes[..shadow.count];
            let before = pieces.len();
            for k in 0..before {
                let mut inner = pieces[k];
                if matches!(inner.inside(planes, room), Inside::Nothing) {
                    pieces.push(inner);
                    continue;
                }
                for plane in planes {
                    let [inside, outside] = inner.divided(*plane);
                    pieces.extend(outside.uncrowded().into_iter().filter(|part| !part.is_empty()));
                    inner = inside;
                    if inner.is_empty() {
                        break;
                    }
                }
            }
            pieces.drain(..before);
        }
        pieces.iter().map(|piece| piece.form_factor(*normal)).sum()
    }
}

/// What rounding leaves of a factor that is hidden.
const ROUNDING: f64 = 1e-12;

impl Hider {
    /// What it hides from x: nothing where x is in its plane, or behind one that hides from its front.
    fn shadow(&self, x: DVec3) -> Shadow {
        let height = self.normal.dot(x) - self.offset;
        let mut shadow = Shadow { planes: [DVec3::ZERO; MOST], count: 1, body: self.body };
        if height == 0.0 || (self.one_sided && height < 0.0) || self.outline.is_empty() {
            // Nothing is above a plane without a direction.
            return shadow;
        }
        shadow.count = self.outline.len();
        let mut before = self.outline.vertex(shadow.count - 1) - x;
        for (plane, corner) in shadow.planes.iter_mut().zip(self.outline.vertices()) {
            let corner = corner - x;
            *plane = corner.cross(before) * height.signum();
            before = corner;
        }
        shadow
    }
}
