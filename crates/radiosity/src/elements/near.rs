//! ∫_P K(x, y) g(y) dy = Σ_edges ∫₀¹ ∫₀¹ K g D s ds dt with y = x* + s (e(t) − x*): polar coordinates about the point x* of P
//! nearest to x.
//!
//! K is nearly singular where x is near P: at the distance δ from x, its scale is δ. Along a ray from x* the distance to
//! x never shrinks, (x* − x) · (y − x*) ≥ 0, so in s the kernel is singular no nearer to 0 than c = δ/|e − x*|, and not
//! in the right half plane; s = c sinh v takes that to a distance of at least asinh 1 = 0.88 from the range of v, whatever δ is.
//! Along an edge t = t* ± δ_e sinh v does the same about the point nearest to x. Gauss's rule on pieces of about that
//! length converges at a rate that depends on nothing: not on the distance, the shape or the angles. All points lie in
//! P, all weights are positive, and a distance of 10⁻⁶ takes some 12 pieces along s where 1 takes one.

use crate::polygon::Polygon;
use fredholm::quadrature::{Quadrature, gauss_legendre};
use glam::DVec3;

/// The rule about the nearest point, of so many Gauss points a piece.
#[derive(Clone, Debug)]
pub struct Polar {
    rule: Quadrature<f64>,
}

/// Pieces in v are at most this long. The error of n points is about (PIECE_RATE)^{−2n}: at 0.88 + ½ from the middle of a piece
/// of half length ½, ρ = 2.76 + √(2.76² − 1) = 5.3.
const PIECE: f64 = 1.0;
const PIECE_RATE: f64 = 5.3;

/// Nothing is gained beyond: rounding.
const MOST_POINTS: usize = 12;

impl Polar {
    /// The rule whose error is about `tolerance` of the integral of |K g|, for a g that is a polynomial of degree ≤ 4.
    pub fn new(tolerance: f64) -> Self {
        // One more than the kernel alone would take: the rule has g, the Jacobian and cosθ cosθ′ to integrate too.
        let points = (-tolerance.ln() / (2.0 * PIECE_RATE.ln())).ceil() as usize + 1;
        Self { rule: gauss_legendre(points.clamp(3, MOST_POINTS), 0.0, 1.0) }
    }

    /// Calls `visit(y − x, weight)` at the nodes y on a convex polygon of a rule for x, a point not on it.
    pub fn visit(&self, x: DVec3, polygon: &Polygon, mut visit: impl FnMut(DVec3, f64)) {
        let corners: Vec<DVec3> = polygon.vertices().iter().map(|v| *v - x).collect();
        let nearest = nearest_to_origin(&corners, polygon.normal());
        let distance = nearest.length();
        for (k, &a) in corners.iter().enumerate() {
            let b = corners[(k + 1) % corners.len()];
            let doubled = (a - nearest).cross(b - nearest).length();
            if doubled > 0.0 {
                self.along_edge(a, b, |end, weight| {
                    let ray = end - nearest;
                    self.graded(distance / ray.length(), 1.0, |s, w| {
                        visit(nearest + s * ray, doubled * weight * s * w);
                    });
                });
            }
        }
    }

    /// Visits the edge from a to b, t in 0 … 1, graded towards the point nearest to the origin.
    fn along_edge(&self, a: DVec3, b: DVec3, mut visit: impl FnMut(DVec3, f64)) {
        let edge = b - a;
        let foot = nearest_parameter(a, edge);
        let scale = (a + foot * edge).length() / edge.length();
        self.graded(scale, 1.0 - foot, |t, w| visit(a + (foot + t) * edge, w));
        self.graded(scale, foot, |t, w| visit(a + (foot - t) * edge, w));
    }

    /// ∫_0^`end` by t = `scale` sinh v, on pieces of v.
    fn graded(&self, scale: f64, end: f64, mut visit: impl FnMut(f64, f64)) {
        if end <= 0.0 {
            return;
        }
        let range = (end / scale).asinh();
        let pieces = (range / PIECE).ceil().max(1.0);
        let length = range / pieces;
        for piece in 0..pieces as usize {
            for (node, weight) in self.rule.nodes.iter().zip(&self.rule.weights) {
                let v = (piece as f64 + node) * length;
                visit(scale * v.sinh(), weight * length * scale * v.cosh());
            }
        }
    }
}

/// The parameter in 0 … 1 of the point nearest to the origin on the segment from a along `edge`.
fn nearest_parameter(a: DVec3, edge: DVec3) -> f64 {
    (-a.dot(edge) / edge.length_squared()).clamp(0.0, 1.0)
}

/// The point of a convex polygon nearest to the origin.
fn nearest_to_origin(corners: &[DVec3], normal: DVec3) -> DVec3 {
    let edges = || corners.iter().enumerate().map(|(k, &a)| (a, corners[(k + 1) % corners.len()] - a));
    let below = corners[0].dot(normal) * normal;
    if edges().all(|(a, edge)| edge.cross(below - a).dot(normal) >= 0.0) {
        return below;
    }
    let ends = edges().map(|(a, edge)| a + nearest_parameter(a, edge) * edge);
    ends.min_by(|p, q| p.length_squared().total_cmp(&q.length_squared())).unwrap_or(below)
}
