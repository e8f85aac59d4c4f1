//! The rules that Nyström's method can take, by their names (paper, chapter 4).

use crate::equation::EquationError;
use crate::quadrature::{Quadrature, gauss_legendre};
use crate::space::equal_parts;
use std::fmt;
use std::str::FromStr;

/// A family of quadrature rules on an interval, one for each n.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RuleKind {
    /// n equal parts, the middle of each.
    Midpoint,
    /// n equal parts, n + 1 nodes.
    Trapezoid,
    /// n equal parts, n even, n + 1 nodes.
    Simpson,
    /// n nodes.
    GaussLegendre,
}

impl RuleKind {
    const ALL: [(Self, &'static str); 4] = [
        (Self::Midpoint, "midpoint"),
        (Self::Trapezoid, "trapezoid"),
        (Self::Simpson, "simpson"),
        (Self::GaussLegendre, "gauss-legendre"),
    ];

    /// The rule on [a, b] for this n.
    pub fn quadrature(self, a: f64, b: f64, n: usize) -> Result<Quadrature<f64>, EquationError> {
        let h = (b - a) / n as f64;
        let ends = |k: usize, end: f64, inside: f64| if k == 0 || k == n { end * h } else { inside * h };
        match self {
            _ if n == 0 => Err(EquationError::Method(format!("the rule {self} needs n ≥ 1"))),
            Self::GaussLegendre => Ok(gauss_legendre(n, a, b)),
            Self::Midpoint => {
                let nodes = equal_parts(a, b, n).windows(2).map(|edge| 0.5 * (edge[0] + edge[1])).collect();
                Ok(Quadrature { nodes, weights: vec![h; n] })
            }
            Self::Trapezoid => {
                let weights = (0..=n).map(|k| ends(k, 0.5, 1.0)).collect();
                Ok(Quadrature { nodes: equal_parts(a, b, n), weights })
            }
            Self::Simpson if n.is_multiple_of(2) => {
                let inside = |k: usize| if k.is_multiple_of(2) { 2.0 / 3.0 } else { 4.0 / 3.0 };
                let weights = (0..=n).map(|k| ends(k, 1.0 / 3.0, inside(k))).collect();
                Ok(Quadrature { nodes: equal_parts(a, b, n), weights })
            }
            Self::Simpson => Err(EquationError::Method(format!(
                "Simpson's rule takes its n parts two by two: n must be even, not {n}"
            ))),
        }
    }
}

/// A name that is no rule's.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no rule is called `{0}`: there are midpoint, trapezoid, simpson and gauss-legendre")]
pub struct UnknownRule(String);

impl FromStr for RuleKind {
    type Err = UnknownRule;

    fn from_str(name: &str) -> Result<Self, UnknownRule> {
        let found = Self::ALL.iter().find(|(_, known)| *known == name);
        found.map(|(rule, _)| *rule).ok_or_else(|| UnknownRule(name.to_owned()))
    }
}

impl fmt::Display for RuleKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = Self::ALL.iter().find(|(rule, _)| rule == self).map_or("", |(_, name)| name);
        f.write_str(name)
    }
}
