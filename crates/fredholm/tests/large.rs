//! Equations that take more unknowns than a matrix is made for: right, and honest about their error.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use fredholm::automatic::{DENSE, Options, solve, solve_large};
use fredholm::equation::{
    Answer, ByOffset, Complex64, Equation, EquationError, Interval, LineKernel, Scalar, Source, Status,
};
use fredholm::product::Product;

fn to(tolerance: f64) -> Options {
    Options { tolerance, unknowns: 60_000, ..Options::default() }
}

fn unit() -> Interval {
    Interval::new(0.0, 1.0).unwrap()
}

const W: f64 = 5000.0;

fn decay(x: f64, y: f64) -> f64 {
    0.5 * (-(x - y).abs()).exp()
}

/// ∫ ½ exp(−|x − y|) sin(w y) dy: what solves u − u″ = sin(w x), u′(0) = u(0), u′(1) = −u(1).
fn transported(x: f64) -> f64 {
    let (left, right) = (0.5 * W * (-x).exp(), 0.5 * (W * W.cos() + W.sin()) * (x - 1.0).exp());
    ((W * x).sin() + left - right) / (1.0 + W * W)
}

fn places() -> impl Iterator<Item = f64> {
    (0..=400).map(|k| f64::from(k) / 400.0)
}

fn difference<T: Scalar>(answer: &Answer<'_, f64, T>, exact: impl Fn(f64) -> T) -> f64 {
    places().map(|x| (answer.at(&x) - exact(x)).modulus()).fold(0.0, f64::max)
}

#[test]
fn a_source_with_hundreds_of_waves_takes_blocks_and_the_error_told_is_that() {
    let equation = Equation::new(unit(), decay, |x: f64| (W * x).sin() - transported(x));
    for tolerance in [1e-4, 1e-7, 1e-10] {
        let answer = solve_large(&equation, &to(tolerance)).unwrap();
        let off = difference(&answer, |x| (W * x).sin());
        assert!(answer.unknowns > DENSE && answer.method.contains("blocks"), "{answer:?}");
        assert_eq!(answer.status, Status::Converged, "{answer:?}");
        assert!(off <= answer.error_estimate && answer.error_estimate <= tolerance, "{off:e} of {answer:?}");
    }
}

/// (1, 2) sin(w x), which a kernel of each kind takes part in, and one that is nothing.
#[test]
fn systems_take_blocks() {
    let kernels: Vec<Box<dyn LineKernel<f64>>> = vec![
        Box::new(|x: f64, y: f64| 0.5 * decay(x, y)),
        Box::new(|x: f64, y: f64| -0.7 * decay(x, y)),
        Box::new(|x: f64, y: f64| 0.9 * decay(x, y)),
        Box::new(|_: f64, _: f64| 0.0),
    ];
    let sources: Vec<Box<dyn Source<f64>>> = vec![
        Box::new(|x: f64| (W * x).sin() + 0.9 * transported(x)),
        Box::new(|x: f64| 2.0 * (W * x).sin() - 0.9 * transported(x)),
    ];
    let system = Equation::system(unit(), kernels, sources).unwrap();
    for tolerance in [1e-4, 1e-9] {
        let answer = solve_large(&system, &to(tolerance)).unwrap();
        assert!(answer.unknowns > DENSE && answer.method.contains("blocks"), "{answer:?}");
        let off = |c: usize, times: f64| {
            places()
                .map(|x| (answer.solution.component(c, &x) - times * (W * x).sin()).abs())
                .fold(0.0, f64::max)
        };
        let off = off(0, 1.0).max(off(1, 2.0));
        assert_eq!(answer.status, Status::Converged, "{answer:?}");
        assert!(
            off <= answer.error_estimate && answer.error_estimate <= 2.0 * tolerance,
            "{off:e} of {answer:?}"
        );
    }
    let few = solve_large(&system, &Options { unknowns: 4000, ..to(1e-9) }).unwrap_err();
    assert!(few.to_string().contains("the source alone takes more than 4000 unknowns"), "{few}");
}

#[test]
fn complex_equations_take_blocks() {
    let (z, a) = (Complex64::new(0.3, 0.8), Complex64::new(1.0, -1.0));
    let kernel = move |x: f64, y: f64| z * decay(x, y);
    let equation = Equation::new(unit(), kernel, move |x: f64| a * ((W * x).sin() - z * transported(x)));
    for tolerance in [1e-4, 1e-9] {
        let answer = solve_large(&equation, &to(tolerance)).unwrap();
        let off = difference(&answer, |x| a * (W * x).sin());
        assert!(answer.unknowns > DENSE && answer.method.contains("blocks"), "{answer:?}");
        assert_eq!(answer.status, Status::Converged, "{answer:?}");
        assert!(
            off <= answer.error_estimate && answer.error_estimate <= 2.0 * tolerance,
            "{off:e} of {answer:?}"
        );
    }
}

