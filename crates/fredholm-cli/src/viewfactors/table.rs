//! The numbers of a run as people read them.

use super::asked::Asked;
use super::report::{Corrected, Report, Stages};
use crate::radiosity::table::grouped;
use crate::solve::table::time;
use crate::text::{Digits, columns, lines};
use radiosity::view_factors::ViewFactors;

/// A larger matrix is for files.
const SHOWN: usize = 12;

/// Letters of a name in the matrix: twelve columns of them fit on a wide screen.
const LETTERS: usize = 12;

/// The table, a line per matter, and the matrix itself where it is small.
pub fn table(report: &Report<'_>, factors: &ViewFactors) -> String {
    let kind =
        if report.asked.reflections { "view factors with reflections, script F" } else { "view factors" };
    let title = format!("{}: {kind}\n\n{}", report.scene, lines(&matters(report)));
    let is_small = report.names.len() <= SHOWN && factors.seen_pairs() > 0;
    if is_small { title + &matrix(report, factors) } else { title }
}

fn matters(report: &Report<'_>) -> Vec<(&'static str, String)> {
    let count = |number: usize| grouped(number as u64);
    let faces = match report.groups {
        Some(groups) => format!("{}, in {} groups", count(report.faces), count(groups)),
        None => count(report.faces),
    };
    let mut matters = vec![("faces", faces), ("pairs", pairs(report)), ("rays", grouped(report.rays))];
    if let Some(told) = report.asked.told() {
        matters.push(("the file", told));
    }
    matters.push(("error", error(report)));
    matters.push(("closure", closure(report)));
    if let Some(defect) = report.emittance_defect {
        let words = format!("rows of script F add up to the emittances within {}", power(defect));
        matters.push(("reflections", words));
    }
    if let Some(correction) = &report.correction {
        matters.push(("enforced", enforced(correction)));
    }
    let defect = match report.reciprocity_defect {
        0.0 => "exact".to_owned(),
        defect => format!("within {defect:.1e}"),
    };
    matters.push(("reciprocity", format!("{defect}, since each pair is computed once")));
    if let Some(bytes) = report.peak_memory_bytes {
        matters.push(("memory", format!("{} MB at most", grouped(bytes >> 20))));
    }
    matters.push(("time", times(report.seconds, &report.stages)));
    if !report.files.is_empty() {
        let names: Vec<String> = report.files.iter().map(|file| file.display().to_string()).collect();
        matters.push(("written", names.join(", ")));
    }
    matters
}

fn pairs(report: &Report<'_>) -> String {
    let counts = &report.pairs;
    match counts.clear + counts.hidden + counts.partly {
        0 => "NONE face each other: do the fronts look the wrong way?".to_owned(),
        facing => format!(
            "{} face each other: {} in full sight, {} in part, {} hidden",
            grouped(facing),
            grouped(counts.clear),
            grouped(counts.partly),
            grouped(counts.hidden)
        ),
    }
}

fn error(report: &Report<'_>) -> String {
    let Report { largest_error, largest_row_error, asked: Asked { tolerance, .. }, .. } = report;
    let told = format!(
        "at most {} of a factor, {} of the sum of a row",
        power(*largest_error),
        power(*largest_row_error)
    );
    let mend = match (report.is_met(), report.correction) {
        (true, _) => return format!("{told}; {tolerance:.1e} allowed"),
        (false, None) => "ask for a larger --tolerance",
        (false, Some(_)) => "what is corrected counts as error, and is less with a smaller --tolerance",
    };
    format!("{told}: TOLERANCE NOT MET, {tolerance:.1e}; {mend}")
}

fn closure(report: &Report<'_>) -> String {
    if !report.closed {
        let although = if report.asked.enclosure { ", ALTHOUGH THE FILE SAYS encl=1" } else { "" };
        let escaping = 100.0 * report.escaping;
        return format!("open{although}: {escaping:.1} % of the sight lines leave the scene");
    }
    if report.closure_rows == 0 {
        return "closed, but every row sees a back: none to check".to_owned();
    }
    let mut text = format!("closed: the rows add up to 1 within {}", power(report.closure_defect));
    match report.names.len() - report.closure_rows {
        0 => {}
        1 => text += ", but for one that sees backs",
        others => text += &format!(", but for {} that see backs", grouped(others as u64)),
    }
    if report.misses_one() > report.largest_row_error + ROUNDING {
        text += ", MORE THAN THEIR ERRORS: is there a small gap, or do faces lie in one another?";
    }
    text
}

