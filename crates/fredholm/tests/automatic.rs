//! The automatic solver on the whole catalogue: right, honest about its error, and not pessimistic.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod problems;

use fredholm::automatic::{Options, solve};
use fredholm::equation::{Answer, Class, Complex64, Equation, EquationError, Interval, Scalar, Status};
use fredholm::quadrature::gauss_legendre;
use fredholm::spectrum::spectrum;
use problems::alternative::{LiebLiniger, Singular, regular, singular, spectra};
use problems::systems::{complex, systems};
use problems::{Borrowed, OfX, Problem, all, problem};

fn to(tolerance: f64) -> Options {
    Options { tolerance, ..Options::default() }
}

/// Places to compare at; of an infinite interval a part.
fn places([a, b]: [f64; 2]) -> Vec<f64> {
    let (a, b) = match (a.is_finite(), b.is_finite()) {
        (true, true) => (a, b),
        (true, false) => (a, a + 30.0),
        (false, true) => (b - 30.0, b),
        (false, false) => (-15.0, 15.0),
    };
    (0..=100).map(|k| a + (b - a) * f64::from(k) / 100.0).collect()
}

/// The largest difference from the exact solution, and the largest value of that, less what null functions explain.
fn error<T: Scalar>(answer: &Answer<'_, f64, T>, exact: impl Fn(f64) -> T, interval: [f64; 2]) -> (f64, f64) {
    let places: Vec<f64> = places(interval).into_iter().filter(|x| exact(*x).finite()).collect();
    let scale = places.iter().map(|x| exact(*x).modulus()).fold(0.0, f64::max);
    let mut difference: Vec<T> = places.iter().map(|x| answer.at(x) - exact(*x)).collect();
    let null = answer.alternative.iter().flat_map(|alternative| &alternative.null_functions);
    let mut basis: Vec<Vec<T>> = Vec::new();
    for function in null {
        let mut values: Vec<T> = places.iter().map(|x| function.at(x)).collect();
        basis.iter().for_each(|known| remove(known, &mut values));
        basis.push(values);
    }
    basis.iter().for_each(|known| remove(known, &mut difference));
    (difference.iter().map(|d| d.modulus()).fold(0.0, f64::max), scale)
}

/// Takes the part along `direction` away.
fn remove<T: Scalar>(direction: &[T], from: &mut [T]) {
    let inner = |u: &[T], v: &[T]| u.iter().zip(v).map(|(u, v)| *u * v.conjugate()).sum::<T>();
    let part = inner(from, direction) / inner(direction, direction);
    from.iter_mut().zip(direction).for_each(|(f, d)| *f -= *d * part);
}

/// What the relative error may be, by the kind of problem that the first letter tells.
fn bound(id: &str) -> f64 {
    match id.as_bytes()[0] {
        b'S' | b'P' => 1e-13,
        b'D' | b'J' => 1e-12,
        _ => 1e-11,
    }
}

#[test]
fn every_problem_is_solved_and_its_error_is_known() {
    let mut ratios = Vec::new();
    for tolerance in [1e-6, 1e-9, 1e-13] {
        for problem in all() {
            let equation = problem.equation();
            let answer = solve(&equation, &to(tolerance)).unwrap();
            let (error, scale) = error(&answer, &problem.exact, problem.interval);
            let what = format!("{} to {tolerance:e}: {:?} {error:.1e} of {scale}", problem.id, answer.status);
            assert_ne!(answer.status, Status::NoSolution, "{what}");
            assert!(error <= answer.error_estimate, "{what}, said to be {:.1e}", answer.error_estimate);
            assert!(error <= bound(problem.id).max(tolerance) * scale, "{what}");
            ratios.push(answer.error_estimate / error.max(f64::EPSILON * scale));
        }
    }
    ratios.sort_by(f64::total_cmp);
    let median = ratios[ratios.len() / 2];
    assert!(median < 20.0, "the estimate is {median} times the error");
}

