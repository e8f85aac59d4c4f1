//! φ_a(x) − Σ_b ∫ K_ab(x, y) φ_b(y) dy = f_a(x) on an interval: the equation as its user states it (paper, (1.7)).
//!
//! One equation or a system, real or complex, on a finite or infinite interval. What is found is an [`Answer`]: a
//! function, with its error.

mod answer;
mod scalar;

pub use answer::{Alternative, Answer, Class, Function, Status};
pub use num_complex::Complex64;
pub use scalar::Scalar;
pub(crate) use scalar::{all_parts, between_parts, of_all_parts};

/// A kernel K(x, y) on a line, evaluated for one x and many y at once.
///
/// Closures `Fn(f64, f64) -> T` are kernels. Where K is singular at x = y, doubles x and y close to each other do not
/// say how close: [`ByOffset`] is a kernel that is told y − x exactly.
pub trait LineKernel<T>: Sync + Send {
    /// `row[j]` = K(x, y_j), where `offset[j]` is y_j − x, exact also where the subtraction would cancel.
    fn row(&self, x: f64, y: &[f64], offset: &[f64], row: &mut [T]);

    /// Whether `offset` is made use of. Otherwise y is never x itself where `offset` is not 0, but a double beside it, and
    /// the error of a singular kernel's integral has the rounding of y in it.
    fn takes_offset(&self) -> bool {
        false
    }
}

impl<T, K: Fn(f64, f64) -> T + Sync + Send> LineKernel<T> for K {
    fn row(&self, x: f64, y: &[f64], _: &[f64], row: &mut [T]) {
        row.iter_mut().zip(y).for_each(|(entry, y)| *entry = self(x, *y));
    }
}

/// The kernel K(x, y) = closure(x, y, y − x): for singular kernels, which need the exact difference.
#[derive(Clone, Copy, Debug)]
pub struct ByOffset<K>(pub K);

impl<T, K: Fn(f64, f64, f64) -> T + Sync + Send> LineKernel<T> for ByOffset<K> {
    fn row(&self, x: f64, y: &[f64], offset: &[f64], row: &mut [T]) {
        let points = y.iter().zip(offset);
        row.iter_mut().zip(points).for_each(|(entry, (y, offset))| *entry = self.0(x, *y, *offset));
    }

    fn takes_offset(&self) -> bool {
        true
    }
}

/// K(y, x)*.
struct Adjoint<'k, T>(&'k dyn LineKernel<T>);

impl<T: Scalar> LineKernel<T> for Adjoint<'_, T> {
    fn row(&self, x: f64, y: &[f64], offset: &[f64], row: &mut [T]) {
        for ((entry, y), offset) in row.iter_mut().zip(y).zip(offset) {
            let mut value = [T::ZERO];
            self.0.row(*y, &[x], &[-offset], &mut value);
            *entry = value[0].conjugate();
        }
    }

    fn takes_offset(&self) -> bool {
        self.0.takes_offset()
    }
}

/// A source f(x).
pub trait Source<T>: Fn(f64) -> T + Sync + Send {}
impl<T, F: Fn(f64) -> T + Sync + Send> Source<T> for F {}

/// Where the equation holds: a < b, either of which may be infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    a: f64,
    b: f64,
}

impl Interval {
    /// The interval from a to b.
    pub fn new(a: f64, b: f64) -> Result<Self, EquationError> {
        // NaN is not less than anything.
        if a < b { Ok(Self { a, b }) } else { Err(EquationError::EmptyInterval { a, b }) }
    }

    /// Its left end.
    pub fn a(&self) -> f64 {
        self.a
    }

    /// Its right end.
    pub fn b(&self) -> f64 {
        self.b
    }

    /// Whether both ends are finite.
    pub fn is_finite(&self) -> bool {
        self.a.is_finite() && self.b.is_finite()
    }
}

/// The equation φ = f + ∫ K φ, or a system of m of them for φ_1 … φ_m.
pub struct Equation<'a, T> {
    interval: Interval,
    kernels: Vec<Box<dyn LineKernel<T> + 'a>>,
    sources: Vec<Box<dyn Source<T> + 'a>>,
}

