//! The hierarchical operator against the matrix that it keeps: what it says of its error, its memory and its action.

#![expect(clippy::unwrap_used, reason = "a test may panic")]

use fredholm::discretize::Coupling;
use fredholm::operator::Rows;
use fredholm::operator::hierarchical::{Hierarchical, Options, Plan};
use rayon::prelude::*;

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
    println!(
        "{name} {tolerance:e}: {:.2e}, told {:.2e}; ranks {:?}",
        error / norm,
        told.error / norm,
        told.ranks
    );
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
