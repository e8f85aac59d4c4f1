//! Real or complex, as the formulas have it.

use expression::{Column, Formula};
use fredholm::automatic::{self, Options};
use fredholm::equation::{Answer, Complex64, Equation, EquationError, Scalar};
use fredholm::plane::{self, PlaneEquation};
use serde::{Serialize, Serializer};

/// A scalar that a formula can be evaluated in.
pub trait FormulaValue: Scalar {
    /// The formula over columns.
    fn fill(formula: &Formula, columns: &[Column<'_>], out: &mut [Self]);

    /// The formula at a point.
    fn at(formula: &Formula, point: &[f64]) -> Self;

    /// What is written of it.
    fn number(self) -> Number;

    /// The solution by the method that is found, for as many unknowns as there are ways to keep a matrix of such numbers.
    fn solve<'e, 'a: 'e>(
        equation: &'e Equation<'a, Self>,
        options: &Options,
    ) -> Result<Answer<'e, f64, Self>, EquationError> {
        automatic::solve(equation, options)
    }

    /// The same in the plane.
    fn solve_in_plane<'e, 'a>(
        equation: &'e PlaneEquation<'a, Self>,
        options: &plane::Options,
    ) -> Result<Answer<'e, [f64; 2], Self>, EquationError> {
        plane::solve(equation, options)
    }
}

impl FormulaValue for f64 {
    fn fill(formula: &Formula, columns: &[Column<'_>], out: &mut [Self]) {
        formula.fill(columns, out);
    }

    fn at(formula: &Formula, point: &[f64]) -> Self {
        formula.at(point)
    }

    fn number(self) -> Number {
        Number::Real(self)
    }

    fn solve<'e, 'a: 'e>(
        equation: &'e Equation<'a, Self>,
        options: &Options,
    ) -> Result<Answer<'e, f64, Self>, EquationError> {
        automatic::solve_large(equation, options)
    }

    fn solve_in_plane<'e, 'a>(
        equation: &'e PlaneEquation<'a, Self>,
        options: &plane::Options,
    ) -> Result<Answer<'e, [f64; 2], Self>, EquationError> {
        plane::solve_large(equation, options)
    }
}

impl FormulaValue for Complex64 {
    fn fill(formula: &Formula, columns: &[Column<'_>], out: &mut [Self]) {
        formula.fill_complex(columns, out);
    }

    fn at(formula: &Formula, point: &[f64]) -> Self {
        formula.at_complex(point)
    }

    fn number(self) -> Number {
        Number::Complex([self.re, self.im])
    }
}

/// A real number, or the real and imaginary parts of a complex one: `x` or `[re, im]` in JSON, null where not finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Number {
    /// A real number.
    Real(f64),
    /// The parts of a complex one.
    Complex([f64; 2]),
}

impl Number {
    /// Its parts: one or two.
    pub fn parts(&self) -> &[f64] {
        match self {
            Self::Real(value) => std::slice::from_ref(value),
            Self::Complex(parts) => parts,
        }
    }

    /// |z|.
    pub fn modulus(&self) -> f64 {
        self.parts().iter().fold(0.0, |modulus: f64, part| modulus.hypot(*part))
    }
}

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Real(value) => value.serialize(serializer),
            Self::Complex(parts) => parts.serialize(serializer),
        }
    }
}
