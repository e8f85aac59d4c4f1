//! A_ij = ∫ K(x_i, y) u_j(y) dy: collocation on panels, with the rule that varies with x (paper, §1.2.3, §1.4.2).

use super::panels::Panels;
use crate::equation::{EquationError, Scalar};
use crate::product::{OnPanel, Product, Reference};
use rayon::prelude::*;

/// The operator of an equation or system from panel polynomials to values at the panels' nodes; the unknowns of one
/// component after those of another.
#[derive(Debug)]
pub(crate) struct Discrete<T> {
    /// n × n, row by row.
    pub(crate) a: Vec<T>,
    /// The number of unknowns.
    pub(crate) n: usize,
    /// For each panel, the largest error that a row has on it, of ∫ K g with |g| ≤ 1.
    pub(crate) errors: Vec<f64>,
    /// For each panel, the largest Σ |κ_q| of a row that had to cut it. In the other rows K is a polynomial there, which
    /// sees nothing of a function's coefficients beyond its own.
    pub(crate) ragged: Vec<f64>,
    /// The most halvings of a panel that the kernel asked for.
    pub(crate) depth: u32,
}

/// From this many entries on, the rows are shared among the cores; less is done before they have awoken.
const SHARED: usize = 10_000;

impl<T: Scalar> Discrete<T> {
    pub(crate) fn assemble(
        product: &Product<'_, '_, T>,
        panels: &Panels,
        reference: &Reference,
    ) -> Result<Self, EquationError> {
        let m = product.equation().components();
        let nodes = panels.nodes(reference);
        let n = m * nodes.len();
        let mut a = vec![T::ZERO; n * n];
        let fill = |(i, row): (usize, &mut [T])| {
            let (component, t) = (i / nodes.len(), nodes[i % nodes.len()]);
            let mut seen = Seen::none(panels.len());
            for (b, part) in row.chunks_mut(nodes.len()).enumerate() {
                let mut builder = product.builder((component, b), t);
                for (k, part) in part.chunks_mut(reference.len()).enumerate() {
                    let on_panel = builder.panel(panels.ends(k), reference, part)?;
                    seen.see(k, on_panel, part);
                }
            }
            Ok(seen)
        };
        let none = || Seen::none(panels.len());
        let seen = if n * n >= SHARED {
            let rows = a.par_chunks_mut(n).enumerate().map(fill);
            rows.try_reduce(none, |one, other| Ok(one.and(&other)))?
        } else {
            a.chunks_mut(n).enumerate().map(fill).try_fold(none(), |all, one| Ok(all.and(&one?)))?
        };
        Ok(Self { a, n, errors: seen.errors, ragged: seen.ragged, depth: seen.depth })
    }

    /// A u.
    pub(crate) fn apply(&self, u: &[T]) -> Vec<T> {
        let product = |row: &[T]| row.iter().zip(u).map(|(a, u)| *a * *u).sum();
        self.a.chunks(self.n).map(product).collect()
    }

    /// For each panel, max_i Σ |A_ij| over its nodes j: how much of it is seen from anywhere.
    pub(crate) fn panel_norms(&self, panels: usize, reference: &Reference) -> Vec<f64> {
        let mut norms = vec![0.0; panels];
        let mut sums = vec![0.0; panels];
        for row in self.a.chunks(self.n) {
            sums.fill(0.0);
            for (k, part) in row.chunks(reference.len()).enumerate() {
                sums[k % panels] += part.iter().map(|a| a.modulus()).sum::<f64>();
            }
            norms.iter_mut().zip(&sums).for_each(|(norm, sum)| *norm = f64::max(*norm, *sum));
        }
        norms
    }
}

/// What was seen while rows were built.
struct Seen {
    errors: Vec<f64>,
    ragged: Vec<f64>,
    depth: u32,
}

impl Seen {
    fn none(panels: usize) -> Self {
        Self { errors: vec![0.0; panels], ragged: vec![0.0; panels], depth: 0 }
    }

    /// Of one kernel after another of a row.
    fn see<T: Scalar>(&mut self, panel: usize, on_panel: OnPanel, weights: &[T]) {
        self.errors[panel] += on_panel.error;
        self.depth = self.depth.max(on_panel.depth);
        if on_panel.depth > 0 {
            self.ragged[panel] += weights.iter().map(|weight| weight.modulus()).sum::<f64>();
        }
    }

    fn and(mut self, other: &Self) -> Self {
        self.errors.iter_mut().zip(&other.errors).for_each(|(one, other)| *one = one.max(*other));
        self.ragged.iter_mut().zip(&other.ragged).for_each(|(one, other)| *one = one.max(*other));
        Self { depth: self.depth.max(other.depth), ..self }
    }
}
