//! The rules that Nyström's method can take, by their names (paper, chapter 4).

use crate::equation::EquationError;
use crate::quadrature::{
    Quadrature, clenshaw_curtis, fejer, gauss_legendre, gauss_lobatto, gauss_radau, midpoint, newton_cotes,
    periodic_trapezoid, trapezoid,
};
use std::fmt;
use std::str::FromStr;

/// A family of quadrature rules on an interval, one for each n.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RuleKind {
    /// n equal parts, the middle of each.
    Midpoint,
    /// n equal parts, n + 1 nodes.
    Trapezoid,
    /// n equal parts, two by two, n + 1 nodes.
    Simpson,
    /// n equal parts, taken `rank` by `rank`, n + 1 nodes.
    NewtonCotes(usize),
    /// n equal weights, for periodic functions.
    PeriodicTrapezoid,
    /// n nodes.
    GaussLegendre,
    /// n equal parts, this many Gauss nodes in each.
    CompositeGauss(usize),
    /// n nodes, the two ends among them.
    GaussLobatto,
    /// n nodes, the left end among them.
    GaussRadau,
    /// n nodes, the two ends among them.
    ClenshawCurtis,
    /// n nodes, without the ends.
    Fejer,
}

/// The families without a number.
const NAMES: [(RuleKind, &str); 9] = [
    (RuleKind::Midpoint, "midpoint"),
    (RuleKind::Trapezoid, "trapezoid"),
    (RuleKind::Simpson, "simpson"),
    (RuleKind::PeriodicTrapezoid, "periodic-trapezoid"),
    (RuleKind::GaussLegendre, "gauss-legendre"),
    (RuleKind::GaussLobatto, "gauss-lobatto"),
    (RuleKind::GaussRadau, "gauss-radau"),
    (RuleKind::ClenshawCurtis, "clenshaw-curtis"),
    (RuleKind::Fejer, "fejer"),
];

impl RuleKind {
    /// The rule on [a, b] for this n.
    ///
    /// # Errors
    ///
    /// [`EquationError::Method`] where there is no such rule.
    pub fn quadrature(self, a: f64, b: f64, n: usize) -> Result<Quadrature<f64>, EquationError> {
        let parts = self.parts();
        if n == 0 || self.nodes(n) == 0 || !n.is_multiple_of(parts) {
            return Err(EquationError::Method(format!(
                "{self} takes {parts} parts at a time: n = {n} is no multiple"
            )));
        }
        let rule = match self {
            Self::Midpoint => midpoint(a, b, n),
            Self::Trapezoid => trapezoid(a, b, n),
            Self::Simpson | Self::NewtonCotes(_) => {
                newton_cotes(parts, 0.0, 1.0).and_then(|rule| rule.composite(a, b, n / parts))
            }
            Self::CompositeGauss(points) => gauss_legendre(points, 0.0, 1.0).composite(a, b, n),
            Self::PeriodicTrapezoid => Ok(periodic_trapezoid(n, a, b)),
            Self::GaussLegendre => Ok(gauss_legendre(n, a, b)),
            Self::GaussLobatto => gauss_lobatto(n, a, b),
            Self::GaussRadau => gauss_radau(n, a, b),
            Self::ClenshawCurtis => clenshaw_curtis(n, a, b),
            Self::Fejer => Ok(fejer(n, a, b)),
        };
        rule.map_err(|error| EquationError::Method(error.to_string()))
    }

    /// n is a multiple of this number.
    pub fn parts(self) -> usize {
        match self {
            Self::Simpson => 2,
            Self::NewtonCotes(rank) => rank.max(1),
            _ => 1,
        }
    }

    /// The number of nodes for this n, or one more.
    pub(super) fn nodes(self, n: usize) -> usize {
        match self {
            Self::CompositeGauss(points) => points.saturating_mul(n),
            _ => n.saturating_add(1),
        }
    }
}

/// A name that is no rule's.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "no rule is called `{0}`: there are midpoint, trapezoid, simpson, newton-cotes-R of a rank R from 1 to 64, \
     periodic-trapezoid, gauss-legendre, gauss-legendre-K with K nodes on each of n parts, gauss-lobatto, gauss-radau, \
     clenshaw-curtis and fejer"
)]
pub struct UnknownRule(String);

impl FromStr for RuleKind {
    type Err = UnknownRule;

    fn from_str(name: &str) -> Result<Self, UnknownRule> {
        if let Some((rule, _)) = NAMES.iter().find(|(_, known)| *known == name) {
            return Ok(*rule);
        }
        let number = |family: &str| -> Option<usize> { name.strip_prefix(family)?.parse().ok() };
        let rank = number("newton-cotes-").filter(|rank| (1..=64).contains(rank)).map(Self::NewtonCotes);
        let points = number("gauss-legendre-").filter(|points| (1..=64).contains(points));
        rank.or(points.map(Self::CompositeGauss)).ok_or_else(|| UnknownRule(name.to_owned()))
    }
}

impl fmt::Display for RuleKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NewtonCotes(rank) => write!(f, "newton-cotes-{rank}"),
            Self::CompositeGauss(points) => write!(f, "gauss-legendre-{points}"),
            _ => f.write_str(NAMES.iter().find(|(rule, _)| rule == self).map_or("", |(_, name)| name)),
        }
    }
}