/// What sums of 20 000 factors round, at most.
const ROUNDING: f64 = 1e-11;

/// A number by its power of ten; nothing is 0.
fn power(number: f64) -> String {
    if number == 0.0 { "0".to_owned() } else { format!("{number:.1e}") }
}

fn enforced(correction: &Corrected) -> String {
    let Corrected { largest, norm, error_norm, beyond_error, at_zero, defect_before, .. } = correction;
    let mut text = format!(
        "from {defect_before:.1e}, by {largest:.1e} of a factor at most; in L² {norm:.1e}, {:.2} of the errors",
        if *error_norm > 0.0 { norm / error_norm } else { 0.0 }
    );
    for (count, what) in [(beyond_error, "by more than their error"), (at_zero, "to 0")] {
        if *count > 0 {
            text += &format!("; {} pairs {what}", grouped(*count));
        }
    }
    text
}

fn times(seconds: f64, stages: &Stages) -> String {
    let stages = [
        ("load", stages.load),
        ("factors", stages.factors),
        ("enforce", stages.enforce),
        ("reflections", stages.reflections),
        ("write", stages.write),
    ];
    let long = stages.iter().filter(|(_, seconds)| *seconds >= 0.005);
    let words: Vec<String> = long.map(|(stage, seconds)| format!("{stage} {}", time(*seconds))).collect();
    if words.is_empty() { time(seconds) } else { format!("{}: {}", time(seconds), words.join(", ")) }
}

/// No more than eight digits are shown, and no fewer than three: errors differ, and stand beside them.
const FINEST: f64 = 1e-8;
const COARSEST: f64 = 1e-4;

/// F and its errors, with names at the head and at the left, and the sum of each row.
fn matrix(report: &Report<'_>, factors: &ViewFactors) -> String {
    let names: Vec<String> = report.names.iter().map(|name| shortened(name)).collect();
    let sums = factors.row_sums();
    let digits = Digits::new(1.0, report.largest_error.clamp(FINEST, COARSEST));
    let value = |factor: f64| if factor == 0.0 { "0".to_owned() } else { digits.write(factor) };
    let title = if report.asked.reflections { "script F" } else { "F" };
    let values = block(title, &names, |i, j| value(factors.factor(i, j)), |i| value(sums[i].value));
    let short = |error: f64| if error == 0.0 { "0".to_owned() } else { format!("{error:.0e}") };
    let errors = block("error", &names, |i, j| short(factors.error(i, j)), |i| short(sums[i].error));
    format!("\n{}\n{}", columns(&values), columns(&errors))
}

fn block(
    title: &str,
    names: &[String],
    cell: impl Fn(usize, usize) -> String,
    sum: impl Fn(usize) -> String,
) -> Vec<Vec<String>> {
    let head = std::iter::once(title).chain(names.iter().map(String::as_str)).chain(["sum"]);
    let row = |(i, name): (usize, &String)| {
        let cells = (0..names.len()).map(|j| cell(i, j));
        std::iter::once(name.clone()).chain(cells).chain([sum(i)]).collect()
    };
    std::iter::once(head.map(str::to_owned).collect()).chain(names.iter().enumerate().map(row)).collect()
}

/// A name of a dozen letters at most: its beginning, and its end, where the numbers are.
fn shortened(name: &str) -> String {
    let letters: Vec<char> = name.chars().collect();
    if letters.len() <= LETTERS {
        return name.to_owned();
    }
    let (start, end) = (&letters[..LETTERS / 2], &letters[letters.len() - LETTERS / 2 + 1..]);
    start.iter().chain(&['…']).chain(end).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_names_keep_their_ends() {
        assert_eq!(shortened("floor#12"), "floor#12");
        assert_eq!(shortened("the_northern_wall#12"), "the_no…ll#12");
        assert_eq!(shortened("the_northern_wall#12").chars().count(), LETTERS);
    }
}
