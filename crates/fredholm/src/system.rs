//! u = f + ρ ⊙ (F u): source, coefficient, operator, and the error that the equation's own residual bounds.

use crate::operator::{Operator, Rows};
use crate::value::{Value, max_norm};
use rayon::prelude::*;

/// The discrete equation: f and ρ take values, F is one real matrix for all their channels.
#[derive(Debug)]
pub struct System<'a, V, F> {
    /// The source f, one value per unknown.
    pub source: &'a [V],
    /// The coefficient ρ, one value per unknown: the λ of textbooks, the reflectance of radiosity.
    pub coefficient: &'a [V],
    /// The operator F.
    pub operator: &'a F,
}

impl<V, F> Clone for System<'_, V, F> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<V, F> Copy for System<'_, V, F> {}

/// Parts that do not make an equation.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SystemError {
    /// Source, coefficient and operator are not of one size.
    #[error(
        "source of {source_len}, coefficient of {coefficient_len} and operator of {dim} unknowns: they must agree"
    )]
    Sizes {
        /// Length of the source.
        source_len: usize,
        /// Length of the coefficient.
        coefficient_len: usize,
        /// Size of the operator.
        dim: usize,
    },
    /// An infinite or NaN number in the source or coefficient.
    #[error("{what} {index} is not finite")]
    NotFinite {
        /// "source" or "coefficient".
        what: &'static str,
        /// Which unknown.
        index: usize,
    },
}

impl<'a, V: Value, F: Operator<V>> System<'a, V, F> {
    /// The equation u = `source` + `coefficient` ⊙ (`operator` u), checked.
    pub fn new(source: &'a [V], coefficient: &'a [V], operator: &'a F) -> Result<Self, SystemError> {
        let (source_len, coefficient_len, dim) = (source.len(), coefficient.len(), operator.dim());
        if source_len != dim || coefficient_len != dim {
            return Err(SystemError::Sizes { source_len, coefficient_len, dim });
        }
        for (what, values) in [("source", source), ("coefficient", coefficient)] {
            if let Some(index) = values.iter().position(|v| !v.all_finite()) {
                return Err(SystemError::NotFinite { what, index });
            }
        }
        Ok(Self { source, coefficient, operator })
    }

    /// The number of unknowns.
    pub fn dim(&self) -> usize {
        self.source.len()
    }

    /// ρ ⊙ (F u).
    pub fn transport(&self, u: &[V]) -> Vec<V> {
        let mut out = vec![V::splat(0.0); self.dim()];
        self.operator.apply(u, &mut out);
        out.iter_mut().zip(self.coefficient).for_each(|(value, rho)| *value = *value * *rho);
        out
    }

    /// The residual r = f + ρ ⊙ (F u) − u. It is zero exactly when u solves the system.
    pub fn residual(&self, u: &[V]) -> Vec<V> {
        let mut r = self.transport(u);
        r.iter_mut().zip(self.source).zip(u).for_each(|((r, f), u)| *r = *r + *f - *u);
        r
    }
}

/// Σ_j |F_ij| of the rows named: over all of them, ‖F‖∞ is the largest.
pub fn row_sums(operator: &impl Rows, rows: &[usize]) -> Vec<f64> {
    rows.par_iter().map_init(Vec::new, |buffer, &i| operator.row(i, buffer).abs_sum()).collect()
}

/// ‖ρF‖∞ = max_i |ρ_i| Σ_j |F_ij|, over all channels, from the row sums of |F| (paper, §1.1.1).
pub fn norm_bound<V: Value>(coefficient: &[V], row_sums: &[f64]) -> f64 {
    let rows: Vec<V> = coefficient.iter().zip(row_sums).map(|(rho, sum)| *rho * *sum).collect();
    max_norm(&rows)
}

/// ‖u − ũ‖∞ ≤ ‖r‖∞ / (1 − ‖ρF‖∞): how far ũ with residual r can be from the solution u of the system.
///
/// `None` when ‖ρF‖∞ ≥ 1, where the residual alone bounds nothing (paper, §1.1.3).
pub fn error_bound(residual_norm: f64, norm_bound: f64) -> Option<f64> {
    (norm_bound < 1.0).then(|| residual_norm / (1.0 - norm_bound))
}
