//! The hierarchical operator against the matrix that it keeps: what it says of its error, its memory and its action.

#![expect(clippy::unwrap_used, reason = "a test may panic")]

use fredholm::direct;
use fredholm::discretize::{Coupling, Galerkin, ProductNystrom};
use fredholm::equation::{ByOffset, Class, Complex64, Equation, EquationError, Interval, LineKernel, Source};
use fredholm::krylov::Gmres;
use fredholm::operator::hierarchical::{Hierarchical, HierarchicalError, Options, Plan};
use fredholm::operator::{Columns, Dense, Matrix, Operator, Rows, TransposedOperator};
use fredholm::product::Product;
use fredholm::relax::*;
use fredholm::space::Space;
use fredholm::system::System;
use fredholm::value::{Rgb, Spectrum};
use rayon::prelude::*;
use std::f64::consts::PI;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A kernel at points, each with a weight.
struct Points<const D: usize, K> {
    points: Vec<[f64; D]>,
    weights: Vec<f64>,
    kernel: K,
}

impl<const D: usize, K: Fn(&[f64; D], &[f64; D]) -> f64 + Sync> Coupling for Points<D, K> {
    fn dim(&self) -> usize {
        self.points.len()
    }
    fn entry(&self, i: usize, j: usize) -> f64 {
        (self.kernel)(&self.points[i], &self.points[j]) * self.weights[j]
    }
}

fn distance<const D: usize>(x: &[f64; D], y: &[f64; D]) -> f64 {
    x.iter().zip(y).map(|(x, y)| (x - y).powi(2)).sum::<f64>().sqrt()
}

/// `f` of the distance, and of a thousandth where that is 0.
fn radial<const D: usize>(f: fn(f64) -> f64) -> impl Fn(&[f64; D], &[f64; D]) -> f64 + Sync {
    move |x, y| f(distance(x, y).max(1e-3))
}

fn line(n: usize) -> Vec<[f64; 1]> {
    (0..n).map(|k| [(k as f64 + 0.5) / n as f64]).collect()
}

/// In no order, denser towards a corner.
fn square(n: usize) -> Vec<[f64; 2]> {
    let part = |k: usize, a: f64| (k as f64 * a).fract();
    (0..n).map(|k| [part(k, 0.754_877_666).powi(2), part(k, 0.569_840_291)]).collect()
}

fn sphere(n: usize) -> Vec<[f64; 3]> {
    let point = |k: usize| {
        let (z, turn) = (1.0 - (2 * k + 1) as f64 / n as f64, k as f64 * 2.399_963_229_728_653);
        let r = (1.0 - z * z).sqrt();
        [r * turn.cos(), r * turn.sin(), z]
    };
    (0..n).map(point).collect()
}

/// Weights that no symmetry hides.
fn of<const D: usize, K>(points: Vec<[f64; D]>, kernel: K) -> Points<D, K> {
    let n = points.len();
    let weights = (0..n).map(|j| (1.0 + (j % 5) as f64) / (3.0 * n as f64)).collect();
    Points { points, weights, kernel }
}

fn kept<const D: usize, K>(points: &Points<D, K>, tolerance: f64) -> Hierarchical
where
    Points<D, K>: Coupling,
{
    let options = Options { tolerance, ..Options::default() };
    Plan::new(points, &points.points, options).unwrap().assemble(|_| ()).unwrap()
}

/// ‖F − F̃‖_F and ‖F‖_F, by all rows.
fn difference(coupling: &impl Coupling, operator: &Hierarchical) -> (f64, f64) {
    let n = coupling.dim();
    let rows = (0..n).into_par_iter().map_init(Vec::new, |buffer, i| {
        let kept = operator.row(i, buffer);
        let of = |j: usize| ((coupling.entry(i, j) - kept.get(j)).powi(2), coupling.entry(i, j).powi(2));
        (0..n).map(of).fold((0.0, 0.0), |sum, term| (sum.0 + term.0, sum.1 + term.1))
    });
    let (error, norm) = rows.collect::<Vec<_>>().into_iter().fold((0.0, 0.0), |a, b| (a.0 + b.0, a.1 + b.1));
    (error.sqrt(), norm.sqrt())
}

