//! ∫_piece g ≈ Σ_ij w_ij g(q_ij): a rule with two counts on a rectangle, a triangle or a ring, and their parts (paper,
//! §4.3.2 in each direction).

use super::Domain;
use super::domain::triangle_area;
use crate::quadrature::{Quadrature, gauss_legendre};
use std::f64::consts::TAU;

/// A part of the domain that has a product rule in two directions.
#[derive(Clone, Copy, Debug)]
pub(super) enum Piece {
    /// Directions: x, y.
    Rectangle { x: [f64; 2], y: [f64; 2] },
    /// Directions: away from the first corner, and from the second corner to the third.
    Triangle([[f64; 2]; 3]),
    /// Directions: radius, angle. A disk has no inner radius.
    Ring { centre: [f64; 2], inner: f64, outer: f64 },
}

impl From<Domain> for Piece {
    fn from(domain: Domain) -> Self {
        match domain {
            Domain::Rectangle { x0, x1, y0, y1 } => Self::Rectangle { x: [x0, x1], y: [y0, y1] },
            Domain::Triangle(corners) => Self::Triangle(corners),
            Domain::Disk { centre, radius } => Self::Ring { centre, inner: 0.0, outer: radius },
        }
    }
}

impl Piece {
    /// How many nodes the second direction needs for one of the first. Polynomials of degree 4n − 1 are exact on a disk
    /// with n radii and 4n angles: r² is of degree 2.
    pub(super) fn proportion(&self) -> usize {
        if matches!(self, Self::Ring { .. }) { 4 } else { 1 }
    }

    /// The product rule with so many nodes in each direction.
    pub(super) fn rule(&self, [m, n]: [usize; 2]) -> Quadrature<[f64; 2]> {
        match *self {
            Self::Rectangle { x, y } => {
                product(&gauss_legendre(m, x[0], x[1]), &gauss_legendre(n, y[0], y[1]), |x, y| ([x, y], 1.0))
            }
            Self::Triangle(corners) => {
                let area = triangle_area(&corners);
                let unit = |n| gauss_legendre(n, 0.0, 1.0);
                product(&unit(m), &unit(n), |u, v| (barycentric(&corners, u, v), 2.0 * area * u))
            }
            Self::Ring { centre, inner, outer } => {
                let square = gauss_legendre(m, inner * inner, outer * outer);
                product(&square, &circle(n), |s, angle| {
                    let (sin, cos) = angle.sin_cos();
                    ([centre[0] + s.sqrt() * cos, centre[1] + s.sqrt() * sin], 0.5)
                })
            }
        }
    }

    /// A point in the middle: of a disk the one that its nodes are farthest from, for its size.
    pub(super) fn middle(&self) -> [f64; 2] {
        match *self {
            Self::Rectangle { x, y } => [0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1])],
            Self::Triangle([a, b, c]) => [0, 1].map(|k| (a[k] + b[k] + c[k]) / 3.0),
            Self::Ring { centre, .. } => centre,
        }
    }

    /// Its parts: halves of a rectangle along either direction or both, four triangles, or two rings.
    pub(super) fn split(&self, along: [bool; 2]) -> Vec<Self> {
        match *self {
            Self::Rectangle { x, y } => {
                let (x, y) = (halves(x, along[0]), halves(y, along[1]));
                x.iter().flat_map(|x| y.iter().map(|y| Self::Rectangle { x: *x, y: *y })).collect()
            }
            Self::Triangle([a, b, c]) => {
                let middle = |p: [f64; 2], q: [f64; 2]| [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])];
                let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
                [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]].map(Self::Triangle).to_vec()
            }
            Self::Ring { centre, inner, outer } => {
                let rings = halves([inner, outer], true).into_iter();
                rings.map(|[inner, outer]| Self::Ring { centre, inner, outer }).collect()
            }
        }
    }

    /// Which of its directions become shorter by splitting.
    pub(super) fn splits(&self) -> [bool; 2] {
        [true, !matches!(self, Self::Ring { .. })]
    }
}

fn halves([a, b]: [f64; 2], split: bool) -> Vec<[f64; 2]> {
    let middle = 0.5 * (a + b);
    if split { vec![[a, middle], [middle, b]] } else { vec![[a, b]] }
}

/// The rule that `map` makes of two others: (a, b) ↦ the node and the Jacobian there.
fn product(
    first: &Quadrature<f64>,
    second: &Quadrature<f64>,
    map: impl Fn(f64, f64) -> ([f64; 2], f64),
) -> Quadrature<[f64; 2]> {
    let pairs =
        |rule: &Quadrature<f64>| rule.nodes.iter().copied().zip(rule.weights.clone()).collect::<Vec<_>>();
    let (first, second) = (pairs(first), pairs(second));
    let of_pair = |((a, v), (b, w)): ((f64, f64), (f64, f64))| {
        let (node, jacobian) = map(a, b);
        (node, v * w * jacobian)
    };
    let all = first.iter().flat_map(|a| second.iter().map(move |b| of_pair((*a, *b))));
    let (nodes, weights) = all.unzip();
    Quadrature { nodes, weights }
}

/// The point a + u ((1 − v) (b − a) + v (c − a)): Duffy's map of the unit square to a triangle.
fn barycentric([a, b, c]: &[[f64; 2]; 3], u: f64, v: f64) -> [f64; 2] {
    [0, 1].map(|k| a[k] + u * ((1.0 - v) * (b[k] - a[k]) + v * (c[k] - a[k])))
}

/// The trapezoid rule on the circle. It begins at a quarter of a step: then no node of n is one of 2n.
fn circle(n: usize) -> Quadrature<f64> {
    let step = TAU / n as f64;
    Quadrature { nodes: (0..n).map(|k| (k as f64 + 0.25) * step).collect(), weights: vec![step; n] }
}
