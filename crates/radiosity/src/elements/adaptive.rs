//! ∫_P Φ(x) dx for a Φ with many components that may not be smooth at the edges of P.
//!
//! Where P shares an edge with another patch, the potential of that patch is bounded on P but bends like w ln w at the
//! distance w from the edge, and at the ends of the edge depends on the direction. The edges of P are sides of the square
//! that it is the image of: Gauss's rule in τ with w = τ³ (10 − 15 τ + 6 τ²), flat at both ends (A. Sidi 1993), converges as
//! if nothing happened there. Its orders are raised until two agree; where they do not, since Φ bends elsewhere, as across a
//! thin gap from the edge of another patch, cells are cut in two, in the direction in which that changes most.

use super::degree::MOST;
use super::rules::collapsed;
use super::space::{is_triangle, point};
use crate::polygon::Polygon;
use fredholm::quadrature::{Quadrature, gauss_legendre};
use glam::DVec3;

/// What is integrated: a block of a matrix, a row for each test function.
pub(super) type Block = [[f64; MOST]; MOST];

/// The value at a node: test functions and potentials, of which the block is the product.
pub(super) type Sample = ([f64; MOST], [f64; MOST]);

/// Points each way of the rules that are dense at the edges. Two squares with a common edge meet a tolerance of 10⁻⁴ with the
/// second.
const FLATTENED: [usize; 7] = [6, 9, 13, 18, 25, 35, 50];

/// A step that leaves more than this of the error promises nothing of the next.
const SLOW: f64 = 0.5;

/// Halves of a cell may agree without having seen what is narrow.
const SAFETY: f64 = 0.1;

/// Cells of a patch, at most: a pair takes no longer than a second, and has what they give.
const MOST_CELLS: usize = 300;

/// The integral of test functions times potentials over a patch.
pub(super) struct Adaptive<'a, F, N> {
    pub polygon: &'a Polygon,
    /// Test functions and potentials at a point.
    pub sample: F,
    /// How large the error of a block is.
    pub norm: N,
    rule: Quadrature<[f64; 2]>,
}

/// A part of the unit square.
#[derive(Clone, Copy)]
struct Cell {
    low: [f64; 2],
    high: [f64; 2],
}

impl<'a, F: Fn(DVec3) -> Sample, N: Fn(&Block) -> f64> Adaptive<'a, F, N> {
    /// For test functions of a degree: n points each way are exact up to 2n − 1, of which a test function takes `degree`.
    pub fn new(degree: usize, polygon: &'a Polygon, sample: F, norm: N) -> Self {
        Self { polygon, sample, norm, rule: gauss_legendre(degree + 4, 0.0, 1.0).squared() }
    }

    /// The integral, with an error of about `tolerance(a first estimate)`.
    pub fn integrate(&self, tolerance: impl Fn(&Block) -> f64) -> Block {
        let mut coarse = self.flattened(FLATTENED[0]);
        let (tolerance, mut last) = (tolerance(&coarse), f64::INFINITY);
        for n in &FLATTENED[1..] {
            let fine = self.flattened(*n);
            let error = (self.norm)(&combined(&fine, &coarse, -1.0));
            if error <= tolerance {
                return fine;
            }
            if error > SLOW * last {
                break;
            }
            (coarse, last) = (fine, error);
        }
        self.by_cells(SAFETY * tolerance)
    }

    /// The integral by cells, the one with the largest error cut next, until the errors add up to the tolerance.
    fn by_cells(&self, tolerance: f64) -> Block {
        let whole = Cell { low: [0.0; 2], high: [1.0; 2] };
        let mut parts = vec![self.part(whole, &self.estimate(whole))];
        while parts.len() < MOST_CELLS && parts.iter().map(Part::error).sum::<f64>() > tolerance {
            let errors = || parts.iter().map(Part::error).enumerate();
            let Some((worst, _)) = errors().max_by(|a, b| a.1.total_cmp(&b.1)) else { break };
            let Part { halves, .. } = parts.swap_remove(worst);
            parts.extend(halves.iter().map(|(cell, estimate)| self.part(*cell, estimate)));
        }
        parts.iter().fold([[0.0; MOST]; MOST], |sum, part| combined(&sum, &part.value, 1.0))
    }

