//! View factors, enclosures and lighting cases whose answers are known in closed form.

#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod common;

use common::*;
use fredholm::direct;
use fredholm::discretize::Coupling;
use fredholm::operator::Dense;
use fredholm::system::System;
use fredholm::value::{Spectrum, Value};
use glam::DVec3;
use radiosity::closure::Closure;
use radiosity::form_factor::{FormFactors, lambert::point_to_polygon};
use radiosity::patches::Patches;
use radiosity::polygon::Polygon;
use radiosity::scene::{Scene, cut};
use radiosity::solve::{Method, Options, Solution, Solver, Unobserved, solve};
use radiosity::visibility::Visibility;
use std::f64::consts::PI;

#[track_caller]
fn assert_close(got: f64, expected: f64, absolute: f64) {
    assert!((got - expected).abs() <= absolute, "{got} is not {expected}, by {:e}", got - expected);
}

fn options(method: Method, accuracy: f64) -> Options {
    Options {
        method,
        solver: Solver::GaussSeidel,
        accuracy,
        tolerance: 1e-11,
        iterations: 1000,
        memory: 1 << 31,
        ..Options::default()
    }
}

fn solved<V: Value>(scene: &Scene<V>, size: f64, method: Method, accuracy: f64) -> (Patches<V>, Solution<V>) {
    let patches = Patches::new(scene, size).unwrap();
    let solution = solve(&patches, &visibility(scene), &options(method, accuracy), &mut Unobserved).unwrap();
    (patches, solution)
}

/// Σ over the patches of two groups: the factor from surface `from` to surface `to`.
fn surface_factor(scene: &Scene<f64>, size: f64, accuracy: f64, from: u32, to: &[u32]) -> f64 {
    let patches = Patches::new(scene, size).unwrap();
    let visibility = visibility(scene);
    let f = FormFactors::patch_to_patch(&patches, &visibility, accuracy);
    let mut row = vec![0.0; f.dim()];
    let sums: Vec<f64> = (0..f.dim())
        .map(|i| {
            f.row(i, 0, &mut row);
            (0..f.dim()).filter(|&j| to.contains(&patches.surface[j])).map(|j| row[j]).sum()
        })
        .collect();
    mean(&patches, &sums, |i| patches.surface[i] == from)
}

#[test]
fn a_screen_hides_its_share_of_a_view_factor() {
    let squares = |screen: DVec3| {
        let (x, y) = (DVec3::X, DVec3::Y);
        let screen = parallelogram(p(0.0, 0.0, 0.5), screen.x * x, screen.y * y);
        scene(
            [vec![parallelogram(DVec3::ZERO, x, y)], vec![parallelogram(DVec3::Z, y, x)], vec![screen]],
            0.5,
        )
    };
    for size in [1.0, 0.25] {
        let quarter = surface_factor(&squares(p(0.5, 0.5, 0.0)), size, 1e-4, 0, &[1]);
        assert_close(quarter, 0.149868671774, 1e-4);
        let half = surface_factor(&squares(p(0.5, 1.0, 0.0)), size, 1e-4, 0, &[1]);
        assert_close(half, 0.099912447849, 1e-4);
    }
}

#[test]
fn a_cube_within_a_cube_takes_its_share_of_the_rooms_view() {
    let room = walls(DVec3::ZERO, DVec3::ONE, false).to_vec();
    let obstacle = walls(DVec3::splat(0.3), DVec3::splat(0.7), true).to_vec();
    let scene = scene([room, obstacle], 0.5);
    for (size, accuracy) in [(0.5, 1e-3), (0.2, 1e-3)] {
        assert_close(surface_factor(&scene, size, accuracy, 0, &[1]), 0.16, 1e-3);
        assert_close(surface_factor(&scene, size, accuracy, 0, &[0]), 0.84, 1e-3);
        assert_close(surface_factor(&scene, size, accuracy, 1, &[0]), 1.0, 1e-3);
        assert_eq!(surface_factor(&scene, size, accuracy, 1, &[1]), 0.0);
    }
}

