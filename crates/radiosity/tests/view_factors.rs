//! View factors with known answers, at the tolerance asked, and what holds of any: each error at least the true one.

use glam::{DQuat, DVec3, EulerRot};
use radiosity::form_factor::pairs::Pairs;
use radiosity::polygon::Polygon;
use std::f64::consts::{PI, TAU};
use std::ops::Range;

fn p(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// The factor from some faces to others and its error.
fn factor(faces: &[Polygon], from: Range<usize>, to: Range<usize>, tolerance: f64) -> (f64, f64) {
    let pairs = Pairs::new(faces, tolerance);
    let area: f64 = faces[from.clone()].iter().map(Polygon::area).sum();
    let all = from.flat_map(|i| to.clone().map(move |j| (i, j)));
    let (value, error) =
        all.map(|(i, j)| pairs.exchange(i, j)).fold((0.0, 0.0), |(v, e), x| (v + x.value, e + x.error));
    (value / area, error / area)
}

#[track_caller]
fn check(faces: &[Polygon], from: Range<usize>, to: Range<usize>, expected: f64, tolerances: &[f64]) {
    for &tolerance in tolerances {
        let (got, error) = factor(faces, from.clone(), to.clone(), tolerance);
        let true_error = (got - expected).abs();
        assert!(true_error <= error + 1e-12, "{got} ± {error:e} is {expected} at {tolerance:e}");
        assert!(error <= tolerance, "{error:e} was to be {tolerance:e}");
    }
}

const IN_SIGHT: [f64; 3] = [1e-3, 1e-5, 1e-8];

/// [x0, x1] × [y0, y1] at height z, looking up or down.
fn rectangle(x: [f64; 2], y: [f64; 2], z: f64, up: bool) -> Polygon {
    let [a, b, c, d] = [p(x[0], y[0], z), p(x[1], y[0], z), p(x[1], y[1], z), p(x[0], y[1], z)];
    if up { Polygon::quadrilateral(a, b, c, d) } else { Polygon::quadrilateral(a, d, c, b) }
}

#[test]
fn rectangles_in_full_sight() {
    let unit = || rectangle([0.0, 1.0], [0.0, 1.0], 0.0, true);
    for (x, y, z, expected) in [
        ([0.0, 1.0], [0.0, 1.0], 1.0, 0.199824895698),
        ([0.0, 1.0], [0.0, 1.0], 0.1, 0.826994522397),
        ([1.0, 3.0], [0.5, 1.5], 1.0, 0.085530552987),
        ([1.0, 2.0], [0.0, 1.0], 1.0, 0.086050489152),
    ] {
        check(&[unit(), rectangle(x, y, z, false)], 0..1, 1..2, expected, &IN_SIGHT);
    }
    let long = |w: f64, h: f64, l: f64| {
        let wall = Polygon::quadrilateral(p(0.0, 0.0, 0.0), p(0.0, 0.0, h), p(l, 0.0, h), p(l, 0.0, 0.0));
        [rectangle([0.0, l], [0.0, w], 0.0, true), wall]
    };
    check(&long(1.0, 1.0, 1.0), 0..1, 1..2, 0.200043776075, &IN_SIGHT);
    check(&long(1.0, 2.0, 1.0), 0..1, 1..2, 0.232852602795, &IN_SIGHT);
    check(&long(1.0, 0.5, 3.0), 0..1, 1..2, 0.174626978343, &IN_SIGHT);
}

#[test]
fn regular_solids_in_full_sight() {
    let (o, x, y, z) = (DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z);
    let corner = [Polygon::triangle(o, x, y), Polygon::triangle(o, z, x)];
    check(&corner, 0..1, 1..2, 0.211324865405, &IN_SIGHT);
    let [a, b, c, d] = [p(1.0, 1.0, 1.0), p(1.0, -1.0, -1.0), p(-1.0, 1.0, -1.0), p(-1.0, -1.0, 1.0)];
    check(&[Polygon::triangle(a, c, b), Polygon::triangle(a, b, d)], 0..1, 1..2, 1.0 / 3.0, &IN_SIGHT);
    for (face, expected) in
        [([z, x, -y], 0.136854306397), ([x, -z, -y], 0.148941118017), ([-x, -y, -z], 0.142613726760)]
    {
        let faces = [Polygon::triangle(y, x, z), Polygon::triangle(face[0], face[1], face[2])];
        check(&faces, 0..1, 1..2, expected, &IN_SIGHT);
    }
    let lid = Polygon::quadrilateral(o, p(0.0, 0.5, 0.75_f64.sqrt()), p(1.0, 0.5, 0.75_f64.sqrt()), x);
    check(&[rectangle([0.0, 1.0], [0.0, 1.0], 0.0, true), lid], 0..1, 1..2, 0.370905321150, &IN_SIGHT);
    let above = [Polygon::triangle(o, x, y), Polygon::triangle(z, z + y, z + x)];
    check(&above, 0..1, 1..2, 0.115049228150, &IN_SIGHT);
}

/// Point k of n on a circle about the z axis.
fn on_circle(k: usize, n: usize, radius: f64, z: f64) -> DVec3 {
    let (sin, cos) = (TAU * k as f64 / n as f64).sin_cos();
    p(radius * cos, radius * sin, z)
}

/// The n sectors of an annulus that looks up or down; a disc where the inner radius is 0.
fn sectors(n: usize, inner: f64, outer: f64, z: f64, up: bool) -> Vec<Polygon> {
    let sector = |k: usize| {
        let [a, b, c, d] =
            [(k, inner), (k, outer), (k + 1, outer), (k + 1, inner)].map(|(k, r)| on_circle(k, n, r, z));
        match (inner > 0.0, up) {
            (false, true) => Polygon::triangle(a, b, c),
            (false, false) => Polygon::triangle(a, c, b),
            (true, true) => Polygon::quadrilateral(a, b, c, d),
            (true, false) => Polygon::quadrilateral(a, d, c, b),
        }
    };
    (0..n).map(sector).collect()
}

/// The n sides of a cylinder, as seen from within or from without.
fn sides(n: usize, radius: f64, low: f64, high: f64, inwards: bool) -> Vec<Polygon> {
    let side = |k: usize| {
        let [a, b, c, d] =
            [(k, low), (k + 1, low), (k + 1, high), (k, high)].map(|(k, z)| on_circle(k, n, radius, z));
        if inwards { Polygon::quadrilateral(a, d, c, b) } else { Polygon::quadrilateral(a, b, c, d) }
    };
    (0..n).map(side).collect()
}

/// Richardson's extrapolation (paper, 4.4.1) of what depends on 1/n², from n, 2n, 4n, 8n facets around; the factors
/// are those of the first face to faces from `to` on, times the errors that the weights of the extrapolation make of theirs.
fn check_round(
    n: usize,
    shape: impl Fn(usize) -> (Vec<Polygon>, Range<usize>),
    expected: f64,
    tolerances: &[f64],
    facets: f64,
) {
    for &tolerance in tolerances {
        let mut table: Vec<f64> = Vec::new();
        let mut said: f64 = 0.0;
        for level in 0..4 {
            let (faces, to) = shape(n << level);
            let (mut value, error) = factor(&faces, 0..1, to, 0.1 * tolerance);
            said = said.max(error);
            for (k, before) in table.iter_mut().enumerate() {
                let next = value + (value - *before) / (4_f64.powi(k as i32 + 1) - 1.0);
                *before = value;
                value = next;
            }
            table.push(value);
        }
        let got = table[3];
        // Σ |weights| of the last extrapolation is below 2.
        assert!(
            (got - expected).abs() <= 2.0 * said + facets,
            "{got} ± {said:e} is {expected}, at {tolerance:e}"
        );
        assert!(2.0 * said <= tolerance, "{said:e} was to be {tolerance:e}");
    }
}

#[test]
fn discs_and_annuli_in_full_sight() {
    let opposite = |to: [f64; 2], from: f64, z: f64| {
        move |n: usize| {
            let mut faces = sectors(n, 0.0, from, 0.0, true);
            faces.truncate(1);
            faces.extend(sectors(n, to[0], to[1], z, false));
            (faces, 1..n + 1)
        }
    };
    for (r1, r2, h, expected) in
        [(1.0, 1.0, 1.0, 0.381966011250), (1.0, 2.0, 1.5, 0.601653344388), (0.3, 1.0, 1.0, 0.488755689553)]
    {
        check_round(12, opposite([0.0, r2], r1, h), expected, &IN_SIGHT, 2e-10);
    }
    check_round(12, opposite([0.5, 1.5], 1.0, 1.0), 0.502582896188, &IN_SIGHT, 2e-10);
}

#[test]
fn the_inside_of_a_cylinder() {
    let inside = |n: usize| (sides(n, 1.0, 0.0, 2.0, true), 1..n);
    check_round(12, inside, 0.585786437627, &IN_SIGHT, 5e-9);
}

const IN_PART: [f64; 3] = [1e-3, 1e-4, 1e-6];

#[test]
fn screens_between_squares() {
    let squares =
        || vec![rectangle([0.0, 1.0], [0.0, 1.0], 0.0, true), rectangle([0.0, 1.0], [0.0, 1.0], 1.0, false)];
    for (screen, part) in [([0.5, 0.5], 0.75), ([0.5, 1.0], 0.5)] {
        let mut faces = squares();
        // Opaque from both sides, whichever way its front looks; sheets of two faces are no different.
        for up in [true, false] {
            faces.truncate(2);
            faces.push(rectangle([0.0, screen[0]], [0.0, screen[1]], 0.5, up));
            check(&faces, 0..1, 1..2, part * 0.199824895698, &IN_PART);
        }
        faces.push(rectangle([0.0, screen[0]], [0.0, screen[1]], 0.5, true));
        check(&faces, 0..1, 1..2, part * 0.199824895698, &IN_PART);
    }
}

#[test]
fn coaxial_cylinders() {
    for (to_inner, expected) in [(false, 0.288183992934), (true, 0.385759490506)] {
        let shape = |n: usize| {
            let mut faces = sides(n, 2.0, 0.0, 3.0, true);
            faces.extend(sides(n, 1.0, 0.0, 3.0, false));
            (faces, if to_inner { n..2 * n } else { 1..n })
        };
        check_round(8, shape, expected, &[1e-3, 1e-4], 1e-5);
    }
}

/// A sphere of m × 2m faces.
fn sphere(m: usize, radius: f64, inwards: bool) -> Vec<Polygon> {
    let at = |i: usize, j: usize| {
        let (sin, cos) = (PI * i as f64 / m as f64).sin_cos();
        on_circle(j, 2 * m, radius * sin, radius * cos)
    };
    let face = |(i, j): (usize, usize)| {
        let mut corners = vec![at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        if i == 0 {
            corners = vec![at(0, 0), at(1, j), at(1, j + 1)];
        } else if i + 1 == m {
            corners = vec![at(i, j), at(m, 0), at(i, j + 1)];
        }
        if inwards {
            corners.reverse();
        }
        match corners[..] {
            [a, b, c, d] => Polygon::quadrilateral(a, b, c, d),
            _ => Polygon::triangle(corners[0], corners[1], corners[2]),
        }
    };
    (0..m).flat_map(|i| (0..2 * m).map(move |j| (i, j))).map(face).collect()
}

#[test]
fn concentric_spheres() {
    // Of polyhedra too: all that leaves the inner one arrives, so that F to it is the ratio of the areas.
    let m = 4;
    let mut faces = sphere(m, 1.0, true);
    let outer = faces.len();
    faces.extend(sphere(m, 0.5, false));
    let area = |range: Range<usize>| faces[range].iter().map(Polygon::area).sum::<f64>();
    let ratio = area(outer..faces.len()) / area(0..outer);
    assert!((ratio - 0.25).abs() < 1e-12);
    check(&faces, 0..outer, 0..outer, 1.0 - ratio, &[1e-3, 1e-4]);
    check(&faces, 0..outer, outer..faces.len(), ratio, &IN_SIGHT);
    check(&faces, outer..faces.len(), 0..outer, 1.0, &IN_SIGHT);
}

#[test]
fn a_sphere_and_a_disc_or_the_walls_of_a_room() {
    // 4πr² F = πR² F from the disc, so that both are .0528 for a disc twice as wide as the sphere.
    let disc_to_sphere = |n: usize| {
        let mut faces = sectors(n, 0.0, 1.0, 2.0, false);
        faces.truncate(1);
        faces.extend(sphere(n / 2, 0.5, false));
        let to = 1..faces.len();
        (faces, to)
    };
    check_round(8, disc_to_sphere, 0.052786404500, &IN_SIGHT, 4e-6);
    // All that leaves the sphere arrives, of polyhedra too; these have an area that goes to 4πr² with 1/m².
    let radius: f64 = 0.4;
    let mut ratios = Vec::new();
    for m in [4, 8] {
        let half = DVec3::splat(0.5);
        let mut faces = cuboid(1, true, |corner| corner * half);
        let walls = faces.len();
        faces.extend(sphere(m, radius, false));
        let ratio = faces[walls..].iter().map(Polygon::area).sum::<f64>() / 6.0;
        let end = faces.len();
        check(&faces, 0..walls, walls..end, ratio, &IN_SIGHT);
        ratios.push(ratio);
    }
    assert!((ratios[1] + (ratios[1] - ratios[0]) / 3.0 - 0.335103216383).abs() < 1e-3);
}

/// The faces of a box, n × n squares each, cut into triangles, in place.
fn cuboid(n: usize, inwards: bool, place: impl Fn(DVec3) -> DVec3) -> Vec<Polygon> {
    let mut faces = Vec::new();
    for (axis, far) in (0..3).flat_map(|axis| [(axis, false), (axis, true)]) {
        let point = |i: usize, j: usize| {
            let mut v = [if far { 1.0 } else { -1.0 }; 3];
            (v[(axis + 1) % 3], v[(axis + 2) % 3]) =
                (2.0 * i as f64 / n as f64 - 1.0, 2.0 * j as f64 / n as f64 - 1.0);
            place(DVec3::from_array(v))
        };
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let mut c = [point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)];
            if far == inwards {
                c.reverse();
            }
            faces.extend([Polygon::triangle(c[0], c[1], c[2]), Polygon::triangle(c[0], c[2], c[3])]);
        }
    }
    faces
}

