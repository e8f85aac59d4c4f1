//! (I − F) c = s: the linear system that every method ends in (paper, (1.28), (1.33), (1.48), (1.56)).

use crate::equation::{EquationError, Scalar};
use faer::Mat;
use faer::linalg::solvers::{PartialPivLu, Solve};

/// A discretised equation c = s + F c. The unknowns of a system stand component by component.
#[derive(Clone, Debug)]
pub struct Discrete<T> {
    matrix: Vec<Vec<T>>,
    source: Vec<T>,
}

/// What a linear system gives.
pub(super) struct Coefficients<T> {
    pub values: Vec<T>,
    /// ‖I − F‖∞ ‖(I − F)⁻¹‖∞.
    pub condition: f64,
}

impl<T: Scalar> Discrete<T> {
    pub(super) fn new(matrix: Vec<Vec<T>>, source: Vec<T>) -> Self {
        Self { matrix, source }
    }

    /// The number of unknowns.
    pub fn dim(&self) -> usize {
        self.source.len()
    }

    /// F_ij.
    pub fn entry(&self, i: usize, j: usize) -> T {
        self.matrix[i][j]
    }

    /// s_i.
    pub fn source(&self, i: usize) -> T {
        self.source[i]
    }

    pub(super) fn solve(&self) -> Result<Coefficients<T>, EquationError> {
        let factors = Factors::new(&self.matrix);
        let condition = factors.condition();
        check_condition(condition)?;
        Ok(Coefficients { values: factors.solve(&self.source), condition })
    }
}

/// A condition from where on a matrix cannot be told from a singular one.
const SINGULAR: f64 = 1e15;

/// An error where the condition is that of a singular matrix; NaN is.
pub(super) fn check_condition(condition: f64) -> Result<(), EquationError> {
    if condition < SINGULAR { Ok(()) } else { Err(singular(condition)) }
}

pub(super) fn singular(condition: f64) -> EquationError {
    EquationError::Method(format!(
        "I − A is singular to rounding (condition {condition:.0e}): the equation has no solution or many; the automatic \
         method tells which"
    ))
}

/// The LU factors of I − F.
pub(super) struct Factors<T> {
    lu: PartialPivLu<T>,
    /// ‖I − F‖∞.
    norm: f64,
    n: usize,
}

/// Up to this size the inverse is computed, above its norm is estimated; 512 take a tenth of a second.
const EXPLICIT: usize = 512;

impl<T: Scalar> Factors<T> {
    pub fn new(f: &[Vec<T>]) -> Self {
        let n = f.len();
        let entry = |i: usize, j: usize| if i == j { T::ONE - f[i][j] } else { -f[i][j] };
        let norm = (0..n).map(|i| (0..n).map(|j| entry(i, j).modulus()).sum()).fold(0.0, f64::max);
        Self { lu: Mat::from_fn(n, n, entry).partial_piv_lu(), norm, n }
    }

    pub fn solve(&self, right: &[T]) -> Vec<T> {
        let solution = self.lu.solve(&Mat::from_fn(self.n, 1, |i, _| right[i]));
        (0..self.n).map(|i| solution[(i, 0)]).collect()
    }

    pub fn condition(&self) -> f64 {
        self.norm * self.inverse_norm()
    }

    /// ‖(I − F)⁻¹‖∞.
    pub fn inverse_norm(&self) -> f64 {
        let n = self.n;
        if n > EXPLICIT {
            return self.hager();
        }
        let inverse = self.lu.solve(&Mat::<T>::identity(n, n));
        let sums = (0..n).map(|i| (0..n).map(|j| inverse[(i, j)].modulus()).sum::<f64>());
        sums.fold(0.0, |largest: f64, sum| if sum > largest || sum.is_nan() { sum } else { largest })
    }

    /// ‖B‖∞ = ‖Bᴴ‖₁ for B = (I − F)⁻¹ by Hager's ascent: from x = (1, …, 1)/n along the signs of Bᴴx (Higham 1988). A lower
    /// bound, seldom below a third.
    fn hager(&self) -> f64 {
        let column = |x: &[T]| Mat::from_fn(self.n, 1, |i, _| x[i]);
        let plain = |m: &Mat<T>| (0..self.n).map(|i| m[(i, 0)]).collect::<Vec<T>>();
        let mut x = vec![T::from(1.0 / self.n as f64); self.n];
        let mut largest = 0.0_f64;
        for _ in 0..5 {
            let y = plain(&self.lu.solve_adjoint(&column(&x)));
            let norm: f64 = y.iter().map(|y| y.modulus()).sum();
            if norm <= largest || norm.is_nan() {
                return if norm.is_nan() { f64::INFINITY } else { largest };
            }
            largest = norm;
            let signs: Vec<T> = y.iter().map(|y| sign(*y)).collect();
            let gradient = self.solve(&signs);
            let steepest =
                (0..self.n).max_by(|i, j| gradient[*i].modulus().total_cmp(&gradient[*j].modulus()));
            x = vec![T::ZERO; self.n];
            if let Some(steepest) = steepest {
                x[steepest] = T::ONE;
            }
        }
        largest
    }
}

fn sign<T: Scalar>(z: T) -> T {
    if z.modulus() == 0.0 { T::ONE } else { z * (1.0 / z.modulus()) }
}