/// The error is what was asked, and what is said of it is true, and no more than three times too much.
fn is_as_asked<const D: usize, K>(name: &str, points: &Points<D, K>)
where
    Points<D, K>: Coupling,
{
    for tolerance in [1e-2, 1e-5, 1e-8, 1e-12] {
        let (error, norm) = is_honest(name, points, tolerance);
        assert!(error <= tolerance * norm, "{name}, {tolerance}: {error} of {norm}");
    }
}

/// ‖F − F̃‖_F and ‖F‖_F, where the former is as it is told.
fn is_honest<const D: usize, K>(name: &str, points: &Points<D, K>, tolerance: f64) -> (f64, f64)
where
    Points<D, K>: Coupling,
{
    let operator = kept(points, tolerance);
    let told = operator.statistics();
    let (error, norm) = difference(points, &operator);
    assert!((told.norm / norm - 1.0).abs() <= 2.0 * tolerance, "{name}: {} is not {norm}", told.norm);
    assert!(error <= told.error, "{name}, {tolerance}: {error} is more than {}", told.error);
    assert!(told.error <= 3.0 * error.max(1e-15 * norm), "{name}, {tolerance}: {error}, said {}", told.error);
    (error, norm)
}

const N: usize = 2000;

#[test]
fn errors_are_as_small_as_asked_and_told_on_a_line() {
    is_as_asked("logarithm", &of(line(N), radial(f64::ln)));
    is_as_asked("power", &of(line(N), radial(|r| r.powf(-0.5))));
    is_as_asked("exponential", &of(line(N), radial(|r| (-5.0 * r).exp())));
    is_as_asked(
        "lopsided",
        &of(line(N), |x: &[f64; 1], y: &[f64; 1]| (1.0 + x[0]) / (0.1 + y[0] + (x[0] - y[0]).abs())),
    );
}

#[test]
fn units_may_be_as_large_or_small_as_they_like() {
    for unit in [1e-60, 1e-35, 1e45, 1e60] {
        let kernel = radial(f64::ln);
        let points = of(line(N), move |x: &[f64; 1], y: &[f64; 1]| unit * kernel(x, y));
        for tolerance in [1e-2, 1e-5] {
            let (error, norm) = is_honest("scaled logarithm", &points, tolerance);
            assert!(error <= tolerance * norm, "{unit}, {tolerance}: {error} of {norm}");
        }
    }
}

#[test]
fn errors_are_as_small_as_asked_and_told_in_the_plane_and_on_a_sphere() {
    is_as_asked("plane, logarithm", &of(square(N), radial(f64::ln)));
    is_as_asked("plane, 1/r", &of(square(N), radial(|r| 1.0 / r)));
    is_as_asked("sphere, 1/r", &of(sphere(N), radial(|r| 1.0 / r)));
}

#[test]
fn a_kernel_that_is_singular_where_nobody_looks_for_it_is_kept_and_its_error_told() {
    // Along y = x/2, in blocks that are far from the diagonal.
    let hidden = of(line(N), |x: &[f64; 1], y: &[f64; 1]| 1.0 / (1e-3 + (x[0] - 2.0 * y[0]).abs()));
    for tolerance in [1e-2, 1e-5, 1e-10] {
        is_honest("hidden", &hidden, tolerance);
    }
}

/// ln |i − j| where places have the same parity, nothing in a third of the rows, and one row that is like no other.
struct Disconnected(usize);

impl Coupling for Disconnected {
    fn dim(&self) -> usize {
        self.0
    }
    fn entry(&self, i: usize, j: usize) -> f64 {
        match i {
            1234 => (j as f64).sin(),
            _ if i.is_multiple_of(3) || !(i + j).is_multiple_of(2) => 0.0,
            _ => (1.0 + i.abs_diff(j) as f64).ln(),
        }
    }
}

#[test]
fn blocks_in_parts_rows_of_zeros_and_a_row_like_no_other_fool_nobody() {
    let coupling = Disconnected(N);
    let options = Options { tolerance: 1e-8, ..Options::default() };
    let operator = Plan::new(&coupling, &line(N), options).unwrap().assemble(|_| ()).unwrap();
    let (error, norm) = difference(&coupling, &operator);
    assert!(
        error <= 1e-8 * norm && error <= operator.statistics().error,
        "{error}, {:?}",
        operator.statistics()
    );
    assert!(operator.statistics().compression() < 0.3);
}