#[test]
fn row_sums_err_by_what_was_asked_for() {
    let room = walls(DVec3::ZERO, DVec3::ONE, false).to_vec();
    let scene = scene([room, walls(DVec3::splat(0.3), DVec3::splat(0.7), true).to_vec()], 0.5);
    let patches = Patches::new(&scene, 0.21).unwrap();
    let visibility = visibility(&scene);
    let rms = |accuracy: f64| {
        let f = FormFactors::patch_to_patch(&patches, &visibility, accuracy);
        let mut row = vec![0.0; f.dim()];
        let square = |i: usize, row: &mut [f64]| {
            f.row(i, 0, row);
            (row.iter().sum::<f64>() - 1.0).powi(2)
        };
        let total: f64 = (0..f.dim()).map(|i| square(i, &mut row)).sum();
        ((total / f.dim() as f64).sqrt(), f.rays())
    };
    let (coarse, fine) = (rms(1e-2), rms(1e-3));
    assert!(coarse.0 < 1e-2 && fine.0 < 1e-3, "{coarse:?} {fine:?}");
    assert!(fine.0 > 1e-4, "more rays than the error asked for needs: {fine:?}");
    assert!(fine.1 > 3 * coarse.1);
}

#[test]
fn the_six_zones_of_a_cube() {
    let mut cube = scene(walls(DVec3::ZERO, DVec3::ONE, false).map(|w| vec![w]), 0.6);
    cube.surfaces[0].emission = 1.0;
    let (_, solution) = solved(&cube, 1.0, Method::Galerkin, 1e-7);
    let expected =
        [1.160714295535, 0.267773389574, 0.267878078723, 0.267878078723, 0.267878078723, 0.267878078723];
    assert!(distance(&solution.radiosity, &expected) < 2e-7, "{:?}", solution.radiosity);
    assert!(matches!(solution.closure, Closure::Closed { defect, rows: 6 } if defect < 1e-6));
}

#[test]
fn inside_a_sphere_of_polygons_the_closed_solution_is_approached_with_order_two() {
    // E = 1 + cos², ρ = ½ + 0.3 cos: H = 8/3.
    let error = |rows: usize| {
        let mut sphere: Scene<f64> = scene(sphere(rows).into_iter().map(|polygon| vec![polygon]), 0.5);
        for surface in &mut sphere.surfaces {
            let cosine = surface.polygons[0].centroid().normalize().z;
            surface.emission = 1.0 + cosine * cosine;
            surface.reflectance = 0.5 + 0.3 * cosine;
        }
        let (patches, solution) = solved(&sphere, 9.0, Method::Galerkin, 1e-3);
        assert!(matches!(solution.closure, Closure::Closed { defect, .. } if defect < 1e-4));
        (mean(&patches, &solution.irradiance, |_| true) - 8.0 / 3.0).abs()
    };
    let (coarse, fine) = (error(12), error(24));
    let rate = (coarse / fine).log2();
    assert!((1.8..2.3).contains(&rate), "{rate}: {coarse:e} {fine:e}");
}

#[test]
fn a_spherical_cavity_with_an_opening_is_the_same_integral() {
    // A cap of area fraction f: B = E + ρ f ⟨E⟩/(1 − ρ f); ε = .3, f = .75: .3/(1 − .7 · .75) = .631578947368.
    let error = |rows: usize| {
        let polygons = sphere(rows);
        let cap = polygons.into_iter().filter(|polygon| polygon.centroid().z < 0.5).collect();
        let mut cavity: Scene<f64> = scene([cap], 0.7);
        cavity.surfaces[0].emission = 0.3;
        let (patches, solution) = solved(&cavity, 9.0, Method::Galerkin, 1e-3);
        assert!(matches!(solution.closure, Closure::Open { escaping } if (escaping - 0.25).abs() < 0.02));
        mean(&patches, &solution.radiosity, |_| true) - 0.631578947368
    };
    // 12 rows of 15°: the cap's edge, at z = ½, is the edge of a row.
    assert!(error(12).abs() < 4e-3);
    assert!(error(24).abs() < 1e-3);
}

/// The irradiance, in lx, at points of the walls of a 4 × 4 × 3 m room.
fn lux(point: DVec3, normal: DVec3, source: &Polygon, radiance: f64) -> f64 {
    PI * radiance * point_to_polygon(point, normal, source)
}

