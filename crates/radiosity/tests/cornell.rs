//! The Cornell box against a program that shares no code with this one: an unbiased path tracer (16 × 1024 paths a
//! texel, 64 × 64 texels a wall, relative standard error of the whole about 0.1 %).

#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod common;

use common::*;
use fredholm::value::{Rgb, Spectrum};
use glam::DVec3;
use radiosity::patches::{Patches, size_for_count};
use radiosity::polygon::Polygon;
use radiosity::scene::{Scene, cornell_box, cornell_box_spectral};
use radiosity::solve::{Method, Options, Solver, Unobserved, solve};

/// Mean radiosity of whole walls, W/m², as the path tracer found it.
const EXPECTED: [(&str, [f64; 3]); 4] = [
    ("floor", [0.34717, 0.23130, 0.06271]),
    ("back", [0.52735, 0.34663, 0.09358]),
    ("right", [0.10960, 0.23799, 0.01434]),
    ("left", [0.43853, 0.02925, 0.00673]),
];

/// The box with the lamp of the path tracer: black, 0.1 mm below a whole ceiling.
fn with_its_lamp() -> Scene<Rgb> {
    let mut scene = cornell_box();
    let named = |scene: &Scene<Rgb>, name: &str| scene.surfaces.iter().position(|s| s.name == name).unwrap();
    let (ceiling, lamp) = (named(&scene, "ceiling"), named(&scene, "light"));
    let corners =
        [(556.0, 0.0), (556.0, 559.2), (0.0, 559.2), (0.0, 0.0)].map(|(x, z)| p(x, 548.8, z) / 1000.0);
    let [a, b, c, d] = corners;
    scene.surfaces[ceiling].polygons = vec![Polygon::quadrilateral(a, b, c, d)];
    assert!(scene.surfaces[ceiling].polygons[0].normal().distance(-DVec3::Y) < 1e-12);
    let lowered: Vec<DVec3> =
        scene.surfaces[lamp].polygons[0].vertices().iter().map(|v| *v - 1e-4 * DVec3::Y).collect();
    scene.surfaces[lamp].polygons =
        vec![Polygon::quadrilateral(lowered[0], lowered[1], lowered[2], lowered[3])];
    scene.surfaces[lamp].reflectance = Spectrum([0.0; 3]);
    scene
}

fn mean_radiosity(
    scene: &Scene<Rgb>,
    method: Method,
    solver: Solver,
    count: usize,
    tolerance: f64,
) -> Vec<(String, [f64; 3])> {
    let patches = Patches::new(scene, size_for_count(scene, count)).unwrap();
    let options = Options {
        method,
        solver,
        accuracy: 1e-3,
        tolerance,
        iterations: 100_000,
        memory: 1 << 31,
        ..Options::default()
    };
    let solution = solve(&patches, &visibility(scene), &options, &mut Unobserved).unwrap();
    let of = |k: usize| {
        let channel = |c: usize| {
            let values: Vec<f64> = solution.radiosity.iter().map(|b| b.0[c]).collect();
            mean(&patches, &values, |i| patches.surface[i] as usize == k)
        };
        [channel(0), channel(1), channel(2)]
    };
    scene.surfaces.iter().enumerate().map(|(k, surface)| (surface.name.clone(), of(k))).collect()
}

#[track_caller]
fn assert_walls(means: &[(String, [f64; 3])], within: f64) {
    for (name, expected) in EXPECTED {
        let got = means.iter().find(|(n, _)| n == name).unwrap().1;
        for c in 0..3 {
            let off = got[c] / expected[c] - 1.0;
            assert!(
                off.abs() < within,
                "{name}, channel {c}: {} for {}, off by {off:.4}",
                got[c],
                expected[c]
            );
        }
    }
}

#[test]
fn mean_radiosities_of_the_walls_are_those_of_a_path_tracer_within_a_hundredth() {
    let scene = with_its_lamp();
    assert_walls(&mean_radiosity(&scene, Method::Galerkin, Solver::GaussSeidel, 3000, 1e-6), 0.01);
    // Centroids see the lamp of a whole patch or none of it: a little less exact on as many patches.
    assert_walls(&mean_radiosity(&scene, Method::Collocation, Solver::Gmres, 3000, 1e-6), 0.01);
}

#[test]
fn progressive_radiosity_finds_the_same_walls() {
    let scene = with_its_lamp();
    assert_walls(&mean_radiosity(&scene, Method::Galerkin, Solver::Southwell, 1000, 1e-4), 0.015);
}

#[test]
fn seventy_six_bands_are_one_matrix_and_seventy_six_solutions() {
    // Band k of the spectral solution is the solution of the scene of band k alone.
    let spectral = cornell_box_spectral();
    let patches = Patches::new(&spectral, size_for_count(&spectral, 300)).unwrap();
    let options = Options {
        method: Method::Galerkin,
        solver: Solver::GaussSeidel,
        accuracy: 1e-2,
        tolerance: 1e-9,
        iterations: 1000,
        ..Options::default()
    };
    let visibility = visibility(&spectral);
    let all = solve(&patches, &visibility, &options, &mut Unobserved).unwrap();
    for k in [5, 40, 75] {
        let mut grey = scene(spectral.surfaces.iter().map(|s| s.polygons.clone()), 0.0);
        for (grey, surface) in grey.surfaces.iter_mut().zip(&spectral.surfaces) {
            (grey.reflectance, grey.emission) = (surface.reflectance.0[k], surface.emission.0[k]);
        }
        let patches = Patches::new(&grey, size_for_count(&grey, 300)).unwrap();
        let one = solve(&patches, &visibility, &options, &mut Unobserved).unwrap();
        let band: Vec<f64> = all.radiosity.iter().map(|b| b.0[k]).collect();
        assert!(
            distance(&band, &one.radiosity) < 1e-6 * one.radiosity.iter().fold(0.0, |m: f64, b| m.max(*b)),
            "band {k}"
        );
    }
}
