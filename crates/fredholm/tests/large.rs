//! Equations that take more unknowns than a matrix is made for: right, and honest about their error.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use fredholm::automatic::{DENSE, Options, solve_large};
use fredholm::equation::{Answer, ByOffset, Equation, EquationError, Interval, Status};
use fredholm::product::Product;

fn to(tolerance: f64) -> Options {
    Options { tolerance, unknowns: 60_000, ..Options::default() }
}

fn unit() -> Interval {
    Interval::new(0.0, 1.0).unwrap()
}

const W: f64 = 5000.0;

/// ∫ ½ exp(−|x − y|) sin(w y) dy: what solves u − u″ = sin(w x), u′(0) = u(0), u′(1) = −u(1).
fn transported(x: f64) -> f64 {
    let (left, right) = (0.5 * W * (-x).exp(), 0.5 * (W * W.cos() + W.sin()) * (x - 1.0).exp());
    ((W * x).sin() + left - right) / (1.0 + W * W)
}

fn places() -> impl Iterator<Item = f64> {
    (0..=400).map(|k| f64::from(k) / 400.0)
}

fn difference(answer: &Answer<'_, f64, f64>, exact: impl Fn(f64) -> f64) -> f64 {
    places().map(|x| (answer.at(&x) - exact(x)).abs()).fold(0.0, f64::max)
}

#[test]
fn a_source_with_hundreds_of_waves_takes_blocks_and_the_error_told_is_that() {
    let kernel = |x: f64, y: f64| 0.5 * (-(x - y).abs()).exp();
    let equation = Equation::new(unit(), kernel, |x: f64| (W * x).sin() - transported(x));
    for tolerance in [1e-4, 1e-7, 1e-10] {
        let answer = solve_large(&equation, &to(tolerance)).unwrap();
        let off = difference(&answer, |x| (W * x).sin());
        assert!(answer.unknowns > DENSE && answer.method.contains("blocks"), "{answer:?}");
        assert_eq!(answer.status, Status::Converged, "{answer:?}");
        assert!(off <= answer.error_estimate && answer.error_estimate <= tolerance, "{off:e} of {answer:?}");
    }
}

#[test]
fn singular_kernels_are_resolved_at_the_ends() {
    let logarithm: fn(f64) -> f64 = |offset| 0.5 * offset.abs().ln();
    let root: fn(f64) -> f64 = |offset| 0.25 / offset.abs().sqrt();
    for (kernel, tolerances) in [(logarithm, [1e-5, 1e-10]), (root, [1e-5, 3e-8])] {
        let kernel = ByOffset(move |_x: f64, _y: f64, offset: f64| kernel(offset));
        let equation = Equation::new(unit(), kernel, |x: f64| (W * x).cos());
        let [rough, fine] = tolerances.map(|tolerance| solve_large(&equation, &to(tolerance)).unwrap());
        assert_eq!([rough.status, fine.status], [Status::Converged; 2], "{rough:?} {fine:?}");
        assert!(rough.unknowns > DENSE && rough.error_estimate > 3.0 * fine.error_estimate, "{rough:?}");
        let off = difference(&rough, |x| fine.at(&x));
        assert!(off <= rough.error_estimate, "{off:e} of {rough:?}");
    }
}

/// What blocks and panels take for smooth is not: only rules that look closer see it.
#[test]
fn a_kernel_that_is_wild_far_from_the_diagonal_is_seen_by_the_residual() {
    let kernel = |x: f64, y: f64| (3000.0 * x * y).cos();
    let equation = Equation::new(unit(), kernel, |x: f64| 1.0 + (W * x).cos());
    let [rough, fine] = [1e-4, 1e-9].map(|tolerance| solve_large(&equation, &to(tolerance)).unwrap());
    assert_eq!([rough.status, fine.status], [Status::Converged; 2], "{rough:?} {fine:?}");
    let off = difference(&rough, |x| fine.at(&x));
    assert!(off <= rough.error_estimate, "{off:e} of {rough:?}");
}

/// Samples of whole panels are no reason to give up the pieces next to the diagonal.
#[test]
fn a_rule_on_many_panels_is_as_good_as_on_few() {
    let equation = Equation::new(unit(), ByOffset(|_: f64, _: f64, offset: f64| offset.abs().ln()), |_| 1.0);
    let product = Product::new(&equation, None).unwrap();
    let breaks: Vec<f64> = (0..=20_000).map(|k| f64::from(k) / 20_000.0).collect();
    let x = 0.900_000_123;
    let row = product.row((0, 0), x, &breaks).unwrap();
    let exact = x * x.ln() + (1.0 - x) * (1.0 - x).ln() - 1.0;
    let off = (row.apply(|_| 1.0) - exact).abs();
    assert!(row.error < 1e-13 && off < 1e-12, "{off:e}, {:e} told", row.error);
}

#[test]
fn what_few_unknowns_resolve_and_what_is_no_single_real_equation_is_solved_as_ever() {
    let equation = Equation::new(unit(), |x: f64, y: f64| x * y, |x: f64| 2.0 * x / 3.0);
    let answer = solve_large(&equation, &to(1e-10)).unwrap();
    assert!(answer.unknowns < 100 && (answer.at(&0.5) - 0.5).abs() < 1e-10, "{answer:?}");
    let whole = Interval::new(0.0, f64::INFINITY).unwrap();
    let equation = Equation::new(whole, |x: f64, y: f64| (-x - y).exp(), |x: f64| 0.5 * (-x).exp());
    let answer = solve_large(&equation, &to(1e-10)).unwrap();
    assert!((answer.at(&0.5) - (-0.5_f64).exp()).abs() < 1e-10, "{answer:?}");
}

#[test]
fn what_cannot_be_solved_is_told() {
    let singular = Equation::new(unit(), |_: f64, _: f64| 1.0, |x: f64| (W * x).sin());
    let error = solve_large(&singular, &to(1e-10)).unwrap_err();
    assert!(error.to_string().contains("singular operator"), "{error}");
    let infinite = Equation::new(unit(), |x: f64, y: f64| 1.0 / (x - y).powi(2), |x: f64| (W * x).sin());
    let error = solve_large(&infinite, &to(1e-10)).unwrap_err();
    assert!(matches!(error, EquationError::KernelNotFinite { .. } | EquationError::Method(_)), "{error}");
    let noise = Equation::new(unit(), |x: f64, y: f64| x * y, |x: f64| (1e17 * x).sin());
    let error = solve_large(&noise, &to(1e-10)).unwrap_err();
    assert!(error.to_string().contains("the source alone takes more than 60000"), "{error}");
}
