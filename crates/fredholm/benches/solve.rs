//! What the automatic solver takes for problems of each class: `cargo bench -p fredholm --bench solve`.
//!
//! A line is one problem: the error that was asked for, the largest true error at 200 points, both relative to max |φ|,
//! the unknowns, and the median time of many solutions in milliseconds. `baseline.py` puts NumPy beside it.
#![expect(clippy::unwrap_used, clippy::print_stdout, reason = "a benchmark")]

#[path = "../tests/problems/mod.rs"]
mod problems;

use fredholm::automatic::{Options, solve};
use problems::{Problem, problem};
use std::time::{Duration, Instant};

/// The problems, and the tolerances at which they are compared.
const CASES: [(&str, f64); 9] = [
    ("S01", 1e-14),
    ("S04 c=.01", 1e-13),
    ("S06", 1e-13),
    ("D01", 1e-12),
    ("D04", 1e-12),
    ("L04", 1e-11),
    ("L23", 1e-11),
    ("A02", 1e-11),
    ("I01", 1e-11),
];

/// Time spent on each problem.
const BUDGET: Duration = Duration::from_millis(500);

fn main() {
    println!("problem        tolerance     error     n         ms");
    for (id, tolerance) in CASES {
        let problem = problem(id);
        let (error, unknowns) = check(&problem, tolerance);
        let milliseconds = 1e3 * median(&problem, tolerance);
        println!("{id:<14} {tolerance:>9.0e} {error:>9.1e} {unknowns:>5} {milliseconds:>10.3}");
    }
}

/// (relative error, unknowns)
fn check(problem: &Problem, tolerance: f64) -> (f64, usize) {
    let equation = problem.equation();
    let answer = solve(&equation, &Options { tolerance, ..Options::default() }).unwrap();
    let [a, b] = problem.interval;
    let b = if b.is_finite() { b } else { a + 20.0 };
    let places = (0..=200).map(|k| a + (b - a) * f64::from(k) / 200.0);
    let places: Vec<f64> = places.filter(|x| (problem.exact)(*x).is_finite()).collect();
    let scale = places.iter().map(|x| (problem.exact)(*x).abs()).fold(0.0, f64::max);
    let error = places.iter().map(|x| (answer.at(x) - (problem.exact)(*x)).abs()).fold(0.0, f64::max);
    (error / scale, answer.unknowns)
}

/// Seconds, the first solution apart.
fn median(problem: &Problem, tolerance: f64) -> f64 {
    let equation = problem.equation();
    let options = Options { tolerance, ..Options::default() };
    let mut times = Vec::new();
    let start = Instant::now();
    while start.elapsed() < BUDGET || times.len() < 5 {
        let start = Instant::now();
        std::hint::black_box(solve(&equation, &options).unwrap());
        times.push(start.elapsed().as_secs_f64());
    }
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}
