//! 3. An equation stated and nothing else: the kernel's class is found, and every answer comes with its error.
//!
//! Builds on `02_methods`, where a method, a space and an n were chosen. New: [`solve`] chooses them, whatever the kernel
//! does on its diagonal x = y and however long the interval is.
#![expect(clippy::print_stdout, reason = "an example shows its numbers")]

use fredholm::automatic::{Options, solve};
use fredholm::equation::{ByOffset, Class, Equation, Interval};
use std::f64::consts::PI;

type Failure = Box<dyn std::error::Error>;

pub(crate) fn main() -> Result<(), Failure> {
    let unit = Interval::new(0.0, 1.0)?;
    println!("{:<30} {:>8} {:>9} {:>9}", "class", "unknowns", "error", "estimate");

    let source = |x: f64| (-x).exp() - 0.5 + (-(x + 1.0)).exp() / 2.0;
    let equation = Equation::new(unit, |x: f64, y: f64| (x + 1.0) * (-x * y).exp() / 2.0, source);
    show(Class::Smooth, &equation, |x| (-x).exp())?;

    // Everything goes once round a circle.
    let kernel = |x: f64, y: f64| -0.3 / PI / (1.0 - 0.64 * ((x + y) / 2.0).cos().powi(2));
    let equation = Equation::new(Interval::new(-PI, PI)?, kernel, |x: f64| 25.0 - 16.0 * x.sin().powi(2));
    show(Class::Periodic, &equation, |x| 8.5 + 128.0 / 17.0 * (2.0 * x).cos())?;

    // A peak a hundredth of the interval wide.
    let kernel = |x: f64, y: f64| 0.002 / (1e-4 + (x - y).powi(2));
    let source = |x: f64| 1.0 - 0.2 * ((100.0 * x).atan() + (100.0 - 100.0 * x).atan());
    show(Class::Peaked, &Equation::new(unit, kernel, source), |_| 1.0)?;

    // −φ″ = φ − f″ with φ(0) = φ(1) = 0, by Green's function: it bends on the diagonal.
    let source = |x: f64| (1.0 - 1.0 / (PI * PI)) * (PI * x).sin();
    let equation = Equation::new(unit, |x: f64, y: f64| x.min(y) * (1.0 - x.max(y)), source);
    show(Class::Kink, &equation, |x| (PI * x).sin())?;

    // φ′ = φ, φ(0) = 1, integrated once: Volterra's kernel jumps.
    let equation = Equation::new(unit, |x: f64, y: f64| if y < x { 1.0 } else { 0.0 }, |_: f64| 1.0);
    show(Class::Jump, &equation, f64::exp)?;

    let x_ln = |x: f64| if x > 0.0 { x * x.ln() } else { 0.0 };
    let kernel = ByOffset(|_, _, offset: f64| offset.abs().ln());
    show(Class::Logarithmic, &Equation::new(unit, kernel, |x: f64| 2.0 - x_ln(x) - x_ln(1.0 - x)), |_| 1.0)?;

    let kernel = ByOffset(|_, _, offset: f64| 0.2 / offset.abs().sqrt());
    let source = |x: f64| 1.0 - 0.4 * (x.sqrt() + (1.0 - x).sqrt());
    show(Class::Algebraic { exponent: -0.5 }, &Equation::new(unit, kernel, source), |_| 1.0)?;

    // The whole line is brought to a finite interval, and what was as wide everywhere is steep towards its ends.
    let source = |x: f64| (-x * x).exp() - (PI / 2.0).sqrt() * (-x * x / 2.0).exp() / 4.0;
    let line = Interval::new(f64::NEG_INFINITY, f64::INFINITY)?;
    let equation = Equation::new(line, |x: f64, y: f64| (-(x - y).powi(2)).exp() / 4.0, source);
    show(Class::Peaked, &equation, |x| (-x * x).exp())
}

fn show(class: Class, equation: &Equation<'_, f64>, exact: fn(f64) -> f64) -> Result<(), Failure> {
    let answer = solve(equation, &Options { tolerance: 1e-12, ..Options::default() })?;
    let (found, estimate) = (answer.class.ok_or("no class was found")?, answer.error_estimate);
    let error =
        [0.02, 0.3, 0.5, 0.91].map(|x| (answer.at(&x) - exact(x)).abs()).into_iter().fold(0.0, f64::max);
    println!("{:<30} {:>8} {error:>9.1e} {estimate:>9.1e}", format!("{found:?}"), answer.unknowns);
    assert_eq!(std::mem::discriminant(&found), std::mem::discriminant(&class));
    assert!(error <= estimate && estimate < 1e-11);
    Ok(())
}
