//! 4. Kernels that are infinite at x = y, and why they should be told y − x.
//!
//! Builds on `03_automatic`. New: [`ByOffset`] and what it is for. A rule for |x − y|^α has nodes y so close to x that the
//! difference of the two doubles is worth nothing, while y − x is known. And a *solution* that is singular, at both ends.
#![expect(clippy::print_stdout, reason = "an example shows its numbers")]

use fredholm::automatic::{Options, solve};
use fredholm::equation::{Answer, ByOffset, Equation, EquationError, Interval, Status};

pub(crate) fn main() -> Result<(), Box<dyn std::error::Error>> {
    // On [9, 10] doubles are 2e-15 apart. f is such that φ = 1.
    let interval = Interval::new(9.0, 10.0)?;
    println!("|x − y|^α/10 on [9, 10]");
    for alpha in [-0.25, -0.5] {
        let power = move |u: f64| 0.1 * u.abs().powf(alpha);
        let integral = move |u: f64| 0.1 * u.powf(1.0 + alpha) / (1.0 + alpha);
        let source = move |x: f64| 1.0 - integral(x - 9.0) - integral(10.0 - x);
        let without = Equation::new(interval, move |x: f64, y: f64| power(y - x), source);
        let with = Equation::new(interval, ByOffset(move |_, _, offset| power(offset)), source);
        let without = told("y − x", &without)?;
        let with = told("offset", &with)?;
        assert_eq!((without.1, with.1), (Status::ToleranceNotMet, Status::Converged));
        assert!(with.0 < 1e-14 && without.0 > 1e3 * with.0);
    }

    // With f = 1 nothing is known of φ, but that it behaves like √x at 0: panels are not enough, and the variable is changed.
    println!("|x − y|^(−1/2)/5 on [0, 1], f = 1");
    let root = ByOffset(|_, _, offset: f64| 0.2 / offset.abs().sqrt());
    let equation = Equation::new(Interval::new(0.0, 1.0)?, root, |_: f64| 1.0);
    let best = to(1e-13, &equation)?;
    for tolerance in [1e-4, 1e-8, 1e-12] {
        let answer = to(tolerance, &equation)?;
        let error = (0..=100).map(|k| f64::from(k) / 100.0).map(|x| (answer.at(&x) - best.at(&x)).abs());
        let error = error.fold(0.0, f64::max);
        println!(
            "  to {tolerance:.0e}  error {error:.1e}  estimate {:.1e}  {} unknowns",
            answer.error_estimate, answer.unknowns
        );
        assert_eq!(answer.status, Status::Converged);
        assert!(error <= answer.error_estimate + best.error_estimate);
    }
    Ok(())
}

/// The error at 101 points, and whether the tolerance is met.
fn told(by: &str, equation: &Equation<'_, f64>) -> Result<(f64, Status), EquationError> {
    let answer = to(1e-13, equation)?;
    let error = (0..=100).map(|k| (answer.at(&(9.0 + f64::from(k) / 100.0)) - 1.0).abs()).fold(0.0, f64::max);
    println!("  by {by:<6}  error {error:.1e}  estimate {:.1e}  {:?}", answer.error_estimate, answer.status);
    Ok((error, answer.status))
}

fn to<'e>(tolerance: f64, equation: &'e Equation<'_, f64>) -> Result<Answer<'e, f64, f64>, EquationError> {
    solve(equation, &Options { tolerance, unknowns: 256, ..Options::default() })
}
