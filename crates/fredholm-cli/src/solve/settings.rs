//! How to solve: the command line's word before the file's, the file's before the default.

use super::args::Solve;
use super::class::ClassName;
use crate::problem::{Domain, FormulaValue, Problem, ProblemFile, Said};
use anyhow::{Result, bail};
use fredholm::automatic;
use fredholm::equation::{Answer, Class, Equation, EquationError};
use fredholm::methods::{self, Method, RuleKind, Setup};
use fredholm::plane::{self, PlaneEquation};
use fredholm::space::SpaceKind;
use std::fmt::Display;
use std::str::FromStr;

/// The greatest error wanted, when nobody says.
const TOLERANCE: f64 = 1e-10;

/// What was decided.
#[derive(Clone, Debug)]
pub struct Settings {
    /// The greatest error wanted, as a part of max |φ|.
    pub tolerance: f64,
    /// Whether one solution of many is an answer.
    pub general: bool,
    class: Option<Class>,
    /// A method by name; none to leave it to the program.
    method: Option<Setup>,
    n: Option<usize>,
    /// The most unknowns; none for a method by name, which has n, or grows by its own measure.
    pub unknowns: Option<usize>,
}

impl Settings {
    /// What the command line and the file say together.
    pub fn new(args: &Solve, file: &ProblemFile, problem: &Problem) -> Result<Self> {
        let domain = &problem.domain;
        let tolerance = args.tolerance.or(file.tolerance).unwrap_or(TOLERANCE);
        let class = either(args.class, file.class.as_ref())?.map(|ClassName(class)| class);
        let n = args.n.or(file.n);
        let unknowns = args.unknowns.or(file.unknowns);
        let method = either(args.method, file.method.as_ref())?;
        let space = either(args.space, file.space.as_ref())?;
        let rule = either(args.rule, file.rule.as_ref())?;
        match (domain, method) {
            (Domain::Plane(_), Some(method)) if method != Method::Nystrom => {
                bail!("{method} is for intervals; in the plane there is nystrom, with a rule of its own");
            }
            (Domain::Plane(_), _) if space.is_some() || rule.is_some() || class.is_some() => {
                bail!(
                    "class, space and rule are for intervals; in the plane there is nystrom, with a rule of its own"
                );
            }
            (Domain::Line(_), None) if space.is_some() || rule.is_some() || n.is_some() => {
                bail!("space, rule and n belong to a method; name it with --method");
            }
            (Domain::Line(_), Some(method)) if unknowns.is_some() => {
                bail!(
                    "{method} has --n; --unknowns is for equations that are solved without a method's name"
                );
            }
            _ => {}
        }
        let by_itself = matches!(domain, Domain::Plane(_)) || method.is_none();
        let dense = if let Domain::Plane(_) = domain { plane::DENSE } else { automatic::DENSE };
        let unknowns = by_itself.then_some(unknowns.unwrap_or(dense));
        let setup = |method| setup(method, space, rule, n, tolerance);
        let method = method.map(setup).transpose()?;
        Ok(Self { tolerance, general: args.general || file.general, class, method, n, unknowns })
    }

    /// Solves an equation on an interval.
    pub fn on_line<'e, 'a: 'e, T: FormulaValue>(
        &self,
        equation: &'e Equation<'a, T>,
    ) -> Result<Answer<'e, f64, T>, EquationError> {
        match &self.method {
            Some(setup) => methods::solve(equation, setup),
            None => automatic::solve_large(equation, &self.automatic()),
        }
    }

    fn automatic(&self) -> automatic::Options {
        let Self { tolerance, class, unknowns, .. } = *self;
        automatic::Options { tolerance, class, unknowns: unknowns.unwrap_or(automatic::DENSE) }
    }

    /// Solves an equation in the plane.
    pub fn in_plane<'e, T: FormulaValue>(
        &self,
        equation: &'e PlaneEquation<'_, T>,
    ) -> Result<Answer<'e, [f64; 2], T>, EquationError> {
        let Self { tolerance, n, unknowns, .. } = *self;
        plane::solve_large(
            equation,
            &plane::Options { tolerance, n, unknowns: unknowns.unwrap_or(plane::DENSE) },
        )
    }
}

/// The command line's choice, or the file's.
fn either<T: FromStr<Err: Display>>(args: Option<T>, file: Option<&Said>) -> Result<Option<T>> {
    match args {
        Some(choice) => Ok(Some(choice)),
        None => file.map(Said::parse).transpose(),
    }
}

/// What a method is given; what it has no use for is refused.
fn setup(
    method: Method,
    space: Option<SpaceKind>,
    rule: Option<RuleKind>,
    n: Option<usize>,
    tolerance: f64,
) -> Result<Setup> {
    let (takes_space, takes_rule) = match method {
        Method::Nystrom => (false, true),
        Method::Neumann | Method::Successive => (false, false),
        _ => (true, false),
    };
    if space.is_some() && !takes_space {
        bail!("{method} has no space; leave --space out");
    }
    if rule.is_some() && !takes_rule {
        bail!("{method} has no rule; leave --rule out");
    }
    let space = space.unwrap_or_else(|| usual_space(method));
    Ok(Setup { method, space, rule: rule.unwrap_or(RuleKind::GaussLegendre), n, tolerance })
}

/// The space of high order in which a method is easiest: nodes for interpolation, an orthogonal basis for projection.
fn usual_space(method: Method) -> SpaceKind {
    match method {
        Method::Galerkin | Method::IteratedGalerkin | Method::LeastSquares => SpaceKind::Legendre,
        _ => SpaceKind::Chebyshev,
    }
}
