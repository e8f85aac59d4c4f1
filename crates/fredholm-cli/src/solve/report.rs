//! The answer at the points asked for: what `--json` writes and the table shows.

use super::class;
use super::settings::Settings;
use crate::problem::{FormulaValue, Number, Points, Problem};
use fredholm::equation::{Alternative, Answer, Function, Status};
use serde::Serialize;
use std::path::PathBuf;

/// The answer in numbers, in the order of the JSON.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// The equation, in words.
    pub equation: String,
    /// `converged`, `tolerance-not-met`, `no-solution` or `not-unique`.
    pub status: &'static str,
    /// The method and what it was given.
    pub method: String,
    /// The kernel's class, where the method asks for it.
    pub class: Option<String>,
    /// How many numbers were solved for.
    pub n: usize,
    /// The most that were allowed, where the program finds how many it takes.
    #[serde(skip)]
    pub most_unknowns: Option<usize>,
    /// The greatest error wanted, as a part of max |φ|.
    pub tolerance: f64,
    /// The estimate of max |φ − exact|.
    pub error_estimate: f64,
    /// max |φ − exact| over the points, where the solution is known.
    pub true_error: Option<f64>,
    /// The condition number of I − A.
    pub condition: f64,
    /// The dimension of the null space of I − A.
    pub nullity: usize,
    /// ⟨f, ψ_k⟩ for each null function of the adjoint.
    pub solvability: Vec<Number>,
    /// The smallest singular values of I − A, where it was found singular or close to it.
    pub singular_values: Vec<f64>,
    /// min |1 − λ| over the spectrum, likewise.
    pub distance_to_spectrum: Option<f64>,
    /// Where φ is told.
    pub x: Points,
    /// φ there.
    pub phi: Values,
    /// The null functions of I − A there.
    pub null_space: Vec<Values>,
    /// Seconds that the solving took.
    pub seconds: f64,
    /// The files written.
    pub files: Vec<PathBuf>,
}

/// The values of a function with one component or several.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Values {
    /// A value for each point.
    One(Vec<Number>),
    /// A list for each component.
    Several(Vec<Vec<Number>>),
}

impl Values {
    /// A function's, component by component.
    pub fn new<P, T: FormulaValue>(function: &Function<'_, P, T>, points: &[P]) -> Self {
        let component = |c: usize| points.iter().map(|x| function.component(c, x).number()).collect();
        match function.components() {
            1 => Self::One(component(0)),
            components => Self::Several((0..components).map(component).collect()),
        }
    }

    /// As many numbers that are none.
    fn missing(self) -> Self {
        let missing = |values: Vec<Number>| values.iter().map(|_| Number::Real(f64::NAN)).collect();
        match self {
            Self::One(values) => Self::One(missing(values)),
            Self::Several(components) => Self::Several(components.into_iter().map(missing).collect()),
        }
    }

    /// The first point at which there is no finite value.
    pub fn first_lost(&self) -> Option<usize> {
        let lost = |values: &Vec<Number>| values.iter().position(|value| !value.modulus().is_finite());
        self.components().iter().filter_map(lost).min()
    }

    /// max |φ|.
    pub fn largest(&self) -> f64 {
        self.components().iter().flatten().map(Number::modulus).fold(0.0, f64::max)
    }

    /// A name for each column: of each component, and of complex numbers each part.
    pub fn names(&self, name: &str) -> Vec<String> {
        let components = self.components();
        let mut names = Vec::new();
        for (c, values) in components.iter().enumerate() {
            let name = if components.len() > 1 { format!("{name}_{}", c + 1) } else { name.to_owned() };
            match values.first().map_or(1, |value| value.parts().len()) {
                1 => names.push(name),
                _ => names.extend([format!("{name}_re"), format!("{name}_im")]),
            }
        }
        names
    }

    /// The lists, one for each component.
    pub fn components(&self) -> &[Vec<Number>] {
        match self {
            Self::One(values) => std::slice::from_ref(values),
            Self::Several(components) => components,
        }
    }
}

impl Report {
    /// The answer at these points.
    pub fn new<P, T: FormulaValue>(
        problem: &Problem,
        answer: &Answer<'_, P, T>,
        points: Vec<P>,
        settings: &Settings,
        seconds: f64,
    ) -> Self
    where
        Points: From<Vec<P>>,
    {
        let phi = Values::new(&answer.solution, &points);
        // What solves nothing is not shown as if it did.
        let phi = if answer.status == Status::NoSolution { phi.missing() } else { phi };
        let alternative = answer.alternative.as_ref();
        let null_space = |found: &Alternative<'_, P, T>| {
            found.null_functions.iter().map(|function| Values::new(function, &points)).collect()
        };
        let solvability = |found: &Alternative<'_, P, T>| {
            found.solvability.iter().map(|product| product.number()).collect()
        };
        let null_space = alternative.map_or_else(Vec::new, null_space);
        let x = Points::from(points);
        // An error that is known is that of numbers.
        let reached = match answer.status {
            Status::Converged if phi.first_lost().is_some() => Status::ToleranceNotMet,
            status => status,
        };
        // One solution of many need not be the known one.
        let comparable = problem.has_exact() && answer.nullity() == 0;
        Self {
            equation: problem.title.clone(),
            status: status(reached),
            method: answer.method.clone(),
            class: answer.class.map(class::name),
            n: answer.unknowns,
            most_unknowns: settings.unknowns,
            tolerance: settings.tolerance,
            error_estimate: answer.error_estimate,
            true_error: comparable.then(|| true_error::<T>(problem, &x, &phi)),
            condition: answer.condition,
            nullity: answer.nullity(),
            solvability: alternative.map_or_else(Vec::new, solvability),
            singular_values: alternative.map_or_else(Vec::new, |found| found.singular_values.clone()),
            distance_to_spectrum: alternative.map(|found| found.distance_to_spectrum),
            x,
            phi,
            null_space,
            seconds,
            files: Vec::new(),
        }
    }
}

/// A status as the JSON has it.
pub fn status(status: Status) -> &'static str {
    match status {
        Status::Converged => "converged",
        Status::ToleranceNotMet => "tolerance-not-met",
        Status::NoSolution => "no-solution",
        Status::NotUnique => "not-unique",
    }
}

/// max |φ − exact| over the points; NaN if it is NaN anywhere.
pub fn true_error<T: FormulaValue>(problem: &Problem, x: &Points, phi: &Values) -> f64 {
    let mut worst = 0.0_f64;
    for (c, values) in phi.components().iter().enumerate() {
        for (k, value) in values.iter().enumerate() {
            let exact = problem.exact::<T>(c, x.coordinates(k)).number();
            let parts = value.parts().iter().zip(exact.parts()).map(|(a, b)| a - b);
            let error = parts.fold(0.0, f64::hypot);
            worst = if error > worst || error.is_nan() { error } else { worst };
        }
    }
    worst
}