#[test]
fn the_class_of_a_kernel_is_found() {
    let rank = |class: Class| match class {
        // How steep is steep, and how often round is once round, nobody can say.
        Class::Smooth | Class::Peaked | Class::Periodic => 0,
        Class::Kink => 1,
        Class::Jump => 2,
        Class::Logarithmic => 3,
        Class::Algebraic { .. } => 4,
    };
    for problem in all() {
        let equation = problem.equation();
        let found = solve(&equation, &to(1e-6)).unwrap().class.unwrap();
        assert_eq!(rank(found), rank(problem.class), "{}: {found:?}", problem.id);
        if let (Class::Algebraic { exponent }, Class::Algebraic { exponent: found }) = (problem.class, found)
        {
            assert!((found - exponent).abs() < 1e-3, "{}: {found}", problem.id);
        }
    }
    let class = |id: &str| solve(&problem(id).equation(), &to(1e-12)).unwrap().class;
    assert_eq!(class("S01"), Some(Class::Smooth));
    assert_eq!(class("S04 c=.01"), Some(Class::Peaked));
    assert_eq!(class("S06"), Some(Class::Periodic));
}

#[test]
fn a_stated_class_is_taken() {
    let problem = problem("D01");
    let equation = problem.equation();
    let options = Options { class: Some(Class::Kink), ..to(1e-12) };
    let answer = solve(&equation, &options).unwrap();
    assert_eq!((answer.class, answer.unknowns), (Some(Class::Kink), 16));
}

/// At 128 unknowns of one polynomial, the tail of its coefficients says 2e-8 where the error is 2.5e-2.
#[test]
fn bosons_on_a_ring_do_not_fool_the_estimate() {
    for tolerance in [1e-4, 1e-8, 1e-11] {
        let interval = Interval::new(-1.0, 1.0).unwrap();
        let equation = Equation::new(interval, LiebLiniger::kernel, LiebLiniger::source);
        let answer = solve(&equation, &to(tolerance)).unwrap();
        let error = (answer.at(&0.0) - LiebLiniger::MIDDLE).abs();
        assert!(error <= answer.error_estimate + 1e-14 * LiebLiniger::MIDDLE, "{error:e} of {answer:?}");
        assert!(error <= tolerance * LiebLiniger::MIDDLE);
        let integral = gauss_legendre(400, -1.0, 1.0).integrate(|x| answer.at(x));
        assert!((integral / LiebLiniger::INTEGRAL - 1.0).abs() < tolerance.max(1e-12));
    }
}

#[test]
fn a_peak_of_any_width_is_seen() {
    // ∫ w/(w² + (x − y)²) dy/π is all but 1 inside, however thin w is: φ = 1 for the f that this makes.
    for w in [1e-3, 1e-5, 1e-7] {
        let kernel = move |x: f64, y: f64| w / (w * w + (x - y).powi(2)) / 4.0;
        let source = move |x: f64| 1.0 - ((x / w).atan() + ((1.0 - x) / w).atan()) / 4.0;
        let equation = Equation::new(Interval::new(0.0, 1.0).unwrap(), kernel, source);
        let answer = solve(&equation, &to(1e-9)).unwrap();
        let error = places([0.0, 1.0]).iter().map(|x| (answer.at(x) - 1.0).abs()).fold(0.0, f64::max);
        assert!(error <= answer.error_estimate && error < 1e-8, "w = {w:e}: {error:e} of {answer:?}");
    }
}

#[test]
fn systems_and_complex_equations_are_solved() {
    for system in systems() {
        let equation = system.equation();
        let answer = solve(&equation, &to(1e-12)).unwrap();
        for (c, exact) in system.exact.iter().enumerate() {
            for x in places([0.0, 1.0]) {
                let error = (answer.solution.component(c, &x) - exact(x)).abs();
                assert!(
                    error <= answer.error_estimate && error < 1e-11,
                    "{} {c} at {x}: {error:e}",
                    system.id
                );
            }
        }
    }
    for problem in complex() {
        let equation: Equation<'_, Complex64> = problem.equation();
        let answer = solve(&equation, &to(1e-12)).unwrap();
        let (error, scale) = error(&answer, &problem.exact, problem.interval);
        assert!(error <= answer.error_estimate && error < 1e-11 * scale, "{}: {error:e}", problem.id);
    }
}

fn equation<'a>(problem: &'a Singular, source: &'a OfX<f64>) -> Equation<'a, f64> {
    let [a, b] = problem.interval;
    Equation::new(Interval::new(a, b).unwrap(), Borrowed(&*problem.kernel), source)
}

