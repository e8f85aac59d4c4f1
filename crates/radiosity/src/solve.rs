//! Room 6: B = E + ρ ⊙ (F B), gathered or shot. A page: every algorithm here is the general theory's.

use crate::closure::Closure;
use crate::form_factor::{FormFactors, point_to_point};
use crate::patches::Patches;
use crate::visibility::Visibility;
use fredholm::direct;
use fredholm::discretize::Coupling;
use fredholm::krylov::Gmres;
use fredholm::operator::{Columns, Dense, NotFinite, OnTheFly, Rows};
use fredholm::relax::{
    GaussSeidel, Jacobi, Outcome, Relaxation, Report, Southwell, Stop, SuccessiveApproximation, relax,
};
use fredholm::system::{System, SystemError, error_bound, norm_bound};
use fredholm::value::{Value, max_norm};
use rayon::prelude::*;
use std::time::Instant;

/// How the equation becomes numbers: what F_ij is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Point to point.
    Nystrom,
    /// Point to patch.
    Collocation,
    /// Patch to patch.
    Galerkin,
}

/// How the numbers are solved for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Solver {
    /// Classical radiosity: gathering along rows.
    GaussSeidel,
    /// Progressive radiosity: shooting along columns that are computed when shot and not stored.
    Southwell,
    /// All patches at once.
    Jacobi,
    /// Successive approximations: each iteration is one bounce of light.
    Successive,
    /// The Krylov method.
    Gmres,
    /// LU factorisation: the oracle.
    Direct,
}

/// What to solve, and how well.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// The discretisation.
    pub method: Method,
    /// The solver.
    pub solver: Solver,
    /// The standard error that a row sum Σ_j F_ij may have from sampled visibility.
    pub accuracy: f64,
    /// The residual to reach, ‖r‖∞ relative to ‖E‖∞.
    pub tolerance: f64,
    /// The most iterations.
    pub iterations: usize,
    /// Whether previews of the progressive method have the ambient estimate.
    pub ambient: bool,
    /// The most bytes that a stored matrix may take.
    pub memory: u64,
}

impl Default for Options {
    /// Galerkin by Gauss–Seidel: row sums to 10⁻³, a residual of 10⁻⁶ of the brightest emission, 8 GiB.
    fn default() -> Self {
        Self {
            method: Method::Galerkin,
            solver: Solver::GaussSeidel,
            accuracy: 1e-3,
            tolerance: 1e-6,
            iterations: 1000,
            ambient: false,
            memory: 8 << 30,
        }
    }
}

/// Why there is no solution.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SolveError {
    /// The matrix would not fit.
    #[error(
        "{patches} patches make a matrix of {} MB, and {} MB are free: take larger patches, or the southwell solver, which stores none",
        needed >> 20, available >> 20
    )]
    Memory {
        /// The number of patches.
        patches: usize,
        /// Bytes of the matrix.
        needed: u64,
        /// Bytes that it may take.
        available: u64,
    },
    /// A form factor is not finite.
    #[error("{0}; do two patches lie in one place? The galerkin and collocation methods do not sample there")]
    FormFactor(#[from] NotFinite),
    /// Emission or reflectance is not finite.
    #[error(transparent)]
    System(#[from] SystemError),
    /// The iteration does not converge.
    #[error(
        "the iteration diverges (residual {residual:.3e} W/m² after {iterations} iterations): ρF has a spectral radius over 1"
    )]
    Diverged {
        /// Iterations made.
        iterations: usize,
        /// The last residual.
        residual: f64,
    },
}

/// Told how the work goes on.
pub trait Observer<V: Value>: Sync {
    /// `entries` more form factors are computed; called from any thread.
    fn assembled(&self, entries: usize);

    /// One more iteration is done: its number, the residual's norm and the norm to reach. Says whether to go on.
    fn relaxed(&mut self, iteration: usize, norm: f64, target: f64, relaxation: &dyn Relaxation<V>) -> bool;
}

/// An observer that does not care.
#[derive(Clone, Copy, Debug)]
pub struct Unobserved;

impl<V: Value> Observer<V> for Unobserved {
    fn assembled(&self, _: usize) {}
    fn relaxed(&mut self, _: usize, _: f64, _: f64, _: &dyn Relaxation<V>) -> bool {
        true
    }
}

