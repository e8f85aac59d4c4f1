//! Ours beside what is known: `docs/scorecard.md`, recomputed and checked on every run.
//!
//! Each case computes its values anew and holds them to an accuracy, 10⁻⁶ where no ray is cast and 10⁻³ where one is, or what
//! the case says. Then the file must say what was computed. After a change that is meant, it is written anew by
//!
//! ```sh
//! SCORECARD=renew cargo test -p radiosity --test scorecard
//! ```

#![allow(clippy::unwrap_used, reason = "in a test a panic is the message, in its helpers too")]

#[path = "scorecard/cie.rs"]
mod cie;
#[path = "scorecard/cornell.rs"]
mod cornell;
#[path = "scorecard/enclosures.rs"]
mod enclosures;
#[path = "scorecard/formulas.rs"]
mod formulas;
#[path = "scorecard/shapes.rs"]
mod shapes;
#[path = "scorecard/sky.rs"]
mod sky;

mod common;

use std::fmt::Write;
use std::path::PathBuf;

/// What is known of a case, and what we make of it.
struct Case {
    title: &'static str,
    /// What it is, and how ours is computed.
    about: &'static str,
    /// What the standard, or the source of the numbers, accepts; empty for formulas.
    accepted: &'static str,
    /// What we hold ourselves to, relative to the expected value.
    within: f64,
    /// Decimals of the table.
    decimals: usize,
    rows: Vec<Row>,
}

struct Row {
    point: String,
    expected: f64,
    ours: f64,
}

impl Row {
    fn new(point: impl Into<String>, expected: f64, ours: f64) -> Self {
        Self { point: point.into(), expected, ours }
    }

    fn error(&self) -> f64 {
        (self.ours - self.expected).abs() / if self.expected == 0.0 { 1.0 } else { self.expected.abs() }
    }
}

impl Case {
    fn worst(&self) -> f64 {
        self.rows.iter().map(Row::error).fold(0.0, f64::max)
    }

    fn check(&self) {
        for row in &self.rows {
            let Row { point, expected, ours } = row;
            assert!(row.error() <= self.within, "{}, {point}: {ours} for {expected}", self.title);
        }
    }

    fn table(&self) -> String {
        let Case { title, about, decimals, .. } = self;
        let mut text =
            format!("\n## {title}\n\n{about}\n\n| point | expected | ours | error |\n|---|---:|---:|---:|\n");
        for row in &self.rows {
            let Row { point, expected, ours } = row;
            let error = below(row.error());
            writeln!(text, "| {point} | {expected:.decimals$} | {ours:.decimals$} | {error} |").unwrap();
        }
        text
    }
}

/// The first of these that is not less: what is left of rounding differs from machine to machine.
fn below(error: f64) -> String {
    let bound =
        ["1e-10", "1e-6", "1e-3", "1e-2"].into_iter().find(|bound| error < bound.parse::<f64>().unwrap());
    format!("< {}", bound.expect("errors are less than a hundredth"))
}

const HEAD: &str = "# Scorecard

Cases of lighting and radiation with known answers, ours beside them. The test
[`scorecard.rs`](../crates/radiosity/tests/scorecard.rs) computes all of it anew on every run, fails where an error is larger
than what we hold ourselves to, and where this page says anything else. Errors are relative.

| case | points | largest error | we ask for | accepted elsewhere |
|---|---:|---:|---:|---|
";

fn page(cases: &[Case]) -> String {
    let mut page = HEAD.to_owned();
    for case in cases {
        let Case { title, within, accepted, rows, .. } = case;
        let (count, worst) = (rows.len(), below(case.worst()));
        writeln!(page, "| {title} | {count} | {worst} | {within:.0e} | {accepted} |").unwrap();
    }
    cases.iter().for_each(|case| page += &case.table());
    page
}

#[test]
fn the_scorecard_says_what_is_computed() {
    let cases: Vec<Case> =
        [cie::cases(), sky::cases(), shapes::cases(), enclosures::cases(), vec![cornell::case()]]
            .into_iter()
            .flatten()
            .collect();
    cases.iter().for_each(Case::check);
    let (page, file) =
        (page(&cases), PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../docs/scorecard.md"));
    if std::env::var_os("SCORECARD").is_some_and(|word| word == "renew") {
        std::fs::write(&file, &page).unwrap();
    }
    let said = std::fs::read_to_string(&file).unwrap_or_default();
    for (k, (said, computed)) in said.lines().zip(page.lines()).enumerate() {
        assert_eq!(said, computed, "docs/scorecard.md:{}; the head of this test says how to renew it", k + 1);
    }
    assert_eq!(said.lines().count(), page.lines().count(), "docs/scorecard.md is not complete");
}
