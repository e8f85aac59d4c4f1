//! ∫_{P_i} ∫_{P_j} cosθ cosθ′ / (π r²) dy dx = (1/2π) ∮_{∂P_i} ∮_{∂P_j} ln r dx·dy, for polygons in front of each other.
//!
//! Stokes' theorem, twice. Of the two integrals over a pair of edges one is elementary, and both are where the edges are
//! parallel or in line, as an edge that two polygons share is. Else the other is taken by Gauss's rule on panels: seen
//! from the middle of a panel of length 2, the integrand has all its singularities on circles about it whose radii are
//! the distances q to the points of the other edge, so that m nodes err by ρ^(−2m), ρ = q + √(q² − 1). Panels are halved
//! towards what is near or touches.

use crate::view_factors::Exchange;
use fredholm::quadrature::{Quadrature, gauss_legendre};
use glam::DVec3;
use std::f64::consts::TAU;
use std::sync::LazyLock;

/// The exchange between two polygons, given by their vertices, each wholly in front of the other's plane or in it, in
/// m²; the error is below `tolerance`, in m², or at rounding: some 10⁻¹⁶ times the product of their circumferences.
pub fn exchange(a: &[DVec3], b: &[DVec3], tolerance: f64) -> Exchange {
    let scale = a[0].distance(b[b.len() / 2]).max(a[a.len() / 2].distance(b[0]));
    let unit = scale.recip();
    let share = tolerance * unit * unit * TAU / (a.len() * b.len()) as f64;
    let (mut sum, mut size, mut error) = (0.0, 0.0, 0.0);
    for e in edges(a, unit) {
        for f in edges(b, unit) {
            let along = e.direction.dot(f.direction);
            let weight = along.abs() * e.length * f.length;
            if weight > f64::EPSILON * e.length * f.length {
                let (integral, missed) = mean_logarithm(&e, &f, share / weight);
                sum += along * integral * e.length * f.length;
                error += weight * missed;
                size += weight * integral.abs().max(1.0);
            }
        }
    }
    let area = scale * scale / TAU;
    Exchange { value: (area * sum).max(0.0), error: area * (error + ROUNDING * size) }
}

/// What the terms of an edge pair are wrong by, relative to themselves or, where they are less, to 1.
const ROUNDING: f64 = 1e-15;

/// An edge, in a unit in which the two polygons are about 1 apart.
struct Edge {
    start: DVec3,
    end: DVec3,
    direction: DVec3,
    length: f64,
}

impl Edge {
    fn new(start: DVec3, end: DVec3) -> Self {
        let length = start.distance(end);
        let direction = if length > 0.0 { (end - start) / length } else { DVec3::ZERO };
        Self { start, end, direction, length }
    }

    /// The distance of a point from it.
    fn distance(&self, x: DVec3) -> f64 {
        let along = (x - self.start).dot(self.direction).clamp(0.0, self.length);
        x.distance(self.start + along * self.direction)
    }

    /// ∫ ln |x − y| dy along it: [s ln √(s² + h²) − s + h atan(s/h)] between the ends, s along and h across.
    fn logarithm(&self, x: DVec3) -> f64 {
        let from = self.start - x;
        let (s, t) = (from.dot(self.direction), (self.end - x).dot(self.direction));
        let square = from.cross(self.direction).length_squared();
        let height = square.sqrt();
        let term = |s: f64| if s == 0.0 { 0.0 } else { 0.5 * s * (s * s + square).ln() };
        term(t) - term(s) - self.length + height * (height * self.length).atan2(square + s * t)
    }
}

fn edges(polygon: &[DVec3], unit: f64) -> impl Iterator<Item = Edge> {
    let next = polygon.iter().cycle().skip(1);
    polygon.iter().zip(next).map(move |(&p, &q)| Edge::new(p * unit, q * unit))
}

/// The mean of ln r over two edges, and a bound of what it is wrong by, which is below `tolerance` if it can be.
fn mean_logarithm(e: &Edge, f: &Edge, tolerance: f64) -> (f64, f64) {
    if e.direction.cross(f.direction).length_squared() < PARALLEL * PARALLEL {
        return (parallel(e, f) / (e.length * f.length), 0.0);
    }
    // The inner integral is over the longer edge, so that the outer one has fewer panels.
    let (outer, inner) = if e.length <= f.length { (e, f) } else { (f, e) };
    let mut panels =
        Panels { outer, inner, digits: -tolerance.clamp(1e-18, 0.1).ln(), tolerance, missed: 0.0 };
    let sum = panels.integral(0.0, 1.0, DEEPEST);
    (sum / inner.length, panels.missed)
}

