//! Charts: a domain as a few quadrilaterals, each the image of [0, 1]², in which solutions are smooth up to the boundary.
//!
//! Where K is as |p − q|^β, φ is as r^(2 + β) at the boundary, r being the distance from it, and as r² ln r where K is logarithmic.
//! With r = u^power it is smoother in u, and 16 nodes do more for it (R. Kress, *Numer. Math.* 58, 1990).

use crate::plane::Domain;
use std::f64::consts::FRAC_PI_2;

type Point = [f64; 2];

/// A map (u, v) ↦ p of [0, 1]² into the plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chart {
    /// At (0, 0), (1, 0), (0, 1) and (1, 1).
    corners: [Point; 4],
    /// The circle that the side u = 0 is an arc of: its centre.
    arc: Option<Point>,
    /// r = u^power where u = 0 is of the boundary, and 1 where it is not; and for v.
    powers: [i32; 2],
}

/// The power for a kernel like |p − q|^exponent: r^(2 + exponent) becomes as smooth as u⁵, but nodes must not come so near to the
/// boundary that no digits are left of r. Lower powers need more elements at the boundary, higher ones more inside.
fn power(exponent: f64) -> i32 {
    let smooth = 5.0 / (2.0 + exponent.min(0.0));
    // An exponent that is found is not found exactly.
    (smooth - 0.01).ceil().min(4.0) as i32
}

/// The half diagonal of the square in the middle of a disk, as a part of the radius.
const MIDDLE: f64 = 0.5;

/// Steps of Newton's method: on convex quadrilaterals it takes a handful.
const STEPS: usize = 30;

/// How far outside [0, 1]² rounding puts points of the boundary.
const OUTSIDE: f64 = 1e-10;

/// The charts of a domain. A polygon has one at each of its corners, a disk one in the middle and four around it.
pub(super) fn charts(domain: Domain, exponent: f64) -> Vec<Chart> {
    let power = power(exponent);
    match domain {
        Domain::Rectangle { x0, x1, y0, y1 } => at_corners(&[[x0, y0], [x1, y0], [x1, y1], [x0, y1]], power),
        Domain::Triangle(corners) => at_corners(&corners, power),
        Domain::Disk { centre, radius } => {
            let at = |r: f64, quarter: usize| {
                let (sin, cos) = (FRAC_PI_2 * (quarter as f64 + 0.5)).sin_cos();
                [centre[0] + r * cos, centre[1] + r * sin]
            };
            let (inner, outer) = (|k| at(MIDDLE * radius, k), |k| at(radius, k));
            let around = |k: usize| Chart {
                corners: [outer(k), inner(k), outer(k + 1), inner(k + 1)],
                arc: Some(centre),
                powers: [power, 1],
            };
            let middle =
                Chart { corners: [inner(0), inner(1), inner(3), inner(2)], arc: None, powers: [1; 2] };
            std::iter::once(middle).chain((0..4).map(around)).collect()
        }
    }
}

fn at_corners(corners: &[Point], power: i32) -> Vec<Chart> {
    let n = corners.len();
    let mean =
        |points: &[Point]| [0, 1].map(|k| points.iter().map(|p| p[k]).sum::<f64>() / points.len() as f64);
    let middle = |k: usize| mean(&[corners[k % n], corners[(k + 1) % n]]);
    let chart = |k: usize| Chart {
        corners: [corners[k], middle(k), middle(k + n - 1), mean(corners)],
        arc: None,
        powers: [power; 2],
    };
    (0..n).map(chart).collect()
}

impl Chart {
    /// p(u, v).
    pub(super) fn point(&self, uv: Point) -> Point {
        self.place([0, 1].map(|k| self.grade(k, uv[k])))
    }

    /// How near to the boundary, as a part of the chart, a place is that is as near as u to the side u = 0, or v.
    pub(super) fn depth(&self, direction: usize, u: f64) -> f64 {
        if self.powers[direction] == 1 { 1.0 } else { self.grade(direction, u) }
    }

    /// dx dy / (du dv).
    pub(super) fn area(&self, uv: Point) -> f64 {
        let [p, q] = self.slopes([0, 1].map(|k| self.grade(k, uv[k])));
        let grades = [0, 1].map(|k| f64::from(self.powers[k]) * uv[k].powi(self.powers[k] - 1));
        (p[0] * q[1] - p[1] * q[0]).abs() * grades[0] * grades[1]
    }

