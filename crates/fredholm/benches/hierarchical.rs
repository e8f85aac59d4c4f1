//! The hierarchical operator from a thousand unknowns to a million, each line an equation with a known solution: building it, its
//! action set against reading as many bytes in the same moment, and GMRES on it; and singular kernels in the plane, as a whole.
//!
//! `cargo bench --bench hierarchical` goes to 10⁵; `-- 65536` makes panels of 16 unknowns up to that number, a million unknowns.
#![allow(missing_docs, clippy::print_stdout)]

use fredholm::discretize::{Coupling, Galerkin, ProductNystrom};
use fredholm::equation::{ByOffset, Equation, Interval};
use fredholm::krylov::Gmres;
use fredholm::operator::hierarchical::{Hierarchical, Options, Plan};
use fredholm::operator::{Matrix, Operator};
use fredholm::plane::{self, Domain, PlaneEquation};
use fredholm::relax::{Relaxation, Stop, relax};
use fredholm::space::{Element, Space};
use fredholm::system::System;
use rayon::prelude::*;
use std::error::Error;
use std::hint::black_box;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let most = std::env::args().skip(1).find_map(|argument| argument.parse().ok()).unwrap_or(6250);
    println!("φ = f + ∫ ln|x − y| φ dy on [0, 1], product rules on panels of degree 15, ε = 1e-9");
    heading();
    let mut lines = Vec::new();
    for panels in [64, 512, 4096, 65536].into_iter().filter(|panels| *panels <= most) {
        lines.push(logarithm(panels)?);
    }
    slopes(&lines);
    println!(
        "\nφ = f + ½ ∫ exp(−|x − y|) φ dy on [0, 1], Galerkin's means over n elements, two nodes each, ε = 1e-9"
    );
    heading();
    let mut lines = Vec::new();
    for n in [1000, 10_000, 100_000, 1_000_000].into_iter().filter(|n| *n <= 16 * most) {
        lines.push(means(n)?);
    }
    slopes(&lines);
    println!("\nφ = f + ½ ∫ φ dS / (4π |x − y|) on the unit sphere, equal weights, ε = 1e-5");
    heading();
    let mut lines = Vec::new();
    for n in [1000, 10_000, 100_000].into_iter().filter(|n| *n <= 16 * most) {
        lines.push(sphere(n)?);
    }
    slopes(&lines);
    println!(
        "\nφ = f + ∫ K φ on the unit square, product rule on graded elements, to 1e-12 or as many unknowns as are allowed"
    );
    println!("{:>22} {:>8} {:>8} {:>8} {:>9} {:>9}", "K", "allowed", "n", "s", "told", "error");
    for allowed in [1024, 4096, 20_000].into_iter().filter(|allowed| *allowed <= 16 * most) {
        square(
            "ln |p − q| / 10",
            allowed,
            |r| 0.1 * r.ln(),
            |h, t| 0.1 * h * (0.5 * (t * h.hypot(t).ln() - t + h * (t / h).atan()) - 0.25 * t),
        )?;
        square("1 / (10 |p − q|)", allowed, |r| 0.1 / r, |h, t| 0.1 * h * (t / h).asinh())?;
    }
    Ok(())
}

/// φ = 1. ∫ K(p, q) dq is a sum over the sides: of `side` from one end to the other, h being the distance of p from a side's line and t
/// what runs along it.
fn square(
    name: &str,
    allowed: usize,
    kernel: fn(f64) -> f64,
    side: fn(f64, f64) -> f64,
) -> Result<(), Box<dyn Error>> {
    let source = |[x, y]: [f64; 2]| {
        let sides = [(y, x), (1.0 - x, y), (1.0 - y, x), (x, y)];
        1.0 - sides
            .iter()
            .filter(|(h, _)| *h > 0.0)
            .map(|(h, at)| side(*h, 1.0 - at) - side(*h, -at))
            .sum::<f64>()
    };
    let kernel = |p: [f64; 2], q: [f64; 2]| kernel((p[0] - q[0]).hypot(p[1] - q[1]));
    let equation = PlaneEquation::new(Domain::rectangle(0.0, 1.0, 0.0, 1.0)?, kernel, source);
    let options = plane::Options { tolerance: 1e-12, n: None, unknowns: allowed };
    let start = Instant::now();
    let answer = plane::solve_large(&equation, &options)?;
    let taken = start.elapsed().as_secs_f64();
    let at = |k: usize| [0.754_877_666, 0.569_840_291].map(|step| (0.5 + step * k as f64).fract());
    let error = (0..1000).map(|k| (answer.at(&at(k)) - 1.0).abs()).fold(0.0, f64::max);
    println!(
        "{name:>22} {allowed:>8} {:>8} {taken:>8.2} {:>9.1e} {error:>9.1e}",
        answer.unknowns, answer.error_estimate
    );
    Ok(())
}

