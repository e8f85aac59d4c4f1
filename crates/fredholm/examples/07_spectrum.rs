//! 7. Eigenvalues and eigenfunctions, A φ = λ φ, each with its error (paper, §1.1.4).
//!
//! Builds on `05_alternative`: 1 in the spectrum is what makes an equation singular. New: all of the spectrum that can be
//! told from 0.
#![expect(clippy::print_stdout, reason = "an example shows its numbers")]

use fredholm::equation::{Complex64, Equation, Interval};
use fredholm::spectrum::spectrum;
use std::f64::consts::PI;

pub(crate) fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Brownian motion: −λ φ″ = φ, φ(0) = φ′(1) = 0. The source does not matter.
    let unit = Interval::new(0.0, 1.0)?;
    let brownian = Equation::new(unit, f64::min, |_: f64| 0.0);
    println!("min(x, y)          λ      error  estimate");
    for (k, pair) in spectrum(&brownian, 6, 1e-12)?.eigenpairs.iter().enumerate() {
        let wave = (k as f64 + 0.5) * PI;
        let error = (pair.value - wave.powi(-2)).norm();
        println!("{:>20.14} {error:>8.1e} {:>8.1e}", pair.value.re, pair.error_estimate);
        assert!(error <= pair.error_estimate && pair.error_estimate < 1e-12);
        // sin((k + ½) π x), up to a factor. An eigenvalue is known to twice as many digits as its function.
        let (at, to) = (pair.function.at(&0.3), pair.function.at(&0.5));
        assert!((at / to - (0.3 * wave).sin() / (0.5 * wave).sin()).norm() < 1e-7);
    }

    // A rotation: x − y goes round, K = e^{2πi(x−y)} + i e^{4πi(x−y)} has the eigenvalues 1 and i, and no other.
    let turn = |u: f64| Complex64::from_polar(1.0, 2.0 * PI * u);
    let kernel = move |x: f64, y: f64| turn(x - y) + Complex64::I * turn(2.0 * (x - y));
    let rotation = Equation::new(unit, kernel, |_: f64| Complex64::ZERO);
    let found = spectrum(&rotation, 10, 1e-12)?;
    let values: Vec<Complex64> = found.eigenpairs.iter().map(|pair| pair.value).collect();
    println!("1 and i: {values:.12?}");
    assert_eq!(values.len(), 2);
    assert!((values[0] + values[1] - Complex64::new(1.0, 1.0)).norm() < 1e-13);

    // K = cos(x − y) on a half turn: π/2 twice.
    let half = Equation::new(Interval::new(0.0, PI)?, |x: f64, y: f64| (x - y).cos(), |_: f64| 0.0);
    let found = spectrum(&half, 10, 1e-12)?;
    assert_eq!(found.eigenpairs.len(), 2);
    assert!(found.eigenpairs.iter().all(|pair| (pair.value - PI / 2.0).norm() < 1e-13));

    // Volterra's kernel has no eigenvalue at all.
    let volterra = Equation::new(unit, |x: f64, y: f64| if y < x { 1.0 } else { 0.0 }, |_: f64| 0.0);
    let found = spectrum(&volterra, 3, 1e-12)?;
    println!("Volterra: {} eigenvalues", found.eigenpairs.len());
    assert!(found.eigenpairs.is_empty());
    Ok(())
}
