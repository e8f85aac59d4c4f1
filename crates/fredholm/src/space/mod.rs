//! U_n = span(u_1 … u_n): the spaces of finite dimension that a solution is sought in (paper, §1.3.2, §3.2).
//!
//! On a line a space is known by its *Lagrange basis*, u_j(x_i) = δ_ij at n unisolvent nodes (th. 1.10): then the
//! coefficients of a function are its values. On surfaces it is [`Space`], broken into elements.

mod barycentric;
mod broken;
mod kind;
mod panels;
mod piecewise;
mod polynomial;
mod trigonometric;

pub use broken::{Element, Space};
pub use kind::SpaceKind;
pub(crate) use panels::{Panels, Resolved, resolve};
pub use piecewise::Piecewise;
pub use polynomial::Polynomial;
pub use trigonometric::Trigonometric;

use crate::equation::Scalar;
use std::fmt::Debug;

/// A space of functions on [a, b] with its Lagrange basis: u_j(x_i) = 1 where i = j, and 0 elsewhere.
pub trait Basis: Debug + Send + Sync {
    /// The nodes x_i, as many as the space has dimensions, ascending.
    fn nodes(&self) -> &[f64];

    /// a = e_0 < e_1 < … = b: from one of them to the next every u_j is, to rounding, a polynomial of degree ≤ 15.
    fn breaks(&self) -> &[f64];

    /// Writes to `values` the u_j(x) for j = `first` …, all others being 0, and returns `first`.
    fn values(&self, x: f64, values: &mut Vec<f64>) -> usize;

    /// n, the dimension.
    fn dim(&self) -> usize {
        self.nodes().len()
    }
}

/// Σ_j c_j u_j(x); `buffer` saves an allocation for each x.
pub(crate) fn combination<T: Scalar>(basis: &dyn Basis, c: &[T], x: f64, buffer: &mut Vec<f64>) -> T {
    let first = basis.values(x, buffer);
    buffer.iter().zip(&c[first..]).map(|(u, c)| *c * *u).sum()
}

/// `pieces` equal parts of [a, b]: their edges.
pub(crate) fn equal_parts(a: f64, b: f64, pieces: usize) -> Vec<f64> {
    let edge = |k: usize| if k == pieces { b } else { a + (b - a) * k as f64 / pieces as f64 };
    (0..=pieces).map(edge).collect()
}
