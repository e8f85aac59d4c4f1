//! Which of the paper's methods (chapter 1), with which space or rule, how large, and how exact.

use super::RuleKind;
use crate::space::SpaceKind;
use std::fmt;
use std::str::FromStr;

/// The methods by their names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Method {
    /// [`super::nystrom`]
    Nystrom,
    /// [`super::collocation`]
    Collocation,
    /// [`super::collocation`], iterated
    IteratedCollocation,
    /// [`super::galerkin`]
    Galerkin,
    /// [`super::galerkin`], iterated
    IteratedGalerkin,
    /// [`super::least_squares`]
    LeastSquares,
    /// [`super::degenerate`]
    Degenerate,
    /// [`super::neumann`]
    Neumann,
    /// [`super::successive`]
    Successive,
}

/// What a method by name is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setup {
    /// The method.
    pub method: Method,
    /// The space, for collocation, Galerkin, least squares and the degenerate kernel.
    pub space: SpaceKind,
    /// The rule, for Nyström.
    pub rule: RuleKind,
    /// n: what [`SpaceKind::basis`] or [`RuleKind::quadrature`] makes of it; terms or steps for the Neumann series and
    /// successive approximations. `None`: it grows until the error estimate meets the tolerance.
    pub n: Option<usize>,
    /// The error estimate to be reached, as a part of max |φ|.
    pub tolerance: f64,
}

impl Method {
    /// All methods, in the paper's order.
    pub const ALL: [Self; 9] = [
        Self::Neumann,
        Self::Successive,
        Self::Nystrom,
        Self::Degenerate,
        Self::Collocation,
        Self::IteratedCollocation,
        Self::LeastSquares,
        Self::Galerkin,
        Self::IteratedGalerkin,
    ];

    fn name(self) -> &'static str {
        match self {
            Self::Nystrom => "nystrom",
            Self::Collocation => "collocation",
            Self::IteratedCollocation => "iterated-collocation",
            Self::Galerkin => "galerkin",
            Self::IteratedGalerkin => "iterated-galerkin",
            Self::LeastSquares => "least-squares",
            Self::Degenerate => "degenerate",
            Self::Neumann => "neumann",
            Self::Successive => "successive",
        }
    }
}

/// A name that is no method's.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "no method is called `{0}`: there are nystrom, collocation, iterated-collocation, galerkin, iterated-galerkin, \
     least-squares, degenerate, neumann and successive"
)]
pub struct UnknownMethod(String);

impl FromStr for Method {
    type Err = UnknownMethod;

    fn from_str(name: &str) -> Result<Self, UnknownMethod> {
        let found = Self::ALL.into_iter().find(|method| method.name() == name);
        found.ok_or_else(|| UnknownMethod(name.to_owned()))
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
