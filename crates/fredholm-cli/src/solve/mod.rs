//! `fredholm solve`: an equation becomes a function with its error, a table, files and a picture.

pub mod args;
mod class;
mod csv;
pub mod picture;
pub mod report;
mod settings;
pub mod table;

use self::args::Solve;
use self::report::Report;
use self::settings::Settings;
use crate::ending::Ending;
use crate::json::{self, Json};
use crate::output::clear_on_interrupt;
use crate::outputs::Outputs;
use crate::plot::Figure;
use crate::problem::{Domain, FormulaValue, Problem, Said, Statement, line_points, plane_points};
use anyhow::Result;
use fredholm::equation::{Complex64, Interval};
use fredholm::plane;
use std::time::Instant;

/// `fredholm solve`.
pub fn command(args: &Solve) -> Result<Ending> {
    clear_on_interrupt()?;
    let statement = Statement::new(&args.problem, Some(&args.source))?;
    let problem = Problem::new(&statement)?;
    let settings = Settings::new(args, &statement.file, &problem)?;
    let at = args.at.as_ref().map(|at| Said::option("at", at)).or_else(|| statement.file.at.clone());
    let run = Run { args, statement, problem: &problem, settings, at };
    match (problem.domain, problem.is_complex()) {
        (Domain::Line(interval), false) => run.on_line::<f64>(interval),
        (Domain::Line(interval), true) => run.on_line::<Complex64>(interval),
        (Domain::Plane(domain), false) => run.in_plane::<f64>(&domain),
        (Domain::Plane(domain), true) => run.in_plane::<Complex64>(&domain),
    }
}

/// All that was decided before the work begins.
struct Run<'a> {
    args: &'a Solve,
    statement: Statement,
    problem: &'a Problem,
    settings: Settings,
    at: Option<Said>,
}

impl Run<'_> {
    fn on_line<T: FormulaValue>(&self, interval: Interval) -> Result<Ending> {
        let points = line_points(self.at.as_ref(), interval, &self.statement.parameters)?;
        let outputs = self.outputs()?;
        let equation = self.problem.equation::<T>(interval)?;
        let start = Instant::now();
        let answer = self.settings.on_line(&equation)?;
        let seconds = start.elapsed().as_secs_f64();
        let report = Report::new(self.problem, &answer, points.clone(), &self.settings, seconds);
        let asked = self.at.as_ref().map(|_| points.as_slice());
        let window = picture::window(interval, asked);
        let draw = || Ok(picture::on_line(&self.problem.title, &equation, &answer, window)?);
        self.finish(report, outputs, draw)
    }

    fn in_plane<T: FormulaValue>(&self, domain: &plane::Domain) -> Result<Ending> {
        let points = plane_points(self.at.as_ref(), domain, &self.statement.parameters)?;
        let outputs = self.outputs()?;
        let equation = self.problem.plane_equation::<T>(*domain)?;
        let start = Instant::now();
        let answer = self.settings.in_plane(&equation)?;
        let seconds = start.elapsed().as_secs_f64();
        let report = Report::new(self.problem, &answer, points, &self.settings, seconds);
        let draw = || Ok(picture::in_plane(&self.problem.title, domain, &answer.solution));
        self.finish(report, outputs, draw)
    }

    fn outputs(&self) -> Result<Outputs> {
        let Solve { csv, json, plot, .. } = self.args;
        Outputs::prepare(csv.as_deref(), json.as_deref(), plot.as_deref())
    }

    /// Writes what was asked for, and tells the rest.
    fn finish(
        &self,
        mut report: Report,
        outputs: Outputs,
        draw: impl FnOnce() -> Result<Figure>,
    ) -> Result<Ending> {
        if let Some(output) = outputs.csv {
            report.files.push(output.write(|out| csv::write(&report, out))?);
        }
        if let Some(output) = outputs.plot {
            report.files.push(draw()?.write(output)?);
        }
        report.files.extend(outputs.json.as_ref().and_then(Json::file));
        json::tell(outputs.json, &report, &table::table(&report))?;
        Ok(match report.status {
            "converged" => Ending::Converged,
            "not-unique" if self.settings.general => Ending::Converged,
            "tolerance-not-met" => Ending::NotConverged,
            _ => Ending::NoAnswer,
        })
    }
}
