//! (I − A) u = f for an A of very many unknowns: in blocks of low rank, solved by GMRES, with its norms estimated.

use super::norm_estimate;
use crate::discretize::Coupling;
use crate::equation::EquationError;
use crate::krylov::Gmres;
use crate::operator::hierarchical::{Hierarchical, HierarchicalError, Options, Plan};
use crate::operator::{Columns, Line, Matrix, NotFinite, Operator, Rows};
use crate::relax::{Outcome, Relaxation, Stop, relax};
use crate::system::System;
use crate::value::Value;

/// I − A in blocks.
pub(crate) struct Blocks {
    operator: Hierarchical,
    /// The part of the solution that may be left out.
    tolerance: f64,
    norm: f64,
    inverse_norm: f64,
}

/// ‖A − Ã‖ and the residual of GMRES, as parts of the tolerance; and the residual for norms, which need not be known well.
const KEPT: f64 = 0.1;
const SOLVED: f64 = 0.01;
const ROUGHLY: f64 = 0.01;

/// The most steps of GMRES.
const STEPS: usize = 500;

/// From this condition on a matrix cannot be told from a singular one.
const SINGULAR: f64 = 1e13;

impl Blocks {
    /// A of unknowns at these points, for solutions to a tolerance, in so many bytes at most; an entry that is not finite is told as the
    /// caller says.
    ///
    /// # Errors
    ///
    /// [`EquationError::Method`] where A takes more memory, or where I − A cannot be told from a singular operator.
    pub(crate) fn new<const D: usize>(
        coupling: &impl Coupling,
        points: &[[f64; D]],
        (tolerance, memory): (f64, u64),
        not_finite: impl Fn(NotFinite) -> EquationError,
    ) -> Result<Self, EquationError> {
        let told = |error| match error {
            HierarchicalError::Entry(entry) => not_finite(entry),
            HierarchicalError::Memory { needed, allowed, .. } => EquationError::Method(format!(
                "in blocks of low rank A takes {:.3} GB, and {:.3} GB are allowed: take a larger tolerance, or allow fewer unknowns",
                needed as f64 / 1e9,
                allowed as f64 / 1e9
            )),
            other => EquationError::Method(other.to_string()),
        };
        let kept = (KEPT * tolerance).clamp(1e-14, 1e-4);
        let options = Options { tolerance: kept, memory, ..Options::default() };
        let operator =
            Plan::new(coupling, points, options).and_then(|plan| plan.assemble(|_| ())).map_err(told)?;
        let (n, transposed) = (points.len(), Transposed(&operator));
        let norm = norm_estimate(n, |u| applied(&transposed, u), |u| applied(&operator, u));
        let inverse_norm =
            norm_estimate(n, |u| solved(&transposed, u, ROUGHLY), |u| solved(&operator, u, ROUGHLY));
        let blocks = Self { operator, tolerance, norm, inverse_norm };
        if blocks.condition() > SINGULAR {
            return Err(EquationError::Method(format!(
                "I − A cannot be told from a singular operator (condition {:.0e}): the equation has no solution or many, and \
                 which of both is told only where fewer unknowns are allowed, and are enough",
                blocks.condition()
            )));
        }
        Ok(blocks)
    }

    /// ‖A‖∞, estimated.
    pub(crate) fn norm(&self) -> f64 {
        self.norm
    }

    /// ‖(I − A)⁻¹‖∞, estimated.
    pub(crate) fn inverse_norm(&self) -> f64 {
        self.inverse_norm
    }

    /// (1 + ‖A‖∞) ‖(I − A)⁻¹‖∞; infinite where GMRES finds no solution.
    pub(crate) fn condition(&self) -> f64 {
        let condition = (1.0 + self.norm) * self.inverse_norm;
        if condition.is_nan() { f64::INFINITY } else { condition }
    }

    /// u with (I − A) u = f; NaN where GMRES does not find it.
    pub(crate) fn solve(&self, f: &[f64]) -> Vec<f64> {
        solved(&self.operator, f, SOLVED * self.tolerance / self.inverse_norm.max(1.0))
    }
}

/// u with (I − F) u = f, to a residual of such a part of f; NaN where GMRES does not find it.
fn solved(operator: &impl Operator<f64>, f: &[f64], part: f64) -> Vec<f64> {
    let ones = vec![1.0; f.len()];
    let system = System { source: f, coefficient: &ones, operator };
    let mut gmres = Gmres::new(system);
    let largest = f.iter().map(|f| f.abs()).fold(0.0, f64::max);
    let stop = Stop { residual: part.max(4.0 * f64::EPSILON) * largest, sweeps: STEPS };
    match relax(&mut gmres, stop, |_, _, _| true).outcome {
        Outcome::Converged | Outcome::Stalled => gmres.solution(),
        _ => vec![f64::NAN; f.len()],
    }
}

fn applied(operator: &impl Operator<f64>, u: &[f64]) -> Vec<f64> {
    let mut image = vec![0.0; u.len()];
    operator.apply(u, &mut image);
    image
}

/// Fᵀ.
struct Transposed<'a>(&'a Hierarchical);

impl Matrix for Transposed<'_> {
    fn dim(&self) -> usize {
        self.0.dim()
    }
    fn diagonal(&self, i: usize) -> f64 {
        self.0.diagonal(i)
    }
}

impl Rows for Transposed<'_> {
    fn row<'a>(&'a self, i: usize, buffer: &'a mut Vec<f64>) -> Line<'a> {
        self.0.column(i, buffer)
    }
    fn act<V: Value>(&self, u: &[V], out: &mut [V]) {
        self.0.act_transposed(u, out);
    }
}
