//! K_n(x, y) = Σ_j a_j(x) b_j(y), φ_n = f + Σ_k γ_k a_k: a kernel of finite rank (paper, §1.3, (1.30)–(1.34), th. 1.9).
//!
//! Interpolation of K in x, (1.40), gives a_j = L_j and b_j = K(x_j, ·): local, global or trigonometric, as the space is.

use super::galerkin::composite_gauss;
use super::integrals::{images, transform_resolved};
use super::{Approximation, Discrete, Integrals};
use crate::equation::{Equation, EquationError, Function, Scalar, Source};
use crate::product::Product;
use crate::space::{Basis, combination, resolve};
use std::sync::Arc;

/// F_jk = ⟨L_k, K(x_j, ·)⟩ = (A L_k)(x_j) and s_j = (A f)(x_j), (1.33): the matrix is collocation's, the source is A f.
/// With the nodes' own rule for the integrals, s = F f, and f + γ is Nyström's solution.
pub fn discrete<T: Scalar>(
    product: &Product<'_, '_, T>,
    basis: &dyn Basis,
    integrals: Integrals<'_>,
) -> Result<Discrete<T>, EquationError> {
    let equation = product.equation();
    let matrix = images(product, basis, basis.nodes(), integrals)?;
    let resolved = resolve(&source_function(equation), basis.breaks(), MORE_PANELS);
    let image = |a: usize, x: f64| match integrals {
        Integrals::Accurate => transform_resolved(product, (a, x), &resolved).map(|image| image.value),
        Integrals::Rule(_) => (0..equation.components())
            .map(|b| Ok(integrals.row(product, (a, b), x, &[])?.apply(|y| equation.source(b, y))))
            .sum(),
    };
    let points = (0..equation.components()).flat_map(|a| basis.nodes().iter().map(move |x| (a, *x)));
    let source = points.map(|(a, x)| image(a, x)).collect::<Result<_, _>>()?;
    Ok(Discrete::new(&matrix, source))
}

/// How many more panels than the space's pieces a source may take.
const MORE_PANELS: usize = 128;

/// f as a function of all its components.
pub(super) fn source_function<'e, T: Scalar>(equation: &'e Equation<'_, T>) -> Function<'e, f64, T> {
    Function::new(equation.components(), |a, x: &f64| equation.source(a, *x))
}

/// The degenerate kernel that interpolates K in x at the nodes of the space.
pub fn solve<'e, T: Scalar>(
    product: &Product<'e, '_, T>,
    basis: Arc<dyn Basis>,
) -> Result<Approximation<'e, T>, EquationError> {
    let equation = product.equation();
    let coefficients = discrete(product, &*basis, Integrals::Accurate)?.solve()?;
    let (n, breaks) = (basis.dim(), basis.breaks().to_vec());
    let (unknowns, gamma) = (coefficients.values.len(), coefficients.values);
    let value = move |a: usize, x: &f64| {
        equation.source(a, *x) + combination(&*basis, &gamma[a * n..][..n], *x, &mut Vec::with_capacity(n))
    };
    let solution = Function::new(equation.components(), value);
    Ok(Approximation { solution, breaks, unknowns, condition: coefficients.condition })
}

/// One term a_j(x) b_j(y) of a degenerate kernel.
pub struct Term<'a, T> {
    a: Box<dyn Source<T> + 'a>,
    b: Box<dyn Source<T> + 'a>,
}

impl<'a, T> Term<'a, T> {
    /// The product a(x) b(y).
    pub fn new(a: impl Source<T> + 'a, b: impl Source<T> + 'a) -> Self {
        Self { a: Box::new(a), b: Box::new(b) }
    }
}

/// The solution of φ − Σ_j ⟨φ, b_j⟩ a_j = f with the terms given, f from the equation (th. 1.9). The equation's own kernel is
/// what the residual is measured with: it may be the sum of the terms, or what they approximate.
///
/// # Errors
///
/// [`EquationError::Method`] for a system of equations, and where the small system is singular.
pub fn solve_given<'e, T: Scalar>(
    equation: &'e Equation<'e, T>,
    terms: Vec<Term<'e, T>>,
) -> Result<Approximation<'e, T>, EquationError> {
    if equation.components() != 1 {
        return Err(EquationError::Method(
            "terms a_j(x) b_j(y) are for one equation, not for a system".into(),
        ));
    }
    let interval = equation.interval();
    let ends = vec![interval.a(), interval.b()];
    let coefficients = separable(equation, &terms, &ends).solve()?;
    let (unknowns, gamma) = (terms.len(), coefficients.values);
    let value = move |_: usize, x: &f64| {
        let sum: T = terms.iter().zip(&gamma).map(|(term, gamma)| (term.a)(*x) * *gamma).sum();
        equation.source(0, *x) + sum
    };
    Ok(Approximation {
        solution: Function::new(1, value),
        breaks: ends,
        unknowns,
        condition: coefficients.condition,
    })
}

/// F_jk = ⟨a_k, b_j⟩ and s_j = ⟨f, b_j⟩, (1.33), on panels that resolve all the functions.
fn separable<T: Scalar>(equation: &Equation<'_, T>, terms: &[Term<'_, T>], ends: &[f64]) -> Discrete<T> {
    let n = terms.len();
    // a_1 … a_n, f, b_1 … b_n
    let all = |c: usize, x: &f64| match c {
        c if c < n => (terms[c].a)(*x),
        c if c == n => equation.source(0, *x),
        c => (terms[c - n - 1].b)(*x),
    };
    let resolved = resolve(&Function::new(2 * n + 1, all), ends, MORE_PANELS);
    let mut lines = vec![vec![T::ZERO; n + 1]; n];
    let rule = composite_gauss(resolved.breaks());
    for (x, weight) in rule.nodes.iter().zip(&rule.weights) {
        for (j, line) in lines.iter_mut().enumerate() {
            let b = all(n + 1 + j, x) * *weight;
            line.iter_mut().enumerate().for_each(|(k, sum)| *sum += all(k, x) * b);
        }
    }
    let source = lines.iter_mut().filter_map(Vec::pop).collect();
    Discrete::new(&lines, source)
}
