//! temporary
#![allow(missing_docs, clippy::print_stdout)]
use fredholm::discretize::{Coupling, ProductNystrom};
use fredholm::equation::{ByOffset, Equation, Interval};
use fredholm::krylov::Gmres;
use fredholm::operator::Operator;
use fredholm::operator::hierarchical::{Options, Plan};
use fredholm::relax::{Relaxation, Stop, relax};
use fredholm::system::System;
use rayon::prelude::*;
use std::time::Instant;

fn main() {
    let panels: usize = std::env::args().nth(1).and_then(|a| a.parse().ok()).unwrap_or(64);
    let tol: f64 = std::env::args().nth(2).and_then(|a| a.parse().ok()).unwrap_or(1e-9);
    let leaf: usize = std::env::args().nth(3).and_then(|a| a.parse().ok()).unwrap_or(64);
    let x_ln = |u: f64| if u > 0.0 { u * u.ln() } else { 0.0 };
    let source = move |x: f64| 2.0 - x_ln(x) - x_ln(1.0 - x);
    let kernel = ByOffset(|_x, _y, offset: f64| offset.abs().ln());
    let equation = Equation::new(Interval::new(0.0, 1.0).unwrap(), kernel, source);
    let breaks: Vec<f64> = (0..=panels).map(|k| k as f64 / panels as f64).collect();
    let t = Instant::now();
    let coupling = ProductNystrom::new(&equation, breaks, None).unwrap();
    let n = coupling.dim();
    println!("n {n}, coupling {:.2} s", t.elapsed().as_secs_f64());
    let t = Instant::now();
    let mut row = vec![0.0; 64];
    for i in 0..1000 {
        coupling.row(i + 32, i / 16 * 16, &mut row);
    }
    println!("near row {:.2} us", t.elapsed().as_secs_f64() * 1e3);
    let points: Vec<[f64; 1]> = coupling.nodes().iter().map(|x| [*x]).collect();
    let t = Instant::now();
    let plan = Plan::new(&coupling, &points, Options { tolerance: tol, leaf, ..Options::default() }).unwrap();
    println!("plan {:.2} s, {:.3} GB", t.elapsed().as_secs_f64(), plan.bytes() as f64 / 1e9);
    let t = Instant::now();
    let op = plan.assemble(|_| ()).unwrap();
    println!(
        "assemble {:.2} s, {:?} rel {:.1e}",
        t.elapsed().as_secs_f64(),
        op.statistics(),
        op.statistics().relative_error()
    );
    let f: Vec<f64> = coupling.nodes().iter().map(|x| source(*x)).collect();
    let rho = vec![1.0; n];
    let mut out = vec![0.0; n];
    op.apply(&f, &mut out);
    let t = Instant::now();
    for _ in 0..200 {
        op.apply(&f, &mut out);
    }
    let a = t.elapsed().as_secs_f64() / 200.0;
    let words: Vec<u64> = (0..op.statistics().bytes / 8).collect();
    let mut ratios = Vec::new();
    for _ in 0..21 {
        let t = Instant::now();
        let sum: u64 = std::hint::black_box(&words)
            .par_chunks(1 << 13)
            .map(|part| part.iter().fold(0, |s: u64, w| s.wrapping_add(*w)))
            .sum();
        std::hint::black_box(sum);
        let read = t.elapsed().as_secs_f64();
        let t = Instant::now();
        op.apply(&f, &mut out);
        ratios.push((t.elapsed().as_secs_f64() / read, read));
    }
    ratios.sort_by(|a, b| a.0.total_cmp(&b.0));
    println!(
        "ratio {:?} least {:?}, {:?}",
        ratios[10],
        ratios[0],
        ratios.iter().map(|r| r.1).fold(1e9, f64::min)
    );
    println!("apply {:.4} s, {:.2} GB/s", a, op.statistics().bytes as f64 / 1e9 / a);
    let t = Instant::now();
    let system = System::new(&f, &rho, &op).unwrap();
    let mut g = Gmres::new(system);
    let r = relax(&mut g, Stop { residual: 1e-9, sweeps: 100 }, |_, _, _| true);
    let u = g.solution();
    let e = u.iter().map(|u| (u - 1.0).abs()).fold(0.0, f64::max);
    println!(
        "gmres {:.2} s, {:?} {} its, residual {:.1e} error {e:.2e}",
        t.elapsed().as_secs_f64(),
        r.outcome,
        r.residuals.len(),
        r.residual
    );
}
