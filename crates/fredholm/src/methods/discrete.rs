//! (I − F) c = s: the linear system that every method ends in (paper, (1.28), (1.33), (1.48), (1.56)).

use crate::equation::{EquationError, Scalar};
use crate::second_kind::SecondKind;

/// A discretised equation c = s + F c. The unknowns of a system stand component by component.
#[derive(Clone, Debug)]
pub struct Discrete<T> {
    /// Row by row.
    matrix: Vec<T>,
    source: Vec<T>,
}

/// What a linear system gives.
pub(super) struct Coefficients<T> {
    pub values: Vec<T>,
    /// ‖I − F‖∞ ‖(I − F)⁻¹‖∞.
    pub condition: f64,
}

impl<T: Scalar> Discrete<T> {
    pub(super) fn new(rows: &[Vec<T>], source: Vec<T>) -> Self {
        Self { matrix: rows.concat(), source }
    }

    /// The number of unknowns.
    pub fn dim(&self) -> usize {
        self.source.len()
    }

    /// F_ij.
    pub fn entry(&self, i: usize, j: usize) -> T {
        self.matrix[i * self.dim() + j]
    }

    /// s_i.
    pub fn source(&self, i: usize) -> T {
        self.source[i]
    }

    pub(super) fn solve(&self) -> Result<Coefficients<T>, EquationError> {
        let system = SecondKind::new(self.dim(), &self.matrix);
        check_condition(system.condition())?;
        Ok(Coefficients { values: system.solve(&self.source), condition: system.condition() })
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
