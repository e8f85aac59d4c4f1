//! F(x) = (1/2π) Σ_k Γ_k · n, Lambert's form factor from a point to a polygon that nothing hides.

use crate::polygon::Polygon;
use glam::DVec3;
use std::f64::consts::TAU;
use wide::f64x4;

/// The form factor ∫ cosθ cosθ′ / (π r²) dA′ from a point x with unit normal n to the front of a polygon, in [0, 1].
///
/// The part of the polygon below the horizon of x counts for nothing; a point that is not in front of the polygon
/// gets 0. The value is exact to rounding: the error is about 10⁻¹⁶ times the polygon's angular size.
/// The multiplier: the light that x receives is F times the exitance of the polygon.
///
/// An edge that passes through x has no direction seen from there, and counts for nothing.
pub fn point_to_polygon(x: DVec3, n: DVec3, polygon: &Polygon) -> f64 {
    if polygon.height_of(x) <= 0.0 {
        return 0.0;
    }
    let v = polygon.vertices();
    // A triangle is a quadrilateral whose last edge is a point.
    let r: [DVec3; 4] = std::array::from_fn(|k| v[k.min(v.len() - 1)] - x);
    let heights = r.map(|p| p.dot(n));
    let lowest = heights.iter().fold(f64::INFINITY, |low, &h| low.min(h));
    let turned = if lowest >= 0.0 {
        edges_along_normal(n, r, [r[1], r[2], r[3], r[0]])
    } else {
        let [a, b, c, d, e] = above_horizon(r, heights);
        edges_along_normal(n, [a, b, c, d], [b, c, d, e]) + edges_along_normal(n, [e; 4], [a, e, e, e])
    };
    // Seen from the front the edges run counter-clockwise: each turns about −n.
    (-turned / TAU).max(0.0)
}

/// The same to a polygon in front of which x is and which is above the horizon, given by the coordinates of its `count`
/// vertices relative to x, the first of them again behind the last.
pub(super) fn of_ring(n: DVec3, [x, y, z]: [&[f64; 16]; 3], count: usize) -> f64 {
    let mut turned = 0.0;
    for first in (0..count).step_by(4) {
        let four = |c: &[f64; 16], from: usize| f64x4::new(std::array::from_fn(|k| c[from + k]));
        let lanes = |from: usize| [four(x, from), four(y, from), four(z, from)];
        let terms = terms(n, lanes(first), lanes(first + 1));
        // Lanes behind the last edge hold what was there before.
        turned += match count - first {
            1 => terms.to_array()[0],
            2 => terms.to_array()[..2].iter().sum(),
            3 => terms.to_array()[..3].iter().sum(),
            _ => terms.reduce_add(),
        };
    }
    (-turned / TAU).max(0.0)
}

/// Σ_k Γ_k · n over the edges from a_k to b_k as seen from the origin: Γ is the edge's angle along the normal of
/// the plane through edge and origin. Four edges go in the four lanes.
fn edges_along_normal(n: DVec3, a: [DVec3; 4], b: [DVec3; 4]) -> f64 {
    terms(n, lanes(a), lanes(b)).reduce_add()
}

#[inline(always)]
fn terms(n: DVec3, [ax, ay, az]: [f64x4; 3], [bx, by, bz]: [f64x4; 3]) -> f64x4 {
    let x = ay * bz - az * by;
    let y = az * bx - ax * bz;
    let z = ax * by - ay * bx;
    let sine = (x * x + y * y + z * z).sqrt();
    let cosine = ax * bx + ay * by + az * bz;
    let along = x * n.x + y * n.y + z * n.z;
    let terms = sine.atan2(cosine) * along / sine;
    // An edge that is a point, or passes through the origin, is 0/0 here.
    sine.simd_gt(f64x4::ZERO).select(terms, f64x4::ZERO)
}

fn lanes(points: [DVec3; 4]) -> [f64x4; 3] {
    let [a, b, c, d] = points;
    [[a.x, b.x, c.x, d.x], [a.y, b.y, c.y, d.y], [a.z, b.z, c.z, d.z]].map(f64x4::from)
}