#[test]
fn nothing_is_kept_of_a_matrix_of_zeros_and_everything_of_noise() {
    let zeros = of(line(N), |_: &[f64; 1], _: &[f64; 1]| 0.0);
    let told = *kept(&zeros, 1e-6).statistics();
    assert_eq!((told.ranks, told.error, told.norm, told.relative_error()), ((0, 0.0, 0), 0.0, 0.0, 0.0));
    let noise = of(line(700), |x: &[f64; 1], y: &[f64; 1]| (1e7 * (0.3 + x[0]) * (0.7 + y[0])).sin());
    let operator = kept(&noise, 1e-10);
    assert!(difference(&noise, &operator).0 <= operator.statistics().error.max(1e-15));
    assert!((0.9..1.3).contains(&operator.statistics().compression()), "{:?}", operator.statistics());
}

#[test]
fn memory_is_told_before_it_is_taken_and_refused() {
    let coupling = of(line(20_000), radial(f64::ln));
    let plan =
        |memory| Plan::new(&coupling, &coupling.points, Options { memory, ..Options::default() }).unwrap();
    let told = plan(Options::default().memory).bytes();
    let taken = plan(told).assemble(|_| ()).unwrap().statistics().bytes;
    assert!(taken <= told && told < 2 * taken, "{told} told, {taken} taken");
    let refused = plan(taken / 2).assemble(|_| panic!("something was made")).unwrap_err();
    assert!(matches!(refused, HierarchicalError::Memory { unknowns: 20_000, .. }), "{refused}");
    assert!(refused.to_string().contains("take a larger tolerance"), "{refused}");
}

#[test]
fn entries_are_all_told_as_they_are_settled() {
    let told = AtomicUsize::new(0);
    let coupling = of(square(N), radial(f64::ln));
    let plan = Plan::new(&coupling, &coupling.points, Options::default()).unwrap();
    plan.assemble(|more| {
        told.fetch_add(more, Ordering::Relaxed);
    })
    .unwrap();
    assert_eq!(told.into_inner(), N * N);
}

#[test]
fn what_makes_no_sense_is_told() {
    let coupling = of(line(10), radial(f64::ln));
    let told = |points: &[[f64; 1]], options| {
        Plan::new(&coupling, points, options).map(|_| ()).unwrap_err().to_string()
    };
    let (points, options) = (line(10), Options::default());
    assert_eq!(told(&line(9), options), "9 points for 10 unknowns: each needs one");
    assert!(
        told(&points, Options { tolerance: 0.0, ..options }).starts_with("a tolerance of 0 cannot be had")
    );
    assert!(told(&points, Options { tolerance: f64::NAN, ..options }).starts_with("a tolerance of NaN"));
    assert!(told(&points, Options { eta: f64::INFINITY, ..options }).starts_with("η = inf"));
    let nowhere: Vec<_> = (0..10).map(|k| [if k == 3 { f64::NAN } else { 0.0 }]).collect();
    assert!(told(&nowhere, options).starts_with("point 3 has the box"));
}

#[test]
fn every_solver_finds_what_it_finds_on_the_dense_matrix() {
    let n = 700;
    let coupling = of(square(n), radial(|r| 0.3 / r.sqrt()));
    let (dense, operator) = (Dense::<f64>::assemble(&coupling, |_| ()).unwrap(), kept(&coupling, 1e-10));
    let source: Vec<f64> = (0..n).map(|i| (i as f64).sin()).collect();
    let (coefficient, weights) = (vec![0.8; n], vec![1.0; n]);
    let exact = direct::solve(System::new(&source, &coefficient, &dense).unwrap());
    let system = System::new(&source, &coefficient, &operator).unwrap();
    let solvers: [(&str, Box<dyn Relaxation<f64>>); 5] = [
        ("successive", Box::new(SuccessiveApproximation::new(system))),
        ("jacobi", Box::new(Jacobi::new(system))),
        ("gauss-seidel", Box::new(GaussSeidel::new(system))),
        ("southwell", Box::new(Southwell::new(system, &weights))),
        ("gmres", Box::new(Gmres::new(system))),
    ];
    for (name, mut solver) in solvers {
        let report = relax(&mut *solver, Stop { residual: 1e-9, sweeps: 100_000 }, |_, _, _| true);
        let error = solver.solution().iter().zip(&exact).map(|(u, e)| (u - e).abs()).fold(0.0, f64::max);
        assert!(report.outcome == Outcome::Converged && error < 1e-8, "{name}: {error}");
    }
}

