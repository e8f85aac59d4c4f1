//! Kernels in the plane that are singular at p = q, with solutions in closed form: the answer is right, and its error is what it says.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use fredholm::equation::{Answer, Class, Complex64, EquationError, Scalar, Status};
use fredholm::plane::{DENSE, Domain, Options, PlaneEquation, solve, solve_large};
use std::f64::consts::{FRAC_PI_2, PI};

type Point = [f64; 2];

fn distance(p: Point, q: Point) -> f64 {
    (p[0] - q[0]).hypot(p[1] - q[1])
}

/// ∫ g over a polygon seen from p within, by its sides: `side` has the distance h of a side's line and what t runs over on it.
fn by_sides(corners: &[Point], p: Point, side: impl Fn(f64, f64) -> f64) -> f64 {
    let sides = corners.iter().zip(corners.iter().cycle().skip(1));
    sides
        .map(|(a, b)| {
            let length = distance(*a, *b);
            let along = [(b[0] - a[0]) / length, (b[1] - a[1]) / length];
            let from = [a[0] - p[0], a[1] - p[1]];
            let (t, h) = (from[0] * along[0] + from[1] * along[1], from[0] * along[1] - from[1] * along[0]);
            if h == 0.0 { 0.0 } else { side(h, t + length) - side(h, t) }
        })
        .sum()
}

/// ∫ dq / |p − q|: h ∫ dt / r.
fn newton(corners: &[Point], p: Point) -> f64 {
    by_sides(corners, p, |h, t| h * (t / h.abs()).asinh())
}

/// ∫ ln |p − q| dq: h ∫ (½ ln r − ¼) dt.
fn logarithm(corners: &[Point], p: Point) -> f64 {
    by_sides(corners, p, |h, t| h * (0.5 * (t * h.hypot(t).ln() - t + h * (t / h).atan()) - 0.25 * t))
}

/// ∫ |p − q| dq: h ∫ ⅓ r dt.
fn cone(corners: &[Point], p: Point) -> f64 {
    by_sides(corners, p, |h, t| h / 6.0 * (t * h.hypot(t) + h * h * (t / h.abs()).asinh()))
}

type Radial = fn(f64) -> f64;
type Potential = fn(&[Point], Point) -> f64;

const KERNELS: [(Radial, Potential); 3] = [(f64::ln, logarithm), (f64::recip, newton), (|r| r, cone)];

const RECTANGLE: Domain = Domain::Rectangle { x0: -1.0, x1: 1.5, y0: 5.0, y1: 6.0 };
const TRIANGLE: Domain = Domain::Triangle([[0.0, 0.0], [3.0, 1.0], [-1.0, 2.0]]);
const DISK: Domain = Domain::Disk { centre: [0.0, 0.0], radius: 1.0 };

fn corners(domain: Domain) -> Vec<Point> {
    match domain {
        Domain::Rectangle { x0, x1, y0, y1 } => vec![[x0, y0], [x1, y0], [x1, y1], [x0, y1]],
        Domain::Triangle(corners) => corners.to_vec(),
        Domain::Disk { .. } => unreachable!("a disk has no corners"),
    }
}

/// Points all over a domain, some of them of its boundary.
fn samples(domain: Domain) -> Vec<Point> {
    let at = |k: usize| {
        let part = |step: f64| (0.5 + step * k as f64).fract();
        let (a, b) = (if k.is_multiple_of(10) { 1.0 } else { part(0.754_877_666) }, part(0.569_840_291));
        match domain {
            Domain::Rectangle { x0, x1, y0, y1 } => [x0 + a * (x1 - x0), y0 + b * (y1 - y0)],
            Domain::Triangle([p, q, r]) => {
                [0, 1].map(|c| p[c] + a * ((1.0 - b) * (q[c] - p[c]) + b * (r[c] - p[c])))
            }
            Domain::Disk { centre, radius } => {
                let (sin, cos) = (2.0 * PI * b).sin_cos();
                [centre[0] + a * radius * cos, centre[1] + a * radius * sin]
            }
        }
    };
    (0..200).map(at).collect()
}

fn to(tolerance: f64) -> Options {
    Options { tolerance, ..Options::default() }
}

/// The largest error at the samples.
fn error<T: Scalar>(answer: &Answer<'_, Point, T>, domain: Domain, exact: impl Fn(Point) -> T) -> f64 {
    samples(domain).into_iter().map(|p| (answer.at(&p) - exact(p)).modulus()).fold(0.0, f64::max)
}

/// J₀(√λ r)/J₀(√λ): the solution on the unit disk for K = −λ ln |p − q| / 2π and f = 1, as −Δφ = λφ, and φ = 1 on the rim.
fn bessel<T: Scalar>(lambda: T) -> impl Fn(Point) -> T {
    let j0 = move |square: f64| {
        let z = lambda * (0.25 * square);
        (1..60).map(f64::from).rev().fold(T::ONE, |sum, k| T::ONE - sum * z * (1.0 / (k * k)))
    };
    move |[x, y]| j0(x * x + y * y) * (T::ONE / j0(1.0))
}

