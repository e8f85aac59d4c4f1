//! What φ, f and K may be on a line: real or complex.

use faer::linalg::solvers::Eigen;
use faer::traits::ComplexField;
use faer::{Mat, MatRef};
use num_complex::Complex64;
use std::fmt::Debug;
use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A real or complex number: [`f64`] or [`Complex64`].
pub trait Scalar:
    ComplexField
    + Copy
    + Debug
    + PartialEq
    + Send
    + Sync
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Mul<f64, Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + Sum
    + From<f64>
    + 'static
{
    /// 0.
    const ZERO: Self;

    /// 1.
    const ONE: Self;

    /// How many parts a number has: one, or a real and an imaginary one.
    const PARTS: usize;

    /// |z|.
    fn modulus(self) -> f64;

    /// The complex conjugate; a real number itself.
    fn conjugate(self) -> Self;

    /// The real and the imaginary part.
    fn parts(self) -> (f64, f64);

    /// The number with these parts; the imaginary one of a real number is left out.
    fn of_parts(re: f64, im: f64) -> Self;

    /// The number as a complex one.
    fn complex(self) -> Complex64 {
        let (re, im) = self.parts();
        Complex64::new(re, im)
    }

    /// Whether neither part is infinite or NaN.
    fn finite(self) -> bool;

    /// The eigenvalues of a square matrix, and its eigenvectors as columns; `None` where the iteration fails.
    fn eigen(matrix: MatRef<'_, Self>) -> Option<(Vec<Complex64>, Mat<Complex64>)>;
}

fn parts_of(eigen: &Eigen<f64>) -> (Vec<Complex64>, Mat<Complex64>) {
    let vectors = eigen.U().to_owned();
    ((0..vectors.ncols()).map(|k| eigen.S()[k]).collect(), vectors)
}

impl Scalar for f64 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    const PARTS: usize = 1;

    fn modulus(self) -> f64 {
        self.abs()
    }
    fn conjugate(self) -> Self {
        self
    }
    fn parts(self) -> (f64, f64) {
        (self, 0.0)
    }
    fn of_parts(re: f64, _: f64) -> Self {
        re
    }
    fn finite(self) -> bool {
        self.is_finite()
    }
    fn eigen(matrix: MatRef<'_, Self>) -> Option<(Vec<Complex64>, Mat<Complex64>)> {
        Some(parts_of(&Eigen::new_from_real(matrix).ok()?))
    }
}

impl Scalar for Complex64 {
    const ZERO: Self = Self::new(0.0, 0.0);
    const ONE: Self = Self::new(1.0, 0.0);
    const PARTS: usize = 2;

    fn modulus(self) -> f64 {
        self.norm()
    }
    fn conjugate(self) -> Self {
        self.conj()
    }
    fn parts(self) -> (f64, f64) {
        (self.re, self.im)
    }
    fn of_parts(re: f64, im: f64) -> Self {
        Self::new(re, im)
    }
    fn finite(self) -> bool {
        self.re.is_finite() && self.im.is_finite()
    }
    fn eigen(matrix: MatRef<'_, Self>) -> Option<(Vec<Complex64>, Mat<Complex64>)> {
        Some(parts_of(&Eigen::new(matrix).ok()?))
    }
}

/// The parts of values, one value after another: the unknowns of a real equation.
pub(crate) fn all_parts<T: Scalar>(values: &[T]) -> Vec<f64> {
    values.iter().flat_map(|value| <[f64; 2]>::from(value.parts()).into_iter().take(T::PARTS)).collect()
}

/// The values that have these parts.
pub(crate) fn of_all_parts<T: Scalar>(parts: &[f64]) -> Vec<T> {
    parts.chunks_exact(T::PARTS).map(|part| T::of_parts(part[0], part[T::PARTS - 1])).collect()
}

/// What part q of a number brings to part p of its product with z, as (κ + iλ)(u + iv) = (κu − λv) + i (λu + κv).
pub(crate) fn between_parts<T: Scalar>(z: T, p: usize, q: usize) -> f64 {
    let (re, im) = z.parts();
    match (p, q) {
        (0, 1) => -im,
        (1, 0) => im,
        _ => re,
    }
}
