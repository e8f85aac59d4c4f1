//! All methods on one problem: what `--json` writes, and the table.

use super::contender::{Run, Runs};
use crate::solve::table::time;
use crate::text::columns;
use serde::Serialize;
use std::io::{self, Write};
use std::path::PathBuf;

/// The comparison in numbers, in the order of the JSON.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// The equation, in words.
    pub equation: String,
    /// `error`, where the solution is known, or `error_estimate`.
    pub measured: &'static str,
    /// Each method with its runs.
    pub methods: Vec<Runs>,
    /// Seconds of all runs.
    pub seconds: f64,
    /// The files written.
    pub files: Vec<PathBuf>,
}

impl Report {
    /// What people read: a line per method, a column per n.
    pub fn table(&self, sizes: &[usize]) -> String {
        let mut head = vec!["n".to_owned()];
        head.extend(sizes.iter().map(usize::to_string));
        head.extend(["order".to_owned(), "time".to_owned()]);
        let (fixed, own): (Vec<&Runs>, Vec<&Runs>) =
            self.methods.iter().partition(|runs| runs.method != AUTOMATIC);
        let rows: Vec<Vec<String>> = fixed.iter().map(|runs| row(runs, sizes)).collect();
        let width = rows.iter().map(|row| row[0].chars().count()).max().unwrap_or(0);
        let left = |mut row: Vec<String>| {
            row[0] = format!("{:<width$}", row[0]);
            row
        };
        let rows: Vec<Vec<String>> = std::iter::once(head).chain(rows).map(left).collect();
        let what = match self.measured {
            "error" => "max |φ − exact| at 41 points",
            _ => "the error estimate by the residual",
        };
        let mut text = format!("{}\n\n  {what}, for each n\n\n{}\n", self.equation, columns(&rows));
        for runs in own {
            text += &match runs.runs.first() {
                Some(run) => format!(
                    "   automatic: {:.1e} with {} unknowns, estimated {:.1e}, in {}\n",
                    run.measured(),
                    run.unknowns,
                    run.error_estimate,
                    time(run.seconds)
                ),
                None => String::new(),
            };
        }
        for runs in &self.methods {
            if let Some(reason) = &runs.refused {
                let n = runs.runs.last().map_or(String::new(), |run| format!(" beyond n = {}", run.n));
                text += &format!("   {}{n}: {reason}\n", runs.method);
            }
        }
        let written: Vec<String> = self.files.iter().map(|file| file.display().to_string()).collect();
        if !written.is_empty() {
            text += &format!("\n   written: {}\n", written.join(", "));
        }
        text
    }

    /// A line for each method and n.
    pub fn csv(&self, out: &mut impl Write) -> io::Result<()> {
        writeln!(out, "method,n,unknowns,error,error_estimate,order,seconds")?;
        let optional = |number: Option<f64>| number.map_or(String::new(), |number| format!("{number:e}"));
        for runs in &self.methods {
            for Run { n, unknowns, error, error_estimate, order, seconds } in &runs.runs {
                let (error, order) = (optional(*error), optional(*order));
                writeln!(
                    out,
                    "{},{n},{unknowns},{error},{error_estimate:e},{order},{seconds:e}",
                    runs.method
                )?;
            }
        }
        Ok(())
    }
}

/// The method that finds its own n.
pub const AUTOMATIC: &str = "automatic";

fn row(runs: &Runs, sizes: &[usize]) -> Vec<String> {
    let error = |n: &usize| {
        let run = runs.runs.iter().find(|run| run.n == *n);
        run.map_or("–".to_owned(), |run| format!("{:.1e}", run.measured()))
    };
    let order = runs.runs.iter().rev().find_map(|run| run.order);
    let order = order.map_or(String::new(), |order| format!("{order:.1}"));
    let seconds = runs.runs.last().map_or(String::new(), |run| time(run.seconds));
    let errors = sizes.iter().map(error);
    std::iter::once(runs.method.clone()).chain(errors).chain([order, seconds]).collect()
}
