//! A rule by its name, on its interval, with its order and its error constant.

use super::args::{Quadrature as Args, Rule};
use crate::args::name;
use anyhow::{Context, Result, bail, ensure};
use expression::Formula;
use fredholm::quadrature::{self, Quadrature, Recurrence};

/// A rule, and what is known of it.
#[derive(Debug)]
pub struct Known {
    /// Its nodes and weights, on the interval asked for.
    pub rule: Quadrature<f64>,
    /// The order N for its weight, where it can be told from rounding.
    pub order: Option<usize>,
    /// C in E(f) = C f^(N+1)(ξ).
    pub constant: Option<f64>,
}

/// A rule on [−1, 1] or its own infinite interval, beside the polynomials that tell its order.
struct Reference {
    rule: Quadrature<f64>,
    polynomials: Recurrence,
    /// The weight's integral grows as the length of the interval to this power.
    power: f64,
}

/// The rule that was asked for, on an interval.
pub fn known(args: &Args, rule: Rule) -> Result<Known> {
    let reference = reference(args, rule)?;
    let order = reference.polynomials.order(&reference.rule);
    let constant = reference.polynomials.error_constant(&reference.rule);
    let settled = own_interval(rule);
    ensure!(
        !settled || (args.from.is_none() && args.to.is_none()) || rule == Rule::Gauss,
        "the rule {} has its own interval: leave out --from and --to",
        name(&rule)
    );
    ensure!(args.panels > 0, "--panels 0: give 1 or more");
    ensure!(args.panels == 1 || reference.power == 1.0 && !settled, "--panels needs a rule for the weight 1");
    if settled {
        return Ok(Known { rule: reference.rule, order, constant });
    }
    let (a, b) = finite(args)?;
    let half = 0.5 * (b - a) / args.panels as f64;
    let scale = args.panels as f64 * half.powf(reference.power);
    let constant =
        constant.zip(order).map(|(constant, order)| constant * scale * half.powi(order as i32 + 1));
    let rule = match args.panels {
        1 => placed(args, rule, &reference, a, b)?,
        panels => reference.rule.map(|x, w| (0.5 * (x + 1.0), 0.5 * w)).composite(a, b, panels)?,
    };
    Ok(Known { rule, order, constant })
}

/// [a, b], both finite.
fn finite(args: &Args) -> Result<(f64, f64)> {
    let (a, b) = (args.from.unwrap_or(-1.0), args.to.unwrap_or(1.0));
    ensure!(
        a.is_finite() && b.is_finite() && a < b,
        "from {a} to {b} is no finite interval; give --from below --to"
    );
    Ok((a, b))
}

fn own_interval(rule: Rule) -> bool {
    matches!(rule, Rule::GaussLaguerre | Rule::GaussHermite | Rule::Gauss)
}

/// The rule from the formula for [a, b] itself where there is one: it keeps the digits at the ends.
fn placed(args: &Args, rule: Rule, reference: &Reference, a: f64, b: f64) -> Result<Quadrature<f64>> {
    Ok(match rule {
        Rule::GaussLegendre => quadrature::gauss_legendre(args.n, a, b),
        Rule::GaussJacobi => quadrature::gauss_jacobi(args.n, args.alpha, args.beta, a, b)?,
        Rule::GaussChebyshev1 => quadrature::gauss_chebyshev_1(args.n, a, b),
        Rule::GaussChebyshev2 => quadrature::gauss_chebyshev_2(args.n, a, b),
        Rule::GaussLobatto => quadrature::gauss_lobatto(args.n, a, b)?,
        Rule::GaussRadau => quadrature::gauss_radau(args.n, a, b)?,
        Rule::ClenshawCurtis => quadrature::clenshaw_curtis(args.n, a, b)?,
        _ => reference.rule.map(|x, w| (0.5 * (x + 1.0), 0.5 * w)).composite(a, b, 1)?,
    })
}