#[test]
fn cie_171_test_case_5_3_a_lambertian_source_in_the_ceiling() {
    let lamp = parallelogram(p(1.5, 1.5, 3.0), DVec3::Y, DVec3::X);
    let wall = [32.6769, 75.1939, 81.3232, 69.0606, 53.4035, 40.0019];
    for (k, expected) in wall.into_iter().enumerate() {
        let got = lux(p(2.0, 0.0, 2.75 - 0.5 * k as f64), DVec3::Y, &lamp, 1000.0);
        assert_close(got / expected, 1.0, 2e-6);
    }
    for (k, expected) in [61.4241, 79.2552, 95.6673, 105.7782].into_iter().enumerate() {
        let got = lux(p(2.0, 0.25 + 0.5 * k as f64, 0.0), DVec3::Z, &lamp, 1000.0);
        assert_close(got / expected, 1.0, 2e-6);
    }
}

#[test]
fn cie_171_test_case_5_6_a_uniform_floor_as_the_source() {
    let floor = parallelogram(DVec3::ZERO, 4.0 * DVec3::X, 4.0 * DVec3::Y);
    let wall = [35.9005, 27.9916, 21.6385, 16.7163, 12.9674];
    for (k, expected) in wall.into_iter().enumerate() {
        let got = 100.0 * point_to_polygon(p(2.0, 0.0, 0.75 + 0.5 * k as f64), DVec3::Y, &floor);
        assert_close(got / expected, 1.0, 4e-6);
    }
    for (k, expected) in [26.7952, 30.9387, 33.9757, 35.5666].into_iter().enumerate() {
        let got = 100.0 * point_to_polygon(p(2.0, 0.25 + 0.5 * k as f64, 3.0), -DVec3::Z, &floor);
        assert_close(got / expected, 1.0, 4e-6);
    }
}

#[test]
fn cie_171_test_case_5_7_a_wall_behind_a_box() {
    // Receivers 2 mm wide stand for the points; the factor to the wall y = 4 past the box across the room.
    let receiver = |centre: DVec3, along: DVec3, across: DVec3| {
        vec![parallelogram(centre - 1e-3 * (along + across), 2e-3 * along, 2e-3 * across)]
    };
    let on_wall = (0..6).map(|k| receiver(p(2.0, 0.0, 2.75 - 0.5 * f64::from(k)), DVec3::Z, DVec3::X));
    let on_floor = (0..5).map(|k| receiver(p(2.0, 0.25 + 0.5 * f64::from(k), 0.0), DVec3::X, DVec3::Y));
    let wall = vec![parallelogram(p(0.0, 4.0, 0.0), 4.0 * DVec3::X, 3.0 * DVec3::Z)];
    let screen = walls(p(0.0, 2.5, 0.0), p(4.0, 2.7, 1.0), true).to_vec();
    let case: Scene<f64> = scene([wall, screen].into_iter().chain(on_wall).chain(on_floor), 0.5);
    let patches = Patches::new(&case, 0.25).unwrap();
    let visibility = visibility(&case);
    let f = FormFactors::point_to_patch(&patches, &visibility, 1e-4);
    let expected = [16.0706, 16.3297, 15.3988, 13.3220, 10.3169, 7.0790, 3.3823, 3.6290, 3.0130, 0.0, 0.0]
        .map(|x| x / 100.0);
    let mut row = vec![0.0; f.dim()];
    for i in (0..f.dim()).filter(|&i| patches.surface[i] >= 2) {
        f.row(i, 0, &mut row);
        let from_wall: f64 = (0..f.dim()).filter(|&j| patches.surface[j] == 0).map(|j| row[j]).sum();
        assert_close(from_wall, expected[patches.surface[i] as usize - 2], 1.6e-4);
    }
}

