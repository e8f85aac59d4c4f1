//! `fredholm quadrature`: a rule's nodes, weights, order and error constant; or an integral, with its error.

pub mod args;
mod rules;

use crate::args::name;
use crate::output::Output;
use crate::radiosity::Ending;
use crate::terminal::{Stream, say};
use anyhow::{Result, bail};
use args::{Quadrature as Args, Rule};
use fredholm::quadrature::{Adaptive, Integral, IntegrateError, romberg, triangle};
use rules::{Known, formula, known};
use serde::Serialize;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;

/// `fredholm quadrature`.
pub fn command(args: &Args) -> Result<Ending> {
    match (args.rule, args.integrate.as_deref()) {
        (Some(Rule::Triangle), None) => on_triangle(args),
        (Some(rule), None) => on_interval(args, rule),
        (Some(rule), Some(text)) if rule != Rule::Romberg => by_rule(args, rule, text),
        (_, Some(text)) => to_tolerance(args, text),
        (None, None) => bail!("say which --rule, or what to --integrate"),
    }
}

/// What `--json` writes of a rule.
#[derive(Debug, Serialize)]
struct RuleReport<'a, P> {
    rule: String,
    nodes: &'a [P],
    weights: &'a [f64],
    order: Option<usize>,
    error_constant: Option<f64>,
}

/// What `--json` writes of an integral; a plain rule knows no error.
#[derive(Debug, Serialize)]
struct IntegralReport {
    status: &'static str,
    value: f64,
    error_estimate: Option<f64>,
    evaluations: usize,
}

fn on_interval(args: &Args, rule: Rule) -> Result<Ending> {
    let Known { rule: made, order, constant } = known(args, rule)?;
    let mut text = format!("{}, {}\n", name(&rule), counted(made.nodes.len()));
    for (x, w) in made.nodes.iter().zip(&made.weights) {
        writeln!(text, "{x:>24.16e}  {w:>24.16e}")?;
    }
    text.push_str(&match (order, constant) {
        (Some(order), Some(c)) => format!("order {order}, E(f) = {c:.6e} f^({})(ξ)\n", order + 1),
        _ => "the order cannot be told from rounding\n".to_owned(),
    });
    let report = RuleReport {
        rule: name(&rule),
        nodes: &made.nodes,
        weights: &made.weights,
        order,
        error_constant: constant,
    };
    tell(args.json.as_deref(), &report, &text)?;
    Ok(Ending::Converged)
}

fn on_triangle(args: &Args) -> Result<Ending> {
    let made = triangle(args.degree, [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])?;
    let mut text = format!("triangle, {}, exact to degree {}\n", counted(made.nodes.len()), args.degree);
    for ([x, y], w) in made.nodes.iter().zip(&made.weights) {
        writeln!(text, "{x:>24.16e}  {y:>24.16e}  {w:>24.16e}")?;
    }
    let report = RuleReport {
        rule: name(&Rule::Triangle),
        nodes: &made.nodes,
        weights: &made.weights,
        order: Some(args.degree),
        error_constant: None,
    };
    tell(args.json.as_deref(), &report, &text)?;
    Ok(Ending::Converged)
}

fn counted(nodes: usize) -> String {
    if nodes == 1 { "1 node".to_owned() } else { format!("{nodes} nodes") }
}

/// Σ w f(x) by the rule that was asked for.
fn by_rule(args: &Args, rule: Rule, text: &str) -> Result<Ending> {
    let integrand = formula(text)?;
    let made = known(args, rule)?.rule;
    for x in &made.nodes {
        let value = integrand.at(&[*x]);
        if !value.is_finite() {
            bail!("{text} is {value} at x = {x}, a node of the rule; give a rule without that node");
        }
    }
    let value = made.integrate(|x| integrand.at(&[*x]));
    let evaluations = made.nodes.len();
    let report = IntegralReport { status: "rule", value, error_estimate: None, evaluations };
    tell(args.json.as_deref(), &report, &format!("{value:.16e}\nevaluations {evaluations}\n"))?;
    Ok(Ending::Converged)
}

/// The integral by the adaptive method or Romberg's.
fn to_tolerance(args: &Args, text: &str) -> Result<Ending> {
    let integrand = formula(text)?;
    let (a, b) = (args.from.unwrap_or(-1.0), args.to.unwrap_or(1.0));
    if !(args.tolerance > 0.0 && args.tolerance.is_finite()) {
        bail!("--tolerance {}: give a positive finite number", args.tolerance);
    }
    let f = |x: f64| integrand.at(&[x]);
    let found = match args.rule {
        Some(_) if !(a.is_finite() && b.is_finite()) => bail!("Romberg's method needs a finite interval"),
        Some(_) => romberg(f, a, b, args.tolerance),
        None => Adaptive { relative: args.tolerance, ..Adaptive::default() }.integrate(f, a, b),
    };
    let (integral, ending) = match found {
        Ok(integral) => (integral, Ending::Converged),
        Err(IntegrateError::NotConverged { best, .. }) => (best, Ending::NotConverged),
        Err(error) => return Err(error.into()),
    };
    let Integral { value, error, evaluations } = integral;
    let converged = ending == Ending::Converged;
    let status = if converged { "converged" } else { "tolerance-not-met" };
    let mut lines = format!("{value:.16e}\nestimated error {error:.1e}\nevaluations {evaluations}\n");
    if !converged {
        lines.push_str("the tolerance was not met\n");
    }
    let report = IntegralReport { status, value, error_estimate: Some(error), evaluations };
    tell(args.json.as_deref(), &report, &lines)?;
    Ok(ending)
}

/// Writes the report where it was asked for, and the text to the terminal, unless the report goes there.
fn tell(json: Option<&Path>, report: &impl Serialize, text: &str) -> Result<()> {
    let Some(path) = json else { return Ok(say(Stream::Out, text)?) };
    let mut whole = serde_json::to_string_pretty(report)?;
    whole.push('\n');
    if path == Path::new("-") {
        return Ok(say(Stream::Out, &whole)?);
    }
    Output::prepare(path)?.write(|out| out.write_all(whole.as_bytes()))?;
    Ok(say(Stream::Out, text)?)
}
