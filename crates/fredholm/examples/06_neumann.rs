//! 6. The Neumann series Σ Aᵏ f: partial sums, a certified remainder, and divergence told (paper, §1.2.1).
//!
//! Builds on `02_methods` and `05_alternative`. New: ‖A‖ certifies a remainder, the spectral radius decides convergence.
#![expect(clippy::print_stdout, reason = "an example shows its numbers")]

use fredholm::equation::{Equation, Interval, Status};
use fredholm::methods::neumann::Series;
use fredholm::methods::{self, Method, RuleKind, Setup, Yardstick};
use fredholm::product::Product;
use fredholm::space::SpaceKind;
use std::sync::Arc;

pub(crate) fn main() -> Result<(), Box<dyn std::error::Error>> {
    let unit = Interval::new(0.0, 1.0)?;
    let source = |x: f64| (-x).exp() - 0.5 + (-(x + 1.0)).exp() / 2.0;
    let equation = Equation::new(unit, |x: f64, y: f64| (x + 1.0) * (-x * y).exp() / 2.0, source);

    // ‖φ − φ_n‖ ≤ ‖A‖ⁿ⁺¹/(1 − ‖A‖) ‖f‖, and ‖A‖ = 1 − 1/e here.
    let product = Arc::new(Product::new(&equation, None)?);
    let yardstick = Yardstick::new(&product)?;
    println!("  n   error     certified");
    for n in [0, 1, 2, 5, 10, 20, 40] {
        let series = Series::new(&product, yardstick)?;
        let remainder = series.remainder(n).ok_or("‖A‖ < 1 here")?;
        let sum = series.partial_sum(n).solution;
        let error =
            [0.0, 0.5, 1.0].map(|x: f64| (sum.at(&x) - (-x).exp()).abs()).into_iter().fold(0.0, f64::max);
        println!("{n:>3}   {error:.1e}   {remainder:.1e}");
        assert!(error <= remainder);
    }

    // Without n: as many terms as the tolerance asks for.
    let neumann = Setup {
        method: Method::Neumann,
        space: SpaceKind::Legendre,
        rule: RuleKind::GaussLegendre,
        n: None,
        tolerance: 1e-12,
    };
    let answer = methods::solve(&equation, &neumann)?;
    println!("{}", answer.method);
    assert_eq!(answer.status, Status::Converged);
    assert!((answer.at(&0.3) - (-0.3_f64).exp()).abs() <= answer.error_estimate);

    // φ(x) = 1 + 4x ∫ y φ(y) dy has the solution 1 − 6x, but the terms 2x (4/3)ⁿ of the series grow.
    let equation = Equation::new(unit, |x: f64, y: f64| 4.0 * x * y, |_: f64| 1.0);
    let answer = methods::solve(&equation, &neumann)?;
    println!("{}", answer.method);
    assert_eq!(answer.status, Status::ToleranceNotMet);
    assert!((answer.at(&0.3) - (1.0 - 1.8)).abs() <= answer.error_estimate);

    // ‖A‖ = 5 √3, but A² = 0: nothing is certified, and the series ends after two terms.
    let e2 = |x: f64| 3_f64.sqrt() * (2.0 * x - 1.0);
    let equation = Equation::new(unit, move |_: f64, y: f64| 10.0 * e2(y), e2);
    let answer = methods::solve(&equation, &neumann)?;
    println!("{}", answer.method);
    assert_eq!((answer.status, answer.unknowns), (Status::Converged, 1));
    Ok(())
}