/// The sine of an angle at which edges count as parallel: below it their logarithms differ by rounding.
const PARALLEL: f64 = 1e-14;

/// Ψ″ = ln √(z² + h²), at the four differences of the ends.
fn parallel(e: &Edge, f: &Edge) -> f64 {
    let from = f.start - e.start;
    let square = from.cross(e.direction).length_squared();
    let height = square.sqrt();
    let psi = |z: f64| {
        let radius = z * z + square;
        if radius == 0.0 {
            return 0.0;
        }
        0.25 * (z * z - square) * radius.ln() - 0.75 * z * z + height * z * z.atan2(height)
    };
    let forwards = e.direction.dot(f.direction).signum();
    let (p, q) = (from.dot(e.direction), from.dot(e.direction) + forwards * f.length);
    forwards * (psi(q) - psi(p) - psi(q - e.length) + psi(p - e.length))
}

/// Halvings of an edge towards a corner that it shares, at most: what is left is 2⁻⁴⁰ of it, and weighs its square.
const DEEPEST: u32 = 40;

/// Most nodes on a panel, and the least ρ with which it is not halved: with it sixteen nodes err by 10⁻¹³.
const MOST: usize = 16;
const LEAST_RHO: f64 = 2.6;

struct Panels<'a> {
    outer: &'a Edge,
    inner: &'a Edge,
    /// −ln of the tolerance.
    digits: f64,
    tolerance: f64,
    missed: f64,
}

impl Panels<'_> {
    /// The mean of the inner integral over the part from s to t of the outer edge, times t − s.
    fn integral(&mut self, s: f64, t: f64, depth: u32) -> f64 {
        let (width, middle) = (t - s, 0.5 * (s + t));
        let length = width * self.outer.length;
        let q = 2.0 * self.inner.distance(self.outer.start.lerp(self.outer.end, middle)) / length;
        let rho = q + (q * q - 1.0).max(0.0).sqrt();
        if rho < LEAST_RHO && depth > 0 {
            // What the logarithm varies by on so short a panel, a few lengths of it, weighed by its width.
            let varies = width * length.min(self.inner.length) / self.inner.length;
            if varies * (2.0 + varies.ln().abs()) > 0.1 * self.tolerance.max(1e-17) {
                return self.integral(s, middle, depth - 1) + self.integral(middle, t, depth - 1);
            }
            self.missed += varies;
        }
        let count = ((self.digits / (2.0 * rho.max(LEAST_RHO).ln())).ceil() as usize).clamp(2, MOST);
        self.missed += width * rho.max(LEAST_RHO).powi(-2 * count as i32);
        let rule = &RULES[count];
        let mean =
            rule.integrate(|x| self.inner.logarithm(self.outer.start.lerp(self.outer.end, s + width * x)));
        width * mean
    }
}

