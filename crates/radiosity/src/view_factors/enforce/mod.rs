//! The nearest exchanges that are closed: min Σ_ij (G_ij − G⁰_ij)² / (A_i A_j) with G = Gᵀ ≥ 0 and Σ_j G_ij = A_i.
//!
//! A kernel that is G_ij/(A_i A_j) on P_i × P_j is an operator on L², and the sum is the square of what the correction
//! is there in the Hilbert–Schmidt norm, which bounds the operator norm that the paper's error estimates are in. Its
//! minimum is, with a number λ_i for each row that is to add up to 1 and 0 for the others,
//!
//! G_ij = max(0, G⁰_ij + A_i A_j (λ_i + λ_j)),
//!
//! so only λ is stored and the exchanges stay as they were computed. What is certainly 0 stays 0. The λ minimise a
//! convex function, whose gradient is what the rows miss, by Newton's method with conjugate gradients; nothing is
//! stored of the size of the matrix.

mod newton;
mod pairs;

use super::ViewFactors;
use newton::{Outcome, multipliers};
use pairs::Pairs;

/// How the exchanges were changed: the λ of each face, in 1/m².
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Multipliers(pub(super) Vec<f64>);

/// The size of a correction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Correction {
    /// max |ΔF_ij|.
    pub largest: f64,
    /// (Σ_ij ΔG_ij² / (A_i A_j))^½: the kernel's change in the norm that was made least.
    pub norm: f64,
    /// The errors of the factors before it, in the same norm.
    pub error_norm: f64,
    /// How many pairs i ≤ j were changed by more than their error.
    pub beyond_error: u64,
    /// How many pairs i ≤ j it set to 0, since they would be less.
    pub at_zero: u64,
    /// How many rows were made to add up to 1.
    pub rows: usize,
    /// max |Σ_j F_ij − 1| over these, before.
    pub defect_before: f64,
    /// The same now.
    pub defect: f64,
    /// Steps of Newton's method.
    pub steps: usize,
}

/// Why the exchanges cannot be closed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum EnforceError {
    /// No row is to add up to 1.
    #[error("no face sees fronts alone, so no row has to add up to 1; leave the closure as it is")]
    NoRows,
    /// A face without partners.
    #[error("the face `{name}` certainly sees no other front, so its row cannot add up to 1: {MEND_OPEN}")]
    Alone {
        /// The face.
        name: String,
    },
    /// The rows miss 1 by much more than their error.
    #[error(
        "the row of `{name}` adds up to {sum:.6}, and its error is only {error:.1e}: that is a gap, no error; {MEND_OPEN}"
    )]
    Open {
        /// The face whose row is worst.
        name: String,
        /// Σ_j F_ij.
        sum: f64,
        /// The bound of its error.
        error: f64,
    },
    /// No non-negative exchanges have these sums.
    #[error(
        "no exchanges between the faces that see each other close the scene: the row of `{name}` still misses 1 by {defect:.1e}; {MEND_OPEN}"
    )]
    Unreachable {
        /// The face whose row is worst.
        name: String,
        /// |Σ_j F_ij − 1| of it.
        defect: f64,
    },
}

/// What to do.
const MEND_OPEN: &str = "close the mesh, with its fronts inside, or do not enforce the closure";

/// A row that misses 1 by this many times the bound of its error is no row of a closed scene, unless by rounding.
/// Where the bounds are estimates they have been seen to be a few times too small, and a gap of a hundredth of a
/// row is 10 errors at a tolerance of 10⁻³.
const GAP: f64 = 10.0;
const ROUNDING: f64 = 1e-9;

