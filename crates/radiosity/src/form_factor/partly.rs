//! ∫_{P_i} g(x) dx, where g(x) is the form factor from x to what is hidden of P_j: cut where g has kinks, and adaptive.

use super::hider::{Hider, Scene};
use super::kinks::{Kink, kinks};
use super::outline::Outline;
use super::piece::{Cell, Piece, area, halves};
use super::shadow::{Room, Shadows};
use crate::view_factors::Exchange;
use fredholm::quadrature::triangle;
use glam::DVec3;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// A rule on a triangle with another of lower degree, whose difference is taken for its error.
#[derive(Clone, Debug)]
pub(super) struct Pair {
    /// Barycentric coordinates, the weight, and that of the lower rule.
    nodes: Vec<([f64; 3], f64, f64)>,
}

impl Pair {
    /// For a relative tolerance.
    pub fn new(tolerance: f64) -> Self {
        match () {
            () if tolerance > 1e-5 => Self::embedded(),
            () if tolerance > 1e-8 => Self::of_degrees(8, 5),
            () => Self::of_degrees(14, 10),
        }
    }

    /// Radon's seven points of degree 5, and the centroid with the three nearer to the corners: degree 2.
    fn embedded() -> Self {
        let mut pair = Self::of_degrees(5, 1);
        pair.nodes.retain(|node| node.1 != 0.0);
        let nearer = |node: &[f64; 3]| node.iter().any(|x| *x > 0.7);
        let square =
            pair.nodes.iter().find(|(x, ..)| nearer(x)).map_or(1.0, |(x, ..)| x.iter().map(|x| x * x).sum());
        // w + 3v = 1 and w/9 + v Σλ² = 1/6.
        let outer = (1.0 / 6.0 - 1.0 / 9.0) / (square - 1.0 / 3.0);
        for (x, _, lower) in &mut pair.nodes {
            let central = x.iter().all(|x| (x - 1.0 / 3.0).abs() < 1e-9);
            *lower = if central {
                1.0 - 3.0 * outer
            } else if nearer(x) {
                outer
            } else {
                0.0
            };
        }
        pair
    }

    fn of_degrees(high: usize, low: usize) -> Self {
        let rule = |degree: usize| {
            let barycentric = |[s, t]: [f64; 2]| [1.0 - s - t, s, t];
            let rule = triangle(degree, [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
            // Degrees up to 20 are in the table.
            let points = rule.into_iter().flat_map(|rule| rule.nodes.into_iter().zip(rule.weights));
            points.map(|(node, weight)| (barycentric(node), 2.0 * weight)).collect::<Vec<_>>()
        };
        let mut nodes: Vec<_> = rule(high).into_iter().map(|(x, w)| (x, w, 0.0)).collect();
        nodes.extend(rule(low).into_iter().map(|(x, w)| (x, 0.0, w)));
        Self { nodes }
    }
}

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
            for cell in divided(&worst.cell, &kinks) {
                let part = self.part(cell, &kinks, &shadows, room);
                error += part.error;
                parts.push(part);
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
            let scene = Scene { eyes: piece.corners(), target: &self.target, reach: self.reach };
            !self.hiders.iter().all(|hider| hider.misses(&scene))
        });
        pieces
    }

    fn part(&self, cell: Cell, kinks: &[Kink], shadows: &Shadows<'_>, room: &mut Room) -> Part {
        let [a, b, c] = cell;
        let (mut high, mut low) = (0.0, 0.0);
        for ([u, v, w], weight, lower) in &self.rules.nodes {
            let x = a * *u + b * *v + c * *w;
            let hidden = shadows.hidden(x, room);
            high += weight * hidden;
            low += lower * hidden;
        }
        let area = area(&cell);
        let mut error = (high - low).abs();
        let cut = kinks.iter().map(|kink| kink.cuts(&cell)).fold(0.0, f64::max);
        error = error.max(self.whole * cut.min(EVEN).powi(2));
        Part { cell, value: area * high, error: area * error }
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