/// What is no equation, or has no answer in numbers.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum EquationError {
    /// b is not greater than a.
    #[error("the interval from {a} to {b} is empty: its first end must be the lesser")]
    EmptyInterval {
        /// The first end.
        a: f64,
        /// The second end.
        b: f64,
    },
    /// A system of m sources needs m × m kernels.
    #[error(
        "{kernels} kernels for {sources} sources: a system of m equations has m sources and m × m kernels"
    )]
    Shape {
        /// How many kernels were given.
        kernels: usize,
        /// How many sources were given.
        sources: usize,
    },
    /// The source is infinite or NaN where it was sampled.
    #[error("the source is {value} at x = {x}")]
    SourceNotFinite {
        /// Where.
        x: f64,
        /// What it is there.
        value: String,
    },
    /// The kernel is infinite or NaN where it was sampled.
    #[error(
        "the kernel is {value} at x = {x}, y = {y}: on the diagonal x = y, take collocation or the automatic method; elsewhere \
         none can integrate it"
    )]
    KernelNotFinite {
        /// Where.
        x: f64,
        /// Where.
        y: f64,
        /// What it is there.
        value: String,
    },
    /// A domain of the plane without a finite, positive area.
    #[error("\"{domain}\" has no finite and positive area")]
    EmptyDomain {
        /// As it was given.
        domain: String,
    },
    /// A text that is no domain of the plane.
    #[error(
        "\"{text}\": {why}; write \"rectangle x0 x1 y0 y1\", \"triangle x1 y1 x2 y2 x3 y3\" or \"disk cx cy r\""
    )]
    UnknownDomain {
        /// What was read.
        text: String,
        /// What is wrong with it.
        why: String,
    },
    /// The source is infinite or NaN at a point of the plane where it was sampled.
    #[error("the source is {value} at (x, y) = ({}, {})", .p[0], .p[1])]
    PlaneSourceNotFinite {
        /// Where.
        p: [f64; 2],
        /// What it is there.
        value: String,
    },
    /// The kernel is infinite or NaN at points of the plane where it was sampled.
    #[error(
        "the kernel is {value} at (x, y) = ({}, {}), (s, t) = ({}, {}): in the plane only kernels are integrated that are finite but \
         at p = q",
        .p[0], .p[1], .q[0], .q[1]
    )]
    PlaneKernelNotFinite {
        /// Where.
        p: [f64; 2],
        /// Where.
        q: [f64; 2],
        /// What it is there.
        value: String,
    },
    /// A method cannot do what is asked of it.
    #[error("{0}")]
    Method(String),
}

impl<'a, T: Scalar> Equation<'a, T> {
    /// φ(x) − ∫ K(x, y) φ(y) dy = f(x) on `interval`.
    pub fn new(interval: Interval, kernel: impl LineKernel<T> + 'a, source: impl Source<T> + 'a) -> Self {
        Self { interval, kernels: vec![Box::new(kernel)], sources: vec![Box::new(source)] }
    }

    /// The system φ_a(x) − Σ_b ∫ K_ab(x, y) φ_b(y) dy = f_a(x); `kernels` row by row, m × m of them.
    pub fn system(
        interval: Interval,
        kernels: Vec<Box<dyn LineKernel<T> + 'a>>,
        sources: Vec<Box<dyn Source<T> + 'a>>,
    ) -> Result<Self, EquationError> {
        if sources.is_empty() || kernels.len() != sources.len() * sources.len() {
            return Err(EquationError::Shape { kernels: kernels.len(), sources: sources.len() });
        }
        Ok(Self { interval, kernels, sources })
    }

    /// Where the equation holds.
    pub fn interval(&self) -> Interval {
        self.interval
    }

    /// m: how many functions are unknown.
    pub fn components(&self) -> usize {
        self.sources.len()
    }

    /// K_ab.
    pub fn kernel(&self, a: usize, b: usize) -> &(dyn LineKernel<T> + 'a) {
        &*self.kernels[a * self.components() + b]
    }

    /// The homogeneous equation of the adjoint, ψ_a(x) − Σ_b ∫ K_ba(y, x)* ψ_b(y) dy = 0 (paper, §1.1.2, (1.6) mended).
    pub fn adjoint(&self) -> Equation<'_, T> {
        let m = self.components();
        let transposed =
            |k: usize| -> Box<dyn LineKernel<T> + '_> { Box::new(Adjoint(self.kernel(k % m, k / m))) };
        let zero = || -> Box<dyn Source<T>> { Box::new(|_| T::ZERO) };
        Equation {
            interval: self.interval,
            kernels: (0..m * m).map(transposed).collect(),
            sources: (0..m).map(|_| zero()).collect(),
        }
    }

    /// f_a(x).
    pub fn source(&self, a: usize, x: f64) -> T {
        (self.sources[a])(x)
    }
}

impl<T> std::fmt::Debug for Equation<'_, T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} equation(s) on [{}, {}]", self.sources.len(), self.interval.a, self.interval.b)
    }
}
