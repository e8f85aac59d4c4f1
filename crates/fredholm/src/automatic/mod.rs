//! φ = f + A φ solved without being told how: panels that the residual asks for, until the error meets the tolerance
//! (paper, §1.4.2 with the rule of §1.2.3).
//!
//! The unknown is a polynomial of degree 15 on each of a few panels; the kernel is integrated by the rule that varies
//! with x ([`crate::product`]), to rounding, whatever its class. What remains is the error of φ_n, and the equation
//! tells it: with the residual r = f + A φ_n − φ_n, measured between the nodes, Nyström's interpolant f + A φ_n (1.29) is
//! wrong by (I − A)⁻¹ A r. Panels are cut where r asks for it. Where they would have to be cut towards an end for ever,
//! a change of variable makes the end smooth; infinite intervals have one from the beginning.

mod attempt;
pub(crate) mod discrete;
pub(crate) mod found;
mod large;
pub(crate) mod panels;
mod periodic;
mod singular;

pub use large::solve_large;

use crate::equation::{Alternative, Answer, Class, Equation, EquationError, Scalar, Status};
use crate::product::{COARSE, Change, Product};
use attempt::Attempt;
use found::PanelFunction;
use panels::Panels;
use std::sync::Arc;

/// What is asked of the answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// The error allowed, as a part of max |φ|.
    pub tolerance: f64,
    /// The kernel's class, if it is known; otherwise it is found.
    pub class: Option<Class>,
    /// The most unknowns. In a matrix they take 56 bytes times their square, twice as many for complex numbers, and time that grows
    /// with their cube; for more of them than [`DENSE`] there is [`solve_large`].
    pub unknowns: usize,
}

/// Unknowns of which a matrix takes some seconds and 500 MB.
pub const DENSE: usize = 3000;

impl Default for Options {
    /// An error of 10⁻¹⁰, any class, and up to [`DENSE`] unknowns.
    fn default() -> Self {
        Self { tolerance: 1e-10, class: None, unknowns: DENSE }
    }
}

/// Solves an equation, or a system, to the tolerance; where that cannot be met the answer is the best found, and says so.
///
/// # Errors
///
/// A kernel or source that is infinite or NaN where it is sampled, or a kernel that cannot be integrated.
pub fn solve<'e, 'a: 'e, T: Scalar>(
    equation: &'e Equation<'a, T>,
    options: &Options,
) -> Result<Answer<'e, f64, T>, EquationError> {
    if options.tolerance.is_nan() {
        return Err(EquationError::Method("the tolerance is NaN: it must be a number".to_owned()));
    }
    let plain = Arc::new(Product::new(equation, options.class)?);
    let (attempt, ending) = search(&plain, plain.change().least_panels(), options)?;
    if ending != Ending::AtEnds {
        return Ok(answer(&plain, attempt, options.tolerance));
    }
    let graded = Arc::new(plain.changed(Change::graded(equation.interval())));
    let (other, _) = search(&graded, GRADED, options)?;
    // Not less than: NaN is no improvement.
    Ok(if other.error < attempt.error || other.status == Some(Status::NoSolution) {
        answer(&graded, other, options.tolerance)
    } else {
        answer(&plain, attempt, options.tolerance)
    })
}

/// Why a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Ending {
    /// The tolerance is met, or there is a verdict.
    Done,
    /// Nothing more is to be gained this way.
    Exhausted,
    /// The panels get shorter and shorter towards an end of the interval.
    AtEnds,
}

/// Attempts without an error halved before the search is given up. A kernel that oscillates some hundred times shows
/// nothing before its panels have been halved six times.
const PATIENCE: usize = 8;

/// Panels that a graded variable begins with.
const GRADED: usize = 4;

/// Unknowns up to which I − A is examined for null functions that are not resolved yet.
const EXAMINED: usize = 500;

/// The part of the interval below which a panel at an end is short: boundary layers a hundred times as thin as the
/// interval are resolved by panels.
const SHORT: f64 = 1.0 / 128.0;

/// Panels whose residual contributes more than this part of the largest contribution are cut.
const CUT: f64 = 0.05;