    /// The (u, v) of a point of the chart.
    pub(super) fn locate(&self, p: Point) -> Option<Point> {
        let mut ab = [0.5; 2];
        for _ in 0..STEPS {
            let (at, [a, b]) = (self.place(ab), self.slopes(ab));
            let missing = [p[0] - at[0], p[1] - at[1]];
            let det = a[0] * b[1] - a[1] * b[0];
            let step = [
                (missing[0] * b[1] - missing[1] * b[0]) / det,
                (a[0] * missing[1] - a[1] * missing[0]) / det,
            ];
            // Charts end not far outside: beyond, their maps fold.
            ab = [0, 1].map(|k| (ab[k] + step[k]).clamp(-0.25, 1.25));
            if step.iter().all(|step| step.abs() <= f64::EPSILON) {
                break;
            }
        }
        let (at, size) = (self.place(ab), distance(self.corners[0], self.corners[3]));
        let inside = ab.iter().all(|c| (-OUTSIDE..=1.0 + OUTSIDE).contains(c));
        // Where p is elsewhere the steps may end anywhere.
        (inside && distance(at, p) <= OUTSIDE * size)
            .then(|| [0, 1].map(|k| self.ungrade(k, ab[k].clamp(0.0, 1.0))))
    }

    fn grade(&self, k: usize, u: f64) -> f64 {
        u.powi(self.powers[k])
    }

    fn ungrade(&self, k: usize, a: f64) -> f64 {
        a.powf(1.0 / f64::from(self.powers[k]))
    }

    /// The point at parts a and b of the sides: between the sides a = 0 and a = 1.
    fn place(&self, [a, b]: Point) -> Point {
        let [p, q, r, s] = self.corners;
        let low = match self.arc {
            None => between(p, r, b),
            Some(centre) => turned(centre, p, FRAC_PI_2 * b),
        };
        between(low, between(q, s, b), a)
    }

    /// The derivatives by a and by b.
    fn slopes(&self, [a, b]: Point) -> [Point; 2] {
        let [p, q, r, s] = self.corners;
        let (low, low_slope) = match self.arc {
            None => (between(p, r, b), [r[0] - p[0], r[1] - p[1]]),
            Some(centre) => {
                let low = turned(centre, p, FRAC_PI_2 * b);
                (low, [-FRAC_PI_2 * (low[1] - centre[1]), FRAC_PI_2 * (low[0] - centre[0])])
            }
        };
        let high = between(q, s, b);
        [[high[0] - low[0], high[1] - low[1]], between(low_slope, [s[0] - q[0], s[1] - q[1]], a)]
    }
}

pub(super) fn distance(p: Point, q: Point) -> f64 {
    (p[0] - q[0]).hypot(p[1] - q[1])
}

/// p + t (q − p).
fn between(p: Point, q: Point, t: f64) -> Point {
    [0, 1].map(|k| p[k] + t * (q[k] - p[k]))
}

/// p turned around a centre.
fn turned(centre: Point, p: Point, angle: f64) -> Point {
    let (sin, cos) = angle.sin_cos();
    let (x, y) = (p[0] - centre[0], p[1] - centre[1]);
    [centre[0] + cos * x - sin * y, centre[1] + sin * x + cos * y]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quadrature::gauss_legendre;

    fn domains() -> [Domain; 3] {
        [
            Domain::Rectangle { x0: -1.0, x1: 3.0, y0: 2.0, y1: 2.5 },
            Domain::Triangle([[0.0, 0.0], [3.0, 1.0], [-1.0, 2.0]]),
            Domain::Disk { centre: [2.0, -1.0], radius: 1.5 },
        ]
    }

    #[test]
    fn charts_cover_their_domain_once() {
        let rule = gauss_legendre(20, 0.0, 1.0);
        for domain in domains() {
            let areas = charts(domain, -1.0).into_iter().map(|chart| {
                rule.squared()
                    .nodes
                    .iter()
                    .zip(rule.squared().weights)
                    .map(|(uv, w)| w * chart.area(*uv))
                    .sum::<f64>()
            });
            assert!((areas.sum::<f64>() / domain.area() - 1.0).abs() < 1e-13, "{domain}");
        }
    }

    #[test]
    fn a_point_is_found_where_it_is() {
        for domain in domains() {
            let charts = charts(domain, -1.0);
            for (k, chart) in charts.iter().enumerate() {
                for uv in [[0.3, 0.4], [0.9, 0.11], [1e-2, 0.7], [0.0, 0.5]] {
                    let p = chart.point(uv);
                    let found = chart.locate(p).unwrap();
                    let off = [0, 1].map(|c| (chart.point(found)[c] - p[c]).abs());
                    assert!(off[0].max(off[1]) < 1e-14, "{domain}, chart {k}, {uv:?}, {found:?}");
                    let others = charts.iter().enumerate().filter(|(other, _)| *other != k);
                    let alone = others.into_iter().all(|(_, other)| other.locate(p).is_none());
                    assert!(alone || uv[0] == 0.0, "{domain}, {uv:?}");
                }
            }
        }
    }
}
