//! Equations in the plane with known solutions: the answer is right, and its error is what it says.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod problems;

use fredholm::equation::{Answer, Complex64, EquationError, Scalar, Status};
use fredholm::plane::{Domain, Options, PlaneEquation, PlaneKernel, PlaneSource, solve};
use fredholm::quadrature::{Quadrature, gauss_legendre};
use problems::special::erf;
use std::f64::consts::PI;

type Point = [f64; 2];

/// Points all over a domain, those of its boundary included.
fn samples(domain: Domain) -> Vec<Point> {
    let steps = || (0..=20).map(|i| f64::from(i) / 20.0);
    let square = steps().flat_map(|a| steps().map(move |b| (a, b)));
    let place = |(a, b): (f64, f64)| match domain {
        Domain::Rectangle { x0, x1, y0, y1 } => [x0 + a * (x1 - x0), y0 + b * (y1 - y0)],
        Domain::Triangle([p, q, r]) => {
            [0, 1].map(|k| p[k] + a * ((1.0 - b) * (q[k] - p[k]) + b * (r[k] - p[k])))
        }
        Domain::Disk { centre, radius } => {
            let (sin, cos) = (2.0 * PI * b).sin_cos();
            [centre[0] + a * radius * cos, centre[1] + a * radius * sin]
        }
    };
    square.map(place).collect()
}

struct Outcome {
    status: Status,
    /// Relative to max |φ|, as the estimate.
    error: f64,
    estimate: f64,
    unknowns: usize,
}

fn outcome<T: Scalar>(
    domain: Domain,
    kernel: impl PlaneKernel<T>,
    source: impl PlaneSource<T>,
    exact: impl Fn(Point) -> T,
    options: Options,
) -> Outcome {
    let equation = PlaneEquation::new(domain, kernel, source);
    let answer = solve(&equation, &options).unwrap();
    let points = samples(domain);
    let size = points.iter().map(|p| exact(*p).modulus()).fold(0.0, f64::max);
    let error = points.iter().map(|p| (answer.at(p) - exact(*p)).modulus()).fold(0.0, f64::max);
    Outcome {
        status: answer.status,
        error: error / size,
        estimate: answer.error_estimate / size,
        unknowns: answer.unknowns,
    }
}

/// Solved to 1e-13, honestly, and without a wild exaggeration.
fn is_solved(outcome: &Outcome) {
    assert_eq!(outcome.status, Status::Converged);
    assert!(outcome.error <= 1e-13, "error {:.1e}", outcome.error);
    is_honest(outcome);
}

fn is_honest(outcome: &Outcome) {
    let (error, estimate) = (outcome.error, outcome.estimate);
    assert!(error <= estimate, "error {error:.1e} is above its estimate {estimate:.1e}");
    // Where nothing but rounding is left, the error may be nought.
    assert!(
        estimate <= 100.0 * error.max(1e-15),
        "error {error:.1e} is far below its estimate {estimate:.1e}"
    );
}

fn to(tolerance: f64) -> Options {
    Options { tolerance, ..Options::default() }
}

#[test]
fn t01_a_separable_product_on_the_unit_square() {
    let kernel = |[x, y]: Point, [s, t]: Point| 0.5 * (-(x * s + y * t)).exp();
    let part = |x: f64| (1.0 - (-(x + 1.0)).exp()) / (x + 1.0);
    let exact = |[x, y]: Point| (-(x + y)).exp();
    let source = |p: Point| exact(p) - 0.5 * part(p[0]) * part(p[1]);
    is_solved(&outcome(Domain::rectangle(0.0, 1.0, 0.0, 1.0).unwrap(), kernel, source, exact, to(1e-13)));
}

#[test]
fn t03_a_polynomial_on_the_unit_triangle() {
    let kernel = |[x, y]: Point, [s, t]: Point| x * y * (s + t);
    let source = |[x, y]: Point| 1.0 + x * y - x * y * (1.0 / 3.0 + 1.0 / 30.0);
    let domain = Domain::triangle([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]).unwrap();
    is_solved(&outcome(domain, kernel, source, |[x, y]| 1.0 + x * y, to(1e-13)));
}

