//! The methods that are compared, and what each of them reaches.

use crate::problem::{FormulaValue, Points, Problem};
use crate::solve::report::{Values, true_error};
use fredholm::automatic;
use fredholm::equation::{Answer, Equation, EquationError};
use fredholm::methods::{self, Method, RuleKind, Setup};
use fredholm::space::SpaceKind;
use serde::Serialize;
use std::time::Instant;

/// A method with its space or rule.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contender {
    method: Method,
    space: SpaceKind,
    rule: RuleKind,
}

/// A method's run with one n.
#[derive(Clone, Debug, Serialize)]
pub struct Run {
    /// Elements or nodes.
    pub n: usize,
    /// How many numbers were solved for.
    pub unknowns: usize,
    /// max |φ − exact|, where the solution is known.
    pub error: Option<f64>,
    /// The estimate of it.
    pub error_estimate: f64,
    /// log₂ of the error's quotient with that of n/2, where both are above rounding.
    pub order: Option<f64>,
    /// Of method and estimate.
    pub seconds: f64,
}

/// All runs of a method.
#[derive(Clone, Debug, Serialize)]
pub struct Runs {
    /// The method and what it was given.
    pub method: String,
    /// With growing n.
    pub runs: Vec<Run>,
    /// Why there are not more of them.
    pub refused: Option<String>,
}

/// A run longer than this is the last of its method.
const PATIENCE: f64 = 5.0;

/// Errors below this part of max |φ| are rounding, and have no order.
const ROUNDING: f64 = 1e-13;

/// An estimate that every method can be held to: none is asked to stop before.
const TOLERANCE: f64 = 1e-14;

/// The methods of the paper, each in the spaces or with the rules that show its order.
pub fn contenders() -> Vec<Contender> {
    let (p1, p2) = (SpaceKind::Piecewise(1), SpaceKind::Piecewise(2));
    let rule = |rule| Contender { method: Method::Nystrom, space: p1, rule };
    let space = |method, space| Contender { method, space, rule: RuleKind::GaussLegendre };
    vec![
        rule(RuleKind::Trapezoid),
        rule(RuleKind::Simpson),
        rule(RuleKind::GaussLegendre),
        space(Method::Degenerate, p1),
        space(Method::Collocation, p1),
        space(Method::Collocation, p2),
        space(Method::Collocation, SpaceKind::Chebyshev),
        space(Method::LeastSquares, p1),
        space(Method::Galerkin, p1),
        space(Method::Galerkin, p2),
        space(Method::IteratedGalerkin, p1),
    ]
}

impl Contender {
    /// The method's name, as it is typed.
    fn name(&self) -> String {
        match self.method {
            Method::Nystrom => format!("nystrom {}", self.rule),
            method => format!("{method} {}", self.space),
        }
    }

    /// Runs the method for each n, until it refuses or takes too long.
    pub fn run<T: FormulaValue>(
        &self,
        problem: &Problem,
        equation: &Equation<'_, T>,
        points: &[f64],
        sizes: &[usize],
    ) -> Runs {
        let Self { method, space, rule } = *self;
        let mut runs: Vec<Run> = Vec::new();
        let mut refused = None;
        for &n in sizes {
            let setup = Setup { method, space, rule, n: Some(n), tolerance: TOLERANCE };
            match timed(problem, points, n, || methods::solve(equation, &setup)) {
                Ok((mut run, size)) => {
                    run.order = runs.last().and_then(|last| order(last, &run, ROUNDING * size));
                    runs.push(run);
                }
                Err(error) => refused = Some(error.to_string()),
            }
            let long = runs.last().is_some_and(|run| run.seconds > PATIENCE);
            if long || refused.is_some() {
                break;
            }
        }
        Runs { method: self.name(), runs, refused }
    }
}

/// The automatic method, which finds its own n.
pub fn automatic<T: FormulaValue>(problem: &Problem, equation: &Equation<'_, T>, points: &[f64]) -> Runs {
    let options = automatic::Options { tolerance: TOLERANCE, ..automatic::Options::default() };
    let method = "automatic".to_owned();
    match timed(problem, points, 0, || automatic::solve(equation, &options)) {
        Ok((run, _)) => Runs { method, runs: vec![Run { n: run.unknowns, ..run }], refused: None },
        Err(error) => Runs { method, runs: Vec::new(), refused: Some(error.to_string()) },
    }
}

/// A run, and max |φ|.
fn timed<'e, T: FormulaValue>(
    problem: &Problem,
    points: &[f64],
    n: usize,
    solve: impl FnOnce() -> Result<Answer<'e, f64, T>, EquationError>,
) -> Result<(Run, f64), EquationError> {
    let start = Instant::now();
    let answer = solve()?;
    let seconds = start.elapsed().as_secs_f64();
    let phi = Values::new(&answer.solution, points);
    let error = || true_error::<T>(problem, &Points::from(points.to_vec()), &phi);
    let run = Run {
        n,
        unknowns: answer.unknowns,
        error: problem.has_exact().then(error),
        error_estimate: answer.error_estimate,
        order: None,
        seconds,
    };
    Ok((run, phi.largest()))
}

impl Run {
    /// The error where it is known, and its estimate where it is not.
    pub fn measured(&self) -> f64 {
        self.error.unwrap_or(self.error_estimate)
    }
}

fn order(coarse: &Run, fine: &Run, rounding: f64) -> Option<f64> {
    let (before, after) = (coarse.measured(), fine.measured());
    let order = (before / after).ln() / (fine.n as f64 / coarse.n as f64).ln();
    (after > rounding && order.is_finite()).then_some(order)
}