#[test]
fn where_there_are_many_solutions_one_is_given_with_all_null_functions() {
    for problem in singular() {
        let equation = equation(&problem, &problem.solvable[0]);
        let answer = solve(&equation, &to(1e-11)).unwrap();
        assert_eq!(
            (answer.status, answer.nullity()),
            (Status::NotUnique, problem.null.len()),
            "{}",
            problem.id
        );
        let (difference, scale) = error(&answer, &problem.solvable[1], problem.interval);
        assert!(difference <= answer.error_estimate && difference < 1e-10 * scale, "{}", problem.id);

        let alternative = answer.alternative.as_ref().unwrap();
        assert!(alternative.solvability.iter().all(|defect| defect.abs() < 1e-11));
        assert!(alternative.distance_to_spectrum < 1e-10, "{}", alternative.distance_to_spectrum);
        // What is known spans what is found, and as many functions span the same space.
        for (found, known) in [
            (&alternative.null_functions, &problem.null),
            (&alternative.adjoint_null_functions, &problem.adjoint),
        ] {
            for function in found {
                let places = places(problem.interval);
                let mut values: Vec<f64> = places.iter().map(|x| function.at(x)).collect();
                let mut basis: Vec<Vec<f64>> = Vec::new();
                for function in known {
                    let mut values: Vec<f64> = places.iter().map(|x| function(*x)).collect();
                    basis.iter().for_each(|other| remove(other, &mut values));
                    basis.push(values);
                }
                basis.iter().for_each(|known| remove(known, &mut values));
                assert!(values.iter().all(|v| v.abs() < 1e-10), "{}", problem.id);
            }
        }
    }
}

#[test]
fn where_there_is_no_solution_the_defect_is_told() {
    for problem in singular() {
        let equation = equation(&problem, &problem.unsolvable);
        let answer = solve(&equation, &to(1e-11)).unwrap();
        assert_eq!(answer.status, Status::NoSolution, "{}", problem.id);
        assert!(answer.error_estimate.is_infinite());
        let alternative = answer.alternative.unwrap();
        assert!(alternative.solvability.iter().any(|defect| defect.abs() > 0.1), "{}", problem.id);
    }
}

#[test]
fn what_looks_singular_and_is_not_has_its_one_solution() {
    for problem in regular() {
        let equation = problem.equation();
        let answer = solve(&equation, &to(1e-8)).unwrap();
        let (error, scale) = error(&answer, &problem.exact, problem.interval);
        assert_eq!((answer.status, answer.nullity()), (Status::Converged, 0), "{}", problem.id);
        assert!(error <= answer.error_estimate && error < 1e-8 * scale, "{}: {error:e}", problem.id);
        if problem.id == "H23" {
            let distance = answer.alternative.unwrap().distance_to_spectrum;
            assert!((distance * 2.0_f64.powi(20) - 1.0).abs() < 1e-8, "{distance}");
        }
    }
}

#[test]
fn eigenvalues_come_with_their_errors() {
    for problem in spectra() {
        let [a, b] = problem.interval;
        let equation = Equation::new(Interval::new(a, b).unwrap(), Borrowed(&*problem.kernel), |_: f64| 0.0);
        let found = spectrum(&equation, 8, 1e-11).unwrap();
        assert_eq!(found.eigenpairs.len(), 8);
        for (k, pair) in (1..).zip(&found.eigenpairs) {
            let exact = (problem.eigenvalue)(k);
            let error = (pair.value - exact).norm();
            assert!(
                error <= pair.error_estimate && error < 1e-10,
                "{} λ_{k}: {error:e} of {:e}",
                problem.id,
                pair.error_estimate
            );
        }
    }
}

#[test]
fn eigenfunctions_are_those_of_the_operator() {
    let problem = &spectra()[0];
    let equation = Equation::new(Interval::new(0.0, 1.0).unwrap(), Borrowed(&*problem.kernel), |_: f64| 0.0);
    let found = spectrum(&equation, 3, 1e-11).unwrap();
    for (k, pair) in found.eigenpairs.iter().enumerate() {
        let exact = |x: f64| ((k as f64 + 0.5) * std::f64::consts::PI * x).sin();
        let size = pair.function.at(&0.37) / exact(0.37);
        for x in places([0.0, 1.0]) {
            assert!((pair.function.at(&x) / size - exact(x)).norm() < 1e-12);
        }
    }
}

/// All but one of the eigenvalues are 0, and there are no n independent eigenvectors.
#[test]
fn an_operator_of_rank_one_has_its_one_eigenvalue() {
    let unit = Interval::new(0.0, 1.0).unwrap();
    for kernel in [|_: f64, _: f64| 2.0, |x: f64, y: f64| 6.0 * x * y] {
        let equation = Equation::new(unit, kernel, |_: f64| 0.0);
        let found = spectrum(&equation, 4, 1e-10).unwrap();
        assert_eq!(found.eigenpairs.len(), 1);
        assert!((found.eigenpairs[0].value - 2.0).norm() < 1e-13);
    }
}

