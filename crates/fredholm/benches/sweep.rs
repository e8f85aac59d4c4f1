//! One Gauss–Seidel sweep on a stored matrix, set against reading as many bytes and doing nothing with them.
//!
//! A sweep reads n² numbers once each: no sweep can be faster than this machine's memory. The last lines printed say
//! how far from that it is.
#![allow(missing_docs, clippy::print_stdout)]

use divan::counter::BytesCount;
use divan::{Bencher, black_box};
use fredholm::discretize::Coupling;
use fredholm::operator::{Dense, Entry};
use fredholm::relax::{GaussSeidel, Relaxation};
use fredholm::system::System;
use fredholm::value::{Rgb, Spectrum, Value};
use rayon::prelude::*;
use std::time::Instant;

/// Unknowns: 100 MB of `f32`, 200 MB of `f64`, more than caches hold.
const N: usize = 5000;

fn main() {
    divan::main();
    // As `cargo bench` calls it, and nothing chosen.
    if std::env::args().skip(1).eq(["--bench".to_owned()]) {
        ratios();
    }
}

/// A matrix without structure whose rows sum to 1 or so.
struct Noise;

impl Coupling for Noise {
    fn dim(&self) -> usize {
        N
    }
    fn entry(&self, i: usize, j: usize) -> f64 {
        let hash = ((i * N + j) as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 40;
        hash as f64 / (1 << 23) as f64 / N as f64
    }
}

fn noise<T: Entry>() -> Dense<T> {
    Dense::assemble(&Noise, |_| ()).expect("finite")
}

/// Gives `work` a relaxation of unknowns of type V by a matrix of entries of type T.
fn with_relaxation<T: Entry, V: Value>(work: impl FnOnce(&mut dyn Relaxation<V>)) {
    let matrix = noise::<T>();
    let (source, coefficient) = (vec![V::splat(1.0); N], vec![V::splat(0.5); N]);
    let system = System::new(&source, &coefficient, &matrix).expect("an equation");
    work(&mut GaussSeidel::new(system));
}

fn bytes<T>() -> usize {
    N * N * size_of::<T>()
}

fn sweeps<T: Entry, V: Value>(bencher: Bencher<'_, '_>) {
    with_relaxation::<T, V>(|relaxation| {
        bencher.counter(BytesCount::new(bytes::<T>())).bench_local(|| relaxation.sweep());
    });
}

#[divan::bench(types = [f32, f64], sample_count = 30)]
fn numbers<T: Entry>(bencher: Bencher<'_, '_>) {
    sweeps::<T, f64>(bencher);
}

#[divan::bench(types = [f32, f64], sample_count = 30)]
fn colours<T: Entry>(bencher: Bencher<'_, '_>) {
    sweeps::<T, Rgb>(bencher);
}

#[divan::bench(types = [f32], sample_count = 10)]
fn spectra<T: Entry>(bencher: Bencher<'_, '_>) {
    sweeps::<T, Spectrum<76>>(bencher);
}

/// Adds up as many bytes as a matrix of T has: 64 kB a task, whole numbers so that vectors of them are added.
#[divan::bench(types = [f32, f64], sample_count = 30)]
fn memory<T: Entry>(bencher: Bencher<'_, '_>) {
    let words = words::<T>();
    bencher.counter(BytesCount::new(bytes::<T>())).bench_local(|| add(black_box(&words)));
}

fn words<T>() -> Vec<u64> {
    (0..bytes::<T>() as u64 / 8).collect()
}

fn add(words: &[u64]) -> u64 {
    let parts = words.par_chunks(1 << 13);
    parts.map(|part| part.iter().fold(0, |sum: u64, word| sum.wrapping_add(*word))).sum()
}

/// Sweeps and plain reads by turns, and the medians over the turns of how many reads a sweep takes.
fn ratios() {
    println!("a sweep, in times that reading the matrix takes:");
    println!("  numbers, f32  {:.2}", ratio::<f32, f64>());
    println!("  numbers, f64  {:.2}", ratio::<f64, f64>());
    println!("  colours, f32  {:.2}", ratio::<f32, Rgb>());
    println!("  colours, f64  {:.2}", ratio::<f64, Rgb>());
    println!("  spectra, f32  {:.2}", ratio::<f32, Spectrum<76>>());
}

fn ratio<T: Entry, V: Value>() -> f64 {
    let words = words::<T>();
    let mut ratios = Vec::new();
    with_relaxation::<T, V>(|relaxation| {
        for _ in 0..21 {
            let read = seconds(|| add(black_box(&words)));
            ratios.push(seconds(|| relaxation.sweep()) / read);
        }
    });
    ratios.sort_by(f64::total_cmp);
    ratios[ratios.len() / 2]
}

fn seconds<T>(work: impl FnOnce() -> T) -> f64 {
    let start = Instant::now();
    black_box(work());
    start.elapsed().as_secs_f64()
}
