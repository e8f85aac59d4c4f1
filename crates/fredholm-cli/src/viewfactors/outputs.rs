//! Which files a run leaves, each prepared before the work begins.

use super::args::ViewFactors as Arguments;
use super::asked::Asked;
use crate::json::Json;
use crate::output::{Output, refuse_twins};
use anyhow::Result;
use radiosity::export::factors::{
    Surroundings, write_csv, write_matrix_market, write_npz, write_view3d, write_view3d_binary,
};
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

/// Writes the matrix in the format that the file's name asks for; View3D's is binary if the name or the mesh asks for it.
pub fn write(
    output: Output,
    factors: &ViewFactors,
    surroundings: &Surroundings<'_>,
    asked: &Asked,
) -> Result<PathBuf> {
    match extension(output.path()).as_str() {
        "npz" => output.write(|out| write_npz(factors, out)),
        "csv" => output.write(|out| write_csv(factors, out)),
        "mtx" => output.write(|out| write_matrix_market(factors, out)),
        _ if is_binary(output.path(), asked) => {
            output.write(|out| write_view3d_binary(factors, surroundings, out))
        }
        // The only others that the command line lets through are .vf and .out.
        _ => output.write(|out| write_view3d(factors, surroundings, out)),
    }
}

/// Whether a file will be in View3D's binary format.
pub fn is_binary(path: &Path, asked: &Asked) -> bool {
    match extension(path).as_str() {
        "vfb" => true,
        "vf" | "out" => asked.binary,
        _ => false,
    }
}

fn extension(path: &Path) -> String {
    path.extension().map(|extension| extension.to_string_lossy().to_lowercase()).unwrap_or_default()
}
