//! Σ_p w_p g(y_p) on a patch: products of Gauss's rules, with the basis at their nodes, of the order that a distance asks for.

use super::degree::{Degree, Local, Reference};
use super::space::{is_triangle, point};
use crate::polygon::Polygon;
use fredholm::quadrature::gauss_legendre;
use glam::DVec3;

/// Rules of 1 × 1 … 8 × 8 points on both reference elements.
#[derive(Debug)]
pub(super) struct Rules {
    triangle: Vec<Rule>,
    square: Vec<Rule>,
}

/// A rule on a reference element.
#[derive(Debug)]
pub(super) struct Rule {
    /// The nodes, the weights, which add up to 1, and the basis there.
    nodes: Vec<([f64; 2], f64, Local)>,
}

/// A node on a patch: where it is, the area that it stands for, and the basis there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub at: DVec3,
    pub weight: f64,
    pub values: Local,
}

/// Points each way beyond which a graded rule is cheaper.
pub(super) const MOST_POINTS: usize = 8;

impl Rules {
    pub fn new(degree: Degree) -> Self {
        let (triangle, square) = (Reference::triangle(degree), Reference::square(degree));
        let all = |reference: &Reference, fold: bool| {
            (1..=MOST_POINTS).map(|n| Rule::new(n, reference, fold)).collect()
        };
        Self { triangle: all(&triangle, true), square: all(&square, false) }
    }

    /// The nodes of n × n points on a patch.
    pub fn nodes(&self, n: usize, polygon: &Polygon) -> impl Iterator<Item = Node> {
        let triangle = is_triangle(polygon);
        let rules = if triangle { &self.triangle } else { &self.square };
        rules[n - 1].nodes.iter().map(move |&([s, t], w, values)| {
            let weight = w * if triangle { polygon.area() } else { polygon.density(s, t) };
            Node { at: point(polygon, [s, t]), weight, values }
        })
    }
}

impl Rule {
    /// n × n points, the square collapsed onto the first corner of a triangle with `fold`.
    fn new(n: usize, reference: &Reference, fold: bool) -> Self {
        let rule = gauss_legendre(n, 0.0, 1.0).squared();
        let node = |(&[s, t], w): (&[f64; 2], &f64)| {
            let (at, weight) = if fold { (collapsed(s, t), 2.0 * s * w) } else { ([s, t], *w) };
            (at, weight, reference.values(at))
        };
        Self { nodes: rule.nodes.iter().zip(&rule.weights).map(node).collect() }
    }
}

/// The point of the reference triangle that (s, t) of the square falls on: s = 0 is its first corner, and the other three
/// sides of the square are its edges.
pub(super) fn collapsed(s: f64, t: f64) -> [f64; 2] {
    [s * (1.0 - t), s * t]
}

/// The fewest points each way whose rule has an error below `tolerance`, relative to the integral of |K φ|, for a kernel
/// seen from `distance` diameters away and polynomials of `degree` as factors; none when a graded rule is called for.
pub(super) fn points(distance: f64, degree: usize, tolerance: f64) -> Option<usize> {
    if distance < NEAREST {
        return None;
    }
    // n points are exact up to the degree 2n − 1, of which the factors take their part.
    let exponent = (ERROR / tolerance).ln() / (distance / RADIUS).ln();
    let n = (0.5 * (exponent + degree as f64)).ceil().max(degree as f64 + 1.0) as usize;
    (n <= MOST_POINTS).then_some(n)
}

/// n points err by less than ERROR (RADIUS/distance)^{2n − degree}.
const ERROR: f64 = 4.0;
const RADIUS: f64 = 0.4;
/// Nearer than that patches may touch.
const NEAREST: f64 = 1.35;