#[test]
fn cie_171_test_case_5_8_interreflection_in_a_cube() {
    // An isotropic point source of Φ = 10 000 lm in the centre of a cube of 4 m. The light that it sends to a patch
    // is Φ/4π times the solid angle, and the source of the equation is what the patch reflects of it.
    let cube: Scene<f64> = scene([walls(DVec3::splat(-2.0), DVec3::splat(2.0), false).to_vec()], 0.5);
    let patches = Patches::new(&cube, 0.5).unwrap();
    let visibility = visibility(&cube);
    let matrix =
        Dense::<f64>::assemble(&FormFactors::patch_to_patch(&patches, &visibility, 1e-5), |_| ()).unwrap();
    let direct_light: Vec<f64> =
        patches.polygons.iter().map(|q| 1e4 / (4.0 * PI) * solid_angle(q) / q.area()).collect();
    assert_close(mean(&patches, &direct_light, |_| true), 104.1667, 1e-4);
    let cases = [
        (0.05, 5.4825),
        (0.1, 11.5741),
        (0.2, 26.0417),
        (0.3, 44.6429),
        (0.4, 69.4444),
        (0.5, 104.1667),
        (0.6, 156.25),
        (0.7, 243.0556),
        (0.8, 416.6667),
        (0.9, 937.5),
        (0.95, 1979.1667),
    ];
    for (rho, expected) in cases {
        let source: Vec<f64> = direct_light.iter().map(|e| rho * e).collect();
        let u = direct::solve(System::new(&source, &vec![rho; source.len()], &matrix).unwrap());
        let indirect: Vec<f64> = u.iter().zip(&source).map(|(u, f)| (u - f) / rho).collect();
        assert_close(mean(&patches, &indirect, |_| true) / expected, 1.0, 1e-4);
    }
}

/// The solid angle of a polygon seen from the origin (Van Oosterom & Strackee 1983).
fn solid_angle(polygon: &Polygon) -> f64 {
    let triangle = |[a, b, c]: [DVec3; 3]| {
        let (x, y, z) = (a.length(), b.length(), c.length());
        2.0 * (a.dot(b.cross(c)).abs()).atan2(x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y)
    };
    polygon.triangles().map(triangle).sum()
}

#[test]
fn p0_converges_as_the_patches_shrink() {
    // Two squares at a right angle, one lit: mean irradiance on the other. Galerkin is exact for a constant emission
    // without reflection, so ρ = 0.8; the fine answer is the reference.
    let corner = |size: f64, method: Method| {
        let floor = vec![parallelogram(DVec3::ZERO, DVec3::X, DVec3::Y)];
        let wall = vec![parallelogram(DVec3::ZERO, DVec3::Z, DVec3::X)];
        let mut corner = scene([floor, wall], 0.8);
        corner.surfaces[0].emission = 1.0;
        let (patches, solution) = solved(&corner, size, method, 1e-5);
        mean(&patches, &solution.irradiance, |i| patches.surface[i] == 1)
    };
    let reference = corner(1.0 / 48.0, Method::Galerkin);
    for (method, rates) in
        [(Method::Galerkin, 1.5..2.6), (Method::Collocation, 0.8..2.2), (Method::Nystrom, 0.7..2.0)]
    {
        let errors = [4.0, 8.0, 16.0].map(|n: f64| (corner(1.0 / n, method) - reference).abs());
        let rate = (errors[0] / errors[2]).log2() / 2.0;
        assert!(rates.contains(&rate), "{method:?}: rate {rate}, errors {errors:?}");
    }
}

#[test]
fn touching_patches_and_blocks_on_the_floor_leak_nothing() {
    // A block stands on the floor of a dark room with a lamp inside the block: nothing outside sees it.
    let room = walls(DVec3::ZERO, p(4.0, 3.0, 2.5), false).to_vec();
    let block = walls(p(1.13, 0.71, 0.0), p(2.09, 1.87, 1.07), true)[1..].to_vec();
    let lamp = vec![parallelogram(p(1.4, 1.0, 0.4), 0.3 * DVec3::X, 0.3 * DVec3::Y)];
    let mut scene = scene([room, block, lamp], Spectrum([0.8; 3]));
    scene.surfaces[2].emission = Spectrum([1000.0; 3]);
    let (patches, solution) = solved(&scene, 0.31, Method::Galerkin, 1e-3);
    // Floor patches under the block see its inside, whose backs do not reflect: all stays with the lamp.
    for i in (0..patches.len()).filter(|&i| patches.surface[i] != 2) {
        assert_eq!(
            solution.radiosity[i],
            Spectrum([0.0; 3]),
            "patch {i} at {}",
            patches.polygons[i].centroid()
        );
    }
}