    /// The integral by n × n points that are dense at the edges.
    fn flattened(&self, n: usize) -> Block {
        let rule = gauss_legendre(n, 0.0, 1.0).map(|&t, weight| {
            (t.powi(3) * (10.0 - 15.0 * t + 6.0 * t * t), 30.0 * (t * (1.0 - t)).powi(2) * weight)
        });
        let mut block = [[0.0; MOST]; MOST];
        let points = rule.squared();
        points.nodes.iter().zip(&points.weights).for_each(|(at, weight)| self.add(*at, *weight, &mut block));
        block
    }

    /// A cell, of which `whole` is an estimate, cut both ways.
    ///
    /// Halves in s and halves in t take away the errors of the rule in s and in t, so both corrections are made.
    fn part(&self, cell: Cell, whole: &Block) -> Part {
        let cuts = [0, 1].map(|axis| cell.halves(axis).map(|half| (half, self.estimate(half))));
        let corrections =
            cuts.each_ref().map(|[first, second]| combined(&combined(&first.1, &second.1, 1.0), whole, -1.0));
        let errors = corrections.each_ref().map(|correction| (self.norm)(correction));
        let value = combined(&combined(whole, &corrections[0], 1.0), &corrections[1], 1.0);
        let [in_s, in_t] = cuts;
        Part { value, errors, halves: if errors[1] > errors[0] { in_t } else { in_s } }
    }

    fn estimate(&self, cell: Cell) -> Block {
        let mut block = [[0.0; MOST]; MOST];
        let size = [0, 1].map(|axis| cell.high[axis] - cell.low[axis]);
        for (&[s, t], weight) in self.rule.nodes.iter().zip(&self.rule.weights) {
            let at = [cell.low[0] + size[0] * s, cell.low[1] + size[1] * t];
            self.add(at, weight * size[0] * size[1], &mut block);
        }
        block
    }

    /// Adds the sample at a point of the square to a block.
    fn add(&self, at: [f64; 2], weight: f64, block: &mut Block) {
        let (x, density) = self.node(at);
        let (tests, potentials) = (self.sample)(x);
        for (row, test) in block.iter_mut().zip(tests) {
            row.iter_mut().zip(potentials).for_each(|(entry, u)| *entry += weight * density * test * u);
        }
    }

    /// The point of the patch at (s, t) of the square, and the area that a unit of the square is stretched to.
    fn node(&self, [s, t]: [f64; 2]) -> (DVec3, f64) {
        if is_triangle(self.polygon) {
            (point(self.polygon, collapsed(s, t)), 2.0 * s * self.polygon.area())
        } else {
            (self.polygon.point(s, t), self.polygon.density(s, t))
        }
    }
}

/// A cell with its integral, what it may be off by, and its halves where it is off by more.
struct Part {
    value: Block,
    errors: [f64; 2],
    halves: [(Cell, Block); 2],
}

impl Part {
    fn error(&self) -> f64 {
        self.errors[0] + self.errors[1]
    }
}

impl Cell {
    fn halves(self, axis: usize) -> [Self; 2] {
        let middle = 0.5 * (self.low[axis] + self.high[axis]);
        let mut halves = [self; 2];
        halves[0].high[axis] = middle;
        halves[1].low[axis] = middle;
        halves
    }
}

/// a + `factor` b.
pub(super) fn combined(a: &Block, b: &Block, factor: f64) -> Block {
    std::array::from_fn(|k| std::array::from_fn(|l| a[k][l] + factor * b[k][l]))
}

/// The block with rows for columns.
pub(super) fn transposed(block: &Block) -> Block {
    std::array::from_fn(|a| std::array::from_fn(|b| block[b][a]))
}
