//! How an equation is stated on a command line.

use clap::Args;
use std::path::PathBuf;

/// The equation, from formulas or a file.
#[derive(Debug, Args)]
pub struct ProblemArgs {
    /// The equation as a file; what the command line says goes before it
    #[arg(value_name = "PROBLEM.toml", help_heading = "Equation")]
    pub file: Option<PathBuf>,

    /// K(x, y) as a formula; in the plane, of the points (x, y) and (s, t)
    #[arg(
        long,
        value_name = "FORMULA",
        required_unless_present = "file",
        allow_hyphen_values = true,
        help_heading = "Equation"
    )]
    pub kernel: Option<String>,

    /// The ends of the interval: numbers, formulas, inf or -inf [default: 0 1]
    #[arg(
        long,
        num_args = 2,
        value_names = ["A", "B"],
        allow_hyphen_values = true,
        conflicts_with = "domain",
        help_heading = "Equation"
    )]
    pub interval: Option<Vec<String>>,

    /// A domain of the plane instead: "rectangle x0 x1 y0 y1", "triangle x1 y1 x2 y2 x3 y3" or "disk cx cy r"
    #[arg(long, value_name = "DOMAIN", help_heading = "Equation")]
    pub domain: Option<String>,

    /// A parameter of the formulas; may be given several times
    #[arg(
        long = "set",
        value_name = "NAME=NUMBER",
        value_parser = assignment,
        allow_hyphen_values = true,
        help_heading = "Equation"
    )]
    pub parameters: Vec<(String, String)>,
}

/// The right-hand side, and the solution where it is known.
#[derive(Debug, Args)]
pub struct SourceArgs {
    /// f(x) as a formula; in the plane, f(x, y)
    #[arg(
        long,
        value_name = "FORMULA",
        required_unless_present = "file",
        allow_hyphen_values = true,
        help_heading = "Equation"
    )]
    pub source: Option<String>,

    /// The solution as a formula, where it is known: the true error is told
    #[arg(long, value_name = "FORMULA", allow_hyphen_values = true, help_heading = "Equation")]
    pub exact: Option<String>,
}

/// What the formulas may have in them, for the help of each command.
pub const FORMULAS: &str = "\
Formulas: + - * / ^, comparisons, if(c, a, b), pi, e, i for complex equations, and the functions
abs min max exp ln sqrt sin cos tan asin acos atan atan2 sinh cosh tanh erf gamma besselj(n, x)
bessely(n, x) expint(n, x) ellipk(k) ellipe(k) li2.

A problem file, of which only kernel and source must be there:

  kernel = \"c / (c^2 + (x - y)^2) / 5\"
  source = \"1\"
  exact = \"exp(-x)\"                    # if it is known
  interval = [0, \"2*pi\"]               # or domain = \"disk 0 0 1\"
  parameters = { c = 0.1 }
  tolerance = 1e-12                    # class, method, space, rule, n, unknowns, at and general as well

A system φ_a = f_a + Σ_b ∫ K_ab φ_b has kernels = [[\"…\", \"…\"], [\"…\", \"…\"]], sources = [\"…\", \"…\"] and
exact = [\"…\", \"…\"] instead.";

fn assignment(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').ok_or("write it as name=number")?;
    Ok((name.trim().to_owned(), value.to_owned()))
}
