//! `fredholm spectrum`: the eigenvalues λ and eigenfunctions of ∫ K φ = λ φ.

pub mod args;
mod report;

use self::args::Spectrum;
use self::report::Report;
use crate::ending::Ending;
use crate::json::{self, Json};
use crate::output::clear_on_interrupt;
use crate::outputs::Outputs;
use crate::plot::{Axis, Curve, Curves, Figure, Panel, Scale};
use crate::problem::{Domain, FormulaValue, Number, Problem, Said, Statement, line_points};
use crate::solve::picture::{curves, window};
use crate::solve::report::Values;
use anyhow::{Result, bail};
use fredholm::equation::{Complex64, Interval};
use fredholm::spectrum::{Eigenpair, spectrum};
use std::time::Instant;

/// The greatest error wanted, when nobody says.
const TOLERANCE: f64 = 1e-10;

/// Eigenfunctions in a picture: more lines cannot be followed.
const DRAWN: usize = 5;

/// `fredholm spectrum`.
pub fn command(args: &Spectrum) -> Result<Ending> {
    clear_on_interrupt()?;
    let statement = Statement::new(&args.problem, None)?;
    let problem = Problem::new(&statement)?;
    let Domain::Line(interval) = problem.domain else {
        bail!("the spectrum is computed on intervals, not in the plane");
    };
    match problem.is_complex() {
        true => run::<Complex64>(args, &statement, &problem, interval),
        false => run::<f64>(args, &statement, &problem, interval),
    }
}

fn run<T: FormulaValue>(
    args: &Spectrum,
    statement: &Statement,
    problem: &Problem,
    interval: Interval,
) -> Result<Ending> {
    let at = args.at.as_ref().map(|at| Said::option("at", at)).or_else(|| statement.file.at.clone());
    let x = line_points(at.as_ref(), interval, &statement.parameters)?;
    let outputs = Outputs::prepare(args.csv.as_deref(), args.json.as_deref(), args.plot.as_deref())?;
    let tolerance = args.tolerance.or(statement.file.tolerance).unwrap_or(TOLERANCE);
    let equation = problem.homogeneous::<T>(interval)?;
    let start = Instant::now();
    let found = spectrum(&equation, args.count, tolerance)?;
    let seconds = start.elapsed().as_secs_f64();
    let pairs = &found.eigenpairs;
    let distance = pairs.iter().map(|pair| (Complex64::new(1.0, 0.0) - pair.value).norm());
    let mut report = Report {
        equation: problem.title.clone(),
        n: found.unknowns,
        eigenvalues: pairs.iter().map(|pair| pair.value.number()).collect(),
        error_estimates: pairs.iter().map(|pair| pair.error_estimate).collect(),
        tolerance,
        distance_to_spectrum: distance.fold(1.0, f64::min),
        eigenfunctions: pairs.iter().map(|pair| Values::new(&pair.function, &x)).collect(),
        x,
        seconds,
        files: Vec::new(),
    };
    if let Some(output) = outputs.csv {
        report.files.push(output.write(|out| report.csv(out))?);
    }
    if let Some(output) = outputs.plot {
        let asked = at.is_some().then_some(report.x.as_slice());
        report.files.push(figure(&report, pairs, window(interval, asked)).write(output)?);
    }
    report.files.extend(outputs.json.as_ref().and_then(Json::file));
    json::tell(outputs.json, &report, &report.table())?;
    Ok(if report.is_converged() { Ending::Converged } else { Ending::NotConverged })
}

/// The eigenvalues' moduli above, the first eigenfunctions below.
fn figure(report: &Report, pairs: &[Eigenpair<'_>], window: [f64; 2]) -> Figure {
    let moduli = report.eigenvalues.iter().map(Number::modulus).enumerate();
    let values = Curve {
        name: String::new(),
        points: moduli.map(|(k, modulus)| [(k + 1) as f64, modulus]).collect(),
        marks: true,
        dashed: false,
    };
    let drawn = pairs.iter().take(DRAWN).enumerate();
    let functions = drawn.flat_map(|(k, pair)| real_curves(&format!("φ{}", k + 1), pair, window)).collect();
    let linear = |name| Axis { name, scale: Scale::Linear };
    let above = Curves {
        x: linear("k"),
        y: Axis { name: "|λ|", scale: Scale::Decades },
        curves: vec![values],
        height: 280.0,
    };
    let below = Curves { x: linear("x"), y: linear("φ(x)"), curves: functions, height: 380.0 };
    Figure { title: report.equation.clone(), panels: vec![Panel::Curves(above), Panel::Curves(below)] }
}

/// Imaginary parts below this part of the largest value are rounding.
const REAL: f64 = 1e-8;

/// The parts of an eigenfunction, without imaginary parts that are rounding alone.
fn real_curves(name: &str, pair: &Eigenpair<'_>, window: [f64; 2]) -> Vec<Curve> {
    let curves = curves(name, &pair.function, window);
    let largest = |curve: &Curve| curve.points.iter().map(|point| point[1].abs()).fold(0.0, f64::max);
    let most = curves.iter().map(largest).fold(0.0, f64::max);
    let (real, imaginary): (Vec<Curve>, Vec<Curve>) =
        curves.into_iter().partition(|curve| !curve.name.starts_with("Im "));
    if imaginary.iter().any(|curve| largest(curve) > REAL * most) {
        return real.into_iter().chain(imaginary).collect();
    }
    let renamed = |curve: Curve| Curve { name: curve.name.trim_start_matches("Re ").to_owned(), ..curve };
    real.into_iter().map(renamed).collect()
}
