//! Very many patches: time, memory, links and error of the hierarchical operator on scenes of any size, and the matrix beside it.
//!
//! `cargo bench -p radiosity --bench hierarchical [-- PATCHES … SCENE … ACCURACY reference finer]`: 1 000, 10 000 and 100 000 if none are given,
//! all four scenes, and an accuracy of factors of 0.001; a million take some minutes each. Times are of the whole: clusters, sketch, links,
//! GMRES, and the estimate of the error. With `reference` light is held against a finer one: where faces are few the adaptive answer to
//! 0.5 %, else links of a third of the accuracy; with `finer` against four times as many patches, of all light.

#![expect(clippy::unwrap_used, clippy::print_stdout, reason = "a benchmark prints what it measures")]

mod scenes;

use fredholm::value::{Rgb, Value};
use radiosity::adaptive::{self, Domain, Request};
use radiosity::patches::{Patches, size_for_count};
use radiosity::reconstruct::Lit;
use radiosity::scene::{Scene, cornell_box};
use radiosity::solve::{Options, Solution, Solver, Storage, Unobserved, solve};
use radiosity::visibility::Visibility;
use rayon::prelude::*;
use std::time::Instant;

/// Up to so many patches there is a matrix beside the links.
const MATRIX: usize = 25_000;

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let given: Vec<usize> = words.iter().filter_map(|word| word.parse().ok()).collect();
    let counts = if given.is_empty() { vec![1_000, 10_000, 100_000] } else { given };
    let named = |name: &&str| words.iter().any(|word| word == name);
    let names = ["Cornell box", "boxes", "terrain", "building", "rooms", "storeys"];
    let accuracy = words.iter().filter_map(|word| word.parse().ok()).find(|a| *a < 1.0).unwrap_or(1e-3);
    let is_asked = |word: &str| words.iter().any(|said| said == word);
    let asked = Asked { accuracy, reference: is_asked("reference"), finer: is_asked("finer") };
    println!("{} threads, --factor-accuracy {accuracy}", rayon::current_num_threads());
    for name in names.iter().filter(|name| named(name) || !names.iter().any(named)) {
        println!(
            "\n{name:12} {:>8} {:>8} {:>8} {:>8} {:>9} {:>8} | {:>8} {:>9} {:>10} | {:>9} {:>9}",
            "links/n",
            "rays/n",
            "MB",
            "s",
            "told",
            "of links",
            "matrix s",
            "MB",
            "difference",
            "reflected",
            "off"
        );
        let lines: Vec<[f64; 2]> =
            counts.iter().map(|count| line(&scene(name, *count), *count, &asked)).collect();
        for pair in lines.windows(2) {
            let slope = (pair[1][1] / pair[0][1]).ln() / (pair[1][0] / pair[0][0]).ln();
            println!("slope of log time from {} to {}: {slope:.2}", pair[0][0], pair[1][0]);
        }
    }
}

/// What is asked for.
struct Asked {
    /// Of form factors.
    accuracy: f64,
    /// Whether light is held against a finer one.
    reference: bool,
    /// Whether against that of finer patches.
    finer: bool,
}

/// Patches of a room of the building.
const A_ROOM: f64 = 4500.0;

/// Rooms from wall to wall of the building that is the same however many patches there are.
const ROOMS: usize = 10;

/// Rooms of a storey from wall to wall, in the building of storeys.
const A_SIDE: usize = 5;

/// A scene that is worth so many patches.
fn scene(name: &str, count: usize) -> Scene<Rgb> {
    match name {
        "boxes" => scenes::boxes(),
        "terrain" => scenes::terrain(count),
        "building" => scenes::building(((count as f64 / A_ROOM).sqrt().ceil() as usize).max(2), 1),
        "rooms" => scenes::building(ROOMS, 1),
        "storeys" => scenes::building(
            A_SIDE,
            (count as f64 / (A_ROOM * A_SIDE.pow(2) as f64)).round().max(1.0) as usize,
        ),
        _ => cornell_box(),
    }
}

/// Patches and seconds.
fn line(scene: &Scene<Rgb>, count: usize, asked: &Asked) -> [f64; 2] {
    let patches = Patches::new(scene, size_for_count(scene, count)).unwrap();
    let visibility = Visibility::new(&scene.polygons());
    let (linked, seconds) = solved(&patches, &visibility, Storage::Hierarchical, asked.accuracy);
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
        let (dense, seconds) = solved(&patches, &visibility, Storage::Dense, asked.accuracy);
        let difference = distance(&patches, &linked.radiosity, &dense.radiosity);
        print!(" {seconds:>8.2} {:>9} {:>9.2}% |", (patches.len().pow(2) * 4) >> 20, 100.0 * difference);
    } else {
        print!(" {:>8} {:>9} {:>10} |", "", "", "");
    }
    if asked.reference {
        let [told, off] = reference(scene, (&patches, &visibility), &linked, asked.accuracy);
        print!(" {:>8.2}% {:>8.2}%", 100.0 * told, 100.0 * off);
    }
    if asked.finer {
        print!(" off from finer patches: {:.2}%", 100.0 * finer(scene, &patches, &linked, asked.accuracy));
    }
    println!();
    [n, seconds]
}

