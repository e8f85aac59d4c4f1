//! The walls of the Cornell box, 64 × 64 texels each: the error of the field and the time that it takes to solve, on one thread.
//!
//! `cargo bench -p radiosity --bench cornell [-- ACCURACY …]`; the reference is the same solver's field at the first accuracy,
//! .3 % if none is given, whose means over walls stand in a test beside those of a path tracer.

#![expect(clippy::unwrap_used, clippy::print_stdout, reason = "a benchmark prints what it measures")]

use fredholm::value::{Rgb, Spectrum, Value};
use glam::DVec3;
use radiosity::adaptive::{Domain, Field, Request, solve};
use radiosity::scene::{Scene, cornell_box};
use rayon::prelude::*;
use std::time::Instant;

const WALLS: [&str; 4] = ["floor", "back", "right", "left"];
const TEXELS: usize = 64;
const RUNS: usize = 5;

fn main() {
    let given: Vec<f64> = std::env::args().skip(1).filter_map(|word| word.parse().ok()).collect();
    let accuracies = if given.is_empty() { vec![0.003, 0.2, 0.05, 0.03, 0.02, 0.01] } else { given };
    let mut scene = cornell_box();
    let light = scene.surfaces.iter().position(|surface| surface.name == "light").unwrap();
    // As in the reference: what the lamp reflects lights the ceiling, and hardly the walls.
    scene.surfaces[light].reflectance = Spectrum([0.0; 3]);
    let (faces, texels) = (scene.polygons(), texels(&scene));
    let solved = |accuracy: f64| {
        let domain = Domain::new(&scene, &faces).unwrap();
        let start = Instant::now();
        let field = solve(&domain, &Request { accuracy, ..Request::default() }, |_| true);
        let seconds = start.elapsed().as_secs_f64();
        let start = Instant::now();
        let (bound, size) = (field.bound().total(), field.size());
        let light = radiosities(&field.for_points(texels.len()), &texels);
        (light, bound, size, [seconds, start.elapsed().as_secs_f64()])
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let (reference, bound, [patches, _], _) = solved(accuracies[0]);
    println!("reference: {patches} patches, error told {:.2} %", 100.0 * bound);
    println!(
        "{:>8} {:>8} {:>9} {:>8} {:>8} {:>9} {:>9}",
        "asked", "patches", "factors", "told", "error", "solve, s", "texels, s"
    );
    for &accuracy in &accuracies[1..] {
        let mut runs: Vec<_> = (0..RUNS).map(|_| pool.install(|| solved(accuracy))).collect();
        runs.sort_by(|a, b| a.3[0].total_cmp(&b.3[0]));
        let (light, bound, [patches, factors], [solving, looking]) = &runs[RUNS / 2];
        let [asked, told, error] =
            [accuracy, *bound, distance(light, &reference)].map(|part| format!("{:.2} %", 100.0 * part));
        println!("{asked:>8} {patches:>8} {factors:>9} {told:>8} {error:>8} {solving:>9.3} {looking:>9.3}");
    }
}

fn radiosities(field: &Field<'_, Rgb>, texels: &[(u32, DVec3)]) -> Vec<Rgb> {
    texels
        .par_chunks(TEXELS)
        .flat_map_iter(|row| field.light(row.iter().copied()).into_iter().map(|[radiosity, _]| radiosity))
        .collect()
}

/// ‖a − b‖/‖b‖ in L².
fn distance(a: &[Rgb], b: &[Rgb]) -> f64 {
    let square = |v: Rgb| v.channels().iter().map(|c| c * c).sum::<f64>();
    let difference: f64 = a.iter().zip(b).map(|(a, b)| square(*a - *b)).sum();
    (difference / b.iter().map(|b| square(*b)).sum::<f64>()).sqrt()
}

/// The centres of the texels; the left wall is skew and two triangles.
fn texels(scene: &Scene<Rgb>) -> Vec<(u32, DVec3)> {
    let mut texels = Vec::new();
    for name in WALLS {
        let before = scene.surfaces.iter().take_while(|surface| surface.name != name);
        let face = before.map(|surface| surface.polygons.len() as u32).sum::<u32>();
        let wall = &scene.surfaces.iter().find(|surface| surface.name == name).unwrap().polygons;
        let first = wall[0].vertices();
        for texel in 0..TEXELS * TEXELS {
            let at = |k: usize| (k as f64 + 0.5) / TEXELS as f64;
            let (s, t) = (at(texel % TEXELS), at(texel / TEXELS));
            texels.push(match wall.get(1) {
                None => (face, wall[0].point(s, t)),
                Some(_) if s >= t => (face, first[0] + (first[1] - first[0]) * s + (first[2] - first[1]) * t),
                Some(other) => {
                    let last = other.vertices()[2];
                    (face + 1, first[0] + (last - first[0]) * t + (first[2] - last) * s)
                }
            });
        }
    }
    texels
}