#[test]
fn t04_a_plane_wave_of_rank_two_on_the_unit_disk() {
    let kernel = |[x, y]: Point, [s, t]: Point| (x * s + y * t) / PI;
    let domain = Domain::disk([0.0, 0.0], 1.0).unwrap();
    is_solved(&outcome(domain, kernel, |[x, _]: Point| 1.0 + 0.75 * x, |[x, _]| 1.0 + x, to(1e-13)));
}

/// A triangle that is a map of the unit one, p = a + M u: K(p, q) = k(u, v)/|det M| has the same φ(u).
#[test]
fn a_triangle_turned_scaled_and_shifted_has_the_solution_of_the_first() {
    let (a, m) = ([3.0, -7.0], [[2.0, -1.5], [0.5, 4.0]]);
    let det = m[0][0] * m[1][1] - m[0][1] * m[1][0];
    let map = |[u, v]: Point| [a[0] + m[0][0] * u + m[0][1] * v, a[1] + m[1][0] * u + m[1][1] * v];
    let back = move |[x, y]: Point| {
        let (x, y) = (x - a[0], y - a[1]);
        [(m[1][1] * x - m[0][1] * y) / det, (m[0][0] * y - m[1][0] * x) / det]
    };
    let kernel = |p: Point, q: Point| {
        let ([x, y], [s, t]) = (back(p), back(q));
        x * y * (s + t) / det
    };
    let source = |p: Point| {
        let [x, y] = back(p);
        1.0 + x * y - x * y * (1.0 / 3.0 + 1.0 / 30.0)
    };
    let exact = |p: Point| {
        let [x, y] = back(p);
        1.0 + x * y
    };
    for corners in [[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], [[0.0, 1.0], [1.0, 0.0], [0.0, 0.0]]] {
        is_solved(&outcome(Domain::triangle(corners.map(map)).unwrap(), kernel, source, exact, to(1e-13)));
    }
}

#[test]
fn a_disk_off_the_origin() {
    let (centre, radius): (Point, f64) = ([2.0, -1.0], 1.5);
    // φ = e^{x/2 + y}, K = (x + y²) e^{−s}/20. ∫ e^{as + bt} is e^{a cx + b cy} times 2πR I₁(kR)/k, k = √(a² + b²).
    let (a, b) = (-0.5_f64, 1.0_f64);
    let z = a.hypot(b) * radius;
    // I₁(z) = z/2 Σ (z²/4)^k/(k! (k + 1)!), by Horner.
    let series =
        (0..40).map(f64::from).rev().fold(1.0, |sum, k| 1.0 + sum * (z * z / 4.0) / ((k + 1.0) * (k + 2.0)));
    let integral = PI * radius * radius * series * (a * centre[0] + b * centre[1]).exp();
    let exact = |[x, y]: Point| (0.5 * x + y).exp();
    let kernel = |[x, y]: Point, [s, _]: Point| (x + y * y) * (-s).exp() / 20.0;
    let source = |p: Point| exact(p) - (p[0] + p[1] * p[1]) * integral / 20.0;
    is_solved(&outcome(Domain::disk(centre, radius).unwrap(), kernel, source, exact, to(1e-13)));
}

/// On [0, 50] × [0, 0.02]: many nodes along it, few across.
#[test]
fn a_rectangle_2500_times_as_long_as_high() {
    let kernel = |[x, y]: Point, [s, t]: Point| (x * 0.1).cos() * (s * 0.5).cos() * (1.0 + y + t);
    // φ = x-free: f from φ = cos(x/2): ∫cos²(s/2) ds = 25 + sin(50)/2 and ∫(1 + y + t) dt = 0.02 (1 + y) + 0.0002.
    let along = 25.0 + 50_f64.sin() / 2.0;
    let exact = |[x, _]: Point| (0.5 * x).cos();
    let source = |p: Point| exact(p) - (p[0] * 0.1).cos() * along * (0.02 * (1.0 + p[1]) + 0.0002);
    let outcome = outcome(Domain::rectangle(0.0, 50.0, 0.0, 0.02).unwrap(), kernel, source, exact, to(1e-13));
    is_solved(&outcome);
    assert!(outcome.unknowns < 700, "{} unknowns", outcome.unknowns);
}

