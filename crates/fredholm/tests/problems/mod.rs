//! Equations with known solutions, one after another, for every class of kernel: what the solvers are judged by.
//!
//! φ(x) − ∫ K(x, y) φ(y) dy = f(x), with f in closed form and stable in double precision. S, P smooth and periodic;
//! D bent on the diagonal; J with a jump there; L, A, B logarithmic, algebraic, one-sided; I on infinite intervals.
//! `catalogue.rs` holds every one against its equation.
#![allow(dead_code, reason = "no test needs all of them")]

pub mod alternative;
mod diagonal;
mod infinite;
mod periodic;
mod singular;
mod smooth;
pub mod special;
pub mod systems;

use fredholm::equation::{Class, Equation, Interval, LineKernel, Scalar};

pub type Kernel<T> = Box<dyn LineKernel<T>>;
pub type OfX<T> = Box<dyn Fn(f64) -> T + Send + Sync>;

/// An equation with its solution.
pub struct Problem<T = f64> {
    pub id: &'static str,
    /// What the kernel is, whatever a solver finds.
    pub class: Class,
    /// Its ends, perhaps infinite.
    pub interval: [f64; 2],
    pub kernel: Kernel<T>,
    pub source: OfX<T>,
    pub exact: OfX<T>,
}

/// All equations of one real unknown that have one solution.
pub fn all() -> Vec<Problem> {
    [smooth::all(), periodic::all(), diagonal::all(), singular::all(), infinite::all()]
        .into_iter()
        .flatten()
        .collect()
}

/// The one of that name.
pub fn problem(id: &str) -> Problem {
    all().into_iter().find(|problem| problem.id == id).unwrap_or_else(|| panic!("no problem is called {id}"))
}

impl<T: Scalar> Problem<T> {
    fn new(
        id: &'static str,
        class: Class,
        interval: [f64; 2],
        kernel: impl LineKernel<T> + 'static,
        source: impl Fn(f64) -> T + Send + Sync + 'static,
        exact: impl Fn(f64) -> T + Send + Sync + 'static,
    ) -> Self {
        let (kernel, source, exact) = (Box::new(kernel), Box::new(source), Box::new(exact));
        Self { id, class, interval, kernel, source, exact }
    }

    /// As a solver takes it.
    pub fn equation(&self) -> Equation<'_, T> {
        let [a, b] = self.interval;
        Equation::new(Interval::new(a, b).unwrap(), Borrowed(&*self.kernel), &self.source)
    }
}

/// A kernel that lives elsewhere.
pub struct Borrowed<'a, T>(pub &'a dyn LineKernel<T>);

impl<T> LineKernel<T> for Borrowed<'_, T> {
    fn row(&self, x: f64, y: &[f64], offset: &[f64], row: &mut [T]) {
        self.0.row(x, y, offset, row);
    }

    fn takes_offset(&self) -> bool {
        self.0.takes_offset()
    }
}