/// The part of a convex quadrilateral with height ≥ 0: at most one corner more, the last one repeated up to five.
fn above_horizon(r: [DVec3; 4], heights: [f64; 4]) -> [DVec3; 5] {
    let mut kept = [DVec3::ZERO; 5];
    let mut count = 0;
    let mut keep = |p: DVec3| {
        kept[count.min(4)] = p;
        count += 1;
    };
    for k in 0..4 {
        let next = (k + 1) % 4;
        let (h, h_next) = (heights[k], heights[next]);
        if h >= 0.0 {
            keep(r[k]);
        }
        if (h < 0.0) != (h_next < 0.0) {
            keep((r[k] * h_next - r[next] * h) / (h_next - h));
        }
    }
    for k in count.max(1)..5 {
        kept[k] = kept[k - 1];
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn p(x: f64, y: f64, z: f64) -> DVec3 {
        DVec3::new(x, y, z)
    }

    /// a × b at height c, facing down, with a corner above the origin.
    fn ceiling(a: f64, b: f64, c: f64) -> Polygon {
        Polygon::quadrilateral(p(0.0, 0.0, c), p(0.0, b, c), p(a, b, c), p(a, 0.0, c))
    }

    /// Howell C-11: a parallel rectangle a × b with a corner at distance c above the point.
    fn corner_closed_form(a: f64, b: f64, c: f64) -> f64 {
        let (x, y) = (a / c, b / c);
        let (p, q) = ((1.0 + x * x).sqrt(), (1.0 + y * y).sqrt());
        (x / p * (y / p).atan() + y / q * (x / q).atan()) / TAU
    }

    #[track_caller]
    fn assert_close(got: f64, expected: f64, relative: f64) {
        assert!((got - expected).abs() <= relative * expected.abs(), "{got} is not {expected}");
    }

    #[test]
    fn a_rectangle_overhead_has_its_closed_form_near_and_far() {
        for (a, b, c) in [(1.0, 1.0, 1.0), (2.0, 0.5, 0.1), (1.0, 1.0, 1e-3), (1.0, 3.0, 50.0)] {
            assert_close(
                point_to_polygon(DVec3::ZERO, DVec3::Z, &ceiling(a, b, c)),
                corner_closed_form(a, b, c),
                1e-13 * c.max(1.0),
            );
        }
        let below_centre = point_to_polygon(p(0.5, 0.5, 0.0), DVec3::Z, &ceiling(1.0, 1.0, 1.0));
        assert_close(below_centre, 4.0 * corner_closed_form(0.5, 0.5, 1.0), 1e-14);
    }

    #[test]
    fn a_far_polygon_is_a_point_source() {
        let far = point_to_polygon(p(0.5, 0.5, 0.0), DVec3::Z, &ceiling(1.0, 1.0, 1e4));
        assert_close(far, 1.0 / (PI * 1e8), 1e-8);
    }

    #[test]
    fn the_parts_of_a_polygon_add_up_to_it() {
        let (a, b, c, d) = (p(-1.0, 0.2, 2.0), p(-0.5, 2.0, 1.5), p(1.5, 2.5, 1.0), p(2.0, 0.0, 1.6));
        let n = p(0.1, -0.7, 0.4).normalize();
        // The plane of abc: d is put into it.
        let normal = (b - a).cross(c - a).normalize();
        let d = d - (d - a).dot(normal) * normal;
        let whole = point_to_polygon(DVec3::ZERO, n, &Polygon::quadrilateral(a, b, c, d));
        let parts = [Polygon::triangle(a, b, c), Polygon::triangle(a, c, d)];
        let sum: f64 = parts.iter().map(|part| point_to_polygon(DVec3::ZERO, n, part)).sum();
        assert!(whole > 0.01);
        assert_close(sum, whole, 1e-13);
    }

    #[test]
    fn a_half_plane_is_half_the_sky() {
        let wide = 1e7;
        let half = Polygon::quadrilateral(
            p(0.0, -wide, 1.0),
            p(0.0, wide, 1.0),
            p(wide, wide, 1.0),
            p(wide, -wide, 1.0),
        );
        assert_close(point_to_polygon(DVec3::ZERO, DVec3::Z, &half), 0.5, 1e-6);
    }

    #[test]
    fn what_is_below_the_horizon_does_not_count() {
        // A wall x = 1 facing −x, reaching as far below the floor as above it.
        let wall = |low: f64| {
            Polygon::quadrilateral(p(1.0, -1.0, low), p(1.0, -1.0, 2.0), p(1.0, 1.0, 2.0), p(1.0, 1.0, low))
        };
        let above = point_to_polygon(DVec3::ZERO, DVec3::Z, &wall(0.0));
        assert!(above > 0.05);
        assert_close(point_to_polygon(DVec3::ZERO, DVec3::Z, &wall(-2.0)), above, 1e-14);
        assert_eq!(point_to_polygon(DVec3::ZERO, -DVec3::X, &wall(-2.0)), 0.0);
        // One corner cut off leaves five.
        let tilted = p(-0.2, 0.9, 0.9).normalize();
        let (a, b) = (wall(-2.0), wall(0.0));
        let lower = Polygon::quadrilateral(
            p(1.0, -1.0, -2.0),
            p(1.0, -1.0, 0.0),
            p(1.0, 1.0, 0.0),
            p(1.0, 1.0, -2.0),
        );
        let parts = point_to_polygon(DVec3::ZERO, tilted, &b) + point_to_polygon(DVec3::ZERO, tilted, &lower);
        assert_close(point_to_polygon(DVec3::ZERO, tilted, &a), parts, 1e-13);
    }

    #[test]
    fn only_the_front_counts_and_no_position_gives_nan() {
        let polygon = ceiling(1.0, 1.0, 1.0);
        assert_eq!(point_to_polygon(p(0.5, 0.5, 2.0), -DVec3::Z, &polygon), 0.0);
        for point in [p(0.5, 0.5, 1.0), p(0.0, 0.0, 1.0), p(0.0, 0.5, 1.0), p(3.0, 0.0, 1.0)] {
            for n in [DVec3::X, DVec3::Z, -DVec3::Z] {
                let f = point_to_polygon(point, n, &polygon);
                assert!((0.0..=1.0).contains(&f), "{point} {n}: {f}");
            }
        }
    }
}
