//! The answer as people read it.

use super::report::{Report, Values};
use crate::problem::Number;
use crate::text::{Digits, columns, lines, short};

/// More points than these are for files.
const ROWS: usize = 200;

/// What was found, a line per matter, and φ at the points asked for.
pub fn table(report: &Report) -> String {
    let mut matters = vec![("status", status(report)), ("method", method(report))];
    if let Some(class) = &report.class {
        matters.push(("kernel", class.clone()));
    }
    if report.status != "no-solution" {
        matters.push(("error", error(report)));
    }
    matters.extend(not_finite(report));
    matters.push(("condition", condition(report)));
    matters.extend(alternative(report));
    matters.push(("time", time(report.seconds)));
    if !report.files.is_empty() {
        let names: Vec<String> = report.files.iter().map(|file| file.display().to_string()).collect();
        matters.push(("written", names.join(", ")));
    }
    format!("{}\n\n{}\n{}", report.equation, lines(&matters), values(report))
}

fn status(report: &Report) -> String {
    match report.status {
        "converged" => "converged".to_owned(),
        "tolerance-not-met" => {
            // A next attempt has no more than twice as many.
            let limit = report.most_unknowns.filter(|most| 2 * report.n > *most);
            let more =
                limit.map_or_else(String::new, |most| format!("allow more than {most} --unknowns, or "));
            format!("TOLERANCE NOT MET: this is the best that was found; {more}ask for a larger --tolerance")
        }
        "no-solution" => {
            "NO SOLUTION: f is not orthogonal to the null space of the adjoint of I − A".to_owned()
        }
        _ => "NOT UNIQUE: φ is a particular solution, to which any null function may be added".to_owned(),
    }
}

fn method(report: &Report) -> String {
    format!("{}, n = {}", report.method, report.n)
}

fn error(report: &Report) -> String {
    let Report { error_estimate, tolerance, .. } = report;
    let estimate = format!("{error_estimate:.1e} by the residual, {tolerance:.1e} max |φ| allowed");
    match report.true_error {
        Some(error) => format!("{estimate}; {error:.1e} in truth, at the points below"),
        None => estimate,
    }
}

/// Where there is no φ, though there should be.
fn not_finite(report: &Report) -> Option<(&'static str, String)> {
    let lost = report.phi.first_lost().filter(|_| report.status != "no-solution")?;
    let names = report.x.names().iter().zip(report.x.coordinates(lost));
    let place: Vec<String> = names.map(|(name, x)| format!("{name} = {}", short(*x))).collect();
    let place = place.join(", ");
    Some(("not finite", format!("φ at {place}, where K or f is not: the error is that of other places")))
}

fn condition(report: &Report) -> String {
    if report.condition.is_finite() { format!("{:.2e}", report.condition) } else { "infinite".to_owned() }
}

/// What Fredholm's alternative says (paper, th. 1.5).
fn alternative(report: &Report) -> Vec<(&'static str, String)> {
    let mut matters = Vec::new();
    if report.nullity > 0 {
        let functions = numbered("φ", report.nullity);
        matters.push((
            "null space",
            format!("of dimension {}: ∫ K φ = φ for φ = {functions}, orthonormal", report.nullity),
        ));
        let products = report.solvability.iter().enumerate();
        let products: Vec<String> =
            products.map(|(k, product)| format!("⟨f, ψ{}⟩ = {}", index(k), complex(product))).collect();
        matters.push(("solvable", format!("if all vanish: {}", products.join(", "))));
        let particular = match report.status {
            "no-solution" => "none, since they do not".to_owned(),
            _ => format!("φ + {}, with any numbers a", combination(report.nullity)),
        };
        matters.push(("solutions", particular));
    } else if let Some(distance) = report.distance_to_spectrum {
        matters.push(("spectrum", format!("1 is {distance:.1e} away from it")));
    }
    matters
}

fn numbered(name: &str, count: usize) -> String {
    (0..count).map(|k| format!("{name}{}", index(k))).collect::<Vec<_>>().join(", ")
}

fn combination(count: usize) -> String {
    (0..count).map(|k| format!("a{0} φ{0}", index(k))).collect::<Vec<_>>().join(" + ")
}

/// ₁, ₂, ₃ …
fn index(k: usize) -> String {
    let digits = (k + 1).to_string();
    digits.chars().filter_map(|c| char::from_u32(0x2080 + c.to_digit(10)?)).collect()
}

fn complex(number: &Number) -> String {
    match number {
        Number::Real(value) => format!("{value:.1e}"),
        Number::Complex([re, im]) => {
            format!("{re:.1e} {} {:.1e} i", if *im < 0.0 { '−' } else { '+' }, im.abs())
        }
    }
}

/// Seconds, in words.
pub fn time(seconds: f64) -> String {
    match seconds {
        0.0..1e-3 => format!("{:.0} µs", seconds * 1e6),
        1e-3..1.0 => format!("{:.1} ms", seconds * 1e3),
        _ => format!("{seconds:.2} s"),
    }
}

/// φ and the null functions at the points.
fn values(report: &Report) -> String {
    let mut table: Vec<Vec<String>> = Vec::new();
    for (axis, name) in report.x.names().iter().enumerate() {
        table.push(column(name, report.x.len(), |k| short(report.x.coordinates(k)[axis])));
    }
    let point = report.x.names().join(", ");
    if report.status != "no-solution" {
        table.extend(shown("φ", &point, &report.phi, report.error_estimate));
    }
    for (k, function) in report.null_space.iter().enumerate() {
        // Nobody estimates the error of a null function; digits of that of φ would be none where there is no φ.
        let error = if report.error_estimate.is_finite() { report.error_estimate } else { report.tolerance };
        table.extend(shown(&format!("φ{}", index(k)), &point, function, error));
    }
    let rows = report.x.len().min(ROWS) + 1;
    let rows: Vec<Vec<String>> =
        (0..rows).map(|k| table.iter().map(|column| column[k].clone()).collect()).collect();
    let rest = report.x.len().saturating_sub(ROWS);
    let more =
        if rest > 0 { format!("   … and {rest} more; --csv writes them all\n") } else { String::new() };
    columns(&rows) + &more
}

fn column(head: &str, rows: usize, cell: impl Fn(usize) -> String) -> Vec<String> {
    std::iter::once(head.to_owned()).chain((0..rows).map(cell)).collect()
}

/// The columns of a function.
fn shown(name: &str, point: &str, values: &Values, error: f64) -> Vec<Vec<String>> {
    let components = values.components();
    let digits = Digits::new(values.largest(), error);
    let mut columns = Vec::new();
    for (c, values) in components.iter().enumerate() {
        let component = if components.len() > 1 { format!(" {}", c + 1) } else { String::new() };
        let parts = values.first().map_or(1, |value| value.parts().len());
        for part in 0..parts {
            let head = match (parts, part) {
                (1, _) => format!("{name}({point}){component}"),
                (_, 0) => format!("Re {name}({point}){component}"),
                _ => format!("Im {name}({point}){component}"),
            };
            columns.push(column(&head, values.len(), |k| digits.write(values[k].parts()[part])));
        }
    }
    columns
}
