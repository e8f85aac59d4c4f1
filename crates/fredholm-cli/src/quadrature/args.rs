//! What may be said after `fredholm quadrature`.

use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Examples, after the options.
pub const EXAMPLES: &str = "\
Examples:
  fredholm quadrature --rule gauss-legendre --n 8             nodes, weights, order, error constant
  fredholm quadrature --rule simpson --panels 10 --from 0 --to 1
  fredholm quadrature --rule gauss --weight=\"-ln(x)\" --n 5 --from 0 --to 1
  fredholm quadrature --rule triangle --degree 20 --json -
  fredholm quadrature --integrate \"exp(-x)/sqrt(x)\" --from 0 --to inf
  fredholm quadrature --integrate \"exp(x)\" --rule romberg --from 0 --to 1

E(f), the integral less the rule, is C f^(N+1)(ξ) for a rule of order N whose Peano kernel has one sign.

Exit codes: 0 done; 1 an error; 2 a mistake on the command line; 3 integrated, but not to the tolerance.";

/// Options of `fredholm quadrature`.
#[derive(Debug, Args)]
pub struct Quadrature {
    /// The rule; left out, `--integrate` adapts to the integrand
    #[arg(long, value_enum, required_unless_present = "integrate")]
    pub rule: Option<Rule>,

    /// How many nodes the rule has, in each panel
    #[arg(long, value_name = "N", default_value_t = 8)]
    pub n: usize,

    /// On how many equal panels the rule is repeated
    #[arg(long, value_name = "M", default_value_t = 1)]
    pub panels: usize,

    /// Where the interval begins; -inf is a number here [default: -1]
    #[arg(long, value_name = "A", value_parser = number, allow_hyphen_values = true)]
    pub from: Option<f64>,

    /// Where it ends, inf allowed [default: 1]
    #[arg(long, value_name = "B", value_parser = number, allow_hyphen_values = true)]
    pub to: Option<f64>,

    /// α of the weights (b − x)^α (x − a)^β and x^α exp(−x)
    #[arg(long, value_name = "ALPHA", default_value_t = 0.0, allow_hyphen_values = true)]
    pub alpha: f64,

    /// β of the weight (b − x)^α (x − a)^β
    #[arg(long, value_name = "BETA", default_value_t = 0.0, allow_hyphen_values = true)]
    pub beta: f64,

    /// The weight of the rule `gauss`, a formula in x
    #[arg(long, value_name = "EXPR", allow_hyphen_values = true)]
    pub weight: Option<String>,

    /// The degree to which the rule `triangle` is exact
    #[arg(long, value_name = "DEGREE", default_value_t = 5)]
    pub degree: usize,

    /// Integrate this formula in x
    #[arg(long, value_name = "EXPR", allow_hyphen_values = true)]
    pub integrate: Option<String>,

    /// The error to stop at, relative to the integral
    #[arg(long, value_name = "ERROR", default_value_t = 1e-12)]
    pub tolerance: f64,

    /// Nodes and weights, or the integral, as JSON; `-` writes it alone to the standard output
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
}

/// Rules by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Rule {
    /// Equidistant nodes with both ends
    NewtonCotes,
    /// Equidistant nodes without the ends
    NewtonCotesOpen,
    /// Newton–Cotes with 1 node, open
    Midpoint,
    /// Newton–Cotes with 2 nodes
    Trapezoid,
    /// Newton–Cotes with 3 nodes
    Simpson,
    /// Newton–Cotes with 5 nodes
    Boole,
    /// Gauss for the weight 1
    GaussLegendre,
    /// Gauss for 1/√((b − x)(x − a))
    #[value(name = "gauss-chebyshev-1")]
    GaussChebyshev1,
    /// Gauss for √((b − x)(x − a))
    #[value(name = "gauss-chebyshev-2")]
    GaussChebyshev2,
    /// Gauss for (b − x)^α (x − a)^β
    GaussJacobi,
    /// Gauss for x^α exp(−x) on [0, ∞)
    GaussLaguerre,
    /// Gauss for exp(−x²) on the real line
    GaussHermite,
    /// Gauss with both ends among the nodes
    GaussLobatto,
    /// Gauss with the beginning among the nodes
    GaussRadau,
    /// Gauss for a weight of your own, `--weight`
    Gauss,
    /// The extrema of Chebyshev's polynomial
    ClenshawCurtis,
    /// Trapezoidal sums, extrapolated; needs `--integrate`
    Romberg,
    /// Symmetric on the triangle (0,0), (1,0), (0,1)
    Triangle,
}

fn number(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number: &f64| !number.is_nan());
    number.ok_or_else(|| "give a number, inf or -inf".to_owned())
}
