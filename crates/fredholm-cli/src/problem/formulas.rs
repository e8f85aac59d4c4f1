//! Formulas become the kernels and sources of an equation.

use super::{FormulaValue, Said};
use anyhow::Result;
use expression::{Column, Formula};
use fredholm::equation::LineKernel;
use fredholm::plane::PlaneKernel;

/// Names and values.
pub type Parameters = [(String, f64)];

/// K(x, y) on a line; close to the diagonal it has the exact y − x.
pub fn line_kernel(said: &Said, parameters: &Parameters) -> Result<Formula> {
    let formula = Formula::with_difference(&said.text, &["x", "y"], parameters, ("y", "x"));
    formula.map_err(|error| said.error(error))
}

/// K((x, y), (s, t)) in the plane.
pub fn plane_kernel(said: &Said, parameters: &Parameters) -> Result<Formula> {
    formula(said, &["x", "y", "s", "t"], parameters)
}

/// A formula in these variables.
pub fn formula(said: &Said, variables: &[&str], parameters: &Parameters) -> Result<Formula> {
    Formula::with_parameters(&said.text, variables, parameters).map_err(|error| said.error(error))
}

/// A number as a formula: `2*pi`, `-inf`.
pub fn constant(said: &Said, parameters: &Parameters) -> Result<f64> {
    let mut names = parameters.to_vec();
    if names.iter().all(|(name, _)| name != "inf") {
        names.push(("inf".to_owned(), f64::INFINITY));
    }
    let formula = formula(said, &[], &names)?;
    let value = if formula.is_complex() { f64::NAN } else { formula.at(&[]) };
    if value.is_nan() { Err(said.error(format!("`{}` is no real number", said.text))) } else { Ok(value) }
}

/// A formula as the kernel of an equation.
#[derive(Clone, Copy, Debug)]
pub struct FormulaKernel<'a>(pub &'a Formula);

impl<T: FormulaValue> LineKernel<T> for FormulaKernel<'_> {
    fn row(&self, x: f64, y: &[f64], offset: &[f64], row: &mut [T]) {
        T::fill(self.0, &[Column::Same(x), Column::Each(y), Column::Each(offset)], row);
    }

    fn takes_offset(&self) -> bool {
        self.0.depends_on(2)
    }
}

impl<T: FormulaValue> PlaneKernel<T> for FormulaKernel<'_> {
    fn row(&self, [x, y]: [f64; 2], q: &[[f64; 2]], row: &mut [T]) {
        let s: Vec<f64> = q.iter().map(|[s, _]| *s).collect();
        let t: Vec<f64> = q.iter().map(|[_, t]| *t).collect();
        let columns = [Column::Same(x), Column::Same(y), Column::Each(&s), Column::Each(&t)];
        T::fill(self.0, &columns, row);
    }
}
