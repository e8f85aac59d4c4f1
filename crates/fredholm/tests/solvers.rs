//! Every solver against the direct one, and equations whose solution is known.

#![expect(clippy::unwrap_used, reason = "a test may panic")]

use fredholm::direct;
use fredholm::discretize::{Collocation, Coupling, Galerkin, Nystrom};
use fredholm::krylov::Gmres;
use fredholm::neumann::estimated_rest;
use fredholm::operator::{Dense, Matrix, OnTheFly, Operator, Rows};
use fredholm::quadrature::gauss_legendre;
use fredholm::relax::*;
use fredholm::space::Space;
use fredholm::system::{System, SystemError, error_bound, norm_bound, row_sums};
use fredholm::value::{Rgb, Spectrum, Value, max_norm};

/// Not symmetric, a diagonal, row sums of about 1.
struct Lopsided(usize);

impl Coupling for Lopsided {
    fn dim(&self) -> usize {
        self.0
    }
    fn entry(&self, i: usize, j: usize) -> f64 {
        let n = self.0 as f64;
        (2.0 + (7.0 * i as f64 + 3.0 * j as f64).sin()) / 2.0 / n * if i == j { 20.0 } else { 0.8 }
    }
}

const N: usize = 150;

struct Problem {
    source: Vec<Rgb>,
    coefficient: Vec<Rgb>,
    matrix: Dense<f64>,
}

/// The third channel has no source: its solution is zero, and no method may trip over it.
fn problem() -> Problem {
    let at = |i: usize, k: f64| 0.5 + 0.45 * (i as f64 * k).sin();
    Problem {
        source: (0..N).map(|i| Spectrum([at(i, 1.1), 100.0 * at(i, 0.3), 0.0])).collect(),
        coefficient: (0..N).map(|i| Spectrum([at(i, 2.0), 0.3 * at(i, 0.7), 0.9])).collect(),
        matrix: Dense::assemble(&Lopsided(N), |_| ()).unwrap(),
    }
}

fn solvers<'a>(
    system: System<'a, Rgb, Dense<f64>>,
    weights: &'a [f64],
) -> Vec<(&'static str, Box<dyn Relaxation<Rgb> + 'a>)> {
    vec![
        ("successive", Box::new(SuccessiveApproximation::new(system))),
        ("jacobi", Box::new(Jacobi::new(system))),
        ("gauss-seidel", Box::new(GaussSeidel::new(system))),
        ("southwell", Box::new(Southwell::new(system, weights))),
        ("gmres", Box::new(Gmres::new(system))),
        ("direct", Box::new(direct::Direct::new(system))),
    ]
}

fn all_row_sums(matrix: &Dense<f64>) -> Vec<f64> {
    row_sums(matrix, &(0..N).collect::<Vec<_>>())
}

fn distance<V: Value>(a: &[V], b: &[V]) -> f64 {
    max_norm(&a.iter().zip(b).map(|(a, b)| *a - *b).collect::<Vec<_>>())
}

#[test]
fn every_solver_finds_what_the_direct_one_finds_and_its_bound_holds() {
    let p = problem();
    let system = System::new(&p.source, &p.coefficient, &p.matrix).unwrap();
    let exact = direct::solve(system);
    assert!(max_norm(&system.residual(&exact)) < 1e-12);
    let norm = norm_bound(&p.coefficient, &all_row_sums(&p.matrix));
    assert!(norm < 1.0, "{norm}");
    let weights: Vec<f64> = (0..N).map(|i| 1.0 + (i % 5) as f64).collect();
    for tolerance in [1e-2, 1e-6, 1e-10] {
        for (name, mut solver) in solvers(system, &weights) {
            let report = relax(&mut *solver, Stop { residual: tolerance, sweeps: 100_000 }, |_, _, _| true);
            assert_eq!(report.outcome, Outcome::Converged, "{name}");
            assert!(report.residual <= tolerance, "{name}");
            let true_residual = max_norm(&system.residual(&solver.solution()));
            assert!((true_residual - report.residual).abs() < 1e-12, "{name}: {true_residual} {report:?}");
            let error = distance(&solver.solution(), &exact);
            let bound = error_bound(report.residual, norm).unwrap();
            assert!(error <= bound + 1e-13, "{name}: {error} > {bound}");
        }
    }
}

#[test]
fn gauss_seidel_in_blocks_is_gauss_seidel_one_after_the_other() {
    let p = problem();
    let system = System::new(&p.source, &p.coefficient, &p.matrix).unwrap();
    let mut solver = GaussSeidel::new(system);
    let mut u = p.source.clone();
    for _ in 0..3 {
        solver.sweep();
        for i in 0..N {
            let f = Lopsided(N);
            let others = (0..N).filter(|&j| j != i).fold(Spectrum([0.0; 3]), |s, j| s + u[j] * f.entry(i, j));
            let diagonal = Spectrum([1.0; 3]) - p.coefficient[i] * f.entry(i, i);
            u[i] = (p.source[i] + p.coefficient[i] * others) / diagonal;
        }
        assert!(distance(&u, &solver.solution()) < 1e-12);
    }
}