/// ∫₀¹ e^{−(x − s)²/2w²} ds.
fn bell(x: f64, w: f64) -> f64 {
    let scale = w * 2_f64.sqrt();
    w * (PI / 2.0).sqrt() * (erf(x / scale) + erf((1.0 - x) / scale))
}

fn peaked(w: f64, options: Options) -> Outcome {
    let kernel = move |[x, y]: Point, [s, t]: Point| {
        0.5 * (-((x - s).powi(2) + (y - t).powi(2)) / (2.0 * w * w)).exp() / (2.0 * PI * w * w)
    };
    // φ = 1.
    let source = move |[x, y]: Point| 1.0 - 0.5 * bell(x, w) * bell(y, w) / (2.0 * PI * w * w);
    outcome(Domain::rectangle(0.0, 1.0, 0.0, 1.0).unwrap(), kernel, source, |_| 1.0, options)
}

#[test]
fn a_gaussian_peak() {
    is_honest(&peaked(0.3, to(1e-12)));
    is_honest(&peaked(0.1, to(1e-11)));
}

#[test]
fn a_peak_too_narrow_for_the_unknowns_is_said_to_be() {
    let outcome = peaked(0.01, Options { unknowns: 1000, ..to(1e-10) });
    assert_eq!(outcome.status, Status::ToleranceNotMet);
    assert!(outcome.error <= outcome.estimate);
}

/// A bump of f a thirtieth of the domain wide, between the nodes of small rules: φ = f + ∫f.
#[test]
fn a_small_bump_of_the_source_is_not_overlooked() {
    let w = 0.033;
    let bump =
        move |[x, y]: Point| (-((x - 0.43_f64).powi(2) + (y - 0.59_f64).powi(2)) / (2.0 * w * w)).exp();
    let mean = bell(0.43, w) * bell(0.59, w);
    let outcome = outcome(
        Domain::rectangle(0.0, 1.0, 0.0, 1.0).unwrap(),
        |_: Point, _: Point| 0.5,
        bump,
        |p| bump(p) + mean,
        to(1e-10),
    );
    assert_eq!(outcome.status, Status::Converged);
    assert!(outcome.error <= outcome.estimate);
}

#[test]
fn complex_kernels() {
    // φ = e^{i(x + 2y)}: K e^{−i(s + 2t)} makes the integral the area.
    let exact = |[x, y]: Point| Complex64::from_polar(1.0, x + 2.0 * y);
    let kernel =
        |[x, y]: Point, [s, t]: Point| Complex64::new(0.3 * x, y) * Complex64::from_polar(1.0, -s - 2.0 * t);
    let source = |[x, y]: Point| exact([x, y]) - Complex64::new(0.3 * x, y);
    is_solved(&outcome(Domain::rectangle(0.0, 2.0, 1.0, 1.5).unwrap(), kernel, source, exact, to(1e-13)));
}

/// K = |p − q|^power/10, with 0 at p = q; φ = 1.
#[test]
fn powers_of_the_distance_are_integrated_whatever_they_are_where_it_is_none() {
    for power in [-1.0, -0.5, 0.5, 1.0] {
        let kernel = move |[x, y]: Point, [s, t]: Point| {
            let r = (x - s).hypot(y - t);
            if r == 0.0 { 0.0 } else { 0.1 * r.powf(power) }
        };
        // ∫ r^power over the disk about p: ∮ ρ^(2 + power)/(2 + power) dα, ρ the way to the circle and α its angle seen from p.
        let integral = move |[x, y]: Point| {
            let (d, n) = (x.hypot(y), 2000);
            let part = |k: i32| {
                let cos = (2.0 * PI * (f64::from(k) + 0.5) / f64::from(n)).cos();
                (1.0 + d * d - 2.0 * d * cos).sqrt().powf(power) * (1.0 - d * cos) / (2.0 + power)
            };
            0.1 * (0..n).map(part).sum::<f64>() * 2.0 * PI / f64::from(n)
        };
        let domain = Domain::disk([0.0, 0.0], 1.0).unwrap();
        let outcome = outcome(domain, kernel, move |p: Point| 1.0 - integral(p), |_| 1.0, to(1e-3));
        let (error, estimate) = (outcome.error, outcome.estimate);
        assert_eq!(outcome.status, Status::Converged, "r^{power}: {estimate:.1e}");
        assert!(error <= estimate, "r^{power}: {error:.1e} is above its estimate {estimate:.1e}");
    }
}