#[test]
fn on_a_sphere_the_single_layer_has_its_eigenvalues() {
    // ∫ Y_l(y) / (4π |x − y|) dy = Y_l(x) / (2l + 1). What a rule misses next to x is found from l = 0.
    let n = 6000;
    let weight = 4.0 * PI / n as f64;
    let kernel = |x: &[f64; 3], y: &[f64; 3]| if x == y { 0.0 } else { 1.0 / (4.0 * PI * distance(x, y)) };
    let coupling = Points { points: sphere(n), weights: vec![weight; n], kernel };
    let operator = kept(&coupling, 1e-8);
    let mut sums = vec![0.0; n];
    operator.apply(&vec![1.0; n], &mut sums);
    let legendre = |degree: usize, z: f64| match degree {
        1 => z,
        2 => 1.5 * z * z - 0.5,
        _ => (35.0 * z.powi(4) - 30.0 * z * z + 3.0) / 8.0,
    };
    for degree in [1, 2, 4] {
        let u: Vec<f64> = coupling.points.iter().map(|x| legendre(degree, x[2])).collect();
        let mut image = vec![0.0; n];
        operator.apply(&u, &mut image);
        let parts = image.iter().zip(&sums).zip(&u).map(|((image, sum), u)| image + (1.0 - sum) * u);
        let error =
            parts.zip(&u).map(|(image, u)| (image - u / (2 * degree + 1) as f64).abs()).fold(0.0, f64::max);
        assert!(error < 1e-3, "degree {degree}: {error}");
    }
}

#[test]
fn averages_over_elements_are_kept_as_well() {
    let kernel = |x: &f64, y: &f64| (0.05 + (x - y).abs()).ln();
    let coupling = Galerkin::new(kernel, Space::on_interval(0.0, 1.0, 1500, 3));
    let options = Options { tolerance: 1e-9, ..Options::default() };
    let operator = Plan::new(&coupling, &line(1500), options).unwrap().assemble(|_| ()).unwrap();
    let (error, norm) = difference(&coupling, &operator);
    assert!(error <= 1e-9 * norm && operator.statistics().compression() < 0.4, "{:?}", operator.statistics());
}

fn panels(count: usize) -> Vec<f64> {
    (0..=count).map(|k| k as f64 / count as f64).collect()
}

/// s |x − y|^α, or s ln |x − y| for α = 0, with the source for which φ = 1 on [0, 1].
fn singular(s: f64, alpha: f64) -> Equation<'static, f64> {
    let of = move |u: f64| if alpha == 0.0 { s * u.ln() } else { s * u.powf(alpha) };
    let integral = move |u: f64| match alpha {
        _ if u == 0.0 => 0.0,
        0.0 => s * (u * u.ln() - u),
        _ => s * u.powf(alpha + 1.0) / (alpha + 1.0),
    };
    let kernel = ByOffset(move |_, _, offset: f64| of(offset.abs()));
    let source = move |x: f64| 1.0 - integral(x) - integral(1.0 - x);
    Equation::new(Interval::new(0.0, 1.0).unwrap(), kernel, source)
}

#[test]
fn product_rules_entry_by_entry_are_the_product_rule() {
    // Panels of all sizes, and a kernel that is not of the difference alone.
    let breaks = vec![0.0, 1e-4, 0.01, 0.02, 0.3, 0.5, 0.55, 1.0];
    let kernel = ByOffset(|x: f64, y: f64, offset: f64| (1.0 + x * y) * offset.abs().ln() + x);
    let equation = Equation::new(Interval::new(0.0, 1.0).unwrap(), kernel, |_| 1.0);
    let coupling = ProductNystrom::new(&equation, breaks.clone(), None).unwrap();
    assert_eq!(coupling.class(), Class::Logarithmic);
    let product = Product::new(&equation, None).unwrap();
    let mut row = vec![0.0; 112];
    for (i, x) in coupling.nodes().iter().enumerate() {
        let expected = product.row((0, 0), *x, &breaks).unwrap();
        let size: f64 = expected.weights.iter().map(|weight| weight.abs()).sum();
        coupling.row(i, 0, &mut row);
        for (j, weight) in expected.weights.iter().enumerate() {
            assert!((row[j] - weight).abs() <= 1e-14 * size, "({i}, {j}): {} is not {weight}", row[j]);
            assert_eq!(coupling.entry(i, j), row[j]);
        }
        let mut part = vec![0.0; 37];
        coupling.row(i, 23, &mut part);
        assert_eq!(part, row[23..60]);
    }
}

