//! F_ij = the i-th coefficient of P_n(K u_j): what the number F_ij *is*, for each method of the paper.
//!
//! [`Nystrom`] replaces the integral by a rule; [`Collocation`] interpolates K u_j at the nodes; [`Galerkin`]
//! takes its mean over the elements; [`ProductNystrom`] varies the rule where K is singular. How F is kept is the business
//! of [`crate::operator`].

mod nystrom;
mod product_nystrom;
mod projection;

pub use nystrom::Nystrom;
pub use product_nystrom::ProductNystrom;
pub use projection::{Collocation, Galerkin};

use rayon::prelude::*;

/// The numbers F_ij of a discretised integral operator, one unknown per element (P0) or node.
pub trait Coupling: Sync {
    /// The number of unknowns n; F is n × n.
    fn dim(&self) -> usize;

    /// F_ij: what unknown j sends to unknown i.
    fn entry(&self, i: usize, j: usize) -> f64;

    /// F_ij for j = `from` …, written to `row`. The same numbers as [`Self::entry`]'s, perhaps found faster together.
    fn row(&self, i: usize, from: usize, row: &mut [f64]) {
        row.iter_mut().enumerate().for_each(|(k, entry)| *entry = self.entry(i, from + k));
    }

    /// How many rows, from row i on, cost little more than one: those of the unknowns of one element, whose first is i.
    fn band(&self, _i: usize) -> usize {
        1
    }

    /// The rows `first` … from column `from` on, as many as `rows` holds, one after another.
    fn rows(&self, first: usize, from: usize, rows: &mut [f64]) {
        let width = self.dim() - from;
        rows.chunks_mut(width.max(1)).enumerate().for_each(|(k, row)| self.row(first + k, from, row));
    }

    /// Positive weights w with w_i F_ij = w_j F_ji, when F is self-adjoint for the product Σ w_i u_i v_i.
    /// Radiosity calls it reciprocity, with the patches' areas for weights. Assembly then computes half of F.
    fn reciprocity(&self) -> Option<&[f64]> {
        None
    }
}

impl<C: Coupling> Coupling for &C {
    fn dim(&self) -> usize {
        (**self).dim()
    }
    fn entry(&self, i: usize, j: usize) -> f64 {
        (**self).entry(i, j)
    }
    fn row(&self, i: usize, from: usize, row: &mut [f64]) {
        (**self).row(i, from, row);
    }
    fn band(&self, i: usize) -> usize {
        (**self).band(i)
    }
    fn rows(&self, first: usize, from: usize, rows: &mut [f64]) {
        (**self).rows(first, from, rows);
    }
    fn reciprocity(&self) -> Option<&[f64]> {
        (**self).reciprocity()
    }
}

/// Column j of F, written to `column` (length n) by all cores: with reciprocity it is row j, rescaled.
pub(crate) fn fill_column(coupling: &impl Coupling, j: usize, column: &mut [f64]) {
    // 256 entries: some fifty microseconds of form factors, a hundred times the cost of handing out the work.
    column.par_chunks_mut(256).enumerate().for_each(|(k, part)| {
        let first = 256 * k;
        match coupling.reciprocity() {
            Some(weights) => {
                coupling.row(j, first, part);
                part.iter_mut().zip(&weights[first..]).for_each(|(entry, w)| *entry *= weights[j] / w);
            }
            None => part.iter_mut().enumerate().for_each(|(i, entry)| *entry = coupling.entry(first + i, j)),
        }
    });
}
