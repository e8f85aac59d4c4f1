//! n, 2n, 4n, … until the error estimate meets the tolerance: the methods that solve a linear system (paper, §1.2.3–1.4).

use super::residual::{Judgement, judge};
use super::{Approximation, Method, Setup, Yardstick};
use super::{collocation, degenerate, galerkin, iterated, least_squares, nystrom};
use crate::equation::{Answer, EquationError, Scalar, Status};
use crate::product::Product;
use crate::space::SpaceKind;
use std::sync::Arc;

/// The answer for this n.
pub(super) fn at<'e, T: Scalar>(
    product: &Arc<Product<'e, 'e, T>>,
    setup: &Setup,
    yardstick: &Yardstick,
    n: usize,
) -> Result<Answer<'e, f64, T>, EquationError> {
    let approximation = approximate(product, setup, n)?;
    let judgement = judge(product, &approximation, yardstick)?;
    Ok(answer(approximation, judgement, setup, described(setup)))
}

/// The answer of the least n, doubled from the first, that meets the tolerance; or the best one.
pub(super) fn grow<'e, T: Scalar>(
    product: &Arc<Product<'e, 'e, T>>,
    setup: &Setup,
    yardstick: &Yardstick,
) -> Result<Answer<'e, f64, T>, EquationError> {
    let mut n = match setup.method {
        Method::Nystrom => FIRST * setup.rule.parts(),
        _ => FIRST,
    };
    let mut best: Result<(Approximation<'e, T>, Judgement), EquationError> = Err(EquationError::Method(
        format!("{} has more unknowns from the start than it may have", setup.method),
    ));
    while unknowns(setup, n) * product.equation().components() <= largest(setup) {
        // A coarse discretisation may be singular where finer ones are not.
        match approximate(product, setup, n) {
            Ok(approximation) => {
                let judgement = judge(product, &approximation, yardstick)?;
                let better = best.as_ref().map_or(true, |(_, best)| judgement.error < best.error);
                if better {
                    best = Ok((approximation, judgement));
                }
                // Below three times the rounding nothing is left to be gained.
                if judgement.error <= goal(setup, judgement) || judgement.error <= 3.0 * judgement.rounding {
                    break;
                }
            }
            Err(error @ (EquationError::KernelNotFinite { .. } | EquationError::SourceNotFinite { .. })) => {
                return Err(error);
            }
            Err(error) => best = best.or(Err(error)),
        }
        n *= 2;
    }
    best.map(|(approximation, judgement)| answer(approximation, judgement, setup, described(setup)))
}

/// What the error estimate has to meet.
pub(super) fn goal(setup: &Setup, judgement: Judgement) -> f64 {
    setup.tolerance * judgement.size
}

pub(super) fn answer<'e, T: Scalar>(
    approximation: Approximation<'e, T>,
    judgement: Judgement,
    setup: &Setup,
    method: String,
) -> Answer<'e, f64, T> {
    let converged = judgement.error <= goal(setup, judgement);
    Answer {
        status: if converged { Status::Converged } else { Status::ToleranceNotMet },
        method,
        class: None,
        unknowns: approximation.unknowns,
        error_estimate: judgement.error,
        condition: approximation.condition,
        solution: approximation.solution,
        alternative: None,
    }
}

fn described(setup: &Setup) -> String {
    match setup.method {
        Method::Nystrom => format!("{}, {}", setup.method, setup.rule),
        _ => format!("{}, {}", setup.method, setup.space),
    }
}

fn approximate<'e, T: Scalar>(
    product: &Arc<Product<'e, 'e, T>>,
    setup: &Setup,
    n: usize,
) -> Result<Approximation<'e, T>, EquationError> {
    let equation = product.equation();
    let (a, b) = (equation.interval().a(), equation.interval().b());
    check_size(setup, n, equation.components())?;
    let basis = || setup.space.basis(a, b, n);
    match setup.method {
        Method::Nystrom => nystrom::solve(equation, setup.rule.quadrature(a, b, n)?),
        Method::Degenerate => degenerate::solve(product, basis()),
        Method::Collocation => collocation::solve(product, basis()),
        Method::Galerkin => galerkin::solve(product, basis()),
        Method::LeastSquares => least_squares::solve(product, basis()),
        Method::IteratedCollocation => {
            Ok(iterated::iterated(product, &collocation::solve(product, basis())?))
        }
        Method::IteratedGalerkin => Ok(iterated::iterated(product, &galerkin::solve(product, basis())?)),
        Method::Neumann | Method::Successive => {
            Err(EquationError::Method(format!("{} solves no linear system", setup.method)))
        }
    }
}

fn unknowns(setup: &Setup, n: usize) -> usize {
    match setup.method {
        Method::Nystrom => setup.rule.nodes(n),
        _ => setup.space.dim(n),
    }
}

/// The first n, of elements or nodes, or of parts by as many as the rule takes at a time.
const FIRST: usize = 4;

/// Up to how many unknowns n grows by itself: where an answer takes some seconds. Global functions are evaluated at 16 points
/// for each of them, and every one is everywhere; Galerkin's method has 16 points an element, and least squares keep them all.
fn largest(setup: &Setup) -> usize {
    match (setup.method, setup.space) {
        (Method::Nystrom, _) => 2100,
        (Method::LeastSquares, SpaceKind::Piecewise(_)) => 300,
        (Method::LeastSquares, _) => 64,
        (Method::Galerkin | Method::IteratedGalerkin, SpaceKind::Piecewise(_)) => 600,
        (Method::Galerkin | Method::IteratedGalerkin, _) => 64,
        (_, SpaceKind::Piecewise(_)) => 1100,
        _ => 300,
    }
}

/// How many unknowns may be asked for: 2 GB for a matrix of 16000 × 16000, or for one of 16 rows an unknown.
fn most(method: Method) -> usize {
    if method == Method::LeastSquares { 3000 } else { 16_000 }
}

fn check_size(setup: &Setup, n: usize, components: usize) -> Result<(), EquationError> {
    // n alone first: a product of absurd numbers would overflow.
    if n == 0 {
        return Err(EquationError::Method(format!("{} needs n ≥ 1", setup.method)));
    }
    let most = most(setup.method);
    if n > most || unknowns(setup, n) * components > most {
        return Err(EquationError::Method(format!(
            "n = {n} makes more than the {most} unknowns that {} may have: take a smaller n, or a space or rule of higher order",
            setup.method
        )));
    }
    Ok(())
}
