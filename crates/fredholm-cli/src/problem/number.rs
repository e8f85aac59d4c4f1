//! Real or complex, as the formulas have it.

use expression::{Column, Formula};
use fredholm::equation::{Complex64, Scalar};
use serde::{Serialize, Serializer};

/// A scalar that a formula can be evaluated in.
pub trait FormulaValue: Scalar {
    /// The formula over columns.
    fn fill(formula: &Formula, columns: &[Column<'_>], out: &mut [Self]);

    /// The formula at a point.
    fn at(formula: &Formula, point: &[f64]) -> Self;

    /// What is written of it.
    fn number(self) -> Number;
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
