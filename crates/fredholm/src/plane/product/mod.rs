//! Kernels that are singular at p = q, or have a bend there: the product rule on graded elements of 16 × 16 nodes (paper, §1.2.3, remark).
//!
//! A u is collocated at the nodes, with weights that integrate K(p, ·) times the elements' polynomials to rounding; so the unknowns
//! need only be as many as φ asks for. φ_n is judged by its residual between the nodes, by a finer rule.

mod alternative;
mod attempt;
mod chart;
mod element;
mod layout;
mod row;

pub(super) use attempt::Attempt;

use super::{DENSE, Options, PlaneEquation};
use crate::equation::{Answer, Class, EquationError, LineKernel, Scalar};
use crate::product::{Change, diagonal};
use element::Elements;
use layout::Layout;
use std::sync::Arc;

/// What K does at p = q, seen along lines across the domain.
///
/// # Errors
///
/// [`EquationError::Method`] where it grows so fast that it cannot be integrated.
pub(super) fn class<T: Scalar>(equation: &PlaneEquation<'_, T>) -> Result<Class, EquationError> {
    let charts = chart::charts(equation.domain, 0.0);
    let mut worst = Class::Smooth;
    for (k, chart) in charts.iter().enumerate() {
        // In directions that nobody would choose.
        let [from, to] = [chart.point([0.83, 0.71]), charts[(k + 1) % charts.len()].point([0.67, 0.91])];
        let on_line = |t: f64| [0, 1].map(|c| from[c] + t * (to[c] - from[c]));
        let kernel = |x: f64, y: f64| {
            let mut value = [T::ZERO];
            equation.kernel.row(on_line(x), &[on_line(y)], &mut value);
            value[0]
        };
        let in_plane = |error| match error {
            EquationError::KernelNotFinite { x, y, value } => {
                EquationError::PlaneKernelNotFinite { p: on_line(x), q: on_line(y), value }
            }
            other => other,
        };
        let change = Change::Identity { a: 0.0, b: 1.0 };
        let seen = diagonal::seen(&kernel as &dyn LineKernel<T>, change).map_err(in_plane)?;
        worst = diagonal::worse(worst, seen);
    }
    match worst {
        Class::Algebraic { exponent } if exponent < STRONGEST => Err(EquationError::Method(format!(
            "the kernel grows like |p − q|^{exponent:.2} towards p = q: in the plane it cannot be integrated"
        ))),
        class => Ok(class),
    }
}

/// |p − q|^−2 has no integral, and is hard to tell from this.
const STRONGEST: f64 = -1.95;

/// Cells of a triangle are as slender as it is, and p is near to very many of them.
const SLENDEREST: f64 = 30.0;

/// How the solution on given elements is found, to a tolerance.
pub(super) type Find<'e, 'a, T> = fn(Layout<'e, 'a, T>, f64) -> Result<Attempt<'e, 'a, T>, EquationError>;

/// With A in blocks of low rank where a matrix takes more time and memory.
pub(super) fn in_blocks<'e, 'a, T: Scalar>(
    layout: Layout<'e, 'a, T>,
    tolerance: f64,
) -> Result<Attempt<'e, 'a, T>, EquationError> {
    if layout.dim() <= DENSE {
        Attempt::dense(layout, tolerance)
    } else {
        Attempt::in_blocks(layout, tolerance)
    }
}

/// Solves with a kernel that is smooth but at p = q, where it is of a class.
pub(super) fn solve<'e, 'a, T: Scalar>(
    equation: &'e PlaneEquation<'a, T>,
    class: Class,
    options: &Options,
    find: Find<'e, 'a, T>,
) -> Result<Answer<'e, [f64; 2], T>, EquationError> {
    if equation.domain.slenderness() > SLENDEREST {
        return Err(EquationError::Method(format!(
            "the {} is {:.0} times as long as it is high: with a kernel that is not smooth at p = q it may be {SLENDEREST} times",
            equation.domain,
            equation.domain.slenderness()
        )));
    }
    let (tolerance, exponent) = (options.tolerance, exponent(class));
    let elements = Elements::new(equation.domain, exponent);
    if elements.unknowns() > options.unknowns {
        return Err(EquationError::Method(format!(
            "a kernel with a singularity takes at least {} unknowns on the {}, and {} are allowed",
            elements.unknowns(),
            equation.domain,
            options.unknowns
        )));
    }
    let attempt = |elements| find(Layout::new(equation, Arc::new(elements), exponent), tolerance);
    let mut best = attempt(elements)?;
    let mut latest = None;
    while !best.is_final(tolerance) {
        let Some(finer) = latest.as_ref().unwrap_or(&best).finer(tolerance, options.unknowns) else { break };
        let found = match attempt(finer) {
            // What was found before is kept where the next takes too much memory.
            Err(EquationError::Method(_)) => break,
            found => found?,
        };
        if found.is_final(tolerance) || found.error < best.error {
            best = found;
            latest = None;
        } else {
            latest = Some(found);
        }
    }
    Ok(best.answer(class, tolerance))
}

/// The exponent of |p − q| in a kernel of a class.
fn exponent(class: Class) -> f64 {
    if let Class::Algebraic { exponent } = class { exponent } else { 0.0 }
}
