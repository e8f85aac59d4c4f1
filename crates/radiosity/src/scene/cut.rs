//! A face with any number of corners becomes convex polygons with three or four: Σ areas = the area of the face.

use super::error::Problem;
use crate::polygon::Polygon;
use glam::{DVec2, DVec3};

/// How far a corner may be off the plane, as a fraction of the face's diameter: a 10 m wall may bulge by 1 mm.
/// Less would refuse coordinates written with five digits; more would let light through the seams.
const FLATNESS: f64 = 1e-4;

/// How far off the plane a quadrilateral may be and still stay whole: the rounding of its corners. Rays take a point
/// within 10⁻⁹ of the scene for one on the polygon, and from further off the polygon would shade itself.
const ROUNDING: f64 = 1e-12;

/// What counts as zero beside a face of diameter 1. Coordinates written with six digits are 10⁻⁶ uncertain, so
/// that a smaller distance between corners means nothing; a larger one may be a real edge (1 mm of 1 km).
const NOTHING: f64 = 1e-6;

/// The checks compare every pair of corners: a face of so many takes a second, and no building has one.
const MOST_CORNERS: usize = 10_000;

/// Areas are the lengths of products of edges: the fourth power of a size must be a number.
const SIZES: std::ops::RangeInclusive<f64> = 1e-60..=1e60;

/// Cuts a planar face into convex polygons, in the order of its corners; front is where they run counter-clockwise.
///
/// A triangle or a convex quadrilateral stays whole, all else becomes triangles; so does a quadrilateral whose
/// corners are in one plane only to the digits that a file has. Lengths are in metres, but only
/// their ratios count: a face is judged as if its diameter were 1.
///
/// # Errors
///
/// When the corners are fewer than three or more than 10 000, not finite, repeated, immensely
/// far apart or near, on one line, not on one plane, or when the outline
/// meets itself.
pub fn cut(corners: &[DVec3]) -> Result<Vec<Polygon>, Problem> {
    if corners.len() < 3 {
        return Err(Problem::TooFewCorners(corners.len()));
    }
    if corners.len() > MOST_CORNERS {
        return Err(Problem::TooManyCorners { count: corners.len(), most: MOST_CORNERS });
    }
    if let Some(value) = corners.iter().flat_map(DVec3::to_array).find(|c| !c.is_finite()) {
        return Err(Problem::NotFinite(value));
    }
    let (first, second) = farthest_pair(corners);
    let diameter = corners[first].distance(corners[second]);
    if diameter > 0.0 && !SIZES.contains(&diameter) {
        return Err(Problem::Size(diameter));
    }
    let shape: Vec<DVec3> = corners.iter().map(|&corner| (corner - corners[0]) / diameter).collect();
    check_distinct(&shape)?;
    let normal = normal(&shape, (shape[second] - shape[first]).normalize())?;
    check_planar(&shape, normal, diameter)?;
    let outline = flattened(&shape, normal);
    check_simple(&outline)?;
    Ok(match *corners {
        [a, b, c] => vec![Polygon::triangle(a, b, c)],
        [a, b, c, d] if is_convex(&outline) && bulge(&shape, normal) <= ROUNDING => {
            vec![Polygon::quadrilateral(a, b, c, d)]
        }
        _ => triangles(&outline)
            .map(|[i, j, k]| Polygon::triangle(corners[i], corners[j], corners[k]))
            .collect(),
    })
}

/// Every pair i < j.
fn pairs(count: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..count).flat_map(move |i| (i + 1..count).map(move |j| (i, j)))
}

fn farthest_pair(corners: &[DVec3]) -> (usize, usize) {
    let distance = |&(i, j): &(usize, usize)| corners[i].distance(corners[j]);
    pairs(corners.len()).max_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or((0, 0))
}

fn check_distinct(shape: &[DVec3]) -> Result<(), Problem> {
    // A face of diameter zero has become 0/0, and NaN is near nothing: hence "not apart" rather than "close".
    let apart = |i: usize, j: usize| shape[i].distance(shape[j]) > NOTHING;
    match pairs(shape.len()).find(|&(i, j)| !apart(i, j)) {
        Some((i, j)) => Err(Problem::RepeatedCorner { first: i + 1, second: j + 1 }),
        None => Ok(()),
    }
}

/// The unit normal, by Newell's sum; `axis` is the direction of the face's diameter.
fn normal(shape: &[DVec3], axis: DVec3) -> Result<DVec3, Problem> {
    let doubled: DVec3 = (0..shape.len()).map(|i| shape[i].cross(shape[(i + 1) % shape.len()])).sum();
    let breadths = shape.iter().map(|&corner| axis.cross(corner - shape[0]));
    let across = breadths.fold(DVec3::ZERO, |a, b| if b.length() > a.length() { b } else { a });
    if across.length() <= NOTHING {
        Err(Problem::Degenerate(shape.len()))
    } else if doubled.length() > NOTHING {
        Ok(doubled.normalize())
    } else {
        // An outline like an 8: its two loops cancel. Any normal of its plane will show where it crosses itself.
        Ok(across.normalize())
    }
}

