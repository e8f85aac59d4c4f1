//! What an integration gives: ∫ f ≈ value, |value − ∫ f| ≲ error.

use super::QuadratureError;

/// The integral of a function, with an estimate of its error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Integral {
    /// The value.
    pub value: f64,
    /// An estimate of |value − ∫ f|, rounding included.
    pub error: f64,
    /// How often f was asked for.
    pub evaluations: usize,
}

/// Why an integral is not to be had, or not to the tolerance.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum IntegrateError {
    /// The interval or the integrand.
    #[error(transparent)]
    Quadrature(#[from] QuadratureError),
    /// The error estimate stayed above the tolerance.
    #[error(
        "not integrated to the tolerance {tolerance:e}: {} with an estimated error of {:e} after {} evaluations; \
         cut the interval where the integrand is singular, or allow a larger error",
        best.value, best.error, best.evaluations
    )]
    NotConverged {
        /// The best that was found.
        best: Integral,
        /// What was asked for.
        tolerance: f64,
    },
}