#[test]
fn the_terms_of_successive_approximations_are_the_neumann_series() {
    let p = problem();
    let system = System::new(&p.source, &p.coefficient, &p.matrix).unwrap();
    let mut solver = SuccessiveApproximation::new(system);
    let (mut sum, mut term) = (vec![Spectrum([0.0; 3]); N], p.source.clone());
    for _ in 0..4 {
        solver.sweep();
        sum.iter_mut().zip(&term).for_each(|(s, t)| *s += *t);
        assert!(distance(&sum, &solver.solution()) < 1e-12);
        term = system.transport(&term);
    }
}

#[test]
fn southwell_relaxes_the_largest_weighted_residual() {
    let p = problem();
    let system = System::new(&p.source, &p.coefficient, &p.matrix).unwrap();
    let mut weights = vec![1.0; N];
    weights[17] = 1e6;
    let mut solver = Southwell::new(system, &weights);
    solver.sweep();
    let touched: Vec<usize> = (0..N).filter(|&i| solver.solution()[i].magnitude() > 0.0).collect();
    assert_eq!(touched, [17]);
    assert_eq!(solver.residual()[17], Spectrum([0.0; 3]));
}

#[test]
fn the_ambient_estimate_is_the_rest_when_f_is_the_mean() {
    // F = the weighted mean, constant ρ: previews with the ambient term are the solution from the start.
    struct Mean(Vec<f64>);
    impl Coupling for Mean {
        fn dim(&self) -> usize {
            self.0.len()
        }
        fn entry(&self, _: usize, j: usize) -> f64 {
            self.0[j] / self.0.iter().sum::<f64>()
        }
    }
    let weights = vec![1.0, 2.0, 5.0];
    let mean = OnTheFly(Mean(weights.clone()));
    let (source, coefficient) = (vec![1.0, 0.0, 3.0], vec![0.6; 3]);
    let system = System::new(&source, &coefficient, &mean).unwrap();
    let solver = Southwell::new(system, &weights).with_ambient();
    assert!(distance(&solver.preview(), &direct::solve(system)) < 1e-14);
    assert_eq!(estimated_rest(&source, &[1.0; 3], &weights), 0.0);
}

#[test]
fn divergence_and_exhaustion_are_reported() {
    let p = problem();
    let large: Vec<Rgb> = p.coefficient.iter().map(|c| *c * 40.0).collect();
    let system = System::new(&p.source, &large, &p.matrix).unwrap();
    let stop = Stop { residual: 1e-9, sweeps: 500 };
    let report = relax(&mut SuccessiveApproximation::new(system), stop, |_, _, _| true);
    assert_eq!(report.outcome, Outcome::Diverged);
    assert!(report.residuals.len() < 50);
    assert_eq!(error_bound(1.0, norm_bound(&large, &all_row_sums(&p.matrix))), None);

    let system = System::new(&p.source, &p.coefficient, &p.matrix).unwrap();
    let stop = Stop { residual: 1e-9, sweeps: 2 };
    let report = relax(&mut Jacobi::new(system), stop, |_, _, _| true);
    assert_eq!((report.outcome, report.residuals.len()), (Outcome::OutOfSweeps, 2));
    let stop = Stop { residual: 1e-9, sweeps: 500 };
    let report = relax(&mut Jacobi::new(system), stop, |sweep, _, _| sweep < 4);
    assert_eq!((report.outcome, report.residuals.len()), (Outcome::Interrupted, 4));
}

#[test]
fn a_residual_below_rounding_is_a_stall_and_no_divergence() {
    let p = problem();
    let system = System::new(&p.source, &p.coefficient, &p.matrix).unwrap();
    let weights = vec![1.0; N];
    for (name, mut solver) in solvers(system, &weights) {
        let report = relax(&mut *solver, Stop { residual: 1e-20, sweeps: 3000 }, |_, _, _| true);
        assert_ne!(report.outcome, Outcome::Diverged, "{name}: {report:?}");
        // 100 is the size of the solution.
        assert!(report.residual < 1e-11, "{name}: {}", report.residual);
    }
}