/// K_ab = (1 + i x y) ln|x − y| but for one, which is smooth: what a row makes of unknowns is what the rules make of the function.
#[test]
fn a_complex_system_is_one_real_matrix() {
    let breaks = vec![0.0, 0.01, 0.02, 0.3, 0.5, 0.55, 1.0];
    let log =
        |a: f64| ByOffset(move |x: f64, y: f64, offset: f64| Complex64::new(a, x * y) * offset.abs().ln());
    let kernels: Vec<Box<dyn LineKernel<Complex64>>> = vec![
        Box::new(log(1.0)),
        Box::new(log(-2.0)),
        Box::new(|x: f64, y: f64| Complex64::new(x, y)),
        Box::new(log(0.5)),
    ];
    let zero = || -> Box<dyn Source<Complex64>> { Box::new(|_| Complex64::ZERO) };
    let interval = Interval::new(0.0, 1.0).unwrap();
    let system = Equation::system(interval, kernels, vec![zero(), zero()]).unwrap();
    let coupling = ProductNystrom::new(&system, breaks.clone(), None).unwrap();
    let product = Product::new(&system, None).unwrap();
    let n = coupling.nodes().len();
    assert_eq!((coupling.width(), coupling.dim(), coupling.points().len()), (4, 4 * n, 4 * n));
    let value = |k: usize| Complex64::new((3.0 * k as f64).sin(), (5.0 * k as f64).cos());
    let values: Vec<_> = (0..2 * n).map(value).collect();
    let unknowns = coupling.unknowns(&values);
    assert_eq!(coupling.values(&unknowns), values);
    let mut images = vec![0.0; 4 * n];
    let mut row = vec![0.0; 4 * n];
    for (i, image) in images.iter_mut().enumerate() {
        coupling.row(i, 0, &mut row);
        *image = row.iter().zip(&unknowns).map(|(entry, u)| entry * u).sum();
        let j = (7 * i) % (4 * n);
        assert_eq!(coupling.entry(i, j), row[j]);
        let mut part = vec![0.0; 41];
        coupling.row(i, 27, &mut part);
        assert_eq!(part, row[27..68]);
    }
    for (k, image) in coupling.values(&images).iter().enumerate() {
        let (a, x) = (k / n, coupling.nodes()[k % n]);
        let of = |b: usize| {
            let weights = product.row((a, b), x, &breaks).unwrap().weights;
            weights.iter().zip(&values[b * n..]).map(|(weight, value)| weight * value).sum::<Complex64>()
        };
        let expected = of(0) + of(1);
        assert!((image - expected).norm() <= 1e-13, "{k}: {image} is not {expected}");
    }
}

#[test]
fn singular_equations_are_solved_with_thousands_of_unknowns() {
    for (s, alpha) in [(1.0, 0.0), (0.25, -0.5), (1.0, 0.5)] {
        let equation = singular(s, alpha);
        let coupling = ProductNystrom::new(&equation, panels(256), None).unwrap();
        let options = Options { tolerance: 1e-10, ..Options::default() };
        let operator = Plan::new(&coupling, &coupling.points(), options).unwrap().assemble(|_| ()).unwrap();
        let source: Vec<f64> = coupling.nodes().iter().map(|x| equation.source(0, *x)).collect();
        let coefficient = vec![1.0; source.len()];
        let mut gmres = Gmres::new(System::new(&source, &coefficient, &operator).unwrap());
        let report = relax(&mut gmres, Stop { residual: 1e-10, sweeps: 60 }, |_, _, _| true);
        let error = gmres.solution().iter().map(|u| (u - 1.0).abs()).fold(0.0, f64::max);
        assert!(report.outcome == Outcome::Converged && error < 1e-9, "α = {alpha}: {error}");
    }
}

