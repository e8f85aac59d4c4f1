//! (A u_j)(x) = Σ_q κ_q(x) u_j(y_q): the integrals that a semi-discrete method leaves to be computed (paper, §1.3.3, remark).

use crate::equation::{Equation, EquationError, Scalar};
use crate::product::{Product, Row};
use crate::quadrature::Quadrature;
use crate::space::{Basis, Resolved, combination};
use rayon::prelude::*;

/// How ∫ K(x, y) u_j(y) dy is computed.
#[derive(Clone, Copy, Debug)]
pub enum Integrals<'a> {
    /// To rounding, by the rule that varies with x: [`Product::row`].
    Accurate,
    /// By one rule for every x. With a space's nodes for its nodes, every method becomes Nyström's.
    Rule(&'a Quadrature<f64>),
}

impl Integrals<'_> {
    /// The rule for K_ab(x, ·) and functions that are polynomials between the `breaks`.
    pub(super) fn row<T: Scalar>(
        self,
        product: &Product<'_, '_, T>,
        (a, b): (usize, usize),
        x: f64,
        breaks: &[f64],
    ) -> Result<Row<T>, EquationError> {
        match self {
            Self::Accurate => product.row((a, b), x, breaks),
            Self::Rule(rule) => sampled_row(product.equation(), (a, b), x, rule),
        }
    }
}

/// The rule with weights α_q K_ab(x, y_q).
pub(super) fn sampled_row<T: Scalar>(
    equation: &Equation<'_, T>,
    (a, b): (usize, usize),
    x: f64,
    rule: &Quadrature<f64>,
) -> Result<Row<T>, EquationError> {
    let mut weights = sampled(equation, (a, b), x, &rule.nodes)?;
    weights.iter_mut().zip(&rule.weights).for_each(|(k, w)| *k = *k * *w);
    Ok(Row { nodes: rule.nodes.clone(), weights, error: 0.0 })
}

/// K_ab(x, y_j), or an error that tells where it is not finite.
pub(super) fn sampled<T: Scalar>(
    equation: &Equation<'_, T>,
    (a, b): (usize, usize),
    x: f64,
    y: &[f64],
) -> Result<Vec<T>, EquationError> {
    let offset: Vec<f64> = y.iter().map(|y| y - x).collect();
    let mut values = vec![T::ZERO; y.len()];
    equation.kernel(a, b).row(x, y, &offset, &mut values);
    match values.iter().position(|value| !value.finite()) {
        Some(j) => Err(not_finite(x, y[j], values[j])),
        None => Ok(values),
    }
}

fn not_finite<T: Scalar>(x: f64, y: f64, value: T) -> EquationError {
    EquationError::KernelNotFinite { x, y, value: in_words(value) }
}

fn in_words<T: Scalar>(value: T) -> String {
    let (re, im) = value.parts();
    if im == 0.0 { format!("{re}") } else { format!("{re} + {im}i") }
}

/// f_a(x), or an error where it is not finite.
pub(super) fn source<T: Scalar>(equation: &Equation<'_, T>, a: usize, x: f64) -> Result<T, EquationError> {
    let value = equation.source(a, x);
    if value.finite() { Ok(value) } else { Err(EquationError::SourceNotFinite { x, value: in_words(value) }) }
}

/// f_a(x_i), component by component.
pub(super) fn sources<T: Scalar>(equation: &Equation<'_, T>, x: &[f64]) -> Result<Vec<T>, EquationError> {
    let pairs = (0..equation.components()).flat_map(|a| x.iter().map(move |x| (a, *x)));
    pairs.map(|(a, x)| source(equation, a, x)).collect()
}

/// For each component a and then each point x: the line of numbers (A_ab u_j)(x), b by b and j by j.
pub(super) fn images<T: Scalar>(
    product: &Product<'_, '_, T>,
    basis: &dyn Basis,
    points: &[f64],
    integrals: Integrals<'_>,
) -> Result<Vec<Vec<T>>, EquationError> {
    let lines: Vec<(usize, f64)> =
        (0..product.equation().components()).flat_map(|a| points.iter().map(move |x| (a, *x))).collect();
    lines.par_iter().map(|&(a, x)| image(product, basis, a, x, integrals)).collect()
}

fn image<T: Scalar>(
    product: &Product<'_, '_, T>,
    basis: &dyn Basis,
    a: usize,
    x: f64,
    integrals: Integrals<'_>,
) -> Result<Vec<T>, EquationError> {
    let n = basis.dim();
    let mut line = vec![T::ZERO; product.equation().components() * n];
    let mut u = Vec::with_capacity(n);
    for (b, part) in line.chunks_exact_mut(n).enumerate() {
        let row = integrals.row(product, (a, b), x, basis.breaks())?;
        for (y, weight) in row.nodes.iter().zip(&row.weights) {
            let first = basis.values(*y, &mut u);
            part[first..].iter_mut().zip(&u).for_each(|(entry, u)| *entry += *weight * *u);
        }
    }
    Ok(line)
}

/// What [`transform`] finds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Transformed<T> {
    /// Σ_b ∫ K_ab(x, y) g_b(y) dy.
    pub value: T,
    /// The error that the rules admit, for |g| ≤ 1.
    pub error: f64,
}

/// (A g)_a(x) for g = Σ_j c_j u_j, the c_j component by component.
pub(super) fn transform<T: Scalar>(
    product: &Product<'_, '_, T>,
    (a, x): (usize, f64),
    basis: &dyn Basis,
    c: &[T],
) -> Result<Transformed<T>, EquationError> {
    let mut sum = Transformed { value: T::ZERO, error: 0.0 };
    let mut u = Vec::with_capacity(basis.dim());
    for (b, c) in c.chunks_exact(basis.dim()).enumerate() {
        let row = Integrals::Accurate.row(product, (a, b), x, basis.breaks())?;
        for (y, weight) in row.nodes.iter().zip(&row.weights) {
            sum.value += *weight * combination(basis, c, *y, &mut u);
        }
        sum.error += row.error;
    }
    Ok(sum)
}

/// (A g)_a(x) for a function known by its values on panels.
pub(super) fn transform_resolved<T: Scalar>(
    product: &Product<'_, '_, T>,
    at: (usize, f64),
    g: &Resolved<T>,
) -> Result<Transformed<T>, EquationError> {
    transform(product, at, &g.panels, &g.values)
}

/// What a closure that must return a number gives where there is none: the residual, computed with checks, tells why.
pub(super) fn or_nan<T: Scalar>(value: Result<Transformed<T>, EquationError>) -> T {
    value.map_or(T::from(f64::NAN), |transformed| transformed.value)
}
