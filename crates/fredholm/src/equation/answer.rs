//! What every method returns: a function, its error from the equation's own residual, and how far to trust it.

use super::Scalar;
use std::fmt;
use std::sync::Arc;

/// (component, point) ↦ value.
type Value<'a, P, T> = dyn Fn(usize, &P) -> T + Send + Sync + 'a;

/// A function of a point, with one or more components: a solution, a null function, an eigenfunction.
#[derive(Clone)]
pub struct Function<'a, P, T> {
    components: usize,
    value: Arc<Value<'a, P, T>>,
}

impl<'a, P, T: Scalar> Function<'a, P, T> {
    /// `value(c, x)` is component c at x.
    pub fn new(components: usize, value: impl Fn(usize, &P) -> T + Send + Sync + 'a) -> Self {
        Self { components, value: Arc::new(value) }
    }

    /// How many components it has.
    pub fn components(&self) -> usize {
        self.components
    }

    /// Its first component at x.
    pub fn at(&self, x: &P) -> T {
        self.component(0, x)
    }

    /// Component c < [`Self::components`] at x.
    pub fn component(&self, c: usize, x: &P) -> T {
        (self.value)(c, x)
    }
}

impl<P, T> fmt::Debug for Function<'_, P, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "function of {} component(s)", self.components)
    }
}

/// How the solving ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// The error estimate meets the tolerance.
    Converged,
    /// It does not; the answer is the best that was found.
    ToleranceNotMet,
    /// I − A has a null space, and f is not orthogonal to that of the adjoint (paper, th. 1.5).
    NoSolution,
    /// I − A has a null space, and f is orthogonal to that of the adjoint: a particular solution is given.
    NotUnique,
}

/// What kind of kernel it is: how smooth, and where it is not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Class {
    /// Many times differentiable, at the scale of the interval.
    Smooth,
    /// Smooth, and periodic together with the source.
    Periodic,
    /// Smooth, but steep at a scale much smaller than the interval.
    Peaked,
    /// Continuous, with a bend on the diagonal x = y: Green's functions.
    Kink,
    /// It jumps on the diagonal.
    Jump,
    /// It grows like ln |x − y|.
    Logarithmic,
    /// It behaves like |x − y|^exponent, with an exponent that is no whole number and above −1.
    Algebraic {
        /// The exponent.
        exponent: f64,
    },
}

/// What Fredholm's alternative says of an equation (paper, §1.1.4, th. 1.5).
#[derive(Clone, Debug)]
pub struct Alternative<'a, P, T> {
    /// A basis of the null space of I − A, orthonormal in L².
    pub null_functions: Vec<Function<'a, P, T>>,
    /// A basis of the null space of the adjoint, orthonormal in L².
    pub adjoint_null_functions: Vec<Function<'a, P, T>>,
    /// ⟨f, ψ_k⟩ for each of the adjoint's null functions: all must vanish for the equation to have a solution.
    pub solvability: Vec<T>,
    /// The smallest singular values of I − A in L², ascending: the first nullity of them are zero to rounding.
    pub singular_values: Vec<f64>,
    /// min_k |1 − λ_k|: the distance of 1 to the spectrum of A.
    pub distance_to_spectrum: f64,
}

/// The answer: a function with its error.
#[derive(Clone, Debug)]
pub struct Answer<'a, P, T> {
    /// How the solving ended.
    pub status: Status,
    /// The method and what it was given, in words: "nystrom, gauss-legendre".
    pub method: String,
    /// The kernel's class, where the method asks for it.
    pub class: Option<Class>,
    /// n: how many numbers were solved for.
    pub unknowns: usize,
    /// An estimate of max |φ − exact|, from the equation's residual.
    pub error_estimate: f64,
    /// ‖I − A‖∞ ‖(I − A)⁻¹‖∞ of the discrete equation: how much an error of f is amplified at most.
    pub condition: f64,
    /// φ; a particular solution where it is not unique.
    pub solution: Function<'a, P, T>,
    /// Fredholm's alternative, where I − A was found singular or close to it.
    pub alternative: Option<Alternative<'a, P, T>>,
}

impl<P, T: Scalar> Answer<'_, P, T> {
    /// φ(x), its first component.
    pub fn at(&self, x: &P) -> T {
        self.solution.at(x)
    }

    /// The dimension of the null space of I − A.
    pub fn nullity(&self) -> usize {
        self.alternative.as_ref().map_or(0, |alternative| alternative.null_functions.len())
    }
}
