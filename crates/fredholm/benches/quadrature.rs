//! How long a rule takes to make: hot for 16 nodes, O(n) for Legendre, O(n²) for the others.
#![allow(missing_docs)]

use divan::{Bencher, black_box};
use fredholm::quadrature::{
    Quadrature, Recurrence, clenshaw_curtis, gauss_hermite, gauss_jacobi, gauss_laguerre, gauss_legendre,
};

fn main() {
    divan::main();
}

#[divan::bench(args = [4, 16, 49, 50, 100, 1000, 5000])]
fn legendre(n: usize) -> Quadrature<f64> {
    gauss_legendre(black_box(n), 0.0, 1.0)
}

#[divan::bench(args = [100, 1000, 2000])]
fn hermite(n: usize) -> Quadrature<f64> {
    gauss_hermite(black_box(n))
}

#[divan::bench(args = [100, 1000])]
fn laguerre(bencher: Bencher<'_, '_>, n: usize) {
    bencher.bench(|| gauss_laguerre(black_box(n), 0.5));
}

#[divan::bench(args = [16, 100, 1000])]
fn jacobi(bencher: Bencher<'_, '_>, n: usize) {
    bencher.bench(|| gauss_jacobi(black_box(n), -0.5, 0.25, 0.0, 1.0));
}

#[divan::bench(args = [100, 1000])]
fn curtis(bencher: Bencher<'_, '_>, n: usize) {
    bencher.bench(|| clenshaw_curtis(black_box(n), 0.0, 1.0));
}

/// A weight of one's own, to rounding.
#[divan::bench(args = [10, 50])]
fn logarithmic(bencher: Bencher<'_, '_>, n: usize) {
    bencher.bench(|| {
        Recurrence::of_weight(black_box(n), |x| -x.ln(), 0.0, 1.0).map(|recurrence| recurrence.gauss())
    });
}