/// φ = exp(−|x|) sin(w x) from 0 on, or everywhere.
#[test]
fn infinite_intervals_take_blocks() {
    const W: f64 = 400.0;
    let phi = |x: f64| (-x.abs()).exp() * (W * x).sin();
    // ∫₀^∞ exp(−|x − y|) φ(y) dy; the other half brings as much as ∫₀^∞ exp(−2 y) sin(w y) dy.
    let right = |x: f64| {
        let (sin, cos) = (W * x).sin_cos();
        (-x).exp() * ((1.0 - cos) / W + (2.0 * sin + W * cos) / (4.0 + W * W))
    };
    let both = move |x: f64| x.signum() * (right(x.abs()) - (-x.abs()).exp() * W / (4.0 + W * W));
    let half = Equation::new(
        Interval::new(0.0, f64::INFINITY).unwrap(),
        |x: f64, y: f64| 0.5 * decay(x, y),
        move |x: f64| phi(x) - 0.25 * right(x),
    );
    let whole = Equation::new(
        Interval::new(f64::NEG_INFINITY, f64::INFINITY).unwrap(),
        |x: f64, y: f64| 0.5 * decay(x, y),
        move |x: f64| phi(x) - 0.25 * both(x),
    );
    for (equation, least) in [(&half, 0.0), (&whole, -8.0)] {
        for tolerance in [1e-4, 1e-8] {
            let answer = solve_large(equation, &to(tolerance)).unwrap();
            let places = places().map(|place| least + (8.0 - least) * place);
            let off = places.map(|x| (answer.at(&x) - phi(x)).abs()).fold(0.0, f64::max);
            assert!(answer.unknowns > DENSE && answer.method.contains("blocks"), "{answer:?}");
            assert_eq!(answer.status, Status::Converged, "{answer:?}");
            assert!(
                off <= answer.error_estimate && answer.error_estimate <= tolerance,
                "{off:e} of {answer:?}"
            );
        }
    }
}

/// Where φ is as √x at an end, doubles next to 1 are too far apart for panels alone.
#[test]
fn ends_have_a_variable_of_their_own_where_panels_do_not_do() {
    let root = ByOffset(|_: f64, _: f64, offset: f64| 0.25 / offset.abs().sqrt());
    let singular = Equation::new(unit(), root, |x: f64| (600.0 * x).cos());
    let source = |x: f64| (1.0 - x).sqrt() * (600.0 * x).cos();
    let smooth = Equation::new(unit(), |x: f64, y: f64| (x * y).cos() / 3.0, source);
    for (equation, tolerance) in [(&singular, 1e-10), (&smooth, 1e-9)] {
        let answer = solve_large(equation, &to(tolerance)).unwrap();
        let dense = solve(equation, &Options { tolerance: 1e-11, ..Options::default() }).unwrap();
        assert_eq!([answer.status, dense.status], [Status::Converged; 2], "{answer:?} {dense:?}");
        assert!(answer.method.contains("blocks") && !dense.method.contains("blocks"), "{answer:?} {dense:?}");
        let off = difference(&answer, |x| dense.at(&x));
        assert!(
            off <= answer.error_estimate && answer.error_estimate <= 10.0 * tolerance,
            "{off:e} of {answer:?}"
        );
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
fn what_few_unknowns_resolve_is_solved_as_ever() {
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
    let somewhere = |x: f64, y: f64| if (0.7..0.7001).contains(&y) { f64::INFINITY } else { x * y };
    match solve_large(&Equation::new(unit(), somewhere, |x: f64| (W * x).sin()), &to(1e-10)) {
        Err(EquationError::KernelNotFinite { y, value, .. }) => {
            assert!((0.7..0.7001).contains(&y) && value == "inf", "{y} {value}");
        }
        other => panic!("{other:?}"),
    }
    let infinite = Equation::new(unit(), |x: f64, y: f64| 1.0 / (x - y).powi(2), |x: f64| (W * x).sin());
    let error = solve_large(&infinite, &to(1e-10)).unwrap_err();
    assert!(matches!(error, EquationError::KernelNotFinite { .. } | EquationError::Method(_)), "{error}");
    let noise = Equation::new(unit(), |x: f64, y: f64| x * y, |x: f64| (1e17 * x).sin());
    let error = solve_large(&noise, &to(1e-10)).unwrap_err();
    assert!(error.to_string().contains("the source alone takes more than 60000"), "{error}");
}