/// The radiosity of each patch, and how well it is known.
#[derive(Clone, Debug)]
pub struct Solution<V> {
    /// B = E + ρ ⊙ (F u) for the solver's last u, W/m²: the residual is added to u, as the progressive method does.
    pub radiosity: Vec<V>,
    /// H = F u, the irradiance of each patch, W/m².
    pub irradiance: Vec<V>,
    /// How the relaxation went.
    pub report: Report,
    /// ‖ρF‖∞.
    pub norm: f64,
    /// Bound of the algebraic error max |B − B̃|, W/m², over patches and channels; `None` when ‖ρF‖∞ ≥ 1.
    pub error_bound: Option<f64>,
    /// The closure test.
    pub closure: Closure,
    /// Form factors computed.
    pub form_factors: u64,
    /// Rays cast for them.
    pub rays: u64,
    /// Seconds to compute the form factors that are stored.
    pub assembly_seconds: f64,
    /// Seconds to solve.
    pub solve_seconds: f64,
}

/// Solves the radiosity equation on the patches.
pub fn solve<V: Value>(
    patches: &Patches<V>,
    visibility: &Visibility,
    options: &Options,
    observer: &mut dyn Observer<V>,
) -> Result<Solution<V>, SolveError> {
    let accuracy = options.accuracy;
    let run = Run { patches, visibility, options };
    match options.method {
        Method::Nystrom => {
            let coupling = point_to_point(patches, visibility);
            run.keep(&coupling, &|| coupling.kernel().rays.total(), observer)
        }
        Method::Collocation => {
            let coupling = FormFactors::point_to_patch(patches, visibility, accuracy);
            run.keep(&coupling, &|| coupling.rays(), observer)
        }
        Method::Galerkin => {
            let coupling = FormFactors::patch_to_patch(patches, visibility, accuracy);
            run.keep(&coupling, &|| coupling.rays(), observer)
        }
    }
}

struct Run<'a, V> {
    patches: &'a Patches<V>,
    visibility: &'a Visibility,
    options: &'a Options,
}

