//! ∫_D g = Σ_pieces ∫ g: D as a union of pieces, each with a product rule of its own, which grows where and in the direction
//! in which it falls short (paper, §4.1: a composite rule).

use super::Domain;
use super::piece::Piece;
use crate::quadrature::Quadrature;

/// A piece with its rule.
#[derive(Clone, Copy, Debug)]
pub(super) struct Element {
    pub(super) piece: Piece,
    /// Nodes in each direction.
    pub(super) counts: [usize; 2],
    /// In each direction: what the rule falls short by, now and when it had fewer nodes.
    now: [Defect; 2],
    before: [Defect; 2],
}

/// What a rule of so many nodes in a direction falls short by.
#[derive(Clone, Copy, Debug)]
struct Defect {
    count: usize,
    size: f64,
}

/// The elements; the unknowns are numbered in their order.
#[derive(Clone, Debug)]
pub(super) struct Mesh(pub(super) Vec<Element>);

/// A finer rule has twice the nodes, so that it sees what is between them, and on an undivided domain no fewer than
/// this in a direction: a bump a twentieth of the domain wide does not slip through.
const LEAST_FINER: usize = 24;

/// A direction grows whose defect is at least this part of the worst. With 1 only one would grow at a time, in many
/// steps; with 0 also those that need it no more.
const WORTH_GROWING: f64 = 0.03;

/// A direction is divided when, at the rate seen, its rule would have to become more than so many times as large. A peak a
/// tenth as wide as the domain, and the same everywhere, needs 2.3 times the 14 nodes that first feel it, and is better left
/// whole; one that is narrow or in one place only asks for more.
const TOO_LARGE: f64 = 2.5;

/// Below so many nodes no rate can be seen.
const LEAST_SPLIT: usize = 12;

impl Element {
    fn new(piece: Piece, counts: [usize; 2]) -> Self {
        let unknown = counts.map(|count| Defect { count, size: f64::INFINITY });
        Self { piece, counts, now: unknown, before: unknown }
    }

    fn unknowns(&self) -> usize {
        self.counts[0] * self.counts[1]
    }

    /// With the defects that its rule has now.
    fn seen(mut self, defects: [f64; 2]) -> Self {
        for (d, size) in defects.into_iter().enumerate() {
            let count = self.counts[d];
            if self.now[d].count != count {
                self.before[d] = self.now[d];
            }
            self.now[d] = Defect { count, size };
        }
        self
    }

    /// Whether growth does not bring a direction's defect to `target`: defects fall like e^{−rate · n}.
    fn is_too_slow(&self, direction: usize, target: f64) -> bool {
        let (now, before) = (self.now[direction], self.before[direction]);
        if now.count == before.count || now.count < LEAST_SPLIT || !self.piece.splits()[direction] {
            return false;
        }
        let rate = (before.size / now.size).ln() / (now.count - before.count) as f64;
        let missing = (now.size / target).ln();
        // Where nothing falls the rate is none or less.
        missing > 0.0 && (rate <= 0.0 || missing / rate > (TOO_LARGE - 1.0) * now.count as f64)
    }

    /// It with more nodes in the directions that fall short, or its parts with together as many or a few more.
    fn refined(mut self, worst: f64, target: f64, growth: f64) -> Vec<Self> {
        let grows = [0, 1].map(|d| self.now[d].size >= WORTH_GROWING * worst);
        let slow = [0, 1].map(|d| grows[d] && self.is_too_slow(d, target));
        if slow.contains(&true) {
            let parts = self.piece.split(slow);
            // A triangle is divided in both directions, whichever is slow.
            let halved = if parts.len() == 4 { [true; 2] } else { slow };
            let counts = [0, 1].map(|d| if halved[d] { self.counts[d] / 2 + 1 } else { self.counts[d] });
            return parts.into_iter().map(|part| Self::new(part, counts)).collect();
        }
        for d in [0, 1].into_iter().filter(|d| grows[*d]) {
            self.counts[d] = (self.counts[d] as f64 * growth).ceil() as usize;
        }
        vec![self]
    }
}

impl Mesh {
    /// The domain undivided, n nodes in each direction (on a disk n radii and 4n angles).
    pub(super) fn new(domain: Domain, n: usize) -> Self {
        let piece = Piece::from(domain);
        Self(vec![Element::new(piece, [n, piece.proportion() * n])])
    }

    pub(super) fn unknowns(&self) -> usize {
        self.0.iter().map(Element::unknowns).sum()
    }

    pub(super) fn rule(&self) -> Quadrature<[f64; 2]> {
        self.joined(|element| element.counts)
    }

    /// A finer rule with other nodes.
    pub(super) fn finer(&self) -> Quadrature<[f64; 2]> {
        let least = LEAST_FINER / self.0.len().min(LEAST_FINER);
        self.joined(|element| {
            let least = [least, element.piece.proportion() * least];
            [0, 1].map(|d| (2 * element.counts[d]).max(least[d]))
        })
    }

    /// Points between the nodes and those of [`Self::finer`], of no phase that these have: the error of the trapezoid rule
    /// with n angles goes like cos n(θ − θ₀), and at nodes of n and 2n it is always the same part of its maximum.
    pub(super) fn between(&self) -> Vec<[f64; 2]> {
        self.joined(|element| element.counts.map(|count| 2 * count + 2)).nodes
    }

    /// A point in the middle of each element.
    pub(super) fn middles(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        self.0.iter().map(|element| element.piece.middle())
    }

    fn joined(&self, counts: impl Fn(&Element) -> [usize; 2]) -> Quadrature<[f64; 2]> {
        let rules = self.0.iter().map(|element| element.piece.rule(counts(element)));
        let (nodes, weights): (Vec<_>, Vec<_>) = rules.map(|rule| (rule.nodes, rule.weights)).unzip();
        Quadrature { nodes: nodes.concat(), weights: weights.concat() }
    }

    /// The mesh refined where the `defects` are, each element's in its two directions: they shall become `target`, by
    /// `growth` > 1 of the counts or by division.
    pub(super) fn refined(&self, defects: &[[f64; 2]], target: f64, growth: f64) -> Self {
        let worst = defects.as_flattened().iter().copied().fold(0.0, f64::max);
        let seen = self.0.iter().zip(defects).map(|(element, defects)| element.seen(*defects));
        Self(seen.flat_map(|element| element.refined(worst, target, growth)).collect())
    }
}
