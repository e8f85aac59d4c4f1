//! 2. Every method of the paper on one equation, and how fast each of them converges.
//!
//! Builds on `01_quadrature`: Nyström's method is as good as its rule. New: spaces and projections, iterating, series.
//!
//! φ(x) − ½ ∫₀¹ (x + 1) e^{−xy} φ(y) dy = e^{−x} − ½ + ½ e^{−(x+1)}, whose solution is e^{−x}.
#![expect(clippy::print_stdout, reason = "an example prints")]

use fredholm::equation::{Equation, EquationError, Interval};
use fredholm::methods::{self, Method, RuleKind, Setup};
use fredholm::space::SpaceKind;

/// The method, its space or rule, and the factor by which its error falls from n = 8 to n = 16: 2 to the order.
struct Row {
    method: Method,
    space: SpaceKind,
    rule: RuleKind,
    factor: f64,
}

pub(crate) fn main() -> Result<(), Box<dyn std::error::Error>> {
    let kernel = |x: f64, y: f64| (x + 1.0) * (-x * y).exp() / 2.0;
    let source = |x: f64| (-x).exp() - 0.5 + (-(x + 1.0)).exp() / 2.0;
    let equation = Equation::new(Interval::new(0.0, 1.0)?, kernel, source);

    let (p0, p1, p2) = (SpaceKind::Piecewise(0), SpaceKind::Piecewise(1), SpaceKind::Piecewise(2));
    let by_rule = |rule, factor| Row { method: Method::Nystrom, space: p1, rule, factor };
    let in_space = |method, space, factor| Row { method, space, rule: RuleKind::GaussLegendre, factor };
    let rows = [
        by_rule(RuleKind::Trapezoid, 4.0),
        by_rule(RuleKind::Simpson, 16.0),
        in_space(Method::Degenerate, p1, 4.0),
        in_space(Method::Collocation, p0, 2.0),
        in_space(Method::Collocation, p1, 4.0),
        in_space(Method::Collocation, p2, 8.0),
        in_space(Method::IteratedCollocation, p2, 16.0),
        in_space(Method::LeastSquares, p1, 4.0),
        in_space(Method::Galerkin, p1, 4.0),
        // One more application of A doubles the order.
        in_space(Method::IteratedGalerkin, p0, 4.0),
        in_space(Method::IteratedGalerkin, p1, 16.0),
        in_space(Method::IteratedGalerkin, p2, 64.0),
    ];

    println!("{:<34} {:>9} {:>9} {:>9} {:>9}", "method", "n = 8", "n = 16", "factor", "estimate");
    for Row { method, space, rule, factor } in rows {
        let setup = |n| Setup { method, space, rule, n: Some(n), tolerance: 1e-12 };
        let (coarse, _, _) = error(&equation, &setup(8))?;
        let (fine, estimate, name) = error(&equation, &setup(16))?;
        println!("{name:<34} {coarse:>9.1e} {fine:>9.1e} {:>9.1} {estimate:>9.1e}", coarse / fine);
        assert!(
            (coarse / fine / factor).log2().abs() < 0.25,
            "{name}: the error falls {:.1} times",
            coarse / fine
        );
        assert!(fine <= estimate);
    }

    // Without n, it grows until the estimate meets the tolerance. High order reaches 1e-13 with a handful of unknowns.
    println!("\n{:<34} {:>9} {:>9} {:>9}", "to 1e-13", "unknowns", "error", "estimate");
    for method in Method::ALL {
        let (space, rule) = (SpaceKind::Legendre, RuleKind::GaussLegendre);
        let setup = Setup { method, space, rule, n: None, tolerance: 1e-13 };
        let answer = methods::solve(&equation, &setup)?;
        let (error, estimate, _) = error(&equation, &Setup { n: Some(answer.unknowns), ..setup })?;
        println!("{:<34} {:>9} {error:>9.1e} {estimate:>9.1e}", method.to_string(), answer.unknowns);
        assert!(error <= estimate && estimate < 1e-13);
    }
    Ok(())
}

/// max |φ_n − φ| at 201 points, its estimate, and the method in words.
fn error(equation: &Equation<'_, f64>, setup: &Setup) -> Result<(f64, f64, String), EquationError> {
    let answer = methods::solve(equation, setup)?;
    let at = (0..=200).map(|k| f64::from(k) / 200.0);
    let error = at.map(|x| (answer.at(&x) - (-x).exp()).abs()).fold(0.0, f64::max);
    Ok((error, answer.error_estimate, answer.method))
}
