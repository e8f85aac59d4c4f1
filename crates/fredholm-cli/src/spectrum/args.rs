//! What may be said to `fredholm spectrum`.

use crate::args::{number, positive};
use crate::problem::args::ProblemArgs;
use crate::solve::args::{csv, picture};
use clap::Args;
use std::path::PathBuf;

/// What stands below the options, but for what is said of formulas.
pub const EXAMPLES: &str = "\
Examples:
  fredholm spectrum --kernel \"min(x,y)\" --count 5
  fredholm spectrum --kernel \"exp(i*(x-y))*cos(x-y)\" --interval 0 pi --at 0:pi/8:pi --json -
  fredholm spectrum --kernel \"min(x,y)*(1-max(x,y))\" --plot modes.svg

JSON: n, eigenvalues and error_estimates, distance_to_spectrum of 1, x, and eigenfunctions, a list
for each eigenvalue (of a system, of a list for each component); complex values are [re, im].

Exit codes: 0 found; 1 an error; 2 a mistake on the command line; 3 all is written, but not every
error estimate meets the tolerance.";

/// Options of `fredholm spectrum`.
#[derive(Debug, Args)]
pub struct Spectrum {
    /// The kernel and its domain.
    #[command(flatten)]
    pub problem: ProblemArgs,

    /// How many eigenvalues, the largest first
    #[arg(long, value_name = "N", value_parser = number(1, 1000), default_value = "10", help_heading = "Method")]
    pub count: usize,

    /// The greatest error wanted of an eigenvalue, as a part of the largest [default: 1e-10]
    #[arg(long, value_name = "ERROR", value_parser = positive, help_heading = "Method")]
    pub tolerance: Option<f64>,

    /// Where the eigenfunctions are wanted: 0:0.1:1, or 0.07,0.31,pi/4
    #[arg(long, value_name = "POINTS", allow_hyphen_values = true, help_heading = "Output")]
    pub at: Option<String>,

    /// The eigenfunctions at these points, with all digits
    #[arg(long, value_name = "FILE.csv", value_parser = csv, help_heading = "Output")]
    pub csv: Option<PathBuf>,

    /// Eigenvalues and eigenfunctions as JSON; `-` writes them alone to the standard output
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub json: Option<PathBuf>,

    /// A picture of the eigenvalues and of the first eigenfunctions
    #[arg(long, value_name = "FILE.svg|.png", value_parser = picture, help_heading = "Output")]
    pub plot: Option<PathBuf>,
}
