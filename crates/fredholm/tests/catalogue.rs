//! The catalogue of problems is right: φ(x) − ∫ K(x, y) φ(y) dy = f(x) for each, by a rule that no solver here uses.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod problems;

use fredholm::equation::{Complex64, LineKernel, Scalar};
use problems::alternative::{LiebLiniger, regular, singular, spectra};
use problems::systems::{complex, systems};
use problems::{OfX, all};
use std::f64::consts::FRAC_PI_2;

/// (distance from the end, weight) of the double exponential rule on (0, length), for that half of it which is near the
/// end: singularities there do no harm. A half-line has one end.
fn half_rule(length: f64) -> Vec<(f64, f64)> {
    // A peak a hundredth of the interval wide and anywhere needs 300; beyond t = 5.4 lies 1e-30 of a singularity.
    let step = 1.0 / 512.0;
    let nodes = (-2800..=2800).map(|k| f64::from(k) * step);
    let pair = |t: f64| {
        if length.is_infinite() {
            // y = e^{π/2 sinh t}.
            let y = (FRAC_PI_2 * t.sinh()).exp();
            (y, y * FRAC_PI_2 * t.cosh() * step)
        } else {
            // y = 1/(1 + e^{π sinh t}), so that it is small where t is large.
            let e = (2.0 * FRAC_PI_2 * t.sinh()).exp();
            (length / (1.0 + e), length * e / (1.0 + e).powi(2) * 2.0 * FRAC_PI_2 * t.cosh() * step)
        }
    };
    nodes
        .filter(|t| length.is_infinite() || *t >= 0.0)
        .map(pair)
        .filter(|(y, w)| *y > 0.0 && w.is_finite())
        .collect()
}

/// The nodes y, the offsets y − x and the weights of ∫_a^b dy, divided at x.
fn rule(x: f64, [a, b]: [f64; 2]) -> [Vec<f64>; 3] {
    let mut rule = [vec![], vec![], vec![]];
    let mut push = |y: f64, offset: f64, w: f64| {
        [y, offset, w].into_iter().zip(&mut rule).for_each(|(number, list)| list.push(number));
    };
    for (end, side) in [(a, -1.0), (b, 1.0)] {
        let length = (end - x).abs();
        let half = half_rule(length);
        for (k, (distance, w)) in half.iter().enumerate() {
            push(x + side * distance, side * distance, *w);
            // The middle node belongs to both halves.
            if length.is_finite() && k > 0 {
                push(end - side * distance, side * (length - distance), *w);
            }
        }
    }
    rule
}

/// ∫ K(x, y) φ(y) dy.
fn integral<T: Scalar>(kernel: &dyn LineKernel<T>, phi: &dyn Fn(f64) -> T, x: f64, interval: [f64; 2]) -> T {
    let [y, offset, weights] = rule(x, interval);
    let mut row = vec![T::ZERO; y.len()];
    kernel.row(x, &y, &offset, &mut row);
    let terms = row.iter().zip(&y).zip(&weights).map(|((k, y), w)| *k * phi(*y) * *w);
    // Far out on a half-line 0 · ∞ is 0.
    terms.filter(|term| term.finite()).sum()
}

/// Twenty points of the interval, none of them special.
fn points([a, b]: [f64; 2]) -> Vec<f64> {
    let place = |k: i32| {
        let t = (f64::from(k) * 0.618_033_988_749_895).fract();
        match (a.is_finite(), b.is_finite()) {
            (true, true) => a + t * (b - a),
            (true, false) => a + 3.0 * t / (1.0 - t),
            (false, true) => b - 3.0 * t / (1.0 - t),
            (false, false) => 0.5 * (2.0 * t - 1.0) / (t * (1.0 - t)),
        }
    };
    (1..=20).map(place).collect()
}

/// A bound for the rounding of f, φ and the integral, relative to the largest of them.
const ROUNDING: f64 = 3e-14;

fn is_solution<T: Scalar>(
    name: &str,
    interval: [f64; 2],
    kernel: &dyn LineKernel<T>,
    f: &dyn Fn(f64) -> T,
    phi: &dyn Fn(f64) -> T,
) {
    for x in points(interval) {
        let integral = integral(kernel, phi, x, interval);
        let size = 1.0 + phi(x).modulus() + integral.modulus();
        let defect = (phi(x) - integral - f(x)).modulus() / size;
        assert!(defect < ROUNDING, "{name} at {x}: {defect:.1e}");
    }
}

#[test]
fn every_solution_solves_its_equation() {
    for problem in all().into_iter().chain(regular()) {
        is_solution(problem.id, problem.interval, &*problem.kernel, &*problem.source, &*problem.exact);
    }
    for problem in complex() {
        is_solution::<Complex64>(
            problem.id,
            problem.interval,
            &*problem.kernel,
            &*problem.source,
            &*problem.exact,
        );
    }
}