#[test]
fn a_mesh_that_is_planar_only_to_the_digits_of_its_file_is_a_furnace_all_the_same() {
    // A cube in no particular position, its corners rounded as a file rounds them, its faces cut like a mesh.
    let turn = glam::DQuat::from_euler(glam::EulerRot::XYZ, 0.3, 1.2, -0.8);
    for (decimals, cells) in [(4, 1), (4, 3), (6, 1), (6, 2), (6, 5), (8, 2), (10, 3), (15, 2)] {
        let rounded =
            |v: DVec3| (turn * v).map(|c| (c * 10_f64.powi(decimals)).round() / 10_f64.powi(decimals));
        let cell = |wall: &Polygon, i: usize, j: usize| {
            let at =
                |i: usize, j: usize| rounded(wall.point(i as f64 / cells as f64, j as f64 / cells as f64));
            cut(&[at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]).unwrap()
        };
        let walls = walls(DVec3::ZERO, DVec3::ONE, false);
        let cells = (0..cells * cells).map(|k| (k / cells, k % cells));
        let polygons =
            walls.iter().flat_map(|w| cells.clone().flat_map(move |(i, j)| cell(w, i, j))).collect();
        let mut furnace: Scene<f64> = scene([polygons], 0.5);
        furnace.surfaces[0].emission = 1.0;
        let (patches, solution) = solved(&furnace, 0.34, Method::Galerkin, 1e-4);
        let error = distance(&solution.radiosity, &vec![2.0; patches.len()]);
        assert!(error < 3e-3, "{decimals} decimals: {error:e}, {:?}", solution.closure);
    }
}

#[test]
fn a_sheet_of_two_faces_is_seen_from_the_side_that_faces() {
    let sheet = parallelogram(p(0.0, 0.0, 1.0), DVec3::X, DVec3::Y);
    let back = parallelogram(p(0.0, 0.0, 1.0), DVec3::Y, DVec3::X);
    for order in [[sheet.clone(), back.clone()], [back, sheet]] {
        let visibility = Visibility::new(&order);
        for (origin, direction) in [(p(0.3, 0.6, 0.0), DVec3::Z), (p(0.3, 0.6, 2.0), -DVec3::Z)] {
            let hit = visibility.nearest(origin, direction).unwrap();
            assert!(order[hit.polygon as usize].normal().dot(direction) < 0.0);
        }
    }
}

#[test]
fn the_same_digits_for_any_number_of_threads_and_any_unit() {
    let room = |scale: f64| {
        let room = walls(DVec3::ZERO, scale * p(4.0, 3.0, 2.5), false).to_vec();
        let block = walls(scale * p(1.0, 0.75, 0.0), scale * p(2.0, 1.875, 1.125), true)[1..].to_vec();
        let mut scene = scene([room, block], Spectrum([0.8, 0.5, 0.2]));
        scene.surfaces[1].emission = Spectrum([1.0, 2.0, 3.0]);
        scene
    };
    let on_threads = |threads: usize, scale: f64, solver: Solver| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let scene = room(scale);
            let patches = Patches::new(&scene, 0.5 * scale).unwrap();
            let options = Options { solver, tolerance: 1e-4, ..options(Method::Galerkin, 1e-2) };
            solve(&patches, &visibility(&scene), &options, &mut Unobserved).unwrap().radiosity
        })
    };
    for solver in [Solver::GaussSeidel, Solver::Southwell, Solver::Gmres, Solver::Direct] {
        let one = on_threads(1, 1.0, solver);
        assert_eq!(one, on_threads(2, 1.0, solver), "{solver:?}");
        assert_eq!(one, on_threads(5, 1.0, solver), "{solver:?}");
        // A power of two scales without rounding: a room a thousandth the size is the same room.
        assert_eq!(one, on_threads(2, 1.0 / 1024.0, solver), "{solver:?}");
    }
}