impl<V: Value> Run<'_, V> {
    /// Decides how F is kept, and solves.
    fn keep(
        &self,
        coupling: &impl Coupling,
        rays: &dyn Fn() -> u64,
        observer: &mut dyn Observer<V>,
    ) -> Result<Solution<V>, SolveError> {
        let n = coupling.dim();
        let start = Instant::now();
        if self.options.solver == Solver::Southwell {
            let operator = OnTheFly(coupling);
            let checked = match self.options.method {
                // Factors between points may add up to anything: the bound needs every row.
                Method::Nystrom => (0..n).collect(),
                // Exact factors add up to 1 at most, and these do to their accuracy, which some rows show.
                _ => spread(n, 64),
            };
            let solution = self.shoot(&operator, &checked, observer)?;
            let columns = solution.report.residuals.len() + checked.len();
            return Ok(Solution { form_factors: (columns * n) as u64, rays: rays(), ..solution });
        }
        let needed = (n as u64).pow(2) * size_of::<f32>() as u64;
        if needed > self.options.memory {
            return Err(SolveError::Memory { patches: n, needed, available: self.options.memory });
        }
        let half = if coupling.reciprocity().is_some() { n * (n + 1) / 2 } else { n * n };
        let matrix = Dense::<f32>::assemble(coupling, |entries| observer.assembled(entries))?;
        let assembly_seconds = start.elapsed().as_secs_f64();
        let all: Vec<usize> = (0..n).collect();
        let solution = self.gather(&matrix, &all, observer)?;
        Ok(Solution { form_factors: half as u64, rays: rays(), assembly_seconds, ..solution })
    }

    /// Solves with the columns of F.
    fn shoot<F: Rows + Columns>(
        &self,
        operator: &F,
        checked: &[usize],
        observer: &mut dyn Observer<V>,
    ) -> Result<Solution<V>, SolveError> {
        let system = System::new(&self.patches.emission, &self.patches.reflectance, operator)?;
        let southwell = Southwell::new(system, &self.patches.areas);
        let mut southwell = if self.options.ambient { southwell.with_ambient() } else { southwell };
        self.relax(system, &mut southwell, checked, observer)
    }

    /// Solves with the rows of F, or its action.
    fn gather<F: Rows>(
        &self,
        operator: &F,
        checked: &[usize],
        observer: &mut dyn Observer<V>,
    ) -> Result<Solution<V>, SolveError> {
        let system = System::new(&self.patches.emission, &self.patches.reflectance, operator)?;
        let mut relaxation: Box<dyn Relaxation<V> + '_> = match self.options.solver {
            Solver::Jacobi => Box::new(Jacobi::new(system)),
            Solver::Successive => Box::new(SuccessiveApproximation::new(system)),
            Solver::Gmres => Box::new(Gmres::new(system)),
            Solver::Direct => Box::new(Solved::new(system)),
            Solver::GaussSeidel | Solver::Southwell => Box::new(GaussSeidel::new(system)),
        };
        self.relax(system, &mut *relaxation, checked, observer)
    }

    fn relax<F: Rows>(
        &self,
        system: System<'_, V, F>,
        relaxation: &mut dyn Relaxation<V>,
        checked: &[usize],
        observer: &mut dyn Observer<V>,
    ) -> Result<Solution<V>, SolveError> {
        let start = Instant::now();
        let target = self.options.tolerance * max_norm(system.source);
        let stop = Stop { residual: target, sweeps: self.options.iterations };
        let report =
            relax(relaxation, stop, |k, norm, relaxation| observer.relaxed(k, norm, target, relaxation));
        if report.outcome == Outcome::Diverged {
            return Err(SolveError::Diverged {
                iterations: report.residuals.len(),
                residual: report.residual,
            });
        }
        let solution = relaxation.solution();
        let radiosity: Vec<V> =
            solution.iter().zip(relaxation.residual()).map(|(u, residual)| *u + residual).collect();
        let irradiance = irradiance(system, &solution, &radiosity);
        let sums = row_sums(system.operator, checked);
        let norm = if sums.len() == system.dim() {
            let sums: Vec<f64> = sums.iter().map(|&(_, sum)| sum).collect();
            norm_bound(system.coefficient, &sums)
        } else {
            let largest = sums.iter().fold(1.0_f64, |largest, &(_, sum)| largest.max(sum));
            max_norm(system.coefficient) * largest
        };
        Ok(Solution {
            radiosity,
            irradiance,
            error_bound: error_bound(report.residual, norm),
            report,
            norm,
            closure: Closure::test(self.patches, self.visibility, &sums),
            form_factors: 0,
            rays: 0,
            assembly_seconds: 0.0,
            solve_seconds: start.elapsed().as_secs_f64(),
        })
    }
}

/// (i, Σ_j F_ij) for some rows.
fn row_sums(operator: &impl Rows, rows: &[usize]) -> Vec<(usize, f64)> {
    let sums = rows.par_iter().map_init(Vec::new, |buffer, &i| (i, operator.row(i, buffer).abs_sum()));
    sums.collect()
}

/// `count` numbers spread evenly over 0 … n − 1; all of them when there are fewer.
fn spread(n: usize, count: usize) -> Vec<usize> {
    let count = count.min(n);
    (0..count).map(|k| (2 * k + 1) * n / (2 * count)).collect()
}

/// H = F u: (B − E)/ρ, and by a row of F where a channel of ρ is 0.
fn irradiance<V: Value, F: Rows>(system: System<'_, V, F>, u: &[V], radiosity: &[V]) -> Vec<V> {
    let black = |i: usize| system.coefficient[i].channels().contains(&0.0);
    let patches = (0..u.len()).into_par_iter().map_init(Vec::new, |buffer, i| match black(i) {
        true => system.operator.row(i, buffer).dot(u),
        false => (radiosity[i] - system.source[i]) / system.coefficient[i],
    });
    patches.collect()
}

/// The direct solver as a relaxation of one sweep.
struct Solved<'a, V, F> {
    system: System<'a, V, F>,
    solution: Vec<V>,
}

impl<'a, V: Value, F: Rows> Solved<'a, V, F> {
    fn new(system: System<'a, V, F>) -> Self {
        Self { system, solution: vec![V::splat(0.0); system.dim()] }
    }
}

impl<V: Value, F: Rows> Relaxation<V> for Solved<'_, V, F> {
    fn sweep(&mut self) -> f64 {
        self.solution = direct::solve(self.system);
        max_norm(&self.residual())
    }
    fn solution(&self) -> Vec<V> {
        self.solution.clone()
    }
    fn residual(&self) -> Vec<V> {
        self.system.residual(&self.solution)
    }
}