/// Where the domain is divided at s = ½, the rules of the parts are exact.
#[test]
fn a_jump_on_a_line_of_division_is_met_by_dividing() {
    let kernel = |[x, _]: Point, [s, _]: Point| x * if s < 0.5 { 0.2 } else { 0.5 };
    let source = |[x, y]: Point| 1.0 + x * y - x * (0.2 * (0.5 + 0.0625) + 0.5 * (0.5 + 0.1875));
    let domain = Domain::rectangle(0.0, 1.0, 0.0, 1.0).unwrap();
    let outcome = outcome(domain, kernel, source, |[x, y]| 1.0 + x * y, to(1e-13));
    is_solved(&outcome);
}

/// f and φ steep in one corner alone: the other parts keep few nodes.
#[test]
fn a_steep_corner() {
    let exact = |[x, y]: Point| 1.0 / (x + y + 0.01);
    // ∫∫ 1/(x + y + c) = g(2 + c) − 2 g(1 + c) + g(c), g(z) = z ln z − z.
    let g = |z: f64| z * z.ln() - z;
    let integral = g(2.01) - 2.0 * g(1.01) + g(0.01);
    let kernel = |[x, y]: Point, _: Point| (x - y).cos() / 3.0;
    let source = move |[x, y]: Point| exact([x, y]) - (x - y).cos() / 3.0 * integral;
    let domain = Domain::rectangle(0.0, 1.0, 0.0, 1.0).unwrap();
    let outcome = outcome(domain, kernel, source, exact, to(1e-12));
    assert_eq!(outcome.status, Status::Converged);
    assert!(outcome.error <= outcome.estimate);
}

/// (φ_n − f), which must be a sum of null functions, less its L² projection on them, by a rule of the domain.
fn beyond_null<T: Scalar>(
    answer: &Answer<'_, Point, T>,
    particular: impl Fn(Point) -> T,
    rule: &Quadrature<Point>,
) -> f64 {
    let null = &answer.alternative.as_ref().unwrap().null_functions;
    let rest = |p: &Point| answer.at(p) - particular(*p);
    let inner = |f: &dyn Fn(&Point) -> T, g: &dyn Fn(&Point) -> T| {
        rule.nodes.iter().zip(&rule.weights).map(|(p, w)| f(p) * g(p).conjugate() * *w).sum::<T>()
    };
    for (i, one) in null.iter().enumerate() {
        for (j, other) in null.iter().enumerate() {
            let product = inner(&|p| one.at(p), &|p| other.at(p));
            assert!((product.modulus() - f64::from(u8::from(i == j))).abs() < 1e-11, "not orthonormal");
        }
    }
    let parts: Vec<T> = null.iter().map(|phi| inner(&rest, &|p| phi.at(p))).collect();
    let left = |p: &Point| rest(p) - null.iter().zip(&parts).map(|(phi, c)| phi.at(p) * *c).sum::<T>();
    rule.nodes.iter().map(|p| left(p).modulus()).fold(0.0, f64::max)
}

#[derive(Clone, Copy)]
struct Expected {
    status: Status,
    nullity: usize,
}

/// The answer's verdict, its null functions, and that its φ is right but for them.
fn has_alternative<T: Scalar>(
    domain: Domain,
    rule: &Quadrature<Point>,
    kernel: impl PlaneKernel<T>,
    source: impl PlaneSource<T>,
    particular: impl Fn(Point) -> T,
    expected: Expected,
) {
    let equation = PlaneEquation::new(domain, kernel, source);
    let answer = solve(&equation, &to(1e-12)).unwrap();
    assert_eq!((answer.status, answer.nullity()), (expected.status, expected.nullity));
    let alternative = answer.alternative.as_ref().unwrap();
    assert_eq!(alternative.adjoint_null_functions.len(), expected.nullity);
    assert_eq!(alternative.solvability.len(), expected.nullity);
    assert!(alternative.distance_to_spectrum < 1e-12);
    let [zero, other] = [expected.nullity - 1, expected.nullity].map(|k| alternative.singular_values[k]);
    assert!(zero < 1e-11 && other > 1e-3, "{:?}", alternative.singular_values);
    let defect = alternative.solvability.iter().map(|defect| defect.modulus()).fold(0.0, f64::max);
    if expected.status == Status::NotUnique {
        assert!(
            defect < 1e-14 && answer.error_estimate < 1e-12,
            "{defect:.1e} {:.1e}",
            answer.error_estimate
        );
        let beyond = beyond_null(&answer, particular, rule);
        assert!(beyond <= answer.error_estimate, "{beyond:.1e} {:.1e}", answer.error_estimate);
    } else {
        assert!(defect > 0.1 && answer.error_estimate.is_infinite());
    }
}

