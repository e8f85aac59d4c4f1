//! The part of a polygon that others hide from a point x, and its form factor: clipped by the planes through x and the
//! edges of what hides it, and given to Lambert's formula.
//!
//! What hides lies between the planes of the two polygons of a pair; then what is in the pyramid from x over it is hidden.

use super::outline::{Inside, MOST, Outline};
use glam::DVec3;

/// A convex polygon that hides something of the pair, in front of both of its polygons.
#[derive(Clone, Debug)]
pub(super) struct Hider {
    pub outline: Outline,
    pub normal: DVec3,
    pub offset: f64,
    /// Whether all points from which the shadow is asked for are in front of it, and whether some are on either side.
    pub in_front: bool,
    pub straddled: bool,
    /// Whether it hides only what is behind it: it is of a body, whose other faces hide the rest.
    pub one_sided: bool,
    /// Hiders of one convex body hide no place twice.
    pub body: Option<u32>,
}

impl Hider {
    pub fn height_of(&self, x: DVec3) -> f64 {
        self.normal.dot(x) - self.offset
    }

    /// The side from which x sees it, 1 or −1; none where x is in its plane or sees a side that hides nothing.
    fn side(&self, x: DVec3) -> Option<f64> {
        let height = self.height_of(x);
        (height != 0.0 && !(self.one_sided && height < 0.0)).then(|| height.signum())
    }
}

/// What hides a polygon, seen from the points of another.
pub(super) struct Shadows<'a> {
    /// The polygon, in front of the plane of the points.
    pub target: Outline,
    /// The normal at the points.
    pub normal: DVec3,
    /// Those of one body stand together.
    pub hiders: &'a [Hider],
}

impl Shadows<'_> {
    /// The form factor from x to what is hidden of the polygon, which is seen from its front.
    ///
    /// `pieces` is room to work in.
    pub fn hidden(&self, x: DVec3, pieces: &mut Vec<Outline>) -> f64 {
        let target = self.target.seen_from(x);
        let (group, others) = first_group(self.hiders);
        if others.is_empty() {
            return self.inside(group, x, std::slice::from_ref(&target));
        }
        pieces.clear();
        pieces.push(target);
        let mut sum = 0.0;
        let mut rest = self.hiders;
        while !rest.is_empty() {
            let (group, others) = first_group(rest);
            // What these hide is taken away from what later ones could hide; after the last ones there is none.
            sum +=
                if others.is_empty() { self.inside(group, x, pieces) } else { self.taken(group, x, pieces) };
            rest = others;
        }
        sum
    }

    fn inside(&self, group: &[Hider], x: DVec3, pieces: &[Outline]) -> f64 {
        let mut sum = 0.0;
        let mut room = [Outline::EMPTY; 2];
        for hider in group {
            let Some(side) = hider.side(x) else { continue };
            let (planes, count) = pyramid(hider, x, side);
            for piece in pieces {
                sum += match piece.inside(&planes[..count], &mut room) {
                    Inside::Nothing => 0.0,
                    Inside::Part(part) => part.form_factor(self.normal),
                    Inside::All => piece.form_factor(self.normal),
                };
            }
        }
        sum
    }

    fn taken(&self, group: &[Hider], x: DVec3, pieces: &mut Vec<Outline>) -> f64 {
        let mut sum = 0.0;
        let mut room = [Outline::EMPTY; 2];
        for hider in group {
            let Some(side) = hider.side(x) else { continue };
            let (planes, count) = pyramid(hider, x, side);
            let before = pieces.len();
            for k in 0..before {
                let mut inner = pieces[k];
                if matches!(inner.inside(&planes[..count], &mut room), Inside::Nothing) {
                    pieces.push(inner);
                    continue;
                }
                for plane in &planes[..count] {
                    let [inside, outside] = inner.divided(*plane);
                    pieces.extend(outside.uncrowded().into_iter().filter(|part| !part.is_empty()));
                    inner = inside;
                    if inner.is_empty() {
                        break;
                    }
                }
                if !inner.is_empty() {
                    sum += inner.form_factor(self.normal);
                }
            }
            pieces.drain(..before);
        }
        sum
    }
}

/// The first hider with all those behind it that hide no place twice, and the rest.
fn first_group(hiders: &[Hider]) -> (&[Hider], &[Hider]) {
    let alike = |hider: &&Hider| hider.body.is_some() && hider.body == hiders[0].body;
    hiders.split_at(hiders.iter().take_while(alike).count().clamp(1, hiders.len()))
}

/// The inward normals of the planes through x and the edges of what hides, and how many there are.
fn pyramid(hider: &Hider, x: DVec3, side: f64) -> ([DVec3; MOST], usize) {
    let mut planes = [DVec3::ZERO; MOST];
    let count = hider.outline.len();
    let mut before = hider.outline.vertex(count - 1) - x;
    for (plane, corner) in planes.iter_mut().zip(hider.outline.vertices()) {
        let corner = corner - x;
        *plane = corner.cross(before) * side;
        before = corner;
    }
    (planes, count)
}
