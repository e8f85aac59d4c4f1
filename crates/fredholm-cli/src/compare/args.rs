//! What may be said to `fredholm compare`.

use crate::args::at_least_one;
use crate::problem::args::{ProblemArgs, SourceArgs};
use crate::solve::args::{csv, picture};
use clap::Args;
use std::path::PathBuf;

/// What stands below the options, but for what is said of formulas.
pub const EXAMPLES: &str = "\
The error is max |φ − exact| at 41 points, where the solution is known, and otherwise its estimate
by the residual. n is the number of nodes or elements; the order is that of the last two errors that
are above rounding. The time has the estimate in it, which takes most of it.

Examples:
  fredholm compare --kernel \"(x+1)*exp(-x*y)/2\" --source \"exp(-x) - 1/2 + exp(-(x+1))/2\" \\
                   --exact \"exp(-x)\" --plot methods.svg
  fredholm compare problem.toml --n 256 --json - | jq '.methods[].runs[-1]'

Exit codes: 0 compared; 1 an error; 2 a mistake on the command line.";

/// Options of `fredholm compare`.
#[derive(Debug, Args)]
pub struct Compare {
    /// The equation.
    #[command(flatten)]
    pub problem: ProblemArgs,

    /// Its right-hand side.
    #[command(flatten)]
    pub source: SourceArgs,

    /// The greatest n; the others are halves of it
    #[arg(long, value_name = "N", value_parser = at_least_one, default_value = "128", help_heading = "Methods")]
    pub n: usize,

    /// A line for each method and n
    #[arg(long, value_name = "FILE.csv", value_parser = csv, help_heading = "Output")]
    pub csv: Option<PathBuf>,

    /// The numbers as JSON; `-` writes them alone to the standard output
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub json: Option<PathBuf>,

    /// A picture of the errors against n
    #[arg(long, value_name = "FILE.svg|.png", value_parser = picture, help_heading = "Output")]
    pub plot: Option<PathBuf>,
}