fn square_rule(a: f64, b: f64) -> Quadrature<Point> {
    gauss_legendre(20, a, b).squared()
}

#[test]
fn the_mean_on_the_unit_square_has_the_eigenvalue_1() {
    let domain = Domain::rectangle(0.0, 1.0, 0.0, 1.0).unwrap();
    let mean = |_: Point, _: Point| 1.0;
    let rule = square_rule(0.0, 1.0);
    let f = |[x, y]: Point| x - y + (2.0 * PI * x).cos();
    has_alternative(domain, &rule, mean, f, f, Expected { status: Status::NotUnique, nullity: 1 });
    has_alternative(
        domain,
        &rule,
        mean,
        |_: Point| 1.0,
        |_| 0.0,
        Expected { status: Status::NoSolution, nullity: 1 },
    );
}

/// (2/π)² cos(x − s) cos(y − t): the products of cos and sin, four of them.
#[test]
fn a_null_space_of_dimension_four() {
    let domain = Domain::rectangle(0.0, PI, 0.0, PI).unwrap();
    let kernel = |[x, y]: Point, [s, t]: Point| (2.0 / PI).powi(2) * (x - s).cos() * (y - t).cos();
    let rule = square_rule(0.0, PI);
    let f = |[x, y]: Point| (3.0 * x).cos() * y;
    // f is orthogonal to all four at any n: a solution that meets a loose tolerance does not end the search for them.
    let equation = PlaneEquation::new(domain, kernel, f);
    assert_eq!(solve(&equation, &to(1e-2)).unwrap().nullity(), 4);
    has_alternative(domain, &rule, kernel, f, f, Expected { status: Status::NotUnique, nullity: 4 });
    has_alternative(
        domain,
        &rule,
        kernel,
        |_: Point| 3.0,
        |_| 0.0,
        Expected { status: Status::NoSolution, nullity: 4 },
    );
}

/// 60 x s t on the unit triangle: the null function is x, the adjoint's is xy, and ∫ (1 − 7.5 xy) xy = 0.
#[test]
fn the_adjoint_has_another_null_function() {
    let domain = Domain::triangle([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]).unwrap();
    let kernel = |[x, _]: Point, [s, t]: Point| 60.0 * x * s * t;
    let rule = gauss_legendre(20, 0.0, 1.0).squared().map(|[u, v], w| ([u * (1.0 - v), u * v], w * u));
    let f = |[x, y]: Point| 1.0 - 7.5 * x * y;
    has_alternative(domain, &rule, kernel, f, f, Expected { status: Status::NotUnique, nullity: 1 });
    // Orthogonal to the null function, but not to the adjoint's: ∫ (1 − 4x) x = 0.
    let orthogonal_to_null = |[x, _]: Point| 10.0 * (1.0 - 2.0 * x);
    has_alternative(
        domain,
        &rule,
        kernel,
        orthogonal_to_null,
        f,
        Expected { status: Status::NoSolution, nullity: 1 },
    );
    let equation = PlaneEquation::new(domain, kernel, f);
    let answer = solve(&equation, &to(1e-12)).unwrap();
    let psi = &answer.alternative.as_ref().unwrap().adjoint_null_functions[0];
    // xy/‖xy‖, ‖xy‖² = 1/180.
    let ratio = psi.at(&[0.3, 0.5]) / (0.15 * 180_f64.sqrt());
    assert!((ratio.abs() - 1.0).abs() < 1e-13, "{ratio}");
}