#[test]
fn potentials_of_polygons_are_what_they_are_in_closed_form() {
    for domain in [RECTANGLE, TRIANGLE] {
        let corners = corners(domain);
        for (radial, potential) in KERNELS {
            // φ = 1.
            let kernel = |p: Point, q: Point| 0.05 * radial(distance(p, q));
            let equation = PlaneEquation::new(domain, kernel, |p: Point| 1.0 - 0.05 * potential(&corners, p));
            let answer = solve(&equation, &to(1e-5)).unwrap();
            assert_eq!(answer.status, Status::Converged, "{domain}");
            let (error, told) = (error(&answer, domain, |_| 1.0), answer.error_estimate);
            assert!(
                error <= told && told <= 200.0 * error,
                "{domain}, {:?}: {error:.1e}, told {told:.1e}",
                answer.class
            );
        }
    }
}

#[test]
fn a_logarithm_on_a_disk_has_bessels_function_for_solution() {
    let kernel = |p: Point, q: Point| -1.0 / PI * distance(p, q).ln();
    let equation = PlaneEquation::new(DISK, kernel, |_| 1.0);
    let answer = solve(&equation, &to(1e-12)).unwrap();
    assert_eq!((answer.status, answer.class), (Status::Converged, Some(Class::Logarithmic)));
    let error = error(&answer, DISK, bessel(2.0));
    assert!(error <= answer.error_estimate && answer.error_estimate < 1e-12, "{error:.1e}");
}

#[test]
fn a_complex_logarithm_on_a_disk_too() {
    let lambda = Complex64::new(3.0, 2.0);
    let kernel = |p: Point, q: Point| -lambda / (2.0 * PI) * distance(p, q).ln();
    let equation = PlaneEquation::new(DISK, kernel, |_| Complex64::from(1.0));
    let answer = solve(&equation, &to(1e-10)).unwrap();
    assert_eq!(answer.status, Status::Converged);
    let error = error(&answer, DISK, bessel(lambda));
    assert!(error <= answer.error_estimate, "{error:.1e}, told {:.1e}", answer.error_estimate);
}

/// At a zero of J₀ the radial solutions and those like cos θ and sin θ of the homogeneous equation are three.
#[test]
fn the_alternative_is_told() {
    const ZERO: f64 = 2.404_825_557_695_773;
    let kernel = |p: Point, q: Point| -ZERO * ZERO / (2.0 * PI) * distance(p, q).ln();
    let equation = PlaneEquation::new(DISK, kernel, |_| 1.0);
    let answer = solve(&equation, &to(1e-10)).unwrap();
    assert_eq!((answer.status, answer.error_estimate), (Status::NoSolution, f64::INFINITY));
    let alternative = answer.alternative.unwrap();
    assert_eq!((alternative.null_functions.len(), alternative.adjoint_null_functions.len()), (3, 3));
    assert!(alternative.singular_values[2] < 1e-13 && alternative.singular_values[3] > 0.1);

    // cos 2θ is orthogonal to all three.
    let equation = PlaneEquation::new(DISK, kernel, |[x, y]: Point| x * x - y * y);
    let answer = solve(&equation, &to(1e-7)).unwrap();
    assert_eq!(answer.status, Status::NotUnique);
    assert!(answer.error_estimate < 1e-7, "{:.1e}", answer.error_estimate);
    assert!(answer.alternative.as_ref().unwrap().solvability.iter().all(|product| product.abs() < 1e-11));
    // φ is as J₂(ar) cos 2θ.
    let along = |r: f64| answer.at(&[r, 0.0]);
    let diagonal = answer.at(&[0.5_f64.sqrt() * 0.8, 0.5_f64.sqrt() * 0.8]);
    assert!(diagonal.abs() < 1e-10 && (answer.at(&[0.0, 0.7]) + along(0.7)).abs() < 1e-10);
    let j2 = |z: f64| {
        (1..30).map(f64::from).rev().fold(1.0, |sum, k| 1.0 - sum * z * z / (4.0 * k * (k + 2.0))) * z * z
    };
    assert!((along(0.5) / along(1.0) - j2(0.5 * ZERO) / j2(ZERO)).abs() < 1e-7);
}

