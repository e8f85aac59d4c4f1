//! φ = f + ∫ K φ, from formulas typed on a command line or in a file to an equation of the library.

pub mod args;
mod file;
mod formulas;
mod number;
mod points;
mod said;
mod statement;

pub use file::ProblemFile;
pub use formulas::constant;
pub use number::{FormulaValue, Number};
pub use points::{Points, contains, equally_spaced, line_points, plane_points};
pub use said::Said;
pub use statement::Statement;

use crate::text::short;
use anyhow::{Result, bail};
use expression::Formula;
use formulas::FormulaKernel;
use fredholm::equation::{Equation, EquationError, Interval, LineKernel, Source};
use fredholm::plane::{self, PlaneEquation};

/// Where an equation holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Domain {
    /// An interval, finite or not.
    Line(Interval),
    /// A domain of the plane.
    Plane(plane::Domain),
}

/// An equation, its formulas compiled.
#[derive(Debug)]
pub struct Problem {
    /// Where it holds.
    pub domain: Domain,
    /// Kernels, row by row.
    kernels: Vec<Formula>,
    sources: Vec<Formula>,
    exact: Vec<Formula>,
    /// "φ(x) = … + ∫ … φ(y) dy", for titles.
    pub title: String,
}

impl Problem {
    /// Compiles what was stated.
    pub fn new(statement: &Statement) -> Result<Self> {
        let domain = domain(statement)?;
        let parameters = &statement.parameters;
        let is_line = matches!(domain, Domain::Line(_));
        let kernel = if is_line { formulas::line_kernel } else { formulas::plane_kernel };
        let variables: &[&str] = if is_line { &["x"] } else { &["x", "y"] };
        let all = |said: &[Said]| -> Result<Vec<Formula>> {
            said.iter().map(|said| formulas::formula(said, variables, parameters)).collect()
        };
        let problem = Self {
            domain,
            kernels: statement.kernels.iter().map(|said| kernel(said, parameters)).collect::<Result<_>>()?,
            sources: all(&statement.sources)?,
            exact: all(&statement.exact)?,
            title: title(statement, domain),
        };
        problem.check()?;
        Ok(problem)
    }

    fn check(&self) -> Result<()> {
        if self.kernels.is_empty() {
            bail!("the file has no `kernel`; write one, or give --kernel");
        }
        if !self.exact.is_empty() && self.exact.len() != self.components() {
            bail!("{} solutions are given for {} unknown functions", self.exact.len(), self.components());
        }
        if matches!(self.domain, Domain::Plane(_)) && self.kernels.len() > 1 {
            bail!("systems are solved on intervals, and a single equation in the plane");
        }
        Ok(())
    }

    /// Whether any of the formulas is complex.
    pub fn is_complex(&self) -> bool {
        let mut formulas = self.kernels.iter().chain(&self.sources).chain(&self.exact);
        formulas.any(Formula::is_complex)
    }

    /// How many functions are unknown.
    pub fn components(&self) -> usize {
        self.kernels.len().isqrt()
    }

    /// Whether the solution is known.
    pub fn has_exact(&self) -> bool {
        !self.exact.is_empty()
    }

    /// Component c of the known solution.
    pub fn exact<T: FormulaValue>(&self, c: usize, point: &[f64]) -> T {
        T::at(&self.exact[c], point)
    }

    /// As an equation on an interval.
    pub fn equation<T: FormulaValue>(&self, interval: Interval) -> Result<Equation<'_, T>> {
        if self.sources.is_empty() {
            bail!("the file has no `source`; write one, or give --source");
        }
        let sources = self.sources.iter().map(|f| Box::new(|x: f64| T::at(f, &[x])) as Box<dyn Source<T>>);
        Ok(self.system(interval, sources.collect())?)
    }

    /// As an equation φ = λ⁻¹ ∫ K φ for its eigenvalues λ.
    pub fn homogeneous<T: FormulaValue>(&self, interval: Interval) -> Result<Equation<'_, T>> {
        let source = || Box::new(|_: f64| T::ZERO) as Box<dyn Source<T>>;
        Ok(self.system(interval, (0..self.components()).map(|_| source()).collect())?)
    }

    fn system<'a, T: FormulaValue>(
        &'a self,
        interval: Interval,
        sources: Vec<Box<dyn Source<T> + 'a>>,
    ) -> Result<Equation<'a, T>, EquationError> {
        let kernels = self.kernels.iter().map(|k| Box::new(FormulaKernel(k)) as Box<dyn LineKernel<T> + 'a>);
        Equation::system(interval, kernels.collect(), sources)
    }

    /// As an equation in the plane.
    pub fn plane_equation<T: FormulaValue>(&self, domain: plane::Domain) -> Result<PlaneEquation<'_, T>> {
        let [source] = self.sources.as_slice() else {
            bail!("an equation in the plane has one source, and {} are given", self.sources.len());
        };
        Ok(PlaneEquation::new(domain, FormulaKernel(&self.kernels[0]), |p: [f64; 2]| T::at(source, &p)))
    }
}

fn domain(statement: &Statement) -> Result<Domain> {
    if let Some(said) = &statement.domain {
        return Ok(Domain::Plane(said.parse()?));
    }
    let Some([a, b]) = &statement.interval else { return Ok(Domain::Line(Interval::new(0.0, 1.0)?)) };
    let end = |said| constant(said, &statement.parameters);
    Ok(Domain::Line(Interval::new(end(a)?, end(b)?).map_err(|error| a.error(error))?))
}

/// The equation as a line of text.
fn title(statement: &Statement, domain: Domain) -> String {
    let place = match domain {
        Domain::Line(interval) => line(interval),
        Domain::Plane(domain) => format!("the {domain}"),
    };
    let parameters = statement.parameters.iter().map(|(name, value)| format!(", {name} = {value}"));
    let parameters: String = parameters.collect();
    match (statement.kernels.as_slice(), statement.sources.as_slice()) {
        ([kernel], [source]) => {
            format!("φ = f + ∫ K φ on {place}, K = {}, f = {}{parameters}", kernel.text, source.text)
        }
        ([kernel], _) => format!("λ φ = ∫ K φ on {place}, K = {}{parameters}", kernel.text),
        (_, sources) => {
            format!("φ = f + ∫ K φ on {place}, a system of {} equations{parameters}", sources.len())
        }
    }
}

/// [0, ∞).
fn line(interval: Interval) -> String {
    let (a, b) = (interval.a(), interval.b());
    let left = if a.is_finite() { format!("[{}", short(a)) } else { "(−∞".to_owned() };
    let right = if b.is_finite() { format!("{}]", short(b)) } else { "∞)".to_owned() };
    format!("{left}, {right}")
}