#[test]
fn a_complex_eigenfunction() {
    let domain = Domain::disk([0.0, 0.0], 1.0).unwrap();
    let wave = |[x, y]: Point| Complex64::from_polar(1.0, 2.0 * x + y);
    // ψ = wave too; i times an odd function is orthogonal to it on the disk.
    let kernel = move |p: Point, q: Point| wave(p) * wave(q).conj() / PI;
    let f = move |p: Point| wave(p) * p[0] * p[1] * Complex64::I;
    let rule = gauss_legendre(20, 0.0, 1.0).squared().map(|[s, t], w| {
        let (sin, cos) = (2.0 * PI * t).sin_cos();
        ([s.sqrt() * cos, s.sqrt() * sin], w * PI)
    });
    has_alternative(domain, &rule, kernel, f, f, Expected { status: Status::NotUnique, nullity: 1 });
    let none = move |p: Point| wave(p) * Complex64::I;
    has_alternative(domain, &rule, kernel, none, f, Expected { status: Status::NoSolution, nullity: 1 });
}

/// 1 − 2⁻²⁰ is not 1: the solution is unique, with fewer digits.
#[test]
fn close_to_an_eigenvalue_the_solution_is_unique() {
    let gap = 2_f64.powi(-20);
    let domain = Domain::rectangle(0.0, 1.0, 0.0, 1.0).unwrap();
    let outcome = outcome(domain, |_: Point, _: Point| 1.0 - gap, move |_: Point| gap, |_| 1.0, to(1e-7));
    assert_eq!(outcome.status, Status::Converged);
    assert!(outcome.error <= outcome.estimate && outcome.estimate < 1e-7);
}

/// The largest error is in the centre, where no rule of a disk has nodes. φ = 1.
#[test]
fn the_error_in_the_centre_of_a_disk_is_seen() {
    let kernel = |[x, y]: Point, [s, t]: Point| 0.3 / (0.2 + (x - s).powi(2) + (y - t).powi(2));
    // By Gauss in r and enough angles: to 1e-15.
    let radii = gauss_legendre(60, 0.0, 1.2);
    let angles = (0..240).map(|k| f64::from(k) * PI / 120.0);
    let fine: Vec<(Point, f64)> = angles
        .flat_map(|angle| {
            let polar = |(r, w): (&f64, &f64)| ([r * angle.cos(), r * angle.sin()], w * r * PI / 120.0);
            radii.nodes.iter().zip(&radii.weights).map(polar).collect::<Vec<_>>()
        })
        .collect();
    let source = move |p: Point| 1.0 - fine.iter().map(|(q, w)| kernel(p, *q) * w).sum::<f64>();
    let domain = Domain::disk([0.0, 0.0], 1.2).unwrap();
    for n in [5, 8, 11] {
        is_honest(&outcome(domain, kernel, &source, |_| 1.0, Options { n: Some(n), ..to(1e-12) }));
    }
}

#[test]
fn fixed_n_is_kept_and_its_error_told() {
    let kernel = |[x, y]: Point, [s, t]: Point| 0.5 * (-(x * s + y * t)).exp();
    let part = |x: f64| (1.0 - (-(x + 1.0)).exp()) / (x + 1.0);
    let exact = |[x, y]: Point| (-(x + y)).exp();
    let source = |p: Point| exact(p) - 0.5 * part(p[0]) * part(p[1]);
    let domain = Domain::rectangle(0.0, 1.0, 0.0, 1.0).unwrap();
    for n in 1..=8 {
        let outcome = outcome(domain, kernel, source, exact, Options { n: Some(n), ..to(1e-12) });
        assert_eq!(outcome.unknowns, n * n);
        is_honest(&outcome);
    }
}

#[test]
fn the_number_of_threads_changes_no_digit() {
    let kernel = |[x, y]: Point, [s, t]: Point| 0.5 * (-(3.0 * x * s + y * t).sin()).exp();
    let equation =
        PlaneEquation::new(Domain::disk([0.5, 0.5], 1.0).unwrap(), kernel, |[x, y]: Point| x.exp() - y);
    let digits = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let answer = pool.install(|| solve(&equation, &to(1e-9)).unwrap());
        (answer.at(&[0.3, 0.2]).to_bits(), answer.error_estimate.to_bits(), answer.condition.to_bits())
    };
    assert_eq!(digits(1), digits(3));
}

