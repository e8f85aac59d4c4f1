//! `fredholm compare`: the methods of the paper on one problem, over growing n: the paper in one picture.

pub mod args;
mod contender;
mod report;

use self::args::Compare;
use self::contender::{Runs, automatic, contenders};
use self::report::Report;
use crate::ending::Ending;
use crate::json::{self, Json};
use crate::output::clear_on_interrupt;
use crate::outputs::Outputs;
use crate::plot::{Axis, Curve, Curves, Figure, Panel, Scale};
use crate::problem::{Domain, FormulaValue, Problem, Statement, equally_spaced, line_points};
use anyhow::{Result, bail};
use fredholm::equation::{Complex64, Interval};
use std::time::Instant;

/// The least n: fewer nodes show no order.
const LEAST: usize = 4;

/// Steps between the points where the error is measured.
const STEPS: usize = 40;

/// `fredholm compare`.
pub fn command(args: &Compare) -> Result<Ending> {
    clear_on_interrupt()?;
    let statement = Statement::new(&args.problem, Some(&args.source))?;
    let problem = Problem::new(&statement)?;
    let Domain::Line(interval) = problem.domain else {
        bail!(
            "the methods are compared on intervals; in the plane there is one, which `fredholm solve` takes"
        );
    };
    match problem.is_complex() {
        true => compare::<Complex64>(args, &problem, interval),
        false => compare::<f64>(args, &problem, interval),
    }
}

fn compare<T: FormulaValue>(args: &Compare, problem: &Problem, interval: Interval) -> Result<Ending> {
    let outputs = Outputs::prepare(args.csv.as_deref(), args.json.as_deref(), args.plot.as_deref())?;
    let equation = problem.equation::<T>(interval)?;
    let points = match interval.is_finite() {
        true => equally_spaced(interval.a(), interval.b(), STEPS).collect(),
        false => line_points(None, interval, &[])?,
    };
    let sizes = sizes(args.n);
    let start = Instant::now();
    let mut methods: Vec<Runs> =
        contenders().iter().map(|contender| contender.run(problem, &equation, &points, &sizes)).collect();
    methods.push(automatic(problem, &equation, &points));
    let measured = if problem.has_exact() { "error" } else { "error_estimate" };
    let seconds = start.elapsed().as_secs_f64();
    let mut report =
        Report { equation: problem.title.clone(), measured, methods, seconds, files: Vec::new() };
    if let Some(output) = outputs.csv {
        report.files.push(output.write(|out| report.csv(out))?);
    }
    if let Some(output) = outputs.plot {
        report.files.push(figure(&report).write(output)?);
    }
    report.files.extend(outputs.json.as_ref().and_then(Json::file));
    json::tell(outputs.json, &report, &report.table(&sizes))?;
    Ok(Ending::Converged)
}

/// The greatest, and its halves down to the least; all even, as Simpson's rule needs them.
fn sizes(most: usize) -> Vec<usize> {
    let halves = std::iter::successors(Some(most.max(LEAST)), |n| Some(n / 2)).take_while(|n| *n >= LEAST);
    let mut sizes: Vec<usize> = halves.map(|n| n.next_multiple_of(2)).collect();
    sizes.reverse();
    sizes
}

/// The errors against n, both logarithmic: the slope of a line is the order of its method.
fn figure(report: &Report) -> Figure {
    let curve = |runs: &Runs| Curve {
        name: runs.method.clone(),
        points: runs.runs.iter().map(|run| [run.n as f64, run.measured()]).collect(),
        marks: true,
        dashed: false,
    };
    let with_runs = report.methods.iter().filter(|runs| !runs.runs.is_empty());
    let panel = Curves {
        x: Axis { name: "n", scale: Scale::Octaves },
        y: Axis {
            name: if report.measured == "error" { "max |φ − exact|" } else { "error estimate" },
            scale: Scale::Decades,
        },
        curves: with_runs.map(curve).collect(),
        height: 560.0,
    };
    Figure { title: report.equation.clone(), panels: vec![Panel::Curves(panel)] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_even_and_grow() {
        assert_eq!(sizes(32), [4, 8, 16, 32]);
        assert_eq!(sizes(1), [4]);
        assert_eq!(sizes(50), [6, 12, 26, 50]);
    }
}
