//! φ(p) = f(p) + ∫_D K(p, q) φ(q) dq on a rectangle, a triangle or a disk D of the plane (paper, (1.7), by §1.2.3); K may be singular
//! at p = q.
//!
//! ```
//! use fredholm::plane::{Domain, Options, PlaneEquation, solve};
//!
//! // On the unit disk, K = (xs + yt)/π and f = 1 + 3x/4: φ = 1 + x.
//! let kernel = |[x, y]: [f64; 2], [s, t]: [f64; 2]| (x * s + y * t) / std::f64::consts::PI;
//! let source = |[x, _]: [f64; 2]| 1.0 + 0.75 * x;
//! let equation = PlaneEquation::new(Domain::disk([0.0, 0.0], 1.0)?, kernel, source);
//!
//! let answer = solve(&equation, &Options::default())?;
//! let error = answer.at(&[0.3, -0.4]) - 1.3;
//! assert!(error.abs() <= answer.error_estimate && answer.error_estimate < 1e-13);
//! # Ok::<(), fredholm::equation::EquationError>(())
//! ```

mod alternative;
mod domain;
mod estimate;
mod mesh;
mod nystrom;
mod piece;
mod product;
mod singular;
mod solve;

pub use domain::Domain;
pub use solve::{DENSE, Options, solve, solve_large};

use crate::equation::{EquationError, Scalar};

/// A kernel K(p, q) in the plane, evaluated for one p and many q at once. Closures `Fn([f64; 2], [f64; 2]) -> T` are
/// kernels.
pub trait PlaneKernel<T>: Sync + Send {
    /// `row[j]` = K(p, q_j).
    fn row(&self, p: [f64; 2], q: &[[f64; 2]], row: &mut [T]);
}

impl<T, K: Fn([f64; 2], [f64; 2]) -> T + Sync + Send> PlaneKernel<T> for K {
    fn row(&self, p: [f64; 2], q: &[[f64; 2]], row: &mut [T]) {
        row.iter_mut().zip(q).for_each(|(entry, q)| *entry = self(p, *q));
    }
}

/// A source f(p).
pub trait PlaneSource<T>: Fn([f64; 2]) -> T + Sync + Send {}
impl<T, F: Fn([f64; 2]) -> T + Sync + Send> PlaneSource<T> for F {}

/// The equation φ(p) − ∫_D K(p, q) φ(q) dq = f(p).
pub struct PlaneEquation<'a, T> {
    domain: Domain,
    kernel: Box<dyn PlaneKernel<T> + 'a>,
    source: Box<dyn PlaneSource<T> + 'a>,
}

impl<'a, T: Scalar> PlaneEquation<'a, T> {
    /// φ(p) − ∫ K(p, q) φ(q) dq = f(p) on `domain`.
    pub fn new(domain: Domain, kernel: impl PlaneKernel<T> + 'a, source: impl PlaneSource<T> + 'a) -> Self {
        Self { domain, kernel: Box::new(kernel), source: Box::new(source) }
    }

    /// D.
    pub fn domain(&self) -> Domain {
        self.domain
    }

    /// f(p), unless it is infinite or NaN.
    fn finite_source(&self, p: [f64; 2]) -> Result<T, EquationError> {
        let value = (self.source)(p);
        if value.finite() {
            return Ok(value);
        }
        Err(EquationError::PlaneSourceNotFinite { p, value: format!("{value:?}") })
    }

    /// K(p, q_j) for all j, unless one of them is infinite or NaN.
    fn finite_row(&self, p: [f64; 2], q: &[[f64; 2]], row: &mut [T]) -> Result<(), EquationError> {
        self.kernel.row(p, q, row);
        match row.iter().position(|entry| !entry.finite()) {
            None => Ok(()),
            Some(j) => {
                Err(EquationError::PlaneKernelNotFinite { p, q: q[j], value: format!("{:?}", row[j]) })
            }
        }
    }
}

impl<T> std::fmt::Debug for PlaneEquation<'_, T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "equation on the {}", self.domain)
    }
}
