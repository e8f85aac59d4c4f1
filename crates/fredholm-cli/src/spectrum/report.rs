//! Eigenvalues and eigenfunctions: what `--json` and `--csv` write, and the table.

use crate::problem::Number;
use crate::solve::report::Values;
use crate::solve::table::time;
use crate::text::{Digits, columns, lines};
use serde::Serialize;
use std::io::{self, Write};
use std::path::PathBuf;

/// The spectrum in numbers, in the order of the JSON.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// The equation, in words.
    pub equation: String,
    /// How many numbers the discrete problem has.
    pub n: usize,
    /// λ with ∫ K φ = λ φ, the largest first.
    pub eigenvalues: Vec<Number>,
    /// Their estimated errors.
    pub error_estimates: Vec<f64>,
    /// The error that is allowed.
    pub tolerance: f64,
    /// min |1 − λ|: how far φ = f + ∫ K φ is from having no solution, or many.
    pub distance_to_spectrum: f64,
    /// Where the eigenfunctions are told.
    pub x: Vec<f64>,
    /// The eigenfunctions there.
    pub eigenfunctions: Vec<Values>,
    /// Seconds.
    pub seconds: f64,
    /// The files written.
    pub files: Vec<PathBuf>,
}

impl Report {
    /// Whether all eigenvalues are as good as was asked.
    pub fn is_converged(&self) -> bool {
        let largest = self.eigenvalues.iter().map(Number::modulus).fold(0.0, f64::max);
        self.error_estimates.iter().all(|error| *error <= self.tolerance * largest)
    }

    /// What people read.
    pub fn table(&self) -> String {
        let mut matters = vec![
            ("unknowns", self.n.to_string()),
            ("spectrum", format!("1 is {:.2e} away from it", self.distance_to_spectrum)),
            ("time", time(self.seconds)),
        ];
        if !self.is_converged() {
            matters
                .insert(0, ("status", format!("TOLERANCE NOT MET, {:.1e} of the largest", self.tolerance)));
        }
        if !self.files.is_empty() {
            let names: Vec<String> = self.files.iter().map(|file| file.display().to_string()).collect();
            matters.push(("written", names.join(", ")));
        }
        let head = ["k", "λ", "error estimate"].map(str::to_owned).to_vec();
        let values = self.eigenvalues.iter().zip(&self.error_estimates).enumerate();
        let rows = values.map(|(k, (value, error))| {
            vec![(k + 1).to_string(), written(value, *error), format!("{error:.1e}")]
        });
        let rows: Vec<Vec<String>> = std::iter::once(head).chain(rows).collect();
        format!("{}\n\n{}\n{}", self.equation, lines(&matters), columns(&rows))
    }

    /// A line per point: x, then the eigenfunctions.
    pub fn csv(&self, out: &mut impl Write) -> io::Result<()> {
        let functions = || self.eigenfunctions.iter().enumerate();
        let names = functions().flat_map(|(k, values)| values.names(&format!("phi{}", k + 1)));
        writeln!(out, "{}", std::iter::once("x".to_owned()).chain(names).collect::<Vec<_>>().join(","))?;
        for (k, x) in self.x.iter().enumerate() {
            let parts =
                functions().flat_map(|(_, values)| values.components()).flat_map(|values| values[k].parts());
            let numbers: Vec<String> =
                std::iter::once(x).chain(parts).map(|part| format!("{part:.16e}")).collect();
            writeln!(out, "{}", numbers.join(","))?;
        }
        Ok(())
    }
}

/// An eigenvalue, without an imaginary part that is error alone.
fn written(value: &Number, error: f64) -> String {
    let digits = Digits::new(value.modulus(), error);
    match value.parts() {
        [re, im] if im.abs() > error => {
            let sign = if *im < 0.0 { '−' } else { '+' };
            format!("{} {sign} {} i", digits.write(*re), digits.write(im.abs()))
        }
        parts => digits.write(parts[0]),
    }
}
