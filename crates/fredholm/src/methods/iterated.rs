//! φ̃ = f + Aφ_n: one more application of A to a projection method's answer doubles its order (Sloan 1976; paper, §1.4).

use super::Approximation;
use super::integrals::{or_nan, transform_resolved};
use crate::equation::{Function, Scalar};
use crate::product::Product;
use crate::space::resolve;
use std::sync::Arc;

/// f + Aφ_n, from an answer of collocation, Galerkin's method or least squares.
pub fn iterated<'e, T: Scalar>(
    product: &Arc<Product<'e, 'e, T>>,
    answer: &Approximation<'_, T>,
) -> Approximation<'e, T> {
    let (equation, product) = (product.equation(), product.clone());
    let interval = equation.interval();
    // φ_n is a polynomial between its breaks: nothing need be cut.
    let phi = resolve(&answer.solution, &answer.breaks, 0);
    let value =
        move |a: usize, x: &f64| equation.source(a, *x) + or_nan(transform_resolved(&product, (a, *x), &phi));
    Approximation {
        solution: Function::new(equation.components(), value),
        breaks: vec![interval.a(), interval.b()],
        unknowns: answer.unknowns,
        condition: answer.condition,
    }
}
