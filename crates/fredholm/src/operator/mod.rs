//! How F is *kept*, and what a solver may ask of it: its action, its rows, its columns.
//!
//! Successive approximations and Krylov methods ask only for u ↦ F u; Gauss–Seidel *gathers* along rows;
//! Southwell *shoots* along columns. That is the last remark of the paper's §3.5.2, made into three traits:
//! a solver on an operator that cannot give what it asks for does not compile.

mod dense;
pub mod hierarchical;
mod line;
mod on_the_fly;
mod parts;

pub use dense::{Dense, Entry, NotFinite};
pub use line::Line;
pub use on_the_fly::OnTheFly;
pub use parts::{Gather, Gathered, Shoot};

use crate::value::Value;
use rayon::prelude::*;

/// A square matrix known by its size and diagonal.
pub trait Matrix: Sync {
    /// The number of rows and columns.
    fn dim(&self) -> usize;

    /// F_ii.
    fn diagonal(&self, i: usize) -> f64;
}

/// A matrix with an action u ↦ F u.
#[diagnostic::on_unimplemented(message = "`{Self}` has no action u ↦ F u on values `{V}`")]
pub trait Operator<V>: Matrix {
    /// `out` = F u; both have length `dim()`.
    fn apply(&self, u: &[V], out: &mut [V]);
}

/// A matrix whose rows can be read: what unknown i gathers from all others.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no rows to gather along",
    note = "Gauss–Seidel updates one unknown from all the others and needs row i of F: keep F `Dense`, `Hierarchical` or `OnTheFly`, or use a method that needs only the action of F (successive approximations, GMRES)"
)]
pub trait Rows: Matrix {
    /// Row i, a view of what is stored or computed into `buffer`.
    fn row<'a>(&'a self, i: usize, buffer: &'a mut Vec<f64>) -> Line<'a>;

    /// `out` = F u, for [`Operator`]: (F u)_i = row i · u, the rows shared among all cores, unless F has a faster way.
    fn act<V: Value>(&self, u: &[V], out: &mut [V]) {
        out.par_iter_mut().enumerate().for_each_init(Vec::new, |buffer, (i, value)| {
            *value = self.row(i, buffer).dot(u);
        });
    }

    /// A way to gather that is faster than row by row, for Gauss–Seidel, if there is one.
    fn gathering<'a, V: Value>(&'a self) -> Option<Box<dyn Gather<V> + 'a>> {
        None
    }
}

/// A matrix whose columns can be read: what unknown j shoots to all others.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no columns to shoot along",
    note = "Southwell's method sends one unknown's residual to all the others and needs column j of F: keep F `Dense`, `Hierarchical` or `OnTheFly`, or use a method that needs only the action of F (successive approximations, GMRES)"
)]
pub trait Columns: Matrix {
    /// Column j, computed or gathered into `buffer`.
    fn column<'a>(&'a self, j: usize, buffer: &'a mut Vec<f64>) -> Line<'a>;

    /// `out` = Fᵀ u, for [`TransposedOperator`]: (Fᵀ u)_j = column j · u, unless F has a faster way.
    fn act_transposed<V: Value>(&self, u: &[V], out: &mut [V]) {
        out.par_iter_mut().enumerate().for_each_init(Vec::new, |buffer, (j, value)| {
            *value = self.column(j, buffer).dot(u);
        });
    }

    /// A way to shoot that is faster than column by column, for Southwell's method, if there is one.
    fn shooting<'a, V: Value>(&'a self) -> Option<Box<dyn Shoot<V> + 'a>> {
        None
    }
}

/// A matrix with an action of its transposed, u ↦ Fᵀ u: what the adjoint, and norms, ask for.
#[diagnostic::on_unimplemented(message = "`{Self}` has no action u ↦ Fᵀ u on values `{V}`")]
pub trait TransposedOperator<V>: Matrix {
    /// `out` = Fᵀ u; both have length `dim()`.
    fn apply_transposed(&self, u: &[V], out: &mut [V]);
}

/// A matrix with rows has an action.
impl<V: Value, R: Rows> Operator<V> for R {
    fn apply(&self, u: &[V], out: &mut [V]) {
        self.act(u, out);
    }
}

/// A matrix with columns has a transposed action.
impl<V: Value, C: Columns> TransposedOperator<V> for C {
    fn apply_transposed(&self, u: &[V], out: &mut [V]) {
        self.act_transposed(u, out);
    }
}
