//! The numbers of a run: what `--json` writes and the table shows.

use super::asked::Asked;
use super::engine::Counts;
use radiosity::view_factors::{Correction, Storage, ViewFactors};
use serde::{Serialize, Serializer};
use std::path::PathBuf;

/// The numbers of a run, in the order of the JSON.
#[derive(Serialize)]
pub struct Report<'a> {
    /// What the scene is called.
    pub scene: String,
    /// How many faces.
    pub faces: usize,
    /// How many groups, where these are the rows.
    pub groups: Option<usize>,
    /// The names of the rows and columns.
    pub names: &'a [String],
    /// Their areas, in m².
    pub areas: &'a [f64],
    /// Their emittances, where reflections are in the factors.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub emittances: Option<&'a [f64]>,
    /// F_ij, from row to column; Hottel's script F where reflections are in them.
    #[serde(rename = "F")]
    pub factors: Matrix<'a>,
    /// The errors in the same places.
    pub error: Errors<'a>,
    /// The greatest error that was asked for, of a factor and of the sum of a row, where it comes from, and what else the
    /// mesh asks for.
    #[serde(flatten)]
    pub asked: Asked,
    /// The greatest error of a factor.
    pub largest_error: f64,
    /// The greatest error of the sum of a row.
    pub largest_row_error: f64,
    /// Whether no sampled sight line leaves the scene.
    pub closed: bool,
    /// The part of the sampled sight lines that leave it.
    pub escaping: f64,
    /// max |Σ_j F_ij − 1|: in a closed scene over the rows that see nothing but fronts, else over all.
    pub closure_defect: f64,
    /// max |Σ_j 𝓕_ij − ε_i| of script F in a closed scene in which no row sees a back; the closure is that of the factors
    /// without reflections.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub emittance_defect: Option<f64>,
    /// How many rows see nothing but fronts.
    pub closure_rows: usize,
    /// max |F_ij − A_j F_ji / A_i|.
    pub reciprocity_defect: f64,
    /// What was done to close it.
    pub correction: Option<Corrected>,
    /// Pairs of polygons.
    pub pairs: Counts,
    /// Rays cast.
    pub rays: u64,
    /// Seconds in all.
    pub seconds: f64,
    /// Where they went.
    pub stages: Stages,
    /// The most memory used at once.
    pub peak_memory_bytes: Option<u64>,
    /// The files written.
    pub files: Vec<PathBuf>,
}

impl Report<'_> {
    /// Whether every factor and row sum is as exact as was asked: by their errors, and where it is known by the truth.
    pub fn is_met(&self) -> bool {
        let Self { asked: Asked { tolerance, .. }, largest_error, largest_row_error, .. } = self;
        // NaN is not.
        largest_error <= tolerance && largest_row_error <= tolerance && self.misses_one() <= *tolerance
    }

    /// By how much the rows miss 1 that are known to add up to it.
    pub fn misses_one(&self) -> f64 {
        if self.closed && self.closure_rows > 0 { self.closure_defect } else { 0.0 }
    }
}

/// Seconds of each stage.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Stages {
    /// Reading the mesh, and preparing the rays.
    pub load: f64,
    /// Computing the factors.
    pub factors: f64,
    /// Closing them.
    pub enforce: f64,
    /// Putting reflections into them.
    pub reflections: f64,
    /// Writing the matrices.
    pub write: f64,
}

/// The size of the correction that closes the factors, by face.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Corrected {
    /// max |ΔF_ij|.
    pub largest: f64,
    /// The norm of ΔK in L² (Hilbert and Schmidt's).
    pub norm: f64,
    /// The errors of the factors in the same norm.
    pub error_norm: f64,
    /// Pairs that were changed by more than their error.
    pub beyond_error: u64,
    /// Pairs that would have become negative, and are 0.
    pub at_zero: u64,
    /// Rows that add up to 1 now.
    pub rows: usize,
    /// By how much the worst of them missed it before.
    pub defect_before: f64,
    /// By how much it misses it now.
    pub defect: f64,
}

impl From<Correction> for Corrected {
    fn from(correction: Correction) -> Self {
        let Correction {
            largest, norm, error_norm, beyond_error, at_zero, rows, defect_before, defect, ..
        } = correction;
        Self { largest, norm, error_norm, beyond_error, at_zero, rows, defect_before, defect }
    }
}

/// F, written row by row.
pub struct Matrix<'a>(pub &'a ViewFactors);

/// The errors, written row by row.
pub struct Errors<'a>(pub &'a ViewFactors);

impl Serialize for Matrix<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let single = |row: Vec<f64>| row.into_iter().map(|factor| factor as f32).collect::<Vec<_>>();
        match self.0.precision() {
            Storage::Single => serializer.collect_seq(self.0.rows().map(single)),
            Storage::Double => serializer.collect_seq(self.0.rows()),
        }
    }
}

impl Serialize for Errors<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let short = |row: Vec<f64>| row.into_iter().map(three_digits).collect::<Vec<_>>();
        serializer.collect_seq(self.0.rows_of_errors().map(short))
    }
}

/// An error with three digits, rounded up.
fn three_digits(error: f64) -> f64 {
    if error == 0.0 || !error.is_finite() {
        return error;
    }
    let unit = 10_f64.powf(error.log10().floor() - 2.0);
    let rounded: f64 = format!("{:.2e}", (error / unit).ceil() * unit).parse().unwrap_or(error);
    if rounded < error { error } else { rounded }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_short_and_not_less() {
        for (error, text) in [(1.2341e-5, "0.0000124"), (9.999e-7, "0.000001"), (0.0, "0"), (0.5, "0.5")] {
            assert_eq!(three_digits(error).to_string(), text);
        }
        for k in 0..2000 {
            let error = 1e-15 * 1.0173_f64.powi(k);
            let short = three_digits(error);
            assert!(short >= error && short <= error * 1.0101, "{error:e} {short:e}");
        }
    }
}