#[test]
fn what_is_no_domain_is_refused() {
    let nan = f64::NAN;
    let inf = f64::INFINITY;
    let refused = [
        Domain::rectangle(0.0, 0.0, 0.0, 1.0),
        Domain::rectangle(1.0, 0.0, 1.0, 0.0),
        Domain::rectangle(0.0, inf, 0.0, 1.0),
        Domain::rectangle(0.0, 1.0, nan, 1.0),
        Domain::rectangle(-1e308, 1e308, 0.0, 1.0),
        Domain::rectangle(0.0, 1e-200, 0.0, 1e-200),
        Domain::triangle([[0.0, 0.0], [1.0, 3.0], [2.0, 6.0]]),
        Domain::triangle([[0.0, 0.0], [0.1, 0.3], [0.2, 0.6]]),
        Domain::triangle([[0.0, 0.0], [0.0, 0.0], [0.0, 0.0]]),
        Domain::triangle([[0.0, 0.0], [1.0, 0.0], [0.0, nan]]),
        Domain::disk([0.0, 0.0], 0.0),
        Domain::disk([0.0, 0.0], -1.0),
        Domain::disk([inf, 0.0], 1.0),
        Domain::disk([0.0, 0.0], nan),
    ];
    for (k, domain) in refused.into_iter().enumerate() {
        assert!(matches!(domain, Err(EquationError::EmptyDomain { .. })), "number {k} is {domain:?}");
    }
    let by_hand = Domain::Disk { centre: [0.0, 0.0], radius: -1.0 };
    let equation = PlaneEquation::new(by_hand, |_: Point, _: Point| 0.1, |_: Point| 1.0);
    assert!(matches!(solve(&equation, &Options::default()), Err(EquationError::EmptyDomain { .. })));
}

#[test]
fn a_domain_is_read_as_it_is_written() {
    for text in ["rectangle 0 1 -0.5 1", "triangle 0 0 1 0 0 1", "disk 0.5 0 2"] {
        assert_eq!(text.parse::<Domain>().unwrap().to_string(), text);
    }
    assert_eq!("  disk\t1e0 0  2 ".parse::<Domain>().unwrap(), Domain::disk([1.0, 0.0], 2.0).unwrap());
    for (text, why) in [
        ("", "\"\" is no domain"),
        ("square 0 1", "\"square\" is no domain"),
        ("rectangle 0 1 0", "3 numbers are not as many as a rectangle has"),
        ("disk 0 0 1 1", "4 numbers are not as many as a disk has"),
        ("disk 0 0 one", "\"one\" is no number"),
        ("disk 0 0 -1", "no finite and positive area"),
        ("rectangle 0 nan 0 1", "no finite and positive area"),
    ] {
        let error = text.parse::<Domain>().unwrap_err().to_string();
        assert!(error.contains(why), "{text}: {error}");
    }
}

#[test]
fn what_is_not_finite_is_named() {
    let domain = Domain::rectangle(0.0, 1.0, 0.0, 1.0).unwrap();
    let error = |kernel: fn(Point, Point) -> f64, source: fn(Point) -> f64| {
        solve(&PlaneEquation::new(domain, kernel, source), &Options::default()).unwrap_err()
    };
    let kernel = error(|[x, _], [s, _]| (x - s).abs().recip().sqrt(), |_| 1.0);
    assert!(matches!(&kernel, EquationError::PlaneKernelNotFinite { p, q, .. } if p[0] == q[0]), "{kernel}");
    let source = error(|_, _| 0.1, |[x, _]| if x > 0.9 { f64::NAN } else { 1.0 });
    assert!(matches!(&source, EquationError::PlaneSourceNotFinite { p, .. } if p[0] > 0.9), "{source}");
}

#[test]
fn options_that_ask_for_nothing_are_refused() {
    let domain = Domain::rectangle(0.0, 1.0, 0.0, 1.0).unwrap();
    let equation = PlaneEquation::new(domain, |_: Point, _: Point| 0.1, |_: Point| 1.0);
    for options in [
        Options { n: Some(0), ..Options::default() },
        Options { n: Some(100), ..Options::default() },
        Options { unknowns: 0, ..Options::default() },
        to(f64::NAN),
        to(-1.0),
    ] {
        assert!(matches!(solve(&equation, &options), Err(EquationError::Method(_))), "{options:?}");
    }
}
