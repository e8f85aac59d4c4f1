//! ∫ g = ∫ g(x(u)) x′(u) du ≈ h Σ_k g(x(kh)) x′(kh): the trapezoidal rule after a change of variable that makes every
//! integrand vanish doubly exponentially at both ends, singular ones too (H. Takahasi, M. Mori, 1974).

use super::{Quadrature, QuadratureError};
use std::f64::consts::FRAC_PI_2;

/// An interval of which one end or both may be infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Interval {
    /// tanh: from a to b.
    Finite(f64, f64),
    /// exp: from a towards ∞ (1.0) or −∞ (−1.0).
    Half(f64, f64),
    /// sinh: from −∞ to ∞.
    Line,
}

impl Interval {
    /// From a to b, a < b.
    pub(super) fn new(a: f64, b: f64) -> Result<Self, QuadratureError> {
        let domain =
            |given, expected| QuadratureError::Domain { what: "the interval's end", given, expected };
        if a.is_nan() || b.is_nan() {
            return Err(domain(f64::NAN, "give a number, or ±inf"));
        }
        if a >= b {
            return Err(domain(b, "it must lie above the beginning"));
        }
        Ok(match (a.is_finite(), b.is_finite()) {
            (true, true) => Self::Finite(a, b),
            (true, false) => Self::Half(a, 1.0),
            (false, true) => Self::Half(b, -1.0),
            (false, false) => Self::Line,
        })
    }

    /// (x, x′) at u.
    pub(super) fn at(self, u: f64) -> (f64, f64) {
        let (s, slope) = (FRAC_PI_2 * u.sinh(), FRAC_PI_2 * u.cosh());
        match self {
            Self::Finite(a, b) => {
                let half = 0.5 * (b - a);
                // 1 − tanh|s|, the distance from the nearer end.
                let t = 2.0 / (1.0 + (2.0 * s.abs()).exp());
                let x = if s < 0.0 { a + half * t } else { b - half * t };
                (x, half * t * (2.0 - t) * slope)
            }
            Self::Half(end, sign) => (end + sign * s.exp(), s.exp() * slope),
            Self::Line => (s.sinh(), s.cosh() * slope),
        }
    }

    /// Whether x lies inside, as rounded.
    pub(super) fn contains(self, x: f64) -> bool {
        match self {
            Self::Finite(a, b) => a < x && x < b,
            Self::Half(end, sign) => x.is_finite() && (x - end) * sign > 0.0,
            Self::Line => x.is_finite(),
        }
    }

    /// The nodes inside with step 1/`per_unit`; where the map leaves the range of numbers there is nothing more.
    pub(super) fn rule(self, per_unit: usize) -> Quadrature<f64> {
        let h = 1.0 / per_unit as f64;
        let reach = (REACH / h) as i32;
        let points = (-reach..=reach).map(|k| self.at(f64::from(k) * h));
        let inside = points.filter(|(x, slope)| self.contains(*x) && slope.is_finite() && *slope > 0.0);
        let (nodes, weights) = inside.map(|(x, slope)| (x, slope * h)).unzip();
        Quadrature { nodes, weights }
    }
}

/// At u = 6.11 exp(2 · π/2 sinh u) is 1e308.
pub(super) const REACH: f64 = 6.11;