#[test]
fn a_box_in_a_box_at_any_size() {
    for unit in [1e-3, 1.0, 1e3] {
        let mut faces = cuboid(3, true, |v| 0.5 * unit * v);
        let room = faces.len();
        faces.extend(cuboid(2, false, |v| 0.2 * unit * v));
        let all = faces.len();
        check(&faces, 0..room, room..all, 0.16, &[1e-3, 1e-4, 1e-6]);
        check(&faces, 0..room, 0..room, 0.84, &[1e-3, 1e-4, 1e-6]);
        check(&faces, room..all, 0..room, 1.0, &[1e-3, 1e-4, 1e-6]);
    }
}

#[test]
fn a_block_hides_the_floor_that_it_stands_on() {
    // The mesh of the floor does not know of the block: faces are under it in part.
    for n in [1, 3] {
        let mut faces = cuboid(n, true, |v| v);
        let (side, room) = (2 * n * n, faces.len());
        faces.extend(cuboid(2, false, |v| 0.5 * v - 0.5 * DVec3::Z));
        let (floor, all) = (4 * side..5 * side, faces.len());
        check(&faces, floor.clone(), 0..all, 0.75, &[1e-3, 1e-4]);
        check(&faces, 0..floor.start, 0..all, 1.0, &[1e-3, 1e-4]);
        check(&faces, floor.end..room, 0..all, 1.0, &[1e-3, 1e-4]);
    }
}

