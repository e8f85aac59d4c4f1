//! Which files a run leaves, each prepared before the work begins.

use super::args::ViewFactors as Arguments;
use crate::json::Json;
use crate::output::{Output, refuse_twins};
use anyhow::Result;
use radiosity::export::factors::{Surroundings, write_csv, write_matrix_market, write_npz, write_view3d};
use radiosity::view_factors::ViewFactors;
use std::path::{Path, PathBuf};

/// What was asked for.
pub struct Outputs {
    /// The matrix, in any formats.
    pub matrices: Vec<Output>,
    /// All numbers of the run.
    pub json: Option<Json>,
}

impl Outputs {
    /// Makes sure that all of them can be written.
    pub fn prepare(args: &Arguments) -> Result<Self> {
        let named = args.output.iter().map(PathBuf::as_path);
        let paths: Vec<Option<&Path>> = named.chain(args.json.as_deref()).map(Some).collect();
        refuse_twins(&paths)?;
        Ok(Self {
            matrices: args.output.iter().map(|path| Output::prepare(path)).collect::<Result<_>>()?,
            json: args.json.as_deref().map(Json::prepare).transpose()?,
        })
    }
}

/// Writes the matrix in the format that the file's name asks for.
pub fn write(output: Output, factors: &ViewFactors, surroundings: &Surroundings<'_>) -> Result<PathBuf> {
    let extension = output.path().extension().map(|extension| extension.to_string_lossy().to_lowercase());
    match extension.as_deref() {
        Some("npz") => output.write(|out| write_npz(factors, out)),
        Some("csv") => output.write(|out| write_csv(factors, out)),
        Some("mtx") => output.write(|out| write_matrix_market(factors, out)),
        // The only others that the command line lets through are .vf and .out.
        _ => output.write(|out| write_view3d(factors, surroundings, out)),
    }
}
