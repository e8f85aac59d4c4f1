//! Relaxation: u is improved step by step, and the residual says how far it has come (paper, §3.4).
//!
//! | method | asks F for | one sweep |
//! |---|---|---|
//! | [`SuccessiveApproximation`] | its action | one term of the Neumann series: one bounce of light |
//! | [`Jacobi`] | its action, diagonal | all unknowns at once |
//! | [`GaussSeidel`] | its rows | all unknowns one after the other: classical radiosity, gathering |
//! | [`Southwell`] | its columns | the one unknown with the largest residual: progressive radiosity, shooting |
//! | [`crate::krylov::Gmres`] | its action | one dimension of the Krylov space |

mod gauss_seidel;
mod jacobi;
mod largest;
mod southwell;
mod successive;

pub use gauss_seidel::GaussSeidel;
pub use jacobi::Jacobi;
pub use largest::Largest;
pub use southwell::Southwell;
pub use successive::SuccessiveApproximation;

use crate::value::{Value, max_norm};

/// An iterative method on u = f + ρ ⊙ (F u), one sweep at a time.
pub trait Relaxation<V: Value> {
    /// One iteration. Returns the ∞-norm of the residual as the method knows it: exact where it carries the
    /// residual, otherwise of the residuals that it met on its way.
    fn sweep(&mut self) -> f64;

    /// The current approximation u.
    fn solution(&self) -> Vec<V>;

    /// The residual f + ρ ⊙ (F u) − u of [`Self::solution`].
    fn residual(&self) -> Vec<V>;

    /// The best picture of the solution now, for the eye: u, or what the method can do better than u.
    fn preview(&self) -> Vec<V> {
        self.solution()
    }
}

/// When to stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop {
    /// The residual's ∞-norm that is small enough.
    pub residual: f64,
    /// The most sweeps.
    pub sweeps: usize,
}

/// How a relaxation went. Not converging is a report, not a panic.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// How it ended.
    pub outcome: Outcome,
    /// The residual norm after each sweep, as [`Relaxation::sweep`] gave it.
    pub residuals: Vec<f64>,
    /// ‖f + ρ ⊙ (F u) − u‖∞ of the final u.
    pub residual: f64,
}

/// How a relaxation ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// The residual is as small as was asked.
    Converged,
    /// The sweeps were used up.
    OutOfSweeps,
    /// The method takes the residual for small enough, time and again, and it is not: rounding lets it fall no further.
    Stalled,
    /// The residual is no longer finite, or grew a thousand times over the smallest: ρF has a spectral radius over 1.
    Diverged,
    /// The observer asked to stop.
    Interrupted,
}

/// A residual this many times the smallest one met means divergence. Gauss–Seidel and Southwell grow a few
/// times before they settle on convergent systems; a hundredfold would do, a thousandfold is beyond doubt.
const DIVERGENCE: f64 = 1e3;

/// How often a method may take its residual for small enough when it is not. Gauss–Seidel, whose own norm is of
/// residuals on its way, is right after one sweep more; a dozen is no accident.
const PATIENCE: usize = 12;

/// Sweeps until `stop`, calling `observe(sweep, norm, relaxation)` after each one; it says whether to go on.
pub fn relax<V: Value>(
    relaxation: &mut dyn Relaxation<V>,
    stop: Stop,
    mut observe: impl FnMut(usize, f64, &dyn Relaxation<V>) -> bool,
) -> Report {
    let (mut residuals, mut smallest) = (Vec::new(), f64::INFINITY);
    let mut mistaken = 0;
    let outcome = loop {
        // The method's own norm may be of another moment or carry rounding: the residual itself decides.
        let last = residuals.last().copied().unwrap_or(0.0);
        if last <= stop.residual {
            if max_norm(&relaxation.residual()) <= stop.residual {
                break Outcome::Converged;
            }
            mistaken += 1;
        }
        if mistaken > PATIENCE {
            break Outcome::Stalled;
        }
        if residuals.len() == stop.sweeps {
            break Outcome::OutOfSweeps;
        }
        let norm = relaxation.sweep();
        residuals.push(norm);
        // What is below the rounding of the first residual says nothing.
        smallest = smallest.min(norm).max(f64::EPSILON * residuals[0]);
        if !norm.is_finite() || norm > DIVERGENCE * smallest {
            break Outcome::Diverged;
        }
        if !observe(residuals.len(), norm, relaxation) {
            break Outcome::Interrupted;
        }
    };
    Report { outcome, residuals, residual: max_norm(&relaxation.residual()) }
}

/// The step that makes the residual of one unknown vanish: r_i / (1 − ρ_i F_ii).
fn step<V: Value>(residual: V, coefficient: V, diagonal: f64) -> V {
    residual / (V::splat(1.0) - coefficient * diagonal)
}