/// The largest distance of a corner from the mean plane.
fn bulge(shape: &[DVec3], normal: DVec3) -> f64 {
    let centre = shape.iter().sum::<DVec3>() / shape.len() as f64;
    shape.iter().map(|&corner| (corner - centre).dot(normal).abs()).fold(0.0, f64::max)
}

fn check_planar(shape: &[DVec3], normal: DVec3, diameter: f64) -> Result<(), Problem> {
    let relative = bulge(shape, normal);
    if relative > FLATNESS {
        return Err(Problem::NotPlanar { metres: relative * diameter, relative, tolerated: FLATNESS });
    }
    Ok(())
}

/// The shape in coordinates of its plane, counter-clockwise.
fn flattened(shape: &[DVec3], normal: DVec3) -> Vec<DVec2> {
    let (u, v) = normal.any_orthonormal_pair();
    shape.iter().map(|corner| DVec2::new(corner.dot(u), corner.dot(v))).collect()
}

/// Twice the signed area of the triangle abc.
fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

fn check_simple(outline: &[DVec2]) -> Result<(), Problem> {
    let edge = |i: usize| (outline[i], outline[(i + 1) % outline.len()]);
    match pairs(outline.len()).find(|&(i, j)| meet(edge(i), edge(j))) {
        Some((i, j)) => Err(Problem::SelfIntersecting { first: i + 1, second: j + 1 }),
        None => Ok(()),
    }
}

/// Whether two edges share more than an end.
fn meet((a, b): (DVec2, DVec2), (c, d): (DVec2, DVec2)) -> bool {
    let crossing = turn(a, b, c) * turn(a, b, d) < 0.0 && turn(c, d, a) * turn(c, d, b) < 0.0;
    let touches = |p: DVec2, q: DVec2, r: DVec2| p != q && p != r && distance_to_edge(p, q, r) <= NOTHING;
    let touching = touches(c, a, b) || touches(d, a, b) || touches(a, c, d) || touches(b, c, d);
    touching || crossing
}

fn distance_to_edge(point: DVec2, start: DVec2, end: DVec2) -> f64 {
    let edge = end - start;
    let along = ((point - start).dot(edge) / edge.length_squared()).clamp(0.0, 1.0);
    point.distance(start + along * edge)
}

/// Whether every corner of a quadrilateral turns left; one that runs straight on makes it a triangle in disguise.
fn is_convex(outline: &[DVec2]) -> bool {
    let n = outline.len();
    (0..n).all(|i| {
        let (a, b, c) = (outline[i], outline[(i + 1) % n], outline[(i + 2) % n]);
        (b - a).normalize().perp_dot((c - b).normalize()) > NOTHING
    })
}

/// The corners of triangles, counter-clockwise, that fill the outline: its ears cut off, then made Delaunay.
fn triangles(outline: &[DVec2]) -> impl Iterator<Item = [usize; 3]> {
    let points: Vec<[f64; 2]> = outline.iter().map(DVec2::to_array).collect();
    let mut corners: Vec<usize> = Vec::new();
    earcut::Earcut::new().earcut(points.iter().copied(), &[], &mut corners);
    earcut::refine(&mut corners, &points);
    corners
        .chunks_exact(3)
        .filter_map(|ear| oriented(outline, [ear[0], ear[1], ear[2]]))
        .collect::<Vec<_>>()
        .into_iter()
}

