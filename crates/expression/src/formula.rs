//! The formula as its users see it: text in, numbers out.

use crate::difference::Difference;
use crate::error::ParseError;
use crate::evaluate::Column;
use crate::graph::Kind;
use crate::names::Names;
use crate::parse::parse;
use crate::program::Program;
use num_complex::Complex;
use std::sync::Arc;

/// Columns that a formula may have: what a result depends on is a mask of bits.
const MOST_COLUMNS: usize = 64;

/// A formula, parsed and compiled. Cheap to clone; threads may share one.
#[derive(Clone, Debug)]
pub struct Formula {
    program: Arc<Program>,
}

impl Formula {
    /// The formula of `text` in `variables`.
    ///
    /// # Errors
    /// What is wrong with the text, and where.
    ///
    /// # Panics
    /// With more than 64 variables.
    pub fn parse(text: &str, variables: &[&str]) -> Result<Formula, ParseError> {
        Formula::with_parameters(text, variables, &[])
    }

    /// The formula of `text` in `variables`, with numbers that have names.
    ///
    /// Variables and parameters come before the constants: a parameter `e` hides Euler's number, and where `i` is a
    /// variable there are no complex numbers.
    ///
    /// # Errors
    /// What is wrong with the text, and where; a name in it that is both a variable and a parameter.
    ///
    /// # Panics
    /// With more than 64 variables.
    pub fn with_parameters(
        text: &str,
        variables: &[&str],
        parameters: &[(String, f64)],
    ) -> Result<Formula, ParseError> {
        Formula::compile(text, Names { variables, parameters, difference: None })
    }

    /// The formula with one more column behind its variables: the exact difference d = u − v of two of them,
    /// `of` = (u, v).
    ///
    /// Where u and v nearly coincide, their doubles have few digits of u − v left, or none: wherever the formula has
    /// a combination a u − a v + c with numbers a and c, and in comparisons and `min` and `max` of u and v, d is used
    /// instead.
    ///
    /// ```
    /// use expression::Formula;
    /// let kernel = Formula::with_difference("abs(x-y)^(-1/2)", &["x", "y"], &[], ("y", "x"))?;
    /// assert_eq!(kernel.at(&[0.3, 0.3, 1e-24]), 1e12);
    /// // The kernel depends on the last column alone: it is that of a convolution.
    /// assert!(!kernel.depends_on(0) && !kernel.depends_on(1) && kernel.depends_on(2));
    /// # Ok::<(), expression::ParseError>(())
    /// ```
    ///
    /// # Errors
    /// As [`Formula::with_parameters`].
    ///
    /// # Panics
    /// If u or v is not among the variables, or with more than 63 of them.
    pub fn with_difference(
        text: &str,
        variables: &[&str],
        parameters: &[(String, f64)],
        of: (&str, &str),
    ) -> Result<Formula, ParseError> {
        let column_of = |name: &str| variables.iter().position(|variable| *variable == name);
        let minuend = column_of(of.0).expect("the minuend of the difference is one of the variables");
        let subtrahend = column_of(of.1).expect("the subtrahend of the difference is one of the variables");
        let difference = Some(Difference { minuend, subtrahend, column: variables.len() });
        Formula::compile(text, Names { variables, parameters, difference })
    }

    fn compile(text: &str, names: Names<'_>) -> Result<Formula, ParseError> {
        let columns = names.variables.len() + usize::from(names.difference.is_some());
        assert!(columns <= MOST_COLUMNS, "{columns} variables are more than {MOST_COLUMNS}");
        let (graph, root) = parse(text, names)?;
        Ok(Formula { program: Arc::new(Program::new(&graph, root, columns)) })
    }

    /// Whether the values may be complex: the text has the imaginary unit, and takes no `real`, `abs` … of the result.
    pub fn is_complex(&self) -> bool {
        self.program.kind == Kind::Complex
    }

    /// Whether the values depend on that column, counted from 0.
    pub fn depends_on(&self, variable: usize) -> bool {
        variable < self.program.columns && self.program.depends >> variable & 1 == 1
    }

    /// The number of columns: the variables, and the difference if there is one.
    pub fn columns(&self) -> usize {
        self.program.columns
    }

    /// The value of a real formula at a point, a coordinate for each column. NaN where it is undefined.
    ///
    /// # Panics
    /// If the formula [is complex](Formula::is_complex), or the point has not as many coordinates as there are columns.
    pub fn at(&self, point: &[f64]) -> f64 {
        self.check(point.len());
        self.check_real();
        self.program.at(point)
    }

    /// The value of any formula at a point, a coordinate for each column. NaN where it is undefined.
    ///
    /// # Panics
    /// If the point has not as many coordinates as there are columns.
    pub fn at_complex(&self, point: &[f64]) -> Complex<f64> {
        self.check(point.len());
        self.program.at_complex(point)
    }

    /// The values of a real formula over a batch, to the last bit those of [`Formula::at`].
    ///
    /// # Panics
    /// If the formula [is complex](Formula::is_complex), a column is missing, or one has not the length of `out`.
    pub fn fill(&self, columns: &[Column<'_>], out: &mut [f64]) {
        self.check(columns.len());
        self.check_real();
        self.program.fill(columns, out);
    }

    /// The values of any formula over a batch, to the last bit those of [`Formula::at_complex`].
    ///
    /// # Panics
    /// If a column is missing, or one has not the length of `out`.
    pub fn fill_complex(&self, columns: &[Column<'_>], out: &mut [Complex<f64>]) {
        self.check(columns.len());
        self.program.fill_complex(columns, out);
    }

    fn check(&self, columns: usize) {
        assert_eq!(columns, self.program.columns, "a value for each column of the formula");
    }

    fn check_real(&self) {
        assert!(!self.is_complex(), "the formula is complex: `at_complex` and `fill_complex` evaluate it");
    }
}
