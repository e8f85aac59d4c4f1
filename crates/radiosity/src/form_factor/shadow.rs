//! The part of a polygon that others hide from a point x, and its form factor: clipped by the planes through x and the
//! edges of what hides it, and given to Lambert's formula.
//!
//! What hides is in front of the polygon's plane, as x is; then all of the polygon in the pyramid from x over it is hidden.

use super::bundle::Bundles;
use super::hider::Hider;
use super::outline::{Inside, Outline};
use glam::DVec3;

/// What hides a polygon, seen from the points of another.
pub(super) struct Shadows<'a> {
    /// The polygon, in front of the plane of the points.
    pub target: Outline,
    /// The normal at the points.
    pub normal: DVec3,
    /// Those of one body stand together.
    pub hiders: &'a [Hider],
}

/// Room to work in.
#[derive(Default)]
pub(super) struct Room {
    pieces: Vec<Outline>,
    parts: [Outline; 2],
    pub bundles: Bundles,
}

impl Shadows<'_> {
    /// The form factor from x to what is hidden of the polygon, which is seen from its front.
    pub fn hidden(&self, x: DVec3, room: &mut Room) -> f64 {
        let Room { pieces, parts, .. } = room;
        let target = self.target.seen_from(x);
        let (group, others) = first_group(self.hiders);
        if others.is_empty() {
            return self.inside(group, x, std::slice::from_ref(&target), parts);
        }
        pieces.clear();
        pieces.push(target);
        let mut sum = 0.0;
        let mut rest = self.hiders;
        while !rest.is_empty() {
            let (group, others) = first_group(rest);
            // What these hide is taken away from what later ones could hide; after the last ones there is none.
            sum += if others.is_empty() {
                self.inside(group, x, pieces, parts)
            } else {
                self.taken(group, x, pieces, parts)
            };
            rest = others;
        }
        sum
    }

    fn inside(&self, group: &[Hider], x: DVec3, pieces: &[Outline], parts: &mut [Outline; 2]) -> f64 {
        let mut sum = 0.0;
        for hider in group {
            let Some((planes, count)) = hider.planes(x) else { continue };
            for piece in pieces {
                sum += match piece.inside(&planes[..count], parts) {
                    Inside::Nothing => 0.0,
                    Inside::Part(part) => part.form_factor(self.normal),
                    Inside::All => piece.form_factor(self.normal),
                };
            }
        }
        sum
    }

    fn taken(&self, group: &[Hider], x: DVec3, pieces: &mut Vec<Outline>, parts: &mut [Outline; 2]) -> f64 {
        let mut sum = 0.0;
        for hider in group {
            let Some((planes, count)) = hider.planes(x) else { continue };
            let before = pieces.len();
            for k in 0..before {
                let mut inner = pieces[k];
                if matches!(inner.inside(&planes[..count], parts), Inside::Nothing) {
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