#[test]
fn blocks_of_low_rank_go_on_where_a_matrix_ends() {
    let square = Domain::Rectangle { x0: 0.0, x1: 1.0, y0: 0.0, y1: 1.0 };
    let corners = corners(square);
    let kernel = |p: Point, q: Point| 0.1 * distance(p, q).ln();
    let equation = PlaneEquation::new(square, kernel, |p: Point| 1.0 - 0.1 * logarithm(&corners, p));
    let answer = solve_large(&equation, &Options { tolerance: 5e-11, n: None, unknowns: 8000 }).unwrap();
    assert_eq!(answer.status, Status::Converged);
    assert!(answer.unknowns > DENSE && answer.method.contains("blocks"), "{}", answer.method);
    let error = error(&answer, square, |_| 1.0);
    assert!(error <= answer.error_estimate, "{error:.1e}, told {:.1e}", answer.error_estimate);
}

/// Bends along x = s and y = t, and not at p = q alone: the product rule has no answer to them, and says so.
#[test]
fn a_bend_along_lines_is_told_honestly() {
    let square = Domain::Rectangle { x0: 0.0, x1: 1.0, y0: 0.0, y1: 1.0 };
    let kernel = |[x, y]: Point, [s, t]: Point| x.min(s) * y.min(t);
    let phi = |[x, y]: Point| (FRAC_PI_2 * x).sin() * (FRAC_PI_2 * y).sin();
    let equation = PlaneEquation::new(square, kernel, |p| (1.0 - FRAC_PI_2.powi(-4)) * phi(p));
    let answer = solve(&equation, &Options { tolerance: 1e-10, n: None, unknowns: 1100 }).unwrap();
    assert_eq!(answer.status, Status::ToleranceNotMet);
    let error = error(&answer, square, phi);
    assert!(
        error <= answer.error_estimate && answer.error_estimate < 1e-3,
        "{error:.1e}, {}, told {:.1e}",
        answer.method,
        answer.error_estimate
    );
}

/// sin r / r is smooth, and 0/0 at p = q.
#[test]
fn what_is_smooth_and_no_number_on_the_diagonal_is_integrated() {
    let given = |p: Point, q: Point| 0.2 * distance(p, q).sin() / distance(p, q);
    let mended = |p: Point, q: Point| if p == q { 0.2 } else { given(p, q) };
    let source = |[x, y]: Point| x + y;
    let (one, other) =
        (PlaneEquation::new(TRIANGLE, given, source), PlaneEquation::new(TRIANGLE, mended, source));
    let [one, other] = [&one, &other].map(|equation| solve(equation, &to(1e-10)).unwrap());
    assert_eq!((one.status, other.status), (Status::Converged, Status::Converged));
    assert!(error(&one, TRIANGLE, |p| other.at(&p)) <= one.error_estimate + other.error_estimate);
}

fn refused(kernel: impl Fn(Point, Point) -> f64 + Sync + Send, options: Options) -> EquationError {
    solve(&PlaneEquation::new(RECTANGLE, kernel, |_| 1.0), &options).unwrap_err()
}

/// At 10⁷ from the origin seven digits of |p − q| are left at a distance of 1, and none at 10⁻⁸.
#[test]
fn rounding_far_from_the_origin_is_in_the_estimate() {
    let far = Domain::Disk { centre: [1e7, 0.0], radius: 1.0 };
    let kernel = |p: Point, q: Point| -1.0 / PI * distance(p, q).ln();
    let equation = PlaneEquation::new(far, kernel, |_| 1.0);
    let answer = solve(&equation, &to(1e-6)).unwrap();
    let phi = bessel(2.0);
    let error = error(&answer, far, |[x, y]| phi([x - 1e7, y]));
    let told = answer.error_estimate;
    assert!(error <= told && told < 1e-4, "{error:.1e}, told {told:.1e}");
}

#[test]
fn what_cannot_be_done_is_said() {
    let strong = refused(|p, q| distance(p, q).powf(-2.5), Options::default());
    assert!(strong.to_string().contains("|p − q|^-2.50"), "{strong}");
    let ln = |p: Point, q: Point| distance(p, q).ln();
    let few = refused(ln, Options { unknowns: 1000, ..Options::default() });
    assert!(few.to_string().contains("at least 1024 unknowns"), "{few}");
    let n = refused(ln, Options { n: Some(20), ..Options::default() });
    assert!(n.to_string().contains("n is for kernels that are smooth"), "{n}");
    let flat = Domain::triangle([[0.0, 0.0], [1.0, 0.0], [1.0, 1e-3]]).unwrap();
    let flat = solve(&PlaneEquation::new(flat, ln, |_| 1.0), &Options::default()).unwrap_err();
    assert!(flat.to_string().contains("1000 times as long as it is high"), "{flat}");
    let none = refused(|_, _| f64::NAN, Options::default());
    assert!(matches!(none, EquationError::PlaneKernelNotFinite { .. }), "{none}");
    // Infinite along a line.
    let line = refused(|[x, _], [s, _]| (x - s).abs().powf(-0.5), Options::default());
    assert!(
        matches!(line, EquationError::PlaneKernelNotFinite { p, q, .. } if p[0] == q[0] && p[1] != q[1]),
        "{line}"
    );
}
