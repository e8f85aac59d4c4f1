//! What may be said to `fredholm solve`.

use super::class::ClassName;
use crate::args::{at_least_one, positive, with_extension};
use crate::problem::args::{ProblemArgs, SourceArgs};
use clap::Args;
use fredholm::methods::{Method, RuleKind};
use fredholm::space::SpaceKind;
use std::path::PathBuf;

/// What stands below the options, but for what is said of formulas.
pub const EXAMPLES: &str = "\
Examples:
  fredholm solve --kernel \"(x+1)*exp(-x*y)/2\" --source \"exp(-x) - 1/2 + exp(-(x+1))/2\"
  fredholm solve --kernel \"ln(abs(x-y))\" --source 1 --at 0:0.05:1 --plot log.svg
  fredholm solve --kernel \"exp(-(x-y)^2)/4\" --source \"exp(-x^2)\" --interval -inf inf
  fredholm solve --kernel \"(x*s+y*t)/pi\" --source \"1+3*x/4\" --domain \"disk 0 0 1\"
  fredholm solve --kernel \"4*x*y^2\" --source \"1-5*x^2/3\" --general --json - | jq .nullity
  fredholm solve problem.toml --set c=0.01 --csv phi.csv

JSON: status (converged, tolerance-not-met, no-solution or not-unique), method, n, error_estimate,
condition, nullity, solvability (a list), x and phi (lists; points of the plane as [x, y], complex
values as [re, im]; of a system phi is a list for each unknown function), seconds, and more. What is
not a finite number is null.

Exit codes: 0 solved; 1 an error; 2 a mistake on the command line; 3 all is written, but the error
estimate does not meet the tolerance; 4 there is no solution, or more than one without --general.";

/// Options of `fredholm solve`. What is `None` is left to the file, and then to a default.
#[derive(Debug, Args)]
pub struct Solve {
    /// The equation.
    #[command(flatten)]
    pub problem: ProblemArgs,

    /// Its right-hand side.
    #[command(flatten)]
    pub source: SourceArgs,

    /// The greatest error wanted, as a part of max |φ| [default: 1e-10]
    #[arg(long, value_name = "ERROR", value_parser = positive, help_heading = "Method")]
    pub tolerance: Option<f64>,

    /// The kernel's class, where it is not to be found: smooth, periodic, peaked, kink, jump, logarithmic or
    /// algebraic:EXPONENT
    #[arg(long, value_name = "CLASS", help_heading = "Method")]
    pub class: Option<ClassName>,

    /// A method by its name, instead of the one that is found: nystrom, collocation, iterated-collocation, galerkin,
    /// iterated-galerkin, least-squares, degenerate, neumann or successive
    #[arg(long, value_name = "NAME", help_heading = "Method")]
    pub method: Option<Method>,

    /// The method's space: p0, p1, p2, … on equal elements, chebyshev, legendre or fourier
    #[arg(long, value_name = "NAME", help_heading = "Method")]
    pub space: Option<SpaceKind>,

    /// The rule of nystrom: midpoint, trapezoid, simpson, newton-cotes-R of a rank R, periodic-trapezoid, gauss-legendre,
    /// gauss-legendre-K with K nodes on each of n parts, gauss-lobatto, gauss-radau, clenshaw-curtis or fejer
    #[arg(long, value_name = "NAME", help_heading = "Method")]
    pub rule: Option<RuleKind>,

    /// Elements, nodes or terms of the method; it grows to the tolerance if left out
    #[arg(long, value_name = "N", value_parser = at_least_one, help_heading = "Method")]
    pub n: Option<usize>,

    /// The most unknowns where the program finds how many it takes [default: 3000, in the plane 4096]. In a matrix time goes with
    /// their cube and memory with their square; more of them are kept in blocks of low rank, up to millions, 4 kB each, 10 kB of
    /// complex ones; so they are in the plane where K is singular at (x, y) = (s, t), some ten thousands, 50 kB each
    #[arg(long, value_name = "N", value_parser = at_least_one, help_heading = "Method")]
    pub unknowns: Option<usize>,

    /// Take one solution of many for an answer: φ plus any combination of the null functions
    #[arg(long, help_heading = "Method")]
    pub general: bool,

    /// Where φ is wanted: 0:0.1:1, or 0.07,0.31,pi/4, or in the plane "0.1,0.2; 0.3,0.4"
    #[arg(long, value_name = "POINTS", allow_hyphen_values = true, help_heading = "Output")]
    pub at: Option<String>,

    /// φ at these points, with all digits
    #[arg(long, value_name = "FILE.csv", value_parser = csv, help_heading = "Output")]
    pub csv: Option<PathBuf>,

    /// The answer as JSON; `-` writes it alone to the standard output
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub json: Option<PathBuf>,

    /// A picture of φ and of the residual f + ∫ K φ − φ
    #[arg(long, value_name = "FILE.svg|.png", value_parser = picture, help_heading = "Output")]
    pub plot: Option<PathBuf>,
}

/// The name of a table.
pub fn csv(text: &str) -> Result<PathBuf, String> {
    with_extension(text, &["csv"])
}

/// The name of a picture.
pub fn picture(text: &str) -> Result<PathBuf, String> {
    with_extension(text, &["svg", "png"])
}