fn reference(args: &Args, rule: Rule) -> Result<Reference> {
    let n = args.n;
    ensure!((1..=MOST).contains(&n), "--n {n}: give 1 to {MOST}");
    // Two more than the order 2n − 1 that no rule exceeds.
    let degree = 2 * n.max(5) + 2;
    let plain = |rule| Reference { rule, polynomials: Recurrence::legendre(degree), power: 1.0 };
    Ok(match rule {
        Rule::NewtonCotes => {
            plain(quadrature::newton_cotes(n - 1, -1.0, 1.0).context("Newton–Cotes has n − 1 panels")?)
        }
        Rule::NewtonCotesOpen => plain(quadrature::newton_cotes_open(n, -1.0, 1.0)?),
        Rule::Midpoint => plain(quadrature::midpoint(-1.0, 1.0, 1)?),
        Rule::Trapezoid => plain(quadrature::trapezoid(-1.0, 1.0, 1)?),
        Rule::Simpson => plain(quadrature::simpson(-1.0, 1.0, 1)?),
        Rule::Boole => plain(quadrature::boole(-1.0, 1.0, 1)?),
        Rule::GaussLegendre => plain(quadrature::gauss_legendre(n, -1.0, 1.0)),
        Rule::GaussLobatto => plain(quadrature::gauss_lobatto(n, -1.0, 1.0)?),
        Rule::GaussRadau => plain(quadrature::gauss_radau(n, -1.0, 1.0)?),
        Rule::ClenshawCurtis => plain(quadrature::clenshaw_curtis(n, -1.0, 1.0)?),
        Rule::GaussChebyshev1 => Reference {
            rule: quadrature::gauss_chebyshev_1(n, -1.0, 1.0),
            polynomials: Recurrence::chebyshev_1(degree),
            power: 0.0,
        },
        Rule::GaussChebyshev2 => Reference {
            rule: quadrature::gauss_chebyshev_2(n, -1.0, 1.0),
            polynomials: Recurrence::chebyshev_2(degree),
            power: 2.0,
        },
        Rule::GaussJacobi => Reference {
            rule: quadrature::gauss_jacobi(n, args.alpha, args.beta, -1.0, 1.0)?,
            polynomials: Recurrence::jacobi(degree, args.alpha, args.beta),
            power: args.alpha + args.beta + 1.0,
        },
        Rule::GaussLaguerre => Reference {
            rule: quadrature::gauss_laguerre(n, args.alpha)?,
            polynomials: Recurrence::laguerre(degree, args.alpha),
            power: 1.0,
        },
        Rule::GaussHermite => Reference {
            rule: quadrature::gauss_hermite(n),
            polynomials: Recurrence::hermite(degree),
            power: 1.0,
        },
        Rule::Gauss => own(args, degree)?,
        Rule::Romberg => bail!("--rule romberg is a method, not a table: say what to --integrate"),
        Rule::Triangle => bail!("a rule on the triangle does not integrate a formula in x alone"),
    })
}

/// More nodes than this would take minutes to tell the order of.
const MOST: usize = 10_000;

/// Gauss's rule for the weight typed.
fn own(args: &Args, degree: usize) -> Result<Reference> {
    let text = args.weight.as_deref().context("--rule gauss needs a --weight, a formula in x")?;
    let weight = formula(text)?;
    let (a, b) = (args.from.unwrap_or(-1.0), args.to.unwrap_or(1.0));
    let polynomials = Recurrence::of_weight(degree, |x| weight.at(&[x]), a, b)?;
    let first = Recurrence {
        diagonal: polynomials.diagonal[..args.n].to_vec(),
        beside: polynomials.beside[..args.n].to_vec(),
        mass: polynomials.mass,
    };
    Ok(Reference { rule: first.gauss(), polynomials, power: 1.0 })
}

/// A formula in x with real values.
pub fn formula(text: &str) -> Result<Formula> {
    let formula = Formula::parse(text, &["x"])?;
    ensure!(
        !formula.is_complex(),
        "the formula {text} has complex values; take its real and imaginary part apart"
    );
    Ok(formula)
}
