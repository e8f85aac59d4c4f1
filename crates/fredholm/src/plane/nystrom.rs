//! u_i = f(q_i) + Σ_j K(q_i, q_j) w_j u_j, and between the nodes φ_n(p) = f(p) + Σ_j K(p, q_j) w_j u_j (paper, (1.27–1.29)).

use super::PlaneEquation;
use super::condition::inverse_norm;
use crate::equation::{EquationError, Function, Scalar};
use crate::quadrature::Quadrature;
use faer::Mat;
use faer::linalg::solvers::{PartialPivLu, Solve};
use rayon::prelude::*;

/// The discrete equation, solved.
pub(super) struct Nystrom<'e, 'a, T: Scalar> {
    pub(super) equation: &'e PlaneEquation<'a, T>,
    pub(super) rule: Quadrature<[f64; 2]>,
    factors: PartialPivLu<T>,
    /// ‖I − A‖∞.
    pub(super) norm: f64,
    /// ‖(I − A)⁻¹‖∞.
    pub(super) inverse_norm: f64,
    /// u.
    pub(super) values: Vec<T>,
    /// w_j u_j.
    pub(super) weighted: Vec<T>,
}

impl<'e, 'a, T: Scalar> Nystrom<'e, 'a, T> {
    pub(super) fn new(
        equation: &'e PlaneEquation<'a, T>,
        rule: Quadrature<[f64; 2]>,
    ) -> Result<Self, EquationError> {
        let source = sources(equation, &rule.nodes)?;
        let mut rows = rows(equation, &rule.nodes)?;
        let n = rule.nodes.len();
        rows.par_chunks_mut(n)
            .for_each(|row| row.iter_mut().zip(&rule.weights).for_each(|(k, w)| *k = *k * *w));
        rows.iter_mut().for_each(|a| *a = -*a);
        (0..n).for_each(|i| rows[i * n + i] += T::ONE);
        let norm = rows.chunks(n).map(|row| row.iter().map(|b| b.modulus()).sum()).fold(0.0, f64::max);
        let factors = Mat::from_fn(n, n, |i, j| rows[i * n + j]).partial_piv_lu();
        let values = solve(&factors, &source);
        let weighted = weighted(&rule, &values);
        let inverse_norm = inverse_norm(&factors, n);
        Ok(Self { equation, rule, factors, norm, inverse_norm, values, weighted })
    }

    /// (I − A)⁻¹ r.
    pub(super) fn solve(&self, right: &[T]) -> Vec<T> {
        solve(&self.factors, right)
    }

    /// φ_n at `points`.
    pub(super) fn interpolate(&self, points: &[[f64; 2]]) -> Result<Vec<T>, EquationError> {
        let source = sources(self.equation, points)?;
        let integral = integrals(self.equation, points, &self.rule.nodes, &self.weighted)?;
        Ok(source.into_iter().zip(integral).map(|(f, integral)| f + integral).collect())
    }

    /// φ_n as a function.
    pub(super) fn into_function(self) -> Function<'e, [f64; 2], T> {
        let Self { equation, rule: Quadrature { nodes, .. }, weighted, .. } = self;
        Function::new(1, move |_, p: &[f64; 2]| {
            let mut row = vec![T::ZERO; nodes.len()];
            equation.kernel.row(*p, &nodes, &mut row);
            (equation.source)(*p) + dot(&row, &weighted)
        })
    }
}

fn solve<T: Scalar>(factors: &PartialPivLu<T>, right: &[T]) -> Vec<T> {
    let solution = factors.solve(Mat::from_fn(right.len(), 1, |i, _| right[i]));
    (0..right.len()).map(|i| solution[(i, 0)]).collect()
}

/// w_j u_j.
pub(super) fn weighted<T: Scalar>(rule: &Quadrature<[f64; 2]>, values: &[T]) -> Vec<T> {
    values.iter().zip(&rule.weights).map(|(u, w)| *u * *w).collect()
}

/// f at `points`.
pub(super) fn sources<T: Scalar>(
    equation: &PlaneEquation<'_, T>,
    points: &[[f64; 2]],
) -> Result<Vec<T>, EquationError> {
    points.iter().map(|p| equation.finite_source(*p)).collect()
}

/// K(q_i, q_j), row by row.
fn rows<T: Scalar>(equation: &PlaneEquation<'_, T>, nodes: &[[f64; 2]]) -> Result<Vec<T>, EquationError> {
    let mut rows = vec![T::ZERO; nodes.len() * nodes.len()];
    let filled: Vec<_> = (rows.par_chunks_mut(nodes.len()).zip(nodes))
        .map(|(row, p)| equation.finite_row(*p, nodes, row))
        .collect();
    // One after another, so that the first error is named however many threads there are.
    filled.into_iter().collect::<Result<(), _>>()?;
    Ok(rows)
}

/// Σ_j K(p, q_j) g_j for all p of `points`, with the weights in g.
pub(super) fn integrals<T: Scalar>(
    equation: &PlaneEquation<'_, T>,
    points: &[[f64; 2]],
    nodes: &[[f64; 2]],
    weighted: &[T],
) -> Result<Vec<T>, EquationError> {
    let at =
        |row: &mut Vec<T>, p: &[f64; 2]| equation.finite_row(*p, nodes, row).map(|()| dot(row, weighted));
    let found: Vec<_> = points.par_iter().map_init(|| vec![T::ZERO; nodes.len()], at).collect();
    found.into_iter().collect()
}

/// Σ_j a_j b_j, by blocks: the rounding of a sum grows with the number of its terms.
fn dot<T: Scalar>(a: &[T], b: &[T]) -> T {
    let blocks = a.chunks(64).zip(b.chunks(64));
    blocks.map(|(a, b)| a.iter().zip(b).map(|(a, b)| *a * *b).sum::<T>()).sum()
}
