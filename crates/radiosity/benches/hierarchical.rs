//! Very many patches: time, memory, links and error of the hierarchical operator on four scenes, and the matrix beside it.
//!
//! `cargo bench -p radiosity --bench hierarchical [-- PATCHES … SCENE …]`: 1 000, 10 000 and 100 000 if none are given, and all four
//! scenes; a million take some minutes each. Times are of the whole: clusters, sketch, links, GMRES, and the estimate of the error.

#![expect(clippy::unwrap_used, clippy::print_stdout, reason = "a benchmark prints what it measures")]

mod scenes;

use fredholm::value::{Rgb, Value};
use radiosity::patches::{Patches, size_for_count};
use radiosity::scene::{Scene, cornell_box};
use radiosity::solve::{Options, Solution, Solver, Storage, Unobserved, solve};
use radiosity::visibility::Visibility;
use std::time::Instant;

/// Up to so many patches there is a matrix beside the links.
const MATRIX: usize = 25_000;

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let given: Vec<usize> = words.iter().filter_map(|word| word.parse().ok()).collect();
    let counts = if given.is_empty() { vec![1_000, 10_000, 100_000] } else { given };
    let named = |name: &&str| words.iter().any(|word| word == name);
    let names = ["Cornell box", "boxes", "terrain", "building"];
    println!("{} threads, --factor-accuracy {ACCURACY}", rayon::current_num_threads());
    for name in names.iter().filter(|name| named(name) || !names.iter().any(named)) {
        println!(
            "\n{name:12} {:>8} {:>8} {:>8} {:>8} {:>9} {:>8} | {:>8} {:>9} {:>10}",
            "links/n", "rays/n", "MB", "s", "told", "of links", "matrix s", "MB", "difference"
        );
        let lines: Vec<[f64; 2]> = counts.iter().map(|count| line(&scene(name, *count), *count)).collect();
        for pair in lines.windows(2) {
            let slope = (pair[1][1] / pair[0][1]).ln() / (pair[1][0] / pair[0][0]).ln();
            println!("slope of log time from {} to {}: {slope:.2}", pair[0][0], pair[1][0]);
        }
    }
}

/// The accuracy that light is asked for to 1 %, and has at some tenths of that.
const ACCURACY: f64 = 1e-3;

/// A scene that is worth so many patches.
fn scene(name: &str, count: usize) -> Scene<Rgb> {
    match name {
        "boxes" => scenes::boxes(),
        "terrain" => scenes::terrain(count),
        "building" => scenes::building(((count as f64 / 2500.0).sqrt().ceil() as usize).clamp(2, 20)),
        _ => cornell_box(),
    }
}

/// Patches and seconds.
fn line(scene: &Scene<Rgb>, count: usize) -> [f64; 2] {
    let patches = Patches::new(scene, size_for_count(scene, count)).unwrap();
    let visibility = Visibility::new(&scene.polygons());
    let (linked, seconds) = solved(&patches, &visibility, Storage::Hierarchical);
    let links = linked.links.unwrap();
    let n = patches.len() as f64;
    let each = |count: u64| count as f64 / n;
    print!(
        "{:12} {:>8.1} {:>8.1} {:>8} {seconds:>8.2} {:>8.2}% {:>7.2}% |",
        patches.len(),
        each(links.statistics.links),
        each(links.statistics.rays),
        links.statistics.bytes >> 20,
        100.0 * links.judged.error,
        100.0 * links.judged.links,
    );
    if patches.len() <= MATRIX {
        let (dense, seconds) = solved(&patches, &visibility, Storage::Dense);
        let difference = distance(&patches, &linked.radiosity, &dense.radiosity);
        print!(" {seconds:>8.2} {:>9} {:>9.2}%", (patches.len().pow(2) * 4) >> 20, 100.0 * difference);
    }
    println!();
    [n, seconds]
}

fn solved(patches: &Patches<Rgb>, visibility: &Visibility, storage: Storage) -> (Solution<Rgb>, f64) {
    let start = Instant::now();
    let options = Options {
        storage,
        accuracy: ACCURACY,
        solver: Solver::Gmres,
        memory: u64::MAX,
        ..Options::default()
    };
    let solution = solve(patches, visibility, &options, &mut Unobserved).unwrap();
    (solution, start.elapsed().as_secs_f64())
}

/// ‖u − v‖ / ‖v‖ in the mean square.
fn distance(patches: &Patches<Rgb>, u: &[Rgb], v: &[Rgb]) -> f64 {
    let square = |x: Rgb| x.channels().iter().map(|c| c * c).sum::<f64>();
    let norm = |of: &dyn Fn(usize) -> f64| (0..v.len()).map(|i| patches.areas[i] * of(i)).sum::<f64>().sqrt();
    norm(&|i| square(u[i] - v[i])) / norm(&|i| square(v[i]))
}