fn solved(
    patches: &Patches<Rgb>,
    visibility: &Visibility,
    storage: Storage,
    accuracy: f64,
) -> (Solution<Rgb>, f64) {
    let start = Instant::now();
    let options =
        Options { storage, accuracy, solver: Solver::Gmres, memory: u64::MAX, ..Options::default() };
    let solution = solve(patches, visibility, &options, &mut Unobserved).unwrap();
    (solution, start.elapsed().as_secs_f64())
}

/// ‖u − v‖ / ‖v‖ in the mean square.
fn distance(patches: &Patches<Rgb>, u: &[Rgb], v: &[Rgb]) -> f64 {
    let all: Vec<usize> = (0..v.len()).collect();
    norm(patches, &all, |i| u[i] - v[i]) / norm(patches, &all, |i| v[i])
}

/// The root of the sum of areas times squares, over some patches.
fn norm(patches: &Patches<Rgb>, of: &[usize], value: impl Fn(usize) -> Rgb) -> f64 {
    of.iter().map(|&i| patches.areas[i] * value(i).square()).sum::<f64>().sqrt()
}

/// What the adaptive answer is asked to err by at most, and the patches that are held against it.
const FINER: f64 = 0.005;
const LOOKS: usize = 20_000;

/// What links tell of the light that is *reflected*, without lamps, and how far that is from a finer one.
fn reference(
    scene: &Scene<Rgb>,
    (patches, visibility): (&Patches<Rgb>, &Visibility),
    linked: &Solution<Rgb>,
    accuracy: f64,
) -> [f64; 2] {
    let faces = scene.polygons();
    let all: Vec<usize> = (0..patches.len()).collect();
    let (at, fine): (Vec<usize>, Vec<Rgb>) = if faces.len() <= 1000 {
        let domain = Domain::new(scene, &faces).unwrap();
        let field = adaptive::solve(&domain, &Request { accuracy: FINER, ..Request::default() }, |_| true);
        let at: Vec<usize> = all.iter().copied().step_by(patches.len().div_ceil(LOOKS)).collect();
        let on = patches.face_of_each();
        let mut points = at.iter().map(|&i| (on[i], patches.polygons[i].centroid()));
        let light = field.seen(&mut points);
        (at, light.into_iter().map(|[b, _]| b).collect())
    } else {
        (all.clone(), solved(patches, visibility, Storage::Hierarchical, accuracy / 3.0).0.radiosity)
    };
    let mut exact = linked.radiosity.clone();
    at.iter().zip(fine).for_each(|(&i, light)| exact[i] = light);
    let reflected = norm(patches, &at, |i| exact[i] - patches.emission[i]);
    let off = norm(patches, &at, |i| linked.radiosity[i] - exact[i]);
    let whole = norm(patches, &all, |i| linked.radiosity[i]);
    let without = norm(patches, &all, |i| linked.radiosity[i] - patches.emission[i]);
    [linked.links.as_ref().unwrap().judged.error * whole / without, off / reflected]
}

/// How many times more patches there are in the finer answer: each of one is four of the other.
const FINER_PATCHES: usize = 4;

/// How far light is from that of finer patches, as a part of all: the difference of means, and what varies within the finer ones.
fn finer(scene: &Scene<Rgb>, patches: &Patches<Rgb>, linked: &Solution<Rgb>, accuracy: f64) -> f64 {
    let fine = Patches::new(scene, size_for_count(scene, FINER_PATCHES * patches.len())).unwrap();
    let solution = solved(&fine, &Visibility::new(&scene.polygons()), Storage::Hierarchical, accuracy).0;
    let mut of_face = vec![Vec::new(); scene.polygons().len()];
    patches.face_of_each().iter().enumerate().for_each(|(i, face)| of_face[*face as usize].push(i));
    let on = fine.face_of_each();
    let off = |k: usize| {
        let x = fine.polygons[k].centroid();
        let distance = |i: &usize| patches.polygons[*i].centroid().distance_squared(x);
        let here = of_face[on[k] as usize].iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap();
        fine.areas[k] * (linked.radiosity[*here] - solution.radiosity[k]).square()
    };
    let square: f64 = (0..fine.len()).into_par_iter().map(off).sum();
    let all: Vec<usize> = (0..fine.len()).collect();
    let whole = norm(&fine, &all, |k| solution.radiosity[k]);
    (square.sqrt() / whole).hypot(solution.links.unwrap().judged.patches)
}