/// Numbers that look random: multiples of an irrational number.
fn numbers(seed: u64) -> impl FnMut(f64, f64) -> f64 {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    move |low, high| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// A room with turned boxes in it that do not touch, all of it turned; how many faces the room has.
fn random_room(seed: u64) -> (Vec<Polygon>, usize) {
    let mut number = numbers(seed);
    let turn = |number: &mut dyn FnMut(f64, f64) -> f64| {
        DQuat::from_euler(EulerRot::XYZ, number(0.0, TAU), number(0.0, TAU), number(0.0, TAU))
    };
    let whole = turn(&mut number);
    let (size, shift) = (p(number(2.0, 3.0), number(2.0, 3.0), number(2.0, 3.0)), p(1.0, 2.0, -1.0));
    let mut faces = cuboid(2, true, |v| whole * (v * size) + shift);
    let room = faces.len();
    for k in 0..4 {
        let middle = p([-1.0, 1.0, -1.0, 1.0][k], [-1.0, -1.0, 1.0, 1.0][k], number(-1.0, 1.0));
        let (own, half) = (turn(&mut number), p(number(0.1, 0.5), number(0.1, 0.5), number(0.1, 0.5)));
        faces.extend(cuboid(1, false, |v| whole * (own * (v * half) + middle) + shift));
    }
    (faces, room)
}

#[test]
fn the_rows_of_closed_rooms_add_up_to_one() {
    for seed in 1..5 {
        let (faces, _) = random_room(seed);
        for tolerance in [1e-3, 1e-4] {
            let pairs = Pairs::new(&faces, tolerance);
            for (i, face) in faces.iter().enumerate() {
                let row = (0..faces.len()).map(|j| pairs.exchange(i, j));
                let (sum, error) = row.fold((0.0, 0.0), |(v, e), x| (v + x.value, e + x.error));
                let (sum, error) = (sum / face.area(), error / face.area());
                assert!((sum - 1.0).abs() <= error + 1e-12, "row {i} of room {seed}: {sum} ± {error:e}");
                assert!(error <= tolerance, "row {i} of room {seed}: {error:e} was to be {tolerance:e}");
            }
        }
    }
}

#[test]
fn factors_do_not_depend_on_order_place_or_size() {
    let (faces, _) = random_room(7);
    let turn = DQuat::from_euler(EulerRot::XYZ, 0.4, -1.1, 2.0);
    let moved: Vec<Polygon> = faces
        .iter()
        .map(|face| {
            let v: Vec<DVec3> =
                face.vertices().iter().map(|v| turn * (*v * 1e3) + p(5e3, -2e3, 0.0)).collect();
            Polygon::triangle(v[0], v[1], v[2])
        })
        .collect();
    let (pairs, others) = (Pairs::new(&faces, 1e-4), Pairs::new(&moved, 1e-4));
    for i in 0..faces.len() {
        for j in 0..i {
            let (x, y, back) = (pairs.exchange(i, j), others.exchange(i, j), pairs.exchange(j, i));
            assert_eq!(x, back);
            let apart = (x.value - y.value * 1e-6).abs();
            assert!(apart <= x.error + y.error * 1e-6 + 1e-12, "{i} {j}: {x:?} {y:?}");
        }
    }
}

#[test]
fn the_parts_of_a_face_add_up_to_it() {
    let (faces, _) = random_room(9);
    let mut cut = faces[1..].to_vec();
    let parts = faces[0].quarters();
    cut.extend(parts.iter().cloned());
    let (pairs, others) = (Pairs::new(&faces, 1e-4), Pairs::new(&cut, 1e-4));
    for j in 1..faces.len() {
        let whole = pairs.exchange(0, j);
        let sum = (0..4).map(|k| others.exchange(faces.len() - 1 + k, j - 1));
        let (value, error) = sum.fold((0.0, 0.0), |(v, e), x| (v + x.value, e + x.error));
        assert!(
            (whole.value - value).abs() <= whole.error + error + 1e-13,
            "{j}: {whole:?} {value} ± {error:e}"
        );
    }
}