#[test]
fn southwell_carries_what_the_unknowns_have_gathered() {
    let p = problem();
    let system = System::new(&p.source, &p.coefficient, &p.matrix).unwrap();
    let weights = vec![1.0; N];
    let mut solver = Southwell::new(system, &weights);
    for _ in 0..300 {
        solver.sweep();
    }
    let mut image = vec![Spectrum([0.0; 3]); N];
    p.matrix.apply(&solver.solution(), &mut image);
    assert!(distance(&image, &solver.gathered()) < 1e-10);
}

#[test]
fn parts_that_do_not_fit_are_refused() {
    let p = problem();
    assert!(matches!(System::new(&p.source[1..], &p.coefficient, &p.matrix), Err(SystemError::Sizes { .. })));
    let mut source = p.source.clone();
    source[5].0[1] = f64::NAN;
    let told = System::new(&source, &p.coefficient, &p.matrix).unwrap_err();
    assert_eq!(told, SystemError::NotFinite { what: "source", index: 5 });
}

// φ(x) = f(x) + ∫₀¹ (x+1)/2 e^{−xy} φ(y) dy with φ(x) = e^{−x}.
fn kernel(x: &f64, y: &f64) -> f64 {
    (x + 1.0) * (-x * y).exp() / 2.0
}
fn source(x: f64) -> f64 {
    (-x).exp() - 0.5 + (-(x + 1.0)).exp() / 2.0
}

/// The largest error at the nodes.
fn error(coupling: &impl Coupling, nodes: &[f64]) -> f64 {
    let matrix = Dense::<f64>::assemble(coupling, |_| ()).unwrap();
    let (f, rho): (Vec<f64>, Vec<f64>) = nodes.iter().map(|&x| (source(x), 1.0)).unzip();
    let u = direct::solve(System::new(&f, &rho, &matrix).unwrap());
    u.iter().zip(nodes).map(|(u, x)| (u - (-x).exp()).abs()).fold(0.0, f64::max)
}

#[test]
fn nystrom_reaches_rounding_and_interpolates_through_its_nodes() {
    let nystrom = Nystrom::new(kernel, gauss_legendre(10, 0.0, 1.0));
    let nodes = nystrom.nodes().to_vec();
    assert!(error(&nystrom, &nodes) < 1e-14);
    assert!(
        error(
            &Nystrom::new(kernel, gauss_legendre(3, 0.0, 1.0)),
            gauss_legendre(3, 0.0, 1.0).nodes.as_slice()
        ) > 1e-8
    );
    let u: Vec<f64> = nodes.iter().map(|x| (-x).exp()).collect();
    for x in [0.0, 0.123, 0.5, 1.0, nodes[3]] {
        assert!((source(x) + nystrom.apply_at(&x, &u) - (-x).exp()).abs() < 1e-14, "at {x}");
    }
}

#[test]
fn p0_converges_with_order_two_at_its_nodes() {
    let nodes = |n: usize| -> Vec<f64> {
        Space::on_interval(0.0, 1.0, n, 4).elements.iter().map(|e| e.node).collect()
    };
    let collocation = |n| error(&Collocation::new(kernel, Space::on_interval(0.0, 1.0, n, 4)), &nodes(n));
    let galerkin = |n| error(&Galerkin::new(kernel, Space::on_interval(0.0, 1.0, n, 4)), &nodes(n));
    for (name, errors) in
        [("collocation", [collocation(20), collocation(40)]), ("galerkin", [galerkin(20), galerkin(40)])]
    {
        let rate = (errors[0] / errors[1]).log2();
        assert!((1.9..2.1).contains(&rate), "{name}: rate {rate}, errors {errors:?}");
    }
}

#[test]
fn galerkin_is_the_mean_of_collocation_over_the_test_element() {
    let space = Space::on_interval(0.0, 1.0, 6, 5);
    let galerkin = Galerkin::new(kernel, space.clone());
    let mean =
        space.elements[2].quadrature.integrate(|x| space.elements[4].quadrature.integrate(|y| kernel(x, y)));
    assert!((galerkin.entry(2, 4) - 6.0 * mean).abs() < 1e-15);
}

#[test]
fn a_relaxation_needs_only_what_it_asks_for() {
    // Southwell on an operator that is not stored: columns are computed when shot.
    let p = problem();
    let on_the_fly = OnTheFly(Lopsided(N));
    let ones = vec![1.0; N];
    let system = System::new(&p.source, &p.coefficient, &on_the_fly).unwrap();
    let mut southwell = Southwell::new(system, &ones);
    relax(&mut southwell, Stop { residual: 1e-10, sweeps: 100_000 }, |_, _, _| true);
    let exact = direct::solve(System::new(&p.source, &p.coefficient, &p.matrix).unwrap());
    assert!(distance(&southwell.solution(), &exact) < 1e-8);
    assert_eq!(on_the_fly.dim(), on_the_fly.row(0, &mut Vec::new()).iter().count());
}
