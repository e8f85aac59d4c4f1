//! ∫ g ≈ Σ_k w_k g(x_k): a quadrature rule is data, its nodes and its weights (paper, chapter 4).
//!
//! | paper | what | here |
//! |---|---|---|
//! | §4.1 | composite rules; order, Peano's kernel, error constant | [`Quadrature::composite`], [`simpson`], …; [`Peano`], [`Recurrence::order`] |
//! | §4.2 | Newton–Cotes | [`newton_cotes`], [`newton_cotes_open`] |
//! | §4.3 | orthogonal polynomials of any weight, and Gauss's rules | [`Recurrence`], [`gauss_legendre`], [`gauss_jacobi`], [`gauss_laguerre`], [`gauss_hermite`], … |
//! | §4.4 | Richardson, Romberg, Euler–Maclaurin | [`richardson`], [`romberg`], [`euler_maclaurin`], [`bernoulli`] |
//! | – | to a tolerance, over finite or infinite intervals | [`integrate`], [`Adaptive`] |
//! | – | in the plane | [`triangle`], [`conical`], [`rectangle`], [`disk`] |
//!
//! ```
//! use fredholm::quadrature::{Peano, Recurrence, gauss_legendre, integrate, simpson};
//!
//! // Simpson's rule has order 3, and E(f) = −(1/90) f⁗(ξ) on [−1, 1].
//! let rule = simpson(-1.0, 1.0, 1)?;
//! let peano = Peano::new(&rule, -1.0, 1.0, 10)?;
//! assert_eq!(peano.order(), 3);
//! assert!((peano.constant() + 1.0 / 90.0).abs() < 1e-16);
//!
//! // Gauss's rule for a weight of one's own: −ln x on (0, 1).
//! let rule = Recurrence::of_weight(5, |x| -x.ln(), 0.0, 1.0)?.gauss();
//! assert!((rule.integrate(|x| x.powi(9)) - 1e-2).abs() < 1e-15);
//!
//! // And whatever is left: to a tolerance.
//! let integral = integrate(|x| (-x).exp() / x.sqrt(), 0.0, f64::INFINITY)?;
//! assert!((integral.value - std::f64::consts::PI.sqrt()).abs() <= integral.error);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod adaptive;
mod bessel;
mod chebyshev;
mod composite;
mod discretized;
mod double_exponential;
mod end_form;
mod error;
mod euler_maclaurin;
mod golub_welsch;
mod integral;
mod jacobi;
mod kronrod;
mod laguerre;
mod legendre;
mod newton_cotes;
mod orthogonal;
mod peano;
mod phase;
mod plane;
mod reference;
mod romberg;
mod scaled;
mod triangle;
mod tridiagonal;

pub use adaptive::{Adaptive, integrate};
pub use chebyshev::{clenshaw_curtis, fejer, gauss_chebyshev_1, gauss_chebyshev_2};
pub use composite::{boole, midpoint, periodic_trapezoid, simpson, trapezoid};
pub use error::QuadratureError;
pub use euler_maclaurin::{bernoulli, euler_maclaurin};
pub use integral::{Integral, IntegrateError};
pub use jacobi::{gauss_jacobi, gauss_lobatto, gauss_radau};
pub use laguerre::{gauss_hermite, gauss_laguerre};
pub use legendre::gauss_legendre;
pub use newton_cotes::{newton_cotes, newton_cotes_open};
pub use orthogonal::Recurrence;
pub use peano::Peano;
pub use plane::{conical, disk, rectangle};
pub use romberg::{richardson, romberg};
pub use triangle::{MOST_SYMMETRIC, triangle};

/// Nodes x_k and weights w_k. The weights carry the measure of the domain: they add up to its length or area.
#[derive(Clone, Debug, PartialEq)]
pub struct Quadrature<P> {
    /// The nodes.
    pub nodes: Vec<P>,
    /// The weights, as many as nodes.
    pub weights: Vec<f64>,
}

impl<P> Quadrature<P> {
    /// Σ_k w_k g(x_k).
    pub fn integrate(&self, integrand: impl Fn(&P) -> f64) -> f64 {
        self.nodes.iter().zip(&self.weights).map(|(x, w)| w * integrand(x)).sum()
    }

    /// The rule on another domain: each node and weight through `map`, which multiplies the weight by its Jacobian.
    pub fn map<Q>(&self, map: impl Fn(&P, f64) -> (Q, f64)) -> Quadrature<Q> {
        let (nodes, weights) = self.nodes.iter().zip(&self.weights).map(|(x, w)| map(x, *w)).unzip();
        Quadrature { nodes, weights }
    }
}

/// A number of points or panels within its bounds.
fn check_size(rule: &'static str, given: usize, least: usize, most: usize) -> Result<(), QuadratureError> {
    match (least..=most).contains(&given) {
        true => Ok(()),
        false => Err(QuadratureError::Size { rule, given, least, most }),
    }
}
