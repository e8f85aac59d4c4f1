//! r(A) = max_k |λ_k|: successive approximations converge for every f when it is below 1 (paper, §1.2.2, th. 1.6).

use super::Integrals;
use super::integrals::images;
use super::yardstick::PANELS;
use crate::equation::{Equation, EquationError, Scalar};
use crate::space::{Basis, Panels, equal_parts};
use faer::Mat;
use num_complex::Complex64;

/// A change by less than this says that the largest eigenvalue is resolved.
const SETTLED: f64 = 1e-9;

/// The spectral radius of A: that of collocation on panels with integrals to rounding, doubled until it settles.
///
/// # Errors
///
/// [`EquationError::KernelNotFinite`].
pub fn spectral_radius<T: Scalar>(equation: &Equation<'_, T>) -> Result<f64, EquationError> {
    let interval = equation.interval();
    let mut radius = f64::INFINITY;
    for panels in PANELS {
        let basis = Panels::new(equal_parts(interval.a(), interval.b(), panels));
        let matrix = images(equation, &basis, basis.nodes(), Integrals::Accurate)?;
        let before = std::mem::replace(&mut radius, largest_eigenvalue(&matrix)?);
        if (radius - before).abs() <= SETTLED * radius.max(1.0) {
            break;
        }
    }
    Ok(radius)
}

fn largest_eigenvalue<T: Scalar>(matrix: &[Vec<T>]) -> Result<f64, EquationError> {
    let entry = |i: usize, j: usize| {
        let (re, im) = matrix[i][j].parts();
        Complex64::new(re, im)
    };
    let eigenvalues = Mat::from_fn(matrix.len(), matrix.len(), entry).eigenvalues();
    let eigenvalues = eigenvalues.map_err(|_| {
        EquationError::Method("the eigenvalues of the discrete operator do not settle".into())
    })?;
    Ok(eigenvalues.iter().map(|lambda| lambda.norm()).fold(0.0, f64::max))
}