#[test]
fn no_eigenvalue_is_lost_where_the_first_panels_are_too_long() {
    // A e^{ikx} = (λ_k) e^{ikx} on a circle: a Gaussian so thin that its eigenvalues hardly decay.
    let w = 0.01_f64;
    let circle = Interval::new(0.0, 1.0).unwrap();
    let kernel =
        move |x: f64, y: f64| (-1..=1).map(|k| (-((x - y + f64::from(k)) / w).powi(2)).exp()).sum::<f64>();
    let equation = Equation::new(circle, kernel, |_: f64| 0.0);
    let found = spectrum(&equation, 3, 1e-8).unwrap();
    assert_eq!(found.eigenpairs.len(), 3);
    let root = std::f64::consts::PI.sqrt();
    for (k, pair) in found.eigenpairs.iter().enumerate() {
        let k = k.div_ceil(2) as f64;
        let exact = w * root * (-(std::f64::consts::PI * k * w).powi(2)).exp();
        assert!((pair.value - exact).norm() <= pair.error_estimate, "{k}: {pair:?} of {exact}");
    }
}

/// Its square is 0, and it has no eigenvalue but 0, though rounding makes one of 10⁻⁸.
#[test]
fn a_nilpotent_operator_has_no_spectrum() {
    let problem = regular().remove(0);
    let equation = problem.equation();
    assert!(spectrum(&equation, 4, 1e-10).unwrap().eigenpairs.is_empty());
}

fn message(
    kernel: impl Fn(f64, f64) -> f64 + Sync + Send,
    source: impl Fn(f64) -> f64 + Sync + Send,
) -> String {
    let equation = Equation::new(Interval::new(0.0, 1.0).unwrap(), kernel, source);
    solve(&equation, &Options::default()).unwrap_err().to_string()
}

/// x − y has no more digits than x and y leave it; what that costs is said.
#[test]
fn the_rounding_of_a_difference_is_in_the_estimate() {
    for exponent in [-0.25, -0.5, -0.75] {
        let kernel = move |x: f64, y: f64| 0.1 * (x - y).abs().powf(exponent);
        let beta = 1.0 + exponent;
        let source = move |x: f64| 1.0 - 0.1 * ((x - 9.0).powf(beta) + (10.0 - x).powf(beta)) / beta;
        let equation = Equation::new(Interval::new(9.0, 10.0).unwrap(), kernel, source);
        let answer = solve(&equation, &to(1e-14)).unwrap();
        let error = places([9.0, 10.0]).iter().map(|x| (answer.at(x) - 1.0).abs()).fold(0.0, f64::max);
        assert!(error <= answer.error_estimate, "{exponent}: {error:e} of {:e}", answer.error_estimate);
        assert_eq!(answer.status, Status::ToleranceNotMet);
    }
}

#[test]
fn what_is_no_number_is_told_with_its_place() {
    assert!(message(|_, _| 1.0, |x| (x - 0.5).sqrt()).starts_with("the source is NaN at x = 0."));
    assert!(message(|x, y| (x - y - 0.5).ln(), |x| x).starts_with("the kernel is NaN at x = 0."));
    assert!(message(|x, y| (x - y).powi(-2), |x| x).contains("cannot be integrated"));
    let problem = problem("D01");
    let equation = problem.equation();
    for exponent in [f64::NAN, -1.0] {
        let class = Some(Class::Algebraic { exponent });
        let error = solve(&equation, &Options { class, ..to(1e-8) }).unwrap_err();
        assert!(error.to_string().contains("state an exponent above −1"), "{error}");
    }
    assert!(solve(&equation, &to(f64::NAN)).is_err());
    assert_eq!(Interval::new(1.0, 1.0), Err(EquationError::EmptyInterval { a: 1.0, b: 1.0 }));
    assert!(Interval::new(f64::NAN, 1.0).is_err());
}

#[test]
fn a_tolerance_below_rounding_is_not_met_and_said_so() {
    let problem: Problem = problem("S01");
    let equation = problem.equation();
    let answer = solve(&equation, &to(1e-17)).unwrap();
    assert_eq!(answer.status, Status::ToleranceNotMet);
    assert!((answer.at(&0.5) - (-0.5_f64).exp()).abs() <= answer.error_estimate);
}