/// The triangle, counter-clockwise, unless it is a line: corners that run straight on leave such shavings.
fn oriented(outline: &[DVec2], [i, j, k]: [usize; 3]) -> Option<[usize; 3]> {
    // Rounding is 10⁻¹⁶ of the face's size, the thinnest face allowed 10⁻⁶.
    const SHAVING: f64 = 1e-12;
    let doubled_area = turn(outline[i], outline[j], outline[k]);
    (doubled_area.abs() > SHAVING).then_some(if doubled_area > 0.0 { [i, j, k] } else { [i, k, j] })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tilted frame, so that no coordinate plane is privileged.
    fn placed(points: &[(f64, f64)], scale: f64) -> Vec<DVec3> {
        let (u, v) = DVec3::new(1.0, 2.0, -0.5).normalize().any_orthonormal_pair();
        points.iter().map(|&(x, y)| scale * (DVec3::new(3.0, -1.0, 7.0) + x * u + y * v)).collect()
    }

    fn area(polygons: &[Polygon]) -> f64 {
        polygons.iter().map(Polygon::area).sum()
    }

    const L: [(f64, f64); 6] = [(0.0, 0.0), (4.0, 0.0), (4.0, 1.0), (1.0, 1.0), (1.0, 3.0), (0.0, 3.0)];

    #[test]
    fn an_l_keeps_its_area_and_its_front_at_every_scale() {
        for scale in [1e-3, 1.0, 1e3] {
            let polygons = cut(&placed(&L, scale)).unwrap();
            assert_eq!(polygons.len(), 4);
            assert!((area(&polygons) / (6.0 * scale * scale) - 1.0).abs() < 1e-12);
            let front = DVec3::new(1.0, 2.0, -0.5).normalize();
            assert!(polygons.iter().all(|p| p.normal().dot(front) > 1.0 - 1e-12));
        }
    }

    #[test]
    fn a_convex_quadrilateral_stays_whole_and_a_dart_is_cut() {
        assert_eq!(cut(&placed(&[(0.0, 0.0), (2.0, 0.0), (1.5, 1.0), (0.0, 1.0)], 1.0)).unwrap().len(), 1);
        let dart = cut(&placed(&[(0.0, 0.0), (2.0, 0.0), (0.5, 0.5), (0.0, 2.0)], 1.0)).unwrap();
        assert_eq!(dart.len(), 2);
        assert!((area(&dart) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_corner_that_runs_straight_on_costs_no_area() {
        let polygons =
            cut(&placed(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)], 1.0)).unwrap();
        assert!((area(&polygons) - 4.0).abs() < 1e-12);
        assert!(polygons.iter().all(|p| p.normal().length() > 0.9));
    }

    #[test]
    fn stars_keep_their_area() {
        // Corners at random distances around a centre: simple whatever the distances, mostly far from convex.
        let mut state = 1_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 40) as f64 / f64::from(1 << 24)
        };
        for n in 5..60_u32 {
            let star: Vec<(f64, f64)> = (0..n)
                .map(|k| (0.2 + random(), std::f64::consts::TAU * f64::from(k) / f64::from(n)))
                .map(|(radius, angle)| (radius * angle.cos(), radius * angle.sin()))
                .collect();
            let shoelace: f64 = (0..star.len())
                .map(|i| (star[i], star[(i + 1) % star.len()]))
                .map(|((x0, y0), (x1, y1))| 0.5 * (x0 * y1 - x1 * y0))
                .sum();
            let polygons = cut(&placed(&star, 1.0)).unwrap();
            assert!((area(&polygons) / shoelace - 1.0).abs() < 1e-11, "{n} corners");
        }
    }

    #[test]
    fn what_is_no_face_is_refused_at_every_scale() {
        for scale in [1e-3, 1.0, 1e3] {
            let refusal = |points: &[(f64, f64)]| cut(&placed(points, scale)).unwrap_err();
            assert!(matches!(refusal(&[(0.0, 0.0), (1.0, 0.0)]), Problem::TooFewCorners(2)));
            assert!(matches!(refusal(&[(0.0, 0.0), (1.0, 0.0), (2.0, 1e-7)]), Problem::Degenerate(3)));
            assert!(matches!(
                refusal(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (1.0, 1e-7)]),
                Problem::RepeatedCorner { first: 2, second: 4 }
            ));
            assert!(matches!(refusal(&[(1.0, 1.0); 4]), Problem::RepeatedCorner { first: 1, second: 2 }));
            // An 8 whose loops cancel, one whose loops do not, and a hair that goes out and back.
            let eight = [(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)];
            assert!(matches!(refusal(&eight), Problem::SelfIntersecting { first: 1, second: 3 }));
            let eight = [(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 3.0)];
            assert!(matches!(refusal(&eight), Problem::SelfIntersecting { first: 1, second: 3 }));
            let hair = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (1.0, 1e-9), (1.0, 1.0)];
            assert!(matches!(refusal(&hair), Problem::RepeatedCorner { .. }));
            let hair = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (1.5, 0.0), (1.0, 1.0)];
            assert!(matches!(refusal(&hair), Problem::SelfIntersecting { .. }));
        }
    }

    #[test]
    fn slivers_and_slight_bulges_pass_but_not_twice_as_much() {
        assert!(cut(&placed(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1e-5), (0.0, 1e-5)], 1.0)).is_ok());
        let bulging = |height: f64| {
            let mut corners = vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
            corners[2].z = height;
            cut(&corners)
        };
        // One corner of a square raised by h leaves all four h/4 off their plane; the diameter is √2.
        assert!(bulging(4.0 * 2_f64.sqrt() * 0.9e-4).is_ok());
        assert!(matches!(
            bulging(4.0 * 2_f64.sqrt() * 1.1e-4),
            Err(Problem::NotPlanar { relative, .. }) if (relative - 1.1e-4).abs() < 1e-8
        ));
    }
}
