//! u_i = f(q_i) + Σ_j K(q_i, q_j) w_j u_j, and between the nodes φ_n(p) = f(p) + Σ_j K(p, q_j) w_j u_j (paper, (1.27–1.29)).

use super::PlaneEquation;
use super::singular::Singular;
use crate::equation::{EquationError, Function, Scalar};
use crate::quadrature::Quadrature;
use crate::second_kind::SecondKind;
use rayon::prelude::*;

/// The discrete equation, solved.
pub(super) struct Nystrom<'e, 'a, T: Scalar> {
    pub(super) equation: &'e PlaneEquation<'a, T>,
    pub(super) rule: Quadrature<[f64; 2]>,
    /// I − A; bordered by the null functions if there are any.
    system: SecondKind<T>,
    /// ‖A‖∞ = max_i Σ_j |K(q_i, q_j)| w_j.
    pub(super) norm: f64,
    /// ‖I − A‖∞ ‖(I − A)⁻¹‖∞, without a border.
    pub(super) condition: f64,
    /// What is known of I − A where it is singular or close to it.
    pub(super) singular: Option<Singular<T>>,
    /// u.
    pub(super) values: Vec<T>,
    /// w_j u_j.
    pub(super) weighted: Vec<T>,
}

/// From this condition number on the singular values are looked at: a null space that the nodes do not resolve yet leaves
/// less than the 1e14 of one that they do.
const SUSPICIOUS: f64 = 1e4;

/// … on up to so many nodes: a decomposition of more takes minutes.
const DECOMPOSED: usize = 1000;

impl<'e, 'a, T: Scalar> Nystrom<'e, 'a, T> {
    pub(super) fn new(
        equation: &'e PlaneEquation<'a, T>,
        rule: Quadrature<[f64; 2]>,
    ) -> Result<Self, EquationError> {
        let source = sources(equation, &rule.nodes)?;
        let n = rule.nodes.len();
        let a = matrix(equation, &rule)?;
        let norm = a.chunks(n).map(|row| row.iter().map(|a| a.modulus()).sum()).fold(0.0, f64::max);
        let mut system = SecondKind::new(n, &a);
        let condition = system.condition();
        // NaN is suspicious too.
        let suspicious = n <= DECOMPOSED && (condition.is_nan() || condition >= SUSPICIOUS);
        let singular = suspicious.then(|| Singular::examine(&a, &rule.weights, &system)).flatten();
        if let Some(singular) = singular.as_ref().filter(|singular| singular.nullity() > 0) {
            system = SecondKind::bordered(&a, &rule.weights, &singular.null, &singular.adjoint);
        }
        let values = system.solve(&source);
        let weighted = weighted(&rule, &values);
        Ok(Self { equation, rule, system, norm, condition, singular, values, weighted })
    }

    /// (I − A)⁻¹ r; with a border, the part of it that is orthogonal to the null functions.
    pub(super) fn solve(&self, right: &[T]) -> Vec<T> {
        self.system.solve(right)
    }

    /// ‖(I − A)⁻¹‖∞.
    pub(super) fn inverse_norm(&self) -> f64 {
        self.system.inverse_norm()
    }

    /// φ_n at `points`.
    pub(super) fn interpolate(&self, points: &[[f64; 2]]) -> Result<Vec<T>, EquationError> {
        let source = sources(self.equation, points)?;
        let integral = integrals(self.equation, points, &self.rule.nodes, &self.weighted)?;
        Ok(source.into_iter().zip(integral).map(|(f, integral)| f + integral).collect())
    }

    /// φ_n as a function.
    pub(super) fn function(&self) -> Function<'e, [f64; 2], T> {
        let equation = self.equation;
        let row = |p, q: &[[f64; 2]], row: &mut [T]| equation.kernel.row(p, q, row);
        let integral = integral(row, &self.rule.nodes, self.weighted.clone());
        Function::new(1, move |_, p: &[f64; 2]| (equation.source)(*p) + integral(p))
    }
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

/// K(q_i, q_j) w_j, row by row.
fn matrix<T: Scalar>(
    equation: &PlaneEquation<'_, T>,
    rule: &Quadrature<[f64; 2]>,
) -> Result<Vec<T>, EquationError> {
    let n = rule.nodes.len();
    let mut rows = vec![T::ZERO; n * n];
    let fill = |(row, p): (&mut [T], &[f64; 2])| {
        equation.finite_row(*p, &rule.nodes, row)?;
        row.iter_mut().zip(&rule.weights).for_each(|(entry, w)| *entry = *entry * *w);
        Ok(())
    };
    let filled: Vec<_> = rows.par_chunks_mut(n).zip(&rule.nodes).map(fill).collect();
    // One after another, so that the first error is named however many threads there are.
    filled.into_iter().collect::<Result<(), EquationError>>()?;
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

/// p ↦ Σ_j K(p, q_j) g_j, with the weights in g, for a kernel that fills rows K(p, ·).
pub(super) fn integral<'e, T: Scalar>(
    kernel: impl Fn([f64; 2], &[[f64; 2]], &mut [T]) + Send + Sync + 'e,
    nodes: &[[f64; 2]],
    weighted: Vec<T>,
) -> impl Fn(&[f64; 2]) -> T + Send + Sync + 'e {
    let nodes = nodes.to_vec();
    move |p| {
        let mut row = vec![T::ZERO; nodes.len()];
        kernel(*p, &nodes, &mut row);
        dot(&row, &weighted)
    }
}

/// Σ_j a_j b_j, by blocks: the rounding of a sum grows with the number of its terms.
fn dot<T: Scalar>(a: &[T], b: &[T]) -> T {
    let blocks = a.chunks(64).zip(b.chunks(64));
    blocks.map(|(a, b)| a.iter().zip(b).map(|(a, b)| *a * *b).sum::<T>()).sum()
}