/// Gauss's rules on [0, 1].
static RULES: LazyLock<Vec<Quadrature<f64>>> =
    LazyLock::new(|| (0..=MOST).map(|n| gauss_legendre(n.max(1), 0.0, 1.0)).collect());

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn p(x: f64, y: f64, z: f64) -> DVec3 {
        DVec3::new(x, y, z)
    }

    fn floor(w: f64, l: f64) -> [DVec3; 4] {
        [p(0.0, 0.0, 0.0), p(l, 0.0, 0.0), p(l, w, 0.0), p(0.0, w, 0.0)]
    }

    /// Parallel to the floor, at height c, looking down.
    fn ceiling(x: [f64; 2], y: [f64; 2], c: f64) -> [DVec3; 4] {
        [p(x[0], y[0], c), p(x[0], y[1], c), p(x[1], y[1], c), p(x[1], y[0], c)]
    }

    /// On the edge of the floor along x, at an angle to it.
    fn wall(h: f64, l: f64, angle: f64) -> [DVec3; 4] {
        let up = p(0.0, angle.cos(), angle.sin()) * h;
        [p(0.0, 0.0, 0.0), up, p(l, 0.0, 0.0) + up, p(l, 0.0, 0.0)]
    }

    #[track_caller]
    fn check(a: &[DVec3], b: &[DVec3], area: f64, expected: f64, digits: f64) {
        // Turned, so that no coordinate is exact.
        let turn = glam::DQuat::from_euler(glam::EulerRot::XYZ, 0.3, 1.2, -0.8);
        for moved in [false, true] {
            let place = |v: &DVec3| if moved { turn * (*v + p(3.0, -2.0, 1.0)) } else { *v };
            let (a, b): (Vec<_>, Vec<_>) = (a.iter().map(place).collect(), b.iter().map(place).collect());
            for tolerance in [1e-3, 1e-5, 1e-8, 1e-12] {
                for Exchange { value, error } in [exchange(&a, &b, tolerance), exchange(&b, &a, tolerance)] {
                    let (got, error) = (value / area, error / area);
                    let true_error = (got - expected).abs();
                    assert!(true_error <= error + digits, "{got} ± {error:e} is {expected}");
                    assert!(error <= 1.5 * tolerance / area, "{error:e} of {tolerance:e}");
                }
            }
        }
    }

    #[test]
    fn parallel_rectangles() {
        let unit = floor(1.0, 1.0);
        check(&unit, &ceiling([0.0, 1.0], [0.0, 1.0], 1.0), 1.0, 0.199824895698, 1e-12);
        check(&floor(1.0, 2.0), &ceiling([0.0, 2.0], [0.0, 1.0], 1.0), 2.0, 0.285875384851, 1e-12);
        check(&unit, &ceiling([0.0, 1.0], [0.0, 1.0], 0.1), 1.0, 0.826994522397, 1e-12);
        check(&unit, &ceiling([1.0, 3.0], [0.5, 1.5], 1.0), 1.0, 0.085530552987, 1e-12);
        check(&unit, &ceiling([1.0, 2.0], [0.0, 1.0], 1.0), 1.0, 0.086050489152, 1e-12);
        // A thin gap: the sides lose 4·(1/2)·gap.
        let gap = 1e-6;
        let thin = exchange(&unit, &ceiling([0.0, 1.0], [0.0, 1.0], gap), 1e-14);
        assert!((1.0 - thin.value - 2.0 * gap).abs() < 1e-10, "{:e}", 1.0 - thin.value);
    }

    #[test]
    fn polygons_that_share_an_edge() {
        check(&floor(1.0, 1.0), &wall(1.0, 1.0, 0.5 * PI), 1.0, 0.200043776075, 1e-12);
        check(&floor(1.0, 1.0), &wall(2.0, 1.0, 0.5 * PI), 1.0, 0.232852602795, 1e-12);
        check(&floor(1.0, 3.0), &wall(0.5, 3.0, 0.5 * PI), 3.0, 0.174626978343, 1e-12);
        check(&floor(1.0, 1.0), &wall(1.0, 1.0, PI / 3.0), 1.0, 0.370905321150, 1e-12);
        let (o, x, y, z) = (DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z);
        check(&[o, x, y], &[o, z, x], 0.5, 0.211324865405, 1e-12);
        let [a, b, c, d] = [p(1.0, 1.0, 1.0), p(1.0, -1.0, -1.0), p(-1.0, 1.0, -1.0), p(-1.0, -1.0, 1.0)];
        check(&[a, c, b], &[a, b, d], 2.0 * 3_f64.sqrt(), 1.0 / 3.0, 1e-14);
    }

    #[test]
    fn the_faces_of_an_octahedron() {
        let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
        let area = 0.5 * 3_f64.sqrt();
        check(&[y, x, z], &[z, x, -y], area, 0.136854306397, 1e-12);
        check(&[y, x, z], &[x, -z, -y], area, 0.148941118017, 1e-12);
        check(&[y, x, z], &[-x, -y, -z], area, 0.142613726760, 1e-12);
    }

    #[test]
    fn triangles_above_each_other() {
        let (o, x, y, up) = (DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z);
        check(&[o, x, y], &[up, up + y, up + x], 0.5, 0.115049228150, 1e-12);
    }
}
