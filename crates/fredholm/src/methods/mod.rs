//! φ_n ≈ φ: each of the paper's methods by name, on a finite interval (paper, chapter 1).
//!
//! | method | what it solves | module |
//! |---|---|---|
//! | Neumann series, successive approximations | φ_n = Σ A^k f | [`neumann`], [`successive`] |
//! | Nyström | φ_n = f + A_n φ_n, A_n by a rule | [`nystrom`] |
//! | degenerate kernel | φ_n = f + A_n φ_n, K_n(x, y) = Σ a_j(x) b_j(y) | [`degenerate`] |
//! | collocation | φ_n = P_n f + P_n A φ_n, P_n interpolates | [`collocation`] |
//! | Galerkin | the same, P_n projects orthogonally | [`galerkin`] |
//! | least squares | min ‖φ_n − A φ_n − f‖ | [`least_squares`] |
//! | iterated | f + A φ_n | [`iterated`] |
//!
//! ```
//! use fredholm::equation::{Equation, Interval, Status};
//! use fredholm::methods::{self, Method, RuleKind, Setup};
//! use fredholm::space::SpaceKind;
//!
//! let source = |x: f64| (-x).exp() - 0.5 + (-(x + 1.0)).exp() / 2.0;
//! let equation = Equation::new(Interval::new(0.0, 1.0)?, |x: f64, y: f64| (x + 1.0) * (-x * y).exp() / 2.0, source);
//! let setup = Setup {
//!     method: Method::IteratedGalerkin,
//!     space: SpaceKind::Piecewise(1),
//!     rule: RuleKind::GaussLegendre,
//!     n: None,
//!     tolerance: 1e-8,
//! };
//! let answer = methods::solve(&equation, &setup)?;
//! assert_eq!(answer.status, Status::Converged);
//! let error: f64 = answer.at(&0.3) - (-0.3_f64).exp();
//! assert!(error.abs() <= answer.error_estimate);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod collocation;
pub mod degenerate;
mod discrete;
pub mod galerkin;
mod growth;
mod integrals;
pub mod iterated;
pub mod least_squares;
pub mod neumann;
mod norm;
pub mod nystrom;
mod radius;
mod residual;
mod rule;
mod series;
mod setup;
pub mod successive;
mod yardstick;

pub use discrete::Discrete;
pub use integrals::Integrals;
pub use norm::operator_norm;
pub use radius::spectral_radius;
pub use residual::{Judgement, judge};
pub use rule::{RuleKind, UnknownRule};
pub use setup::{Method, Setup, UnknownMethod};
pub use yardstick::Yardstick;

use crate::equation::{Answer, Equation, EquationError, Function, Scalar};
use crate::product::Product;
use crate::space::{Basis, combination};
use discrete::Coefficients;
use std::sync::Arc;

/// A method's answer before its error is known.
#[derive(Clone, Debug)]
pub struct Approximation<'a, T> {
    /// φ_n.
    pub solution: Function<'a, f64, T>,
    /// Where φ_n may bend: it is smooth from one of them to the next, apart from what f and K bring along.
    pub breaks: Vec<f64>,
    /// How many numbers were solved for.
    pub unknowns: usize,
    /// ‖I − F‖∞ ‖(I − F)⁻¹‖∞ of the discrete equation.
    pub condition: f64,
}

impl<'a, T: Scalar> Approximation<'a, T> {
    /// Σ_j c_j u_j, the coefficients component by component.
    fn in_space(components: usize, basis: Arc<dyn Basis>, coefficients: Coefficients<T>) -> Self {
        let (n, breaks) = (basis.dim(), basis.breaks().to_vec());
        let (unknowns, c) = (coefficients.values.len(), coefficients.values);
        let value =
            move |a: usize, x: &f64| combination(&*basis, &c[a * n..][..n], *x, &mut Vec::with_capacity(n));
        let solution = Function::new(components, value);
        Self { solution, breaks, unknowns, condition: coefficients.condition }
    }
}

/// The solution of the equation by the method of the setup, with its error from the residual.
///
/// # Errors
///
/// [`EquationError::Method`] for an infinite interval, a size that makes no rule or needs too much memory, and an I − A that is
/// singular to rounding; [`EquationError::KernelNotFinite`] and [`EquationError::SourceNotFinite`] where the method meets such
/// values.
pub fn solve<'e, T: Scalar>(
    equation: &'e Equation<'e, T>,
    setup: &Setup,
) -> Result<Answer<'e, f64, T>, EquationError> {
    if !equation.interval().is_finite() {
        return Err(EquationError::Method(format!(
            "{} needs a finite interval: the automatic method takes infinite ones",
            setup.method
        )));
    }
    let product = Arc::new(Product::new(equation, None)?);
    let yardstick = Yardstick::new(&product)?;
    match (setup.method, setup.n) {
        (Method::Neumann | Method::Successive, _) => series::solve(&product, setup, yardstick),
        // Of an equation that is singular itself, a coarse discretisation would give one answer of many, or of none.
        _ if yardstick.condition() > NEARLY_SINGULAR => Err(discrete::singular(yardstick.condition())),
        (_, Some(n)) => growth::at(&product, setup, &yardstick, n),
        (_, None) => growth::grow(&product, setup, &yardstick),
    }
}

/// A condition of the resolved equation from where on no digit of an answer is sure to a thousandth.
const NEARLY_SINGULAR: f64 = 1e13;
