//! An action of links, and a sweep of Gauss–Seidel on them, set against reading as many bytes in the same moment and doing nothing
//! with them; and Gauss–Seidel and Southwell to a residual of 10⁻² on links, beside the same with rows and columns written out.
//!
//! `cargo bench -p radiosity --bench links [-- PATCHES]`: 100 000 in a hall with boxes if none are given. The bytes are those of
//! the links alone, of factors and of who sends; what else is read, the means, counts as time.
#![expect(clippy::unwrap_used, clippy::print_stdout, reason = "a benchmark prints what it measures")]

#[expect(dead_code, reason = "one of its scenes is enough")]
mod scenes;

use fredholm::operator::{Columns, Line, Matrix, Operator, Rows};
use fredholm::relax::{GaussSeidel, Relaxation, Southwell, Stop, relax};
use fredholm::system::System;
use fredholm::value::{Rgb, Value, max_norm};
use radiosity::hierarchical::{Hierarchical, Light, Plan};
use radiosity::patches::{Patches, size_for_count};
use radiosity::visibility::Visibility;
use rayon::prelude::*;
use std::hint::black_box;
use std::time::Instant;

/// Turns, of which medians are told.
const TURNS: usize = 41;

fn main() {
    let count = std::env::args().skip(1).find_map(|word| word.parse().ok()).unwrap_or(100_000);
    let scene = scenes::boxes();
    let patches = Patches::new(&scene, size_for_count(&scene, count)).unwrap();
    let visibility = Visibility::new(&scene.polygons());
    let plan = Plan::new(&patches, &visibility);
    let light = Light::ambient(&patches, &patches.emission);
    let links = plan.assemble(&light, 0.1, 1, |_| ());
    let told = links.statistics();
    println!(
        "{} threads, {} patches, {} links of {} MB, {} MB in all",
        rayon::current_num_threads(),
        told.patches,
        told.links,
        told.link_bytes >> 20,
        told.bytes >> 20
    );
    // From within the pool: what is short takes a fifth longer, read or act, where a thread from outside waits for two others.
    rayon::scope(|_| {
        measure("numbers", &links, |_| 1.0_f64);
        measure("colours", &links, |i| patches.reflectance[i]);
    });
    solve("links", &links, &patches, usize::MAX);
    // Of a sweep by rows, and of so many shots by columns, the time of all is known.
    let few = if told.patches > MOST_BY_LINES { 1 } else { usize::MAX };
    solve("lines", &Lines(&links), &patches, few);
}

/// Up to so many patches are solved for by lines.
const MOST_BY_LINES: usize = 20_000;

/// The same links, as rows and columns.
struct Lines<'a>(&'a Hierarchical);

impl Matrix for Lines<'_> {
    fn dim(&self) -> usize {
        self.0.dim()
    }
    fn diagonal(&self, i: usize) -> f64 {
        self.0.diagonal(i)
    }
}

impl Rows for Lines<'_> {
    fn row<'a>(&'a self, i: usize, buffer: &'a mut Vec<f64>) -> Line<'a> {
        self.0.row(i, buffer)
    }
}

impl Columns for Lines<'_> {
    fn column<'a>(&'a self, j: usize, buffer: &'a mut Vec<f64>) -> Line<'a> {
        self.0.column(j, buffer)
    }
}

/// To a residual of 10⁻² of the brightest emission, in `sweeps` sweeps and a hundred times as many shots at most.
fn solve<F: Rows + Columns>(name: &str, operator: &F, patches: &Patches<Rgb>, sweeps: usize) {
    let system = System::new(&patches.emission, &patches.reflectance, operator).unwrap();
    let stop = Stop { residual: 1e-2 * max_norm(&patches.emission), sweeps };
    let tell = |solver: &str, stop: Stop, relaxation: &mut dyn Relaxation<Rgb>| {
        let start = Instant::now();
        let (mut steps, mut norm) = (0, f64::INFINITY);
        // A last look at the residual, as `relax` has it, would be an action by rows.
        if sweeps == usize::MAX {
            let report = relax(relaxation, stop, |_, _, _| true);
            (steps, norm) = (report.residuals.len(), report.residual);
        }
        while sweeps != usize::MAX && steps < stop.sweeps {
            (steps, norm) = (steps + 1, relaxation.sweep());
        }
        let seconds = start.elapsed().as_secs_f64();
        println!("{solver} by {name}: {steps} sweeps in {seconds:.2} s, residual {norm:.1e}");
    };
    tell("gauss-seidel", stop, &mut GaussSeidel::new(system));
    let stop = Stop { sweeps: sweeps.saturating_mul(100), ..stop };
    tell("southwell", stop, &mut Southwell::new(system, &patches.areas));
}

fn measure<V: Value>(name: &str, links: &Hierarchical, value: impl Fn(usize) -> V) {
    let n = links.statistics().patches;
    let words: Vec<u64> = (0..links.statistics().link_bytes / 8).collect();
    let u: Vec<V> = (0..n).map(value).collect();
    let (source, coefficient) = (vec![V::splat(1.0); n], vec![V::splat(0.5); n]);
    let mut relaxation = GaussSeidel::new(System::new(&source, &coefficient, links).unwrap());
    let mut image = vec![V::splat(0.0); n];
    let (mut reads, mut actions, mut sweeps) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..TURNS {
        let read = seconds(|| add(black_box(&words)));
        reads.push(read);
        actions.push(seconds(|| links.apply(&u, &mut image)) / read);
        sweeps.push(seconds(|| relaxation.sweep()) / read);
    }
    let [read, action, sweep] = [reads, actions, sweeps].map(median);
    println!(
        "{name}: a read {:.2} ms, {:.1} GB/s; an action {action:.2} reads, {:.0} % of that; a sweep, on one core, {sweep:.2} reads",
        1e3 * read,
        8e-9 * words.len() as f64 / read,
        100.0 / action
    );
}

fn add(words: &[u64]) -> u64 {
    let parts = words.par_chunks(1 << 13);
    parts.map(|part| part.iter().fold(0, |sum: u64, word| sum.wrapping_add(*word))).sum()
}

fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers[numbers.len() / 2]
}

fn seconds<T>(work: impl FnOnce() -> T) -> f64 {
    let start = Instant::now();
    black_box(work());
    start.elapsed().as_secs_f64()
}
