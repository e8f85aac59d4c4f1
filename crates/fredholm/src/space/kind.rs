//! The spaces by their names: p0, p1, p2, …, chebyshev, legendre, fourier.

use super::{Basis, Piecewise, Polynomial, Trigonometric};
use std::fmt;
use std::str::FromStr;
use std::sync::Arc;

/// A family of spaces on an interval, one for each n.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SpaceKind {
    /// [`Piecewise`] polynomials of this degree, at most 15, on n equal elements.
    Piecewise(usize),
    /// [`Polynomial`]s by their values at n Chebyshev nodes.
    Chebyshev,
    /// [`Polynomial`]s by their values at n Gauss nodes: an orthogonal basis.
    Legendre,
    /// [`Trigonometric`] polynomials with n coefficients, for periodic equations.
    Fourier,
}

/// The highest degree on an element: that of [`crate::product::Product::row`], and where equidistant nodes are still harmless
/// (Lebesgue constant 512 at degree 15).
const HIGHEST_DEGREE: usize = 15;

impl SpaceKind {
    /// The space of this kind on [a, b] for a given n ≥ 1: elements for p0, p1, …, dimensions for the others.
    pub fn basis(self, a: f64, b: f64, n: usize) -> Arc<dyn Basis> {
        let n = n.max(1);
        match self {
            Self::Piecewise(degree) => Arc::new(Piecewise::new(a, b, degree.min(HIGHEST_DEGREE), n)),
            Self::Chebyshev => Arc::new(Polynomial::chebyshev(a, b, n)),
            Self::Legendre => Arc::new(Polynomial::legendre(a, b, n)),
            Self::Fourier => Arc::new(Trigonometric::new(a, b, n)),
        }
    }

    /// The dimension of the space for this n.
    pub fn dim(self, n: usize) -> usize {
        match self {
            Self::Piecewise(0) | Self::Chebyshev | Self::Legendre | Self::Fourier => n,
            Self::Piecewise(degree) => degree * n + 1,
        }
    }
}

/// A name that is no space's.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no space is called `{0}`: there are p0, p1, p2, … p15, chebyshev, legendre and fourier")]
pub struct UnknownSpace(String);

impl FromStr for SpaceKind {
    type Err = UnknownSpace;

    fn from_str(name: &str) -> Result<Self, UnknownSpace> {
        match name {
            "chebyshev" => Ok(Self::Chebyshev),
            "legendre" => Ok(Self::Legendre),
            "fourier" => Ok(Self::Fourier),
            _ => {
                let degree = name.strip_prefix('p').and_then(|degree| degree.parse().ok());
                let degree = degree.filter(|degree| *degree <= HIGHEST_DEGREE);
                degree.map(Self::Piecewise).ok_or_else(|| UnknownSpace(name.to_owned()))
            }
        }
    }
}

impl fmt::Display for SpaceKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Piecewise(degree) => write!(f, "p{degree}"),
            Self::Chebyshev => f.write_str("chebyshev"),
            Self::Legendre => f.write_str("legendre"),
            Self::Fourier => f.write_str("fourier"),
        }
    }
}
