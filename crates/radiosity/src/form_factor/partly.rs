//! ∫_{P_i} g(x) dx, where g(x) is the form factor from x to what is hidden of P_j: cut where g has kinks, and adaptive.

use super::bundle;
use super::hider::{Hider, Scene};
use super::kinks::{Kink, kinks};
use super::outline::Outline;
use super::piece::{Cell, Piece, area, halves};
use super::rules::{Eight, Pair};
use super::shadow::{Room, Shadows};
use crate::view_factors::Exchange;
use glam::DVec3;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// The hidden part of an exchange.
pub(super) struct Partly<'a> {
    /// What is integrated over, and its normal.
    pub outer: Piece,
    pub normal: DVec3,
    pub target: Outline,
    pub hiders: &'a [Hider],
    /// A length that no distance here is far above.
    pub reach: f64,
    /// What the two would exchange if nothing were hidden, over the area of the outer one.
    pub whole: f64,
    pub rules: &'a Pair,
}

/// A cell with its integral.
struct Part {
    cell: Cell,
    value: f64,
    error: f64,
    /// Whether a rule of higher degree may be better than two halves: no kink was seen, nor was the rule used.
    is_smooth: bool,
}

impl PartialEq for Part {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}
impl Eq for Part {}
impl PartialOrd for Part {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Part {
    fn cmp(&self, other: &Self) -> Ordering {
        self.error.total_cmp(&other.error)
    }
}

/// Most cells that a pair is cut into.
const MOST: usize = 20_000;

/// With more pieces than that it is left to their errors which are cut further.
const MANY: usize = 20;

/// The error that is told of a higher rule is no less than this part of the lower one's: two rules may agree by chance.
const LEAST_GAIN: f64 = 0.05;

/// A cell is cut in any case by a kink that is no nearer to a corner than this part of it. A kink nearer than that may hide
/// from all nodes: what grows from it on grows at most as fast as from nothing to the whole over the cell.
const EVEN: f64 = 0.03;

impl Partly<'_> {
    /// The integral, with an error below `tolerance` in m².
    pub fn hidden(&self, tolerance: f64, room: &mut Room) -> Exchange {
        let kinks = kinks(self.outer.corners(), &self.target, self.hiders, self.reach);
        let shadows = Shadows { target: self.target, normal: self.normal, hiders: self.hiders };
        let mut parts = BinaryHeap::new();
        let mut error = 0.0;
        for piece in self.pieces(&kinks) {
            for cell in piece.triangles() {
                let part = self.part(cell, &kinks, &shadows, room);
                error += part.error;
                parts.push(part);
            }
        }
        while error > tolerance && parts.len() < MOST {
            let Some(worst) = parts.pop() else { break };
            error -= worst.error;
            let mut add = |part: Part| {
                error += part.error;
                parts.push(part);
            };
            match self.raised(&worst, room) {
                Some(part) => add(part),
                None => divided(&worst.cell, &kinks)
                    .into_iter()
                    .for_each(|cell| add(self.part(cell, &kinks, &shadows, room))),
            }
        }
        let (value, error) = parts.iter().fold((0.0, 0.0), |(v, e), part| (v + part.value, e + part.error));
        Exchange { value, error }
    }

    /// What is going to be cut in any case is not integrated before; nor is where nothing is hidden.
    fn pieces(&self, kinks: &[Kink]) -> Vec<Piece> {
        let mut pieces = vec![self.outer];
        for kink in kinks {
            if pieces.len() > MANY {
                break;
            }
            for k in 0..pieces.len() {
                if kink.cuts(pieces[k].corners()) > EVEN
                    && let Some([above, below]) = pieces[k].divided(|x| kink.height_of(x))
                {
                    pieces[k] = above;
                    pieces.push(below);
                }
            }
        }
        pieces.retain(|piece| {
            let scene = Scene::new(piece.corners(), &self.target, self.reach);
            !self.hiders.iter().all(|hider| hider.misses(&scene))
        });
        pieces
    }

    fn part(&self, cell: Cell, kinks: &[Kink], shadows: &Shadows<'_>, room: &mut Room) -> Part {
        let side_by_side = self.side_by_side(&self.rules.eights, &cell, room);
        let cut = kinks.iter().map(|kink| kink.cuts(&cell)).fold(0.0, f64::max);
        let is_smooth = side_by_side.is_some() && cut == 0.0;
        let [high, low] = side_by_side.unwrap_or_else(|| self.one_by_one(&cell, shadows, room));
        let error = (high - low).abs().max(self.whole * cut.min(EVEN).powi(2));
        let area = area(&cell);
        Part { cell, value: area * high, error: area * error, is_smooth }
    }

    /// A smooth part by the rule of higher degree, from which the other differed by its true error.
    fn raised(&self, part: &Part, room: &mut Room) -> Option<Part> {
        let smooth = Some(part).filter(|part| part.is_smooth)?;
        let [mean, _] = self.side_by_side(&self.rules.higher, &smooth.cell, room)?;
        let value = area(&smooth.cell) * mean;
        Some(Part {
            cell: smooth.cell,
            value,
            error: (value - smooth.value).abs().max(LEAST_GAIN * smooth.error),
            is_smooth: false,
        })
    }

    /// The means over a cell by a rule and by its lower one, from eight nodes at a time.
    fn side_by_side(&self, eights: &[Eight], cell: &Cell, room: &mut Room) -> Option<[f64; 2]> {
        let [hider] = self.hiders else { return None };
        let (mut high, mut low) = (0.0, 0.0);
        for eight in eights {
            let x = eight.points(cell);
            let hidden = bundle::hidden(&self.target, hider, &x, self.normal, &mut room.bundles)?;
            high += (eight.weight * hidden).reduce_add();
            low += (eight.lower * hidden).reduce_add();
        }
        Some([high, low])
    }

    fn one_by_one(&self, [a, b, c]: &Cell, shadows: &Shadows<'_>, room: &mut Room) -> [f64; 2] {
        let (mut high, mut low) = (0.0, 0.0);
        for ([u, v, w], weight, lower) in &self.rules.nodes {
            let hidden = shadows.hidden(*a * *u + *b * *v + *c * *w, room);
            high += weight * hidden;
            low += lower * hidden;
        }
        [high, low]
    }
}

/// A cell cut by the kink that divides it most evenly, or across its longest side if none does.
fn divided(cell: &Cell, kinks: &[Kink]) -> Vec<Cell> {
    let best = kinks.iter().map(|kink| (kink.cuts(cell), kink)).max_by(|a, b| a.0.total_cmp(&b.0));
    match best {
        Some((even, kink)) if even > 0.0 => {
            let parts = Piece::new(cell).divided(|x| kink.height_of(x));
            parts.iter().flatten().flat_map(|part| part.triangles().collect::<Vec<_>>()).collect()
        }
        _ => halves(cell).to_vec(),
    }
}