#[test]
fn outside_of_the_interval_there_is_no_solution() {
    let problem: Problem = problem("S01");
    let equation = problem.equation();
    let answer = solve(&equation, &to(1e-10)).unwrap();
    assert!(answer.at(&1.5).is_nan() && answer.at(&f64::NAN).is_nan());
}

#[test]
fn jumps_and_spikes_of_the_source_are_seen() {
    let unit = Interval::new(0.0, 1.0).unwrap();
    for tolerance in [1e-3, 1e-6, 1e-10] {
        for jump in [0.51, 0.3712] {
            let phi = move |x: f64| if x < jump { 1.0 } else { 2.0 };
            let moment = 0.5 * jump * jump + (1.0 - jump * jump);
            let equation =
                Equation::new(unit, |x: f64, y: f64| x * y / 2.0, move |x: f64| phi(x) - moment * x / 2.0);
            let answer = solve(&equation, &to(tolerance)).unwrap();
            let error = places([0.0, 1.0]).iter().map(|x| (answer.at(x) - phi(*x)).abs()).fold(0.0, f64::max);
            assert!(
                error <= answer.error_estimate && error < tolerance,
                "{jump} to {tolerance:e}: {error:e}"
            );
        }
        // φ = f + c x with c = ½ ∫ φ, so that ¾ c = ½ ∫ f.
        let width = 2e-3;
        let spike = move |x: f64| (-((x - 0.70123) / width).powi(2)).exp();
        let equation = Equation::new(unit, |x: f64, _: f64| x / 2.0, spike);
        let answer = solve(&equation, &to(tolerance)).unwrap();
        let exact = spike(0.9) + 0.9 * width * std::f64::consts::PI.sqrt() / 1.5;
        assert!((answer.at(&0.9) - exact).abs() <= answer.error_estimate, "{answer:?}");
    }
}

#[test]
fn breaks_off_the_diagonal_are_found() {
    let integral = |y: f64| 2.0 * y - (3.0 * y).cos() / 3.0;
    let kernel = |x: f64, y: f64| if y < x / 2.0 { 1.0 } else { -0.5 };
    let source = move |x: f64| {
        let (low, break_, high) = (integral(0.0), integral(x / 2.0), integral(1.0));
        (3.0 * x).sin() + 2.0 - ((break_ - low) - 0.5 * (high - break_))
    };
    let equation = Equation::new(Interval::new(0.0, 1.0).unwrap(), kernel, source);
    let answer = solve(&equation, &to(1e-10)).unwrap();
    let exact = |x: f64| (3.0 * x).sin() + 2.0;
    let error = places([0.0, 1.0]).iter().map(|x| (answer.at(x) - exact(*x)).abs()).fold(0.0, f64::max);
    assert!(error <= answer.error_estimate && error < 1e-10, "{error:e} of {answer:?}");
}

#[test]
fn a_very_large_source_without_solution_is_told() {
    for size in [1e-200, 1e200] {
        let unit = Interval::new(0.0, 1.0).unwrap();
        let equation = Equation::new(unit, |x: f64, y: f64| 4.0 * x * x * y, move |_: f64| size);
        assert_eq!(solve(&equation, &to(1e-8)).unwrap().status, Status::NoSolution);
    }
}

/// The nodes gather towards the ends until doubles do, but the source is not asked for its value there.
#[test]
fn a_source_that_is_no_number_at_the_ends_is_no_obstacle() {
    let source = |x: f64| if x == 0.0 || x == 1.0 { f64::NAN } else { x };
    let kernel = |x: f64, y: f64| (x - y).abs().ln();
    let equation = Equation::new(Interval::new(0.0, 1.0).unwrap(), kernel, source);
    let answer = solve(&equation, &to(1e-11)).unwrap();
    assert!(answer.status == Status::Converged && answer.at(&1.0).is_finite());
}

#[test]
fn where_the_source_is_infinite_so_is_the_solution() {
    // φ = 1/x + (3/2) x; and x ln x at 0, which is 0 · (−∞), has a limit.
    let unit = Interval::new(0.0, 1.0).unwrap();
    let pole = Equation::new(unit, |x: f64, y: f64| x * y, |x: f64| 1.0 / x);
    let answer = solve(&pole, &to(1e-10)).unwrap();
    assert!(answer.at(&0.0).is_infinite() && (answer.at(&0.5) - 2.75).abs() < 1e-10);
    let limit = Equation::new(unit, |x: f64, y: f64| x * y, |x: f64| x * x.ln() + x / 9.0);
    assert!(solve(&limit, &to(1e-10)).unwrap().at(&0.0).abs() < 1e-8);
}