/// What is told of one size.
struct Row {
    n: usize,
    built: f64,
    action: f64,
    bytes: f64,
}

fn heading() {
    println!(
        "{:>9} {:>8} {:>8} {:>8} {:>8} {:>7} {:>5} {:>8} {:>9} {:>7} {:>5} {:>8} {:>8}",
        "n",
        "build s",
        "CPU s",
        "told MB",
        "MB",
        "dense",
        "rank",
        "error",
        "action ms",
        "/read",
        "GMRES",
        "s",
        "error"
    );
}

/// φ = 1.
fn logarithm(panels: usize) -> Result<Row, Box<dyn Error>> {
    let x_ln = |u: f64| if u > 0.0 { u * u.ln() } else { 0.0 };
    let source = move |x: f64| 2.0 - x_ln(x) - x_ln(1.0 - x);
    let kernel = ByOffset(|_x, _y, offset: f64| offset.abs().ln());
    let equation = Equation::new(Interval::new(0.0, 1.0)?, kernel, source);
    let breaks = (0..=panels).map(|k| k as f64 / panels as f64).collect();
    let coupling = ProductNystrom::new(&equation, breaks, None)?;
    let (operator, told) = build(&coupling, &coupling.points(), 1e-9)?;
    let f: Vec<f64> = coupling.nodes().iter().map(|x| source(*x)).collect();
    solved(&operator, &told, &operator, &f, &|_| 1.0, 1.0)
}

/// φ = 1.
fn means(n: usize) -> Result<Row, Box<dyn Error>> {
    let space = Space::on_interval(0.0, 1.0, n, 2);
    let points: Vec<[f64; 1]> = space.elements.iter().map(|element| [element.node]).collect();
    let source = |x: &f64| 0.5 * ((-x).exp() + (x - 1.0).exp());
    let mean = |element: &Element<f64>| n as f64 * element.quadrature.integrate(source);
    let f: Vec<f64> = space.elements.iter().map(mean).collect();
    let coupling = Galerkin::new(|x: &f64, y: &f64| 0.5 * (-(x - y).abs()).exp(), space);
    let (operator, told) = build(&coupling, &points, 1e-9)?;
    solved(&operator, &told, &operator, &f, &|_| 1.0, 1.0)
}

/// φ = z, an eigenfunction for 1/3.
fn sphere(n: usize) -> Result<Row, Box<dyn Error>> {
    let point = |k: usize| {
        let (z, turn) = (1.0 - (2 * k + 1) as f64 / n as f64, k as f64 * 2.399_963_229_728_653);
        let r = (1.0 - z * z).sqrt();
        [r * turn.cos(), r * turn.sin(), z]
    };
    let coupling = Sphere((0..n).map(point).collect());
    let (operator, told) = build(&coupling, &coupling.0, 1e-5)?;
    let mut sums = vec![0.0; n];
    operator.apply(&vec![1.0; n], &mut sums);
    let corrected = Corrected { operator: &operator, rest: sums.iter().map(|sum| 1.0 - sum).collect() };
    let f: Vec<f64> = coupling.0.iter().map(|x| x[2] * (1.0 - 0.5 / 3.0)).collect();
    solved(&operator, &told, &corrected, &f, &|i| coupling.0[i][2], 0.5)
}

/// 1/(4π |x_i − x_j|) with equal weights, and nothing on the diagonal.
struct Sphere(Vec<[f64; 3]>);

impl Coupling for Sphere {
    fn dim(&self) -> usize {
        self.0.len()
    }
    fn entry(&self, i: usize, j: usize) -> f64 {
        let (x, y) = (self.0[i], self.0[j]);
        let distance = ((x[0] - y[0]).powi(2) + (x[1] - y[1]).powi(2) + (x[2] - y[2]).powi(2)).sqrt();
        if i == j { 0.0 } else { 1.0 / (distance * self.0.len() as f64) }
    }
}

/// What the rule misses next to x, found from ∫ dS / (4π |x − y|) = 1.
struct Corrected<'a> {
    operator: &'a Hierarchical,
    rest: Vec<f64>,
}

impl Matrix for Corrected<'_> {
    fn dim(&self) -> usize {
        self.rest.len()
    }
    fn diagonal(&self, i: usize) -> f64 {
        self.operator.diagonal(i) + self.rest[i]
    }
}

