//! ∫_P K(x, y) g(y) dy = Σ_edges ∫₀¹ ∫₀¹ K g D s ds dt with y = x* + s (e(t) − x*): polar coordinates about the point x* of P
//! nearest to x.
//!
//! K is nearly singular where x is near P: at the distance δ from x, its scale is δ. Along a ray from x* the distance to
//! x never shrinks, (x* − x) · (y − x*) ≥ 0, so in s the kernel is singular no nearer to 0 than c = δ/|e − x*|, and not
//! in the right half plane; s = c sinh v takes that to a distance of at least asinh 1 = 0.88 from the range of v and π/2 from
//! the rest of its axis, whatever δ is. Along an edge t = t* + δ_e sinh v does the same about the point nearest to x. So
//! Gauss's rule converges at a rate that is told by the length of the range alone: not by the distance, the shape or the
//! angles. All points lie in P, all weights are positive, and the range grows like −ln δ.

use crate::polygon::Polygon;
use fredholm::quadrature::{Quadrature, gauss_legendre};
use glam::DVec3;
use std::f64::consts::PI;

/// The rule about the nearest point.
#[derive(Clone, Debug)]
pub struct Polar {
    /// Gauss's rules of 1, 2, … points on 0 … 1.
    rules: Vec<Quadrature<f64>>,
    /// −ln of the tolerance.
    digits: f64,
    /// Points more than the kernel alone would take.
    more: usize,
}

/// A range of v is cut in pieces no longer than this: longer ones take hardly fewer points in all.
const PIECE: f64 = 3.0;

/// Nothing is gained beyond: rounding.
const MOST_POINTS: usize = 24;

impl Polar {
    /// The rule whose error is about `tolerance` of ∫ |K g|, for a g that is as smooth as a polynomial of a `degree` is, also
    /// through a bilinear map: those of Q2 on a trapezoid missed 10⁻¹⁰ by a factor of 10 with a point less.
    pub fn new(tolerance: f64, degree: usize) -> Self {
        let rules = (1..=MOST_POINTS).map(|n| gauss_legendre(n, 0.0, 1.0)).collect();
        Self { rules, digits: -tolerance.ln(), more: 1 + degree }
    }

    /// The rule for a piece of a range of v: n points err by ρ^{−2n} when ρ is the sum of the half axes of the ellipse
    /// about the piece that reaches the nearest singularity, 0.88 before its beginning or π/2 beside it.
    fn rule(&self, length: f64) -> &Quadrature<f64> {
        let rate = (PI / length).asinh().min((1.0 + 1.76 / length).acosh());
        let points = (0.5 * self.digits / rate).ceil() as usize + self.more;
        &self.rules[points.min(MOST_POINTS) - 1]
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
                    self.graded(distance / ray.length(), [0.0, 1.0], |s, w| {
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
        self.graded(scale, [-foot, 1.0 - foot], |t, w| visit(a + (foot + t) * edge, w));
    }

    /// ∫ over a range of t by t = `scale` sinh v, on pieces of v.
    fn graded(&self, scale: f64, range: [f64; 2], mut visit: impl FnMut(f64, f64)) {
        // Where the point itself lies on P, or a ray has no length, there is nothing to integrate.
        if !(scale > 0.0 && scale.is_finite()) {
            return;
        }
        let [from, to] = range.map(|t| (t / scale).asinh());
        let pieces = ((to - from) / PIECE).ceil().max(1.0);
        let length = (to - from) / pieces;
        let rule = self.rule(length);
        for piece in 0..pieces as usize {
            for (node, weight) in rule.nodes.iter().zip(&rule.weights) {
                let v = from + (piece as f64 + node) * length;
                visit(scale * v.sinh(), weight * length * scale * v.cosh());
            }
        }
    }
}

/// The parameter in 0 … 1 of the point nearest to the origin on the segment from a along `edge`.
fn nearest_parameter(a: DVec3, edge: DVec3) -> f64 {
    let square = edge.length_squared();
    if square > 0.0 { (-a.dot(edge) / square).clamp(0.0, 1.0) } else { 0.0 }
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