#[test]
fn panels_that_are_not_of_the_interval_are_told() {
    let equation = singular(1.0, 0.0);
    for breaks in [vec![], vec![0.0], vec![0.0, 0.5], vec![0.0, 0.6, 0.5, 1.0], vec![0.0, f64::NAN, 1.0]] {
        let told = ProductNystrom::new(&equation, breaks, None).unwrap_err();
        assert!(told.to_string().contains("these must ascend from 0 to 1"), "{told}");
    }
    let line =
        Equation::new(Interval::new(0.0, f64::INFINITY).unwrap(), |x: f64, y: f64| (-x - y).exp(), |_| 1.0);
    assert!(matches!(
        ProductNystrom::new(&line, vec![0.0, f64::INFINITY], None),
        Err(EquationError::Method(_))
    ));
}

#[test]
fn a_picture_covers_the_matrix_once() {
    let operator = kept(&of(square(N), radial(f64::ln)), 1e-6);
    let picture = operator.picture();
    let area = |line: &str| {
        let number = |name: &str| -> f64 {
            line.split(name).nth(1).unwrap().split('"').next().unwrap().parse().unwrap()
        };
        number(" width=\"") * number(" height=\"")
    };
    let blocks: Vec<f64> = picture.lines().filter(|line| line.contains("stroke")).map(area).collect();
    let told = operator.statistics();
    assert_eq!(blocks.len(), told.dense_blocks + told.low_rank_blocks);
    assert!((blocks.iter().sum::<f64>() / (960.0 * 960.0) - 1.0).abs() < 1e-3);
    // However many unknowns, it can be looked at.
    let fine = kept(&of(line(30_000), radial(f64::ln)), 1e-3).picture();
    assert!(fine.len() < 1_000_000 && fine.contains("#786e6e"), "{}", fine.len());
}

#[test]
fn blocks_over_many_strips_act_and_are_read_as_small_ones_are() {
    // Places in no order, and blocks of 1050 × 1050.
    let n = 4200;
    let points: Vec<[f64; 1]> = (0..n).map(|k| [(k * 1009 % n) as f64 / n as f64]).collect();
    let coupling = of(points, |x: &[f64; 1], y: &[f64; 1]| (1.0 + x[0]) * (1e-3 + (x[0] - y[0]).abs()).ln());
    let operator = kept(&coupling, 1e-10);
    let u: Vec<Rgb> = (0..n).map(|j| Spectrum([1.0, (j as f64).sin(), (j % 3) as f64 - 1.0])).collect();
    let numbers: Vec<f64> = u.iter().map(|u| u.0[1]).collect();
    let (mut forward, mut transposed) = (vec![Spectrum([0.0; 3]); n], vec![Spectrum([0.0; 3]); n]);
    let (mut forward_1, mut transposed_1) = (vec![0.0; n], vec![0.0; n]);
    operator.apply(&u, &mut forward);
    operator.apply(&numbers, &mut forward_1);
    operator.apply_transposed(&u, &mut transposed);
    operator.apply_transposed(&numbers, &mut transposed_1);
    let (mut first, mut second) = (Vec::new(), Vec::new());
    for i in (0..n).step_by(97) {
        let (row, column) = (operator.row(i, &mut first), operator.column(i, &mut second));
        let size: f64 = (0..n).map(|j| coupling.entry(i, j).abs() + coupling.entry(j, i).abs()).sum();
        let close = |a: f64, b: f64, of: f64| assert!((a - b).abs() <= 1e-8 * of, "{i}: {a} is not {b}");
        close(operator.diagonal(i), coupling.entry(i, i), size / n as f64);
        for j in 0..n {
            close(row.get(j), coupling.entry(i, j), size / n as f64);
            close(column.get(j), coupling.entry(j, i), size / n as f64);
        }
        for channel in 0..3 {
            let sum = |entry: &dyn Fn(usize) -> f64| (0..n).map(|j| entry(j) * u[j].0[channel]).sum::<f64>();
            close(forward[i].0[channel], sum(&|j| coupling.entry(i, j)), size);
            close(transposed[i].0[channel], sum(&|j| coupling.entry(j, i)), size);
        }
        close(forward_1[i], forward[i].0[1], size);
        close(transposed_1[i], transposed[i].0[1], size);
    }
}
