//! ‖A‖∞, ‖(I − A)⁻¹‖∞ and the spectral radius of A: what an error is measured with (paper, §1.1.1, §1.1.3, th. 1.6).
//!
//! Not from the method that is judged, whose matrix may be wrong, but from collocation on panels with integrals to rounding.

use super::Integrals;
use super::discrete::Factors;
use super::integrals::images;
use crate::equation::{Equation, EquationError, Scalar};
use crate::space::{Basis, Panels, equal_parts};
use faer::Mat;
use num_complex::Complex64;

/// Numbers of an operator that do not depend on how an equation with it is solved.
#[derive(Clone, Copy, Debug)]
pub struct Yardstick {
    /// ‖A‖∞ = max_x Σ_b ∫ |K_ab(x, y)| dy, rounded up in the fifth digit.
    pub norm: f64,
    /// ‖(I − A)⁻¹‖∞: how much larger an error can be than the residual.
    pub inverse_norm: f64,
    /// max_k |λ_k| over the spectrum of A: successive approximations converge for every f when it is below 1.
    pub spectral_radius: f64,
}

/// Equal panels of 16 nodes, doubled until ‖(I − A)⁻¹‖ settles: 4 see what is as wide as a tenth of the interval; 32, with
/// 512 unknowns, a hundredth.
const PANELS: [usize; 4] = [4, 8, 16, 32];

/// A change of ‖(I − A)⁻¹‖ by less than this part is as good as none: it multiplies an estimate.
const SETTLED: f64 = 0.1;

impl Yardstick {
    /// The numbers of the equation's operator.
    ///
    /// # Errors
    ///
    /// [`EquationError::KernelNotFinite`].
    pub fn new<T: Scalar>(equation: &Equation<'_, T>) -> Result<Self, EquationError> {
        let interval = equation.interval();
        let (mut matrix, mut inverse_norm) = (Vec::new(), 0.0);
        for panels in PANELS {
            let basis = Panels::new(equal_parts(interval.a(), interval.b(), panels));
            matrix = images(equation, &basis, basis.nodes(), Integrals::Accurate)?;
            let before = std::mem::replace(&mut inverse_norm, inverse_norm_of(&matrix));
            // A change of a norm beyond 1e10 is that of rounding.
            if (inverse_norm - before).abs() <= SETTLED * inverse_norm || inverse_norm.min(before) > 1e10 {
                break;
            }
        }
        Ok(Self { norm: norm(equation)?, inverse_norm, spectral_radius: spectral_radius(&matrix)? })
    }

    /// ‖I − A‖∞ ‖(I − A)⁻¹‖∞, from ‖I − A‖ ≤ 1 + ‖A‖.
    pub fn condition(&self) -> f64 {
        (1.0 + self.norm) * self.inverse_norm
    }

    /// Whether successive approximations converge whatever the source, as far as the digits tell.
    pub fn contracts(&self) -> bool {
        self.spectral_radius < 1.0 - 1e-8
    }
}

fn inverse_norm_of<T: Scalar>(matrix: &[Vec<T>]) -> f64 {
    let norm = Factors::new(matrix).inverse_norm();
    if norm.is_nan() { f64::INFINITY } else { norm }
}

fn spectral_radius<T: Scalar>(matrix: &[Vec<T>]) -> Result<f64, EquationError> {
    let entry = |i: usize, j: usize| {
        let (re, im) = matrix[i][j].parts();
        Complex64::new(re, im)
    };
    let eigenvalues = Mat::from_fn(matrix.len(), matrix.len(), entry).eigenvalues();
    let eigenvalues = eigenvalues
        .map_err(|_| EquationError::Method("the eigenvalues of the discrete operator do not settle".into()))?;
    Ok(eigenvalues.iter().map(|lambda| lambda.norm()).fold(0.0, f64::max))
}

/// Where ∫ |K(x, y)| dy is computed for its maximum, before that is searched more closely.
const SAMPLES: usize = 65;

/// The pieces on which |K| is integrated. A change of sign in one of them costs (1/32)² / 16² of |K|, at most: 4e-6.
const PIECES: usize = 32;

fn norm<T: Scalar>(equation: &Equation<'_, T>) -> Result<f64, EquationError> {
    let interval = equation.interval();
    let breaks = equal_parts(interval.a(), interval.b(), PIECES);
    let points = equal_parts(interval.a(), interval.b(), SAMPLES - 1);
    let mut largest = 0.0_f64;
    for a in 0..equation.components() {
        let at = |x: f64| absolute_integral(equation, a, x, &breaks);
        let values = points.iter().map(|x| at(*x)).collect::<Result<Vec<_>, _>>()?;
        let best = (0..SAMPLES).max_by(|i, j| values[*i].total_cmp(&values[*j])).unwrap_or(0);
        let around = (points[best.saturating_sub(1)], points[(best + 1).min(SAMPLES - 1)]);
        largest = largest.max(values[best]).max(maximum(at, around)?);
    }
    Ok(largest * (1.0 + 1e-5))
}

/// Σ_b ∫ |K_ab(x, y)| dy.
fn absolute_integral<T: Scalar>(
    equation: &Equation<'_, T>,
    a: usize,
    x: f64,
    breaks: &[f64],
) -> Result<f64, EquationError> {
    let rows = (0..equation.components()).map(|b| Integrals::Accurate.row(equation, (a, b), x, breaks));
    rows.map(|row| row.map(|row| row.weights.iter().map(|weight| weight.modulus()).sum::<f64>())).sum()
}

/// The maximum by golden section, to the square root of the fifth digit: a maximum is flat.
fn maximum(
    at: impl Fn(f64) -> Result<f64, EquationError>,
    (mut low, mut high): (f64, f64),
) -> Result<f64, EquationError> {
    const GOLDEN: f64 = 0.618_033_988_749_895;
    let mut largest = 0.0_f64;
    for _ in 0..12 {
        let width = GOLDEN * (high - low);
        let (left, right) = (high - width, low + width);
        let (at_left, at_right) = (at(left)?, at(right)?);
        largest = largest.max(at_left).max(at_right);
        if at_left < at_right {
            low = left;
        } else {
            high = right;
        }
    }
    Ok(largest)
}
