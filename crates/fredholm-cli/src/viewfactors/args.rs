//! What may be said to `fredholm viewfactors`.

use crate::args::{number, positive, with_extension};
use clap::Args;
use std::path::PathBuf;

/// What stands below the options.
pub const EXAMPLES: &str = "\
F_ij is the part of what leaves face i, diffusely, that arrives at face j. A face has a front, from
which its corners run counter-clockwise; it sends and receives there, and blocks from both sides.

The tolerance is an absolute error: no factor and no sum of a row is to be further from the truth.
Every factor comes with its own error. Reciprocity, A_i F_ij = A_j F_ji, holds by construction; in
a closed mesh the rows miss 1 by what the errors are, unless --enforce makes them add up.

Of the control line `C` of View3D's .vs3 files `eps` is the tolerance, `out=1` asks for its binary
format, `emit=1` for factors with reflections in them, Hottel's script F, and with `encl=1` an open
mesh is told; nothing is corrected for that. A masking surface `M` sees its base alone.

\
Examples:
  fredholm viewfactors room.obj                              a table, and the factors of few faces
  fredholm viewfactors room.obj --groups                     between its groups, objects, materials
  fredholm viewfactors room.obj -o f.npz -o f.out            for NumPy, and as View3D writes them
  fredholm viewfactors room.obj --tolerance 1e-6 --enforce -o f.mtx
  fredholm viewfactors room.obj --json - | jq .closure_defect

Exit codes: 0 computed; 1 an error; 2 a mistake on the command line; 3 all is written, but not every
factor and row sum is as exact as was asked.";

/// Options of `fredholm viewfactors`.
#[derive(Debug, Args)]
pub struct ViewFactors {
    /// The faces: a mesh in metres (.obj, .glb, .gltf, .stl, .ply, .vs3), or a scene (.toml)
    pub mesh: PathBuf,

    /// Factors between groups (`g`, `o` or material) in place of faces
    #[arg(long)]
    pub groups: bool,

    /// The greatest error wanted of a factor and of the sum of a row [default: `eps` of a .vs3 file, or 1e-4]
    #[arg(long, value_name = "ERROR", value_parser = positive)]
    pub tolerance: Option<f64>,

    /// Correct the factors by as little as closes them: rows add up to 1, no factor below 0
    #[arg(long)]
    pub enforce: bool,

    /// Threads to work with [default: one per core]
    #[arg(long, value_name = "N", value_parser = number(1, 1024))]
    pub threads: Option<usize>,

    /// The matrix, in the format of the name: NumPy, CSV, MatrixMarket, or View3D's, text, or binary (.vfb; .vf and .out
    /// too if a .vs3 file has `out=1`); may be said again
    #[arg(
        short,
        long,
        value_name = "FILE.npz|.csv|.mtx|.vf|.out|.vfb",
        value_parser = matrix,
        help_heading = "Output"
    )]
    pub output: Vec<PathBuf>,

    /// Factors, errors and the numbers of the run as JSON; `-` writes them alone to the standard output
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub json: Option<PathBuf>,
}

fn matrix(text: &str) -> Result<PathBuf, String> {
    with_extension(text, &["npz", "csv", "mtx", "vf", "out", "vfb"])
}