#[test]
fn every_name_is_there_once() {
    let mut ids: Vec<_> = all().iter().chain(&regular()).map(|problem| problem.id).collect();
    let count = ids.len();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), count);
    assert!(all().iter().all(|problem| problem.equation().components() == 1));
}

#[test]
fn sources_and_solutions_are_finite_at_the_ends() {
    for problem in all() {
        for x in problem.interval.into_iter().filter(|x| x.is_finite()) {
            assert!(
                (problem.source)(x).is_finite() && (problem.exact)(x).is_finite(),
                "{} at {x}",
                problem.id
            );
        }
    }
}

#[test]
fn every_system_is_solved() {
    for system in systems() {
        let m = system.exact.len();
        assert_eq!(system.equation().components(), m);
        for a in 0..m {
            for x in points([0.0, 1.0]) {
                let terms =
                    (0..m).map(|b| integral(&*system.kernels[a * m + b], &*system.exact[b], x, [0.0, 1.0]));
                let defect = (system.exact[a])(x) - terms.sum::<f64>() - (system.sources[a])(x);
                assert!(defect.abs() < ROUNDING, "{} row {a} at {x}: {defect:.1e}", system.id);
            }
        }
    }
}

#[test]
fn null_functions_are_and_verdicts_are_right() {
    for problem in singular() {
        let (kernel, interval) = (&*problem.kernel, problem.interval);
        for null in &problem.null {
            is_solution(problem.id, interval, kernel, &|_| 0.0, null);
        }
        let [f, phi] = &problem.solvable;
        is_solution(problem.id, interval, kernel, f, phi);
        let middle = 0.37 * interval[0] + 0.63 * interval[1];
        let product = |f: &OfX<f64>, psi: &OfX<f64>| integral(&|_: f64, y: f64| f(y), psi, middle, interval);
        assert!(problem.adjoint.iter().all(|psi| product(f, psi).abs() < ROUNDING), "{}", problem.id);
        assert!(
            problem.adjoint.iter().any(|psi| product(&problem.unsolvable, psi).abs() > 0.1),
            "{}",
            problem.id
        );
        // ψ(x) = ∫ K(y, x) ψ(y) dy: the kernel's columns, one y after another.
        let column = |x: f64, y: f64| entry(kernel, y, x);
        for psi in &problem.adjoint {
            is_solution(problem.id, interval, &column, &|_| 0.0, psi);
        }
    }
}

fn entry(kernel: &dyn LineKernel<f64>, x: f64, y: f64) -> f64 {
    let mut entry = [0.0];
    kernel.row(x, &[y], &[y - x], &mut entry);
    entry[0]
}

/// Σ λ_k² = ∫∫ K².
#[test]
fn spectra_have_the_square_sum_of_their_kernels() {
    for spectrum in spectra() {
        let [a, b] = spectrum.interval;
        let outer = fredholm::quadrature::gauss_legendre(12, a, b);
        let square = |x: f64| {
            let kernel = |x: f64, y: f64, offset: f64| {
                let mut entry = [0.0];
                spectrum.kernel.row(x, &[y], &[offset], &mut entry);
                entry[0].powi(2)
            };
            integral(&fredholm::equation::ByOffset(kernel), &|_| 1.0, x, spectrum.interval)
        };
        let squares = outer.integrate(|x| square(*x));
        let sum: f64 = (1..4000).rev().map(|k| (spectrum.eigenvalue)(k).powi(2)).sum();
        // The rest of Σ 2/n² from n = 2000 is 1e-3.
        assert!((sum - squares).abs() < 2e-3 * squares, "{}: {sum} {squares}", spectrum.id);
    }
}

/// Lieb's numbers fit his equation, with nodes a seventh of the peak's width apart.
#[test]
fn the_numbers_of_lieb_and_liniger() {
    let rule = fredholm::quadrature::gauss_legendre(800, -1.0, 1.0);
    let nystrom =
        fredholm::discretize::Nystrom::new(|x: &f64, y: &f64| LiebLiniger::kernel(*x, *y), rule.clone());
    let matrix = fredholm::operator::Dense::<f64>::assemble(&nystrom, |_| ()).unwrap();
    let source = vec![LiebLiniger::source(0.0); 800];
    let coefficient = vec![1.0; 800];
    let system = fredholm::system::System::new(&source, &coefficient, &matrix).unwrap();
    let u = fredholm::direct::solve(system);
    let middle = LiebLiniger::source(0.0) + nystrom.apply_at(&0.0, &u);
    let integral: f64 = rule.weights.iter().zip(&u).map(|(w, u)| w * u).sum();
    assert!((middle / LiebLiniger::MIDDLE - 1.0).abs() < 1e-11, "{middle}");
    assert!((integral / LiebLiniger::INTEGRAL - 1.0).abs() < 1e-11, "{integral}");
}
