//! F(x, P) from one point x: the shadows that hiders cast from it, those that reach into a part, and what they leave of it.

use super::lambert::point_to_polygon;
use super::outline::{Inside, Outline};
use super::outlook::{Hiders, Outlook};
use crate::kernel::{SurfacePoint, unoccluded};
use crate::polygon::Polygon;
use crate::reconstruct::{Rotation, lattice};
use crate::visibility::Visibility;
use glam::DVec3;
use std::ops::Range;

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
        let part = Outline::from_point(part.vertices(), self.x);
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
        let mut target = Outline::from_point(part.vertices(), self.x);
        let normal = self.normal;
        target.keep_above(|v| v.dot(normal));
        let rest = self.rest(whole, target, hiders.clone());
        if rest > ROUNDING * whole { rest } else { 0.0 }
    }

    /// The share of a part that is in sight: few rays where they agree, more where they do not.
    fn share_of_rays(&self, visibility: &Visibility, part: &Polygon) -> f64 {
        let x = SurfacePoint { position: self.x, normal: self.normal };
        let rotation = Rotation::at(self.x);
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
            return whole - hidden(&target, shadow(one), *normal, room);
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

/// So many planes at once: each adds a vertex at most, and half of a crowded outline has seven of the twelve that it may have.
const FEW: usize = 5;

/// The form factor of what is above all planes.
fn hidden(piece: &Outline, planes: &[DVec3], normal: DVec3, room: &mut [Outline; 2]) -> f64 {
    let (now, later) = planes.split_at(planes.len().min(FEW));
    let part = match piece.inside(now, room) {
        Inside::Nothing => return 0.0,
        Inside::Part(part) => part,
        Inside::All => piece,
    };
    if later.is_empty() {
        return part.form_factor(normal);
    }
    part.uncrowded()
        .into_iter()
        .filter(|half| !half.is_empty())
        .map(|half| hidden(&half, later, normal, room))
        .sum()
}

/// Leaves what is not above all planes.
pub(crate) fn take_away(piece: Outline, planes: &[DVec3], left: &mut Vec<Outline>) {
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