/// Cuts panels, of which there are `count` at first, where the residual asks for it; returns the best attempt.
fn search<T: Scalar>(
    product: &Product<'_, '_, T>,
    count: usize,
    options: &Options,
) -> Result<(Attempt<T>, Ending), EquationError> {
    let mut panels = Panels::equal(product.change().range(), count);
    let mut best = Attempt::new(product, panels.clone(), options.tolerance)?;
    let mut last_contributions = best.contributions.clone();
    let mut stalled = 0;
    loop {
        if best.status == Some(Status::NoSolution) || best.meets(options.tolerance) {
            return Ok((best, Ending::Done));
        }
        // Near to rounding there is little to wait for.
        let patience = if best.error < 100.0 * best.floor { 1 } else { PATIENCE };
        // Singular values take twenty times as long as a solution: what 500 unknowns do not resolve is given up.
        let lost = best.condition.is_nan() || best.error.is_infinite() && best.unknowns() > EXAMINED;
        if stalled >= patience || lost {
            return Ok((best, Ending::Exhausted));
        }
        let worst = last_contributions.iter().copied().fold(0.0, f64::max);
        let is_cut = |panel: usize| last_contributions[panel] >= CUT * worst;
        if at_ends(product, &panels, is_cut) {
            return Ok((best, Ending::AtEnds));
        }
        panels = panels.cut(|panel| if is_cut(panel) { 2 } else { 1 });
        if panels.len() * product.equation().components() * COARSE.len() > options.unknowns {
            return Ok((best, Ending::Exhausted));
        }
        let attempt = Attempt::new(product, panels.clone(), options.tolerance)?;
        last_contributions.clone_from(&attempt.contributions);
        let verdict = attempt.status == Some(Status::NoSolution);
        stalled = if attempt.error < 0.5 * best.error { 0 } else { stalled + 1 };
        if verdict || attempt.error < best.error || best.error.is_infinite() {
            best = attempt;
        }
    }
}

/// Whether the ends of the interval need a change of variable: with a singular kernel the solution is singular there,
/// unless the equation goes round a circle; otherwise, when a panel at an end is to be cut that is short already.
fn at_ends<T: Scalar>(product: &Product<'_, '_, T>, panels: &Panels, is_cut: impl Fn(usize) -> bool) -> bool {
    if !matches!(product.change(), Change::Identity { .. }) {
        return false;
    }
    if has_singular_kernel(product) {
        return !periodic::is_periodic(product.equation());
    }
    let rest = (0..panels.len()).any(|panel| !is_cut(panel));
    rest && [0, panels.len() - 1].iter().any(|end| is_cut(*end) && panels.share(*end) <= SHORT)
}

fn has_singular_kernel<T: Scalar>(product: &Product<'_, '_, T>) -> bool {
    matches!(product.worst_class(), Class::Logarithmic | Class::Algebraic { .. })
}

fn answer<'e, 'a: 'e, T: Scalar>(
    product: &Arc<Product<'e, 'a, T>>,
    attempt: Attempt<T>,
    tolerance: f64,
) -> Answer<'e, f64, T> {
    let met = if attempt.meets(tolerance) { Status::Converged } else { Status::ToleranceNotMet };
    let status = attempt.status.unwrap_or(met);
    let unknowns = attempt.unknowns();
    let Attempt { error, condition, depth, singular, values, panels, .. } = attempt;
    let panels = Arc::new(panels);
    let found = |values| PanelFunction::new(product, &panels, values);
    let alternative = singular.map(|singular| Alternative {
        null_functions: singular.null.into_iter().map(|values| found(values).function()).collect(),
        adjoint_null_functions: singular.adjoint.into_iter().map(|values| found(values).function()).collect(),
        solvability: singular.defects,
        singular_values: singular.values,
        distance_to_spectrum: singular.distance_to_spectrum,
    });
    Answer {
        status,
        method: match panels.len() {
            1 => "automatic: collocation by one polynomial of degree 15, iterated".to_owned(),
            count => format!("automatic: collocation on {count} panels of degree 15, iterated"),
        },
        class: Some(class(product, depth)),
        unknowns,
        error_estimate: if status == Status::NoSolution { f64::INFINITY } else { error },
        condition,
        solution: found::interpolant(product.clone(), found(values)),
        alternative,
    }
}

/// The class of the kernel, as the diagonal shows it and as its integration did.
fn class<T: Scalar>(product: &Product<'_, '_, T>, depth: u32) -> Class {
    match product.worst_class() {
        Class::Smooth if depth > 3 => Class::Peaked,
        Class::Smooth if periodic::is_periodic(product.equation()) => Class::Periodic,
        class => class,
    }
}
