//! Equations in the plane with known solutions: the answer is right, and its error is what it says.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use fredholm::equation::{Complex64, EquationError, Scalar, Status};
use fredholm::plane::{Domain, Options, PlaneEquation, PlaneKernel, PlaneSource, solve};
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
    let begin = std::time::Instant::now();
    let answer = solve(&equation, &options).unwrap();
    let seconds = begin.elapsed().as_secs_f64();
    let points = samples(domain);
    let size = points.iter().map(|p| exact(*p).modulus()).fold(0.0, f64::max);
    let error = points.iter().map(|p| (answer.at(p) - exact(*p)).modulus()).fold(0.0, f64::max);
    let outcome = Outcome {
        status: answer.status,
        error: error / size,
        estimate: answer.error_estimate / size,
        unknowns: answer.unknowns,
    };
    println!(
        "{:?} n {} error {:.1e} estimate {:.1e} cond {:.1e} {seconds:.3} s",
        outcome.status, outcome.unknowns, outcome.error, outcome.estimate, answer.condition
    );
    outcome
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

/// ∫ over a disk of e^{as + bt} is 2πR I₁(cR)/c e^{a cx + b cy}, c = √(a² + b²): here K(p, q) = g(p) e^{−s/2} φ(q)⁻¹ φ-free.
#[test]
fn a_disk_off_the_origin() {
    let (centre, radius): (Point, f64) = ([2.0, -1.0], 1.5);
    // φ = e^{x/2 + y}, K = (x + y²) e^{−s}/20: the integral of e^{−s/2 + t}.
    let c: f64 = 1.25_f64.sqrt();
    let z = c * radius;
    let bessel: f64 = (0..40).rev().fold(0.0, |sum, k| {
        let k = f64::from(k);
        1.0 + sum * (z * z / 4.0) / ((k + 1.0) * (k + 2.0))
    }) * z
        / 2.0;
    let integral = 2.0 * PI * radius * bessel / c * (-0.5 * centre[0] + centre[1]).exp();
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
    let erf = |z: f64| {
        // ∫₀^z e^{−u²} du 2/√π by Gauss: no special functions here.
        let rule = fredholm::quadrature::gauss_legendre(60, 0.0, z.abs().min(6.5));
        rule.integrate(|u| (-u * u).exp()).copysign(z) * 2.0 / PI.sqrt()
    };
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

/// A bump of f a thirtieth of the domain wide, between the nodes of small rules: φ = f + ∫f/(1 − ½)/2.
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

/// φ = 1 for K = |p − q|^{1/2}·…: not smooth on the diagonal, no closed form needed: f = 1 − ∫K is a fine rule's in polar
/// coordinates about p, on the disk.
#[test]
fn a_kernel_that_is_not_smooth_is_not_said_to_be_solved() {
    for (power, guard) in [(-1.0, 0.0), (-0.5, 0.0), (0.5, 0.0), (1.0, 0.0)] {
        let kernel = move |[x, y]: Point, [s, t]: Point| {
            let r = (x - s).hypot(y - t);
            if r == 0.0 { guard } else { 0.2 * r.powf(power) }
        };
        // ∫ r^power over the disk about p: ∮ ρ(θ)^{2+power}/(2+power) dθ, ρ the way to the circle.
        let integral = move |[x, y]: Point| {
            let d = x.hypot(y);
            let n = 4000;
            let ray = |k: i32| {
                let (sin, cos) = (2.0 * PI * (f64::from(k) + 0.5) / f64::from(n)).sin_cos();
                let way = -d * cos + (1.0 - (d * sin).powi(2)).sqrt();
                way.powf(2.0 + power) / (2.0 + power)
            };
            0.2 * (0..n).map(ray).sum::<f64>() * 2.0 * PI / f64::from(n)
        };
        let options = Options { unknowns: 800, ..to(1e-12) };
        let domain = Domain::disk([0.0, 0.0], 1.0).unwrap();
        let outcome = outcome(domain, kernel, move |p: Point| 1.0 - integral(p), |_| 1.0, options);
        assert_eq!(outcome.status, Status::ToleranceNotMet);
        is_honest(&outcome);
    }
}

/// K = if(s < 1/2, 1, 2)…: divided, the rules are exact on the parts.
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
    let kernel = error(|[x, y], [s, t]| 1.0 / (x - s).hypot(y - t), |_| 1.0);
    assert!(matches!(&kernel, EquationError::PlaneKernelNotFinite { p, q, .. } if p == q), "{kernel}");
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
