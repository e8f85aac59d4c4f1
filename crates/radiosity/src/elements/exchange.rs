//! G_ab = ∫_{P_i} φ_a(x) ∫_{P_j} K(x, y) φ_b(y) dy dx between patches that nothing hides from each other.
//!
//! Patches apart: the product of two Gauss rules. Near ones, of any shape, across each other's planes, with a common edge or
//! corner or a thin gap between them: [`Moments`] over one, cut adaptively over the other.

use super::adaptive::{Adaptive, Block, combined, transposed};
use super::degree::MOST;
use super::moments::{Front, Moments, kernel};
use super::rules::{Node, points};
use super::space::Space;
use crate::form_factor::exchange::SMALL;
use crate::kernel::SurfacePoint;
use crate::polygon::Polygon;

/// What is integrated over the outer patch must be smoother than its cells are asked to agree, or they are cut without end.
const SMOOTH: f64 = 0.05;

/// The unoccluded exchange between the elements of a space.
#[derive(Debug)]
pub(super) struct Exchange<'a> {
    moments: Moments<'a>,
    tolerance: f64,
    /// ΣA.
    area: f64,
}

impl<'a> Exchange<'a> {
    /// With an error of about `tolerance` for each pair, in the means ⟨φ_a, ·⟩/m_a, relative to the exchange of the pair or,
    /// where that is less, to a tenth of what patches of these areas exchange in the mean.
    pub fn new(space: &'a Space<'a>, tolerance: f64) -> Self {
        Self { moments: Moments::new(space, SMOOTH * tolerance), tolerance, area: space.areas.iter().sum() }
    }

    /// The block G of elements i and j: that of j and i, transposed.
    pub fn between(&self, i: usize, j: usize) -> Block {
        let areas = &self.space().areas;
        // The rule does not depend on who asks.
        let (outer, inner) = if (areas[i], i) <= (areas[j], j) { (i, j) } else { (j, i) };
        let block = self.over(outer, inner);
        if outer == i { block } else { transposed(&block) }
    }

    /// The moments that it integrates.
    pub fn moments(&self) -> &Moments<'a> {
        &self.moments
    }

    fn space(&self) -> &'a Space<'a> {
        self.moments.space()
    }

    fn over(&self, outer: usize, inner: usize) -> Block {
        let space = self.space();
        let (a, b) = (&space.polygons()[outer], &space.polygons()[inner]);
        let seen = Front::of(b, a);
        match (Front::of(a, b), &seen) {
            (Front::Nothing, _) | (_, Front::Nothing) => [[0.0; MOST]; MOST],
            (Front::Whole, Front::Whole) => {
                let between = a.centroid().distance(b.centroid());
                let distance = between / space.diameters[outer].max(space.diameters[inner]);
                match points(distance, space.degree().order(), self.tolerance) {
                    Some(n) => self.product(n, a, b),
                    None => self.near(outer, inner, &seen, a),
                }
            }
            (Front::Whole, _) => self.near(outer, inner, &seen, a),
            (Front::Pieces(pieces), _) => pieces.iter().fold([[0.0; MOST]; MOST], |sum, piece| {
                combined(&sum, &self.near(outer, inner, &seen, piece), 1.0)
            }),
        }
    }

    /// Σ_p Σ_q w_p w_q φ_a(x_p) K(x_p, y_q) φ_b(y_q), n × n points on each patch.
    fn product(&self, n: usize, a: &Polygon, b: &Polygon) -> Block {
        let rules = self.moments.rules();
        let inner: Vec<Node> = rules.nodes(n, b).collect();
        let mut block = [[0.0; MOST]; MOST];
        for x in rules.nodes(n, a) {
            let mut potentials = [0.0; MOST];
            for y in &inner {
                let k = y.weight * kernel(a.normal(), b.normal(), y.at - x.at);
                potentials.iter_mut().zip(y.values).for_each(|(u, value)| *u += k * value);
            }
            for (row, test) in block.iter_mut().zip(x.values) {
                let test = x.weight * test;
                row.iter_mut().zip(potentials).for_each(|(entry, u)| *entry += test * u);
            }
        }
        block
    }

    /// The moments of `inner`, integrated over a piece of `outer`.
    fn near(&self, outer: usize, inner: usize, seen: &Front, piece: &Polygon) -> Block {
        let space = self.space();
        let normal = piece.normal();
        let sample = |position| {
            let moments = self.moments.at(&SurfacePoint { position, normal }, inner, seen);
            (space.values(outer, position), moments)
        };
        let weights = &space.weights()[space.range(outer)];
        let norm = |block: &Block| {
            let rows = block.iter().zip(weights);
            rows.flat_map(|(row, m)| row.iter().map(move |g| g.abs() / m)).fold(0.0, f64::max)
        };
        let tolerance = |estimate: &Block| {
            let exchange: f64 = estimate.iter().flatten().sum();
            // Of the whole patch, not of a piece: a cut may leave a sliver whose share is rounding.
            let least = SMALL * space.areas[outer] * space.areas[inner] / self.area;
            self.tolerance * exchange.max(least) / space.areas[outer]
        };
        Adaptive::new(space.degree().order(), piece, sample, norm).integrate(tolerance)
    }
}
