//! 8. Equations on a rectangle, a triangle and a disk of the plane.
//!
//! Builds on `03_automatic`; points are [x, y] now. New: domains, and an answer that is a function of a point.
#![expect(clippy::print_stdout, reason = "an example shows its numbers")]

use fredholm::equation::{EquationError, Status};
use fredholm::plane::{Domain, Options, PlaneEquation, solve};
use std::f64::consts::PI;

type Point = [f64; 2];

pub(crate) fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("{:<28} {:>8} {:>9} {:>9}", "domain", "unknowns", "error", "estimate");

    let kernel = |[x, y]: Point, [s, t]: Point| (-(x * s + y * t)).exp() / 2.0;
    let mean = |x: f64| (1.0 - (-(x + 1.0)).exp()) / (x + 1.0);
    let source = move |[x, y]: Point| (-(x + y)).exp() - mean(x) * mean(y) / 2.0;
    let square = PlaneEquation::new(Domain::rectangle(0.0, 1.0, 0.0, 1.0)?, kernel, source);
    show(&square, |[x, y]| (-(x + y)).exp())?;

    let kernel = |[x, y]: Point, [s, t]: Point| x * y * (s + t);
    let source = |[x, y]: Point| 1.0 + x * y * (1.0 - 1.0 / 3.0 - 1.0 / 30.0);
    let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    show(&PlaneEquation::new(Domain::triangle(corners)?, kernel, source), |[x, y]| 1.0 + x * y)?;

    let kernel = |[x, y]: Point, [s, t]: Point| (x * s + y * t) / PI;
    let disk = Domain::disk([0.0, 0.0], 1.0)?;
    show(&PlaneEquation::new(disk, kernel, |[x, _]: Point| 1.0 + 0.75 * x), |[x, _]| 1.0 + x)?;

    // Four times that kernel annuls x and y: a multiple of x can be added to a solution, and f = x has none.
    let singular = |[x, y]: Point, [s, t]: Point| 4.0 * (x * s + y * t) / PI;
    let many = PlaneEquation::new(disk, singular, |[_, _]: Point| 1.0);
    let none = PlaneEquation::new(disk, singular, |[x, _]: Point| x);
    let (many, none) = (solve(&many, &Options::default())?, solve(&none, &Options::default())?);
    println!("4 (xs + yt)/π: f = 1 {:?}, f = x {:?}", many.status, none.status);
    assert_eq!((many.status, many.nullity()), (Status::NotUnique, 2));
    assert_eq!((none.status, none.nullity()), (Status::NoSolution, 2));
    Ok(())
}

fn show(equation: &PlaneEquation<'_, f64>, exact: fn(Point) -> f64) -> Result<(), EquationError> {
    let answer = solve(equation, &Options::default())?;
    let points: [Point; 3] = [[0.1, 0.2], [0.7, 0.15], [0.3, 0.6]];
    let error = points.map(|p| (answer.at(&p) - exact(p)).abs()).into_iter().fold(0.0, f64::max);
    let domain = equation.domain().to_string();
    println!("{domain:<28} {:>8} {error:>9.1e} {:>9.1e}", answer.unknowns, answer.error_estimate);
    assert!(error <= answer.error_estimate && answer.error_estimate < 1e-12);
    Ok(())
}