impl Operator<f64> for Corrected<'_> {
    fn apply(&self, u: &[f64], out: &mut [f64]) {
        self.operator.apply(u, out);
        out.iter_mut().zip(u).zip(&self.rest).for_each(|((out, u), rest)| *out += u * rest);
    }
}

/// Seconds on the clock and of all cores, and the bytes that were foreseen.
struct Told {
    wall: f64,
    cpu: f64,
    bytes: f64,
}

fn build<const D: usize>(
    coupling: &impl Coupling,
    points: &[[f64; D]],
    tolerance: f64,
) -> Result<(Hierarchical, Told), Box<dyn Error>> {
    let (start, before) = (Instant::now(), cpu_seconds());
    let plan = Plan::new(coupling, points, Options { tolerance, ..Options::default() })?;
    let operator = plan.assemble(|_| ())?;
    let told =
        Told { wall: start.elapsed().as_secs_f64(), cpu: cpu_seconds() - before, bytes: plan.bytes() as f64 };
    Ok((operator, told))
}

fn solved(
    operator: &Hierarchical,
    told: &Told,
    system: &impl Operator<f64>,
    f: &[f64],
    exact: &dyn Fn(usize) -> f64,
    rho: f64,
) -> Result<Row, Box<dyn Error>> {
    // From within the pool: a thread from outside waits for others that sleep.
    let (action, ratio) = rayon::scope(|_| action(operator, f));
    let coefficient = vec![rho; f.len()];
    let start = Instant::now();
    let mut gmres = Gmres::new(System::new(f, &coefficient, system)?);
    let report = relax(&mut gmres, Stop { residual: 1e-9, sweeps: 100 }, |_, _, _| true);
    let solving = start.elapsed().as_secs_f64();
    let error = gmres.solution().iter().enumerate().map(|(i, u)| (u - exact(i)).abs()).fold(0.0, f64::max);
    let kept = operator.statistics();
    println!(
        "{:>9} {:>8.2} {:>8.2} {:>8.1} {:>8.1} {:>6.2}% {:>5.1} {:>8.1e} {:>9.2} {ratio:>7.2} {:>5} {solving:>8.2} {error:>8.1e}",
        kept.unknowns,
        told.wall,
        told.cpu,
        told.bytes / 1e6,
        kept.bytes as f64 / 1e6,
        100.0 * kept.compression(),
        kept.ranks.1,
        kept.relative_error(),
        1e3 * action,
        report.residuals.len()
    );
    Ok(Row { n: f.len(), built: told.wall, action, bytes: kept.bytes as f64 })
}

/// Seconds of an action, and in how many times reading as many bytes it takes: medians of pairs.
fn action(operator: &Hierarchical, u: &[f64]) -> (f64, f64) {
    let words: Vec<u64> = (0..operator.statistics().bytes / 8).collect();
    let mut image = vec![0.0; u.len()];
    let pairs = if operator.statistics().bytes > 1 << 30 { 9 } else { 41 };
    let (mut actions, mut ratios): (Vec<f64>, Vec<f64>) = (0..pairs)
        .map(|_| {
            let read = seconds(|| add(black_box(&words)));
            let action = seconds(|| operator.apply(u, &mut image));
            (action, action / read)
        })
        .unzip();
    (median(&mut actions), median(&mut ratios))
}

fn add(words: &[u64]) -> u64 {
    let parts = words.par_chunks(1 << 13);
    parts.map(|part| part.iter().fold(0, |sum: u64, word| sum.wrapping_add(*word))).sum()
}

fn median(numbers: &mut [f64]) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers[numbers.len() / 2]
}

fn seconds<T>(work: impl FnOnce() -> T) -> f64 {
    let start = Instant::now();
    black_box(work());
    start.elapsed().as_secs_f64()
}

/// Of this process so far, on Linux; in its hundredths of a second.
fn cpu_seconds() -> f64 {
    let told = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let after_name = told.rsplit(')').next().unwrap_or_default();
    let ticks = after_name.split_whitespace().skip(11).take(2).filter_map(|ticks| ticks.parse::<f64>().ok());
    ticks.sum::<f64>() / 100.0
}

/// d ln t / d ln n from the last but one size to the last.
fn slopes(rows: &[Row]) {
    if let [.., one, other] = rows {
        let slope = |of: fn(&Row) -> f64| (of(other) / of(one)).ln() / (other.n as f64 / one.n as f64).ln();
        println!(
            "growing like n to the power of: building {:.2}, action {:.2}, memory {:.2}",
            slope(|row| row.built),
            slope(|row| row.action),
            slope(|row| row.bytes)
        );
    }
}