impl ViewFactors {
    /// Makes the rows of the faces that are `whole` add up to 1, to 10⁻¹², by the least correction of the kernel in L²:
    /// of all G = Gᵀ ≥ 0 with Σ_j G_ij = A_i the one with the least Σ_ij ΔG_ij² / (A_i A_j). Exchanges that are certainly
    /// 0 stay 0; errors grow by what is corrected. It takes no memory of the size of the matrix.
    ///
    /// # Errors
    ///
    /// When these cannot be the rows of a closed scene; the factors are then as they were.
    ///
    /// # Panics
    ///
    /// When `whole` does not say something of each face.
    pub fn enforce(&mut self, whole: &[bool]) -> Result<Correction, EnforceError> {
        assert_eq!(whole.len(), self.len(), "a word for each face");
        let before = self.corrected.take();
        let found = self.closing(whole);
        match found {
            Ok((multipliers, correction)) => {
                self.corrected = Some(multipliers);
                Ok(correction)
            }
            Err(error) => {
                self.corrected = before;
                Err(error)
            }
        }
    }

    fn closing(&self, whole: &[bool]) -> Result<(Multipliers, Correction), EnforceError> {
        let defect_before = self.check_rows(whole)?;
        let pairs = Pairs::new(self);
        let Outcome { multipliers, defects, steps } = multipliers(&pairs, whole);
        let (worst, defect) = largest(&defects);
        if defect > newton::ENOUGH {
            return Err(EnforceError::Unreachable { name: self.names[worst].clone(), defect });
        }
        let rows = whole.iter().filter(|whole| **whole).count();
        let correction = Correction { rows, defect_before, defect, steps, ..self.size_of(&multipliers) };
        Ok((Multipliers(multipliers), correction))
    }

    /// That the rows can be those of a closed scene; by how much the worst of them misses 1.
    fn check_rows(&self, whole: &[bool]) -> Result<f64, EnforceError> {
        let mut defects = vec![0.0; self.len()];
        let mut excess = vec![0.0; self.len()];
        let sums = self.row_sums();
        for (i, sum) in sums.iter().enumerate().filter(|(i, _)| whole[*i]) {
            if sum.value == 0.0 && sum.error == 0.0 {
                return Err(EnforceError::Alone { name: self.names[i].clone() });
            }
            defects[i] = (sum.value - 1.0).abs();
            excess[i] = defects[i] - (GAP * sum.error + ROUNDING);
        }
        let (worst, most) = largest(&excess);
        match () {
            () if !whole.contains(&true) => Err(EnforceError::NoRows),
            () if most > 0.0 => Err(EnforceError::Open {
                name: self.names[worst].clone(),
                sum: sums[worst].value,
                error: sums[worst].error,
            }),
            () => Ok(largest(&defects).1),
        }
    }

    /// What these λ do to the exchanges.
    fn size_of(&self, multipliers: &[f64]) -> Correction {
        let mut size = Correction {
            largest: 0.0,
            norm: 0.0,
            error_norm: 0.0,
            beyond_error: 0,
            at_zero: 0,
            rows: 0,
            defect_before: 0.0,
            defect: 0.0,
            steps: 0,
        };
        self.for_each(|i, j, exchange| {
            let (a, b) = (self.areas[i], self.areas[j]);
            let new = corrected(exchange.value, exchange.error, a * b, multipliers[i] + multipliers[j]);
            let change = (new - exchange.value).abs();
            let times = if i == j { 1.0 } else { 2.0 };
            size.largest = size.largest.max(change / a.min(b));
            size.norm += times * change.powi(2) / (a * b);
            size.error_norm += times * exchange.error.powi(2) / (a * b);
            size.beyond_error += u64::from(change > exchange.error);
            size.at_zero += u64::from(new == 0.0 && exchange.value > 0.0);
        });
        Correction { norm: size.norm.sqrt(), error_norm: size.error_norm.sqrt(), ..size }
    }
}

/// G_ij for the sum λ_i + λ_j; what is certainly 0, since it is 0 without an error, stays so.
pub(super) fn corrected(value: f64, error: f64, areas: f64, multipliers: f64) -> f64 {
    if value == 0.0 && error == 0.0 { 0.0 } else { (value + areas * multipliers).max(0.0) }
}

/// The largest of some numbers and its place.
fn largest(numbers: &[f64]) -> (usize, f64) {
    let step = |(at, most): (usize, f64), (k, number): (usize, &f64)| {
        if *number > most { (k, *number) } else { (at, most) }
    };
    numbers.iter().enumerate().fold((0, 0.0), step)
}

#[cfg(test)]
mod tests;
