//! Room 6: B = f + ρ ⊙ (F B) with f = E + ρ H of what is no surface, gathered or shot. A page: every algorithm here is the general theory's.

mod hierarchical;

pub use hierarchical::Links;

use crate::closure::Closure;
use crate::elements::{Elements, Space};
use crate::form_factor::{FormFactors, point_to_point};
use crate::hierarchical::{Hierarchical, Kept, KeptError};
use crate::kernel::Lambertian;
use crate::lights;
use crate::patches::Patches;
use crate::visibility::Visibility;
use fredholm::direct::Direct;
use fredholm::discretize::{Coupling, Nystrom};
use fredholm::krylov::Gmres;
use fredholm::operator::{Columns, Dense, NotFinite, OnTheFly, Operator, Rows};
use fredholm::quadrature::Quadrature;
use fredholm::relax::{
    GaussSeidel, Jacobi, Outcome, Relaxation, Report, Southwell, Stop, SuccessiveApproximation, relax,
};
use fredholm::system::{System, SystemError, error_bound, norm_bound, row_sums};
use fredholm::value::{Value, max_norm};
use rayon::prelude::*;
use std::io::Read;
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

/// How F is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Storage {
    /// All n² entries, in `f32`.
    Dense,
    /// None: each row or column is computed when it is asked for, and forgotten.
    OnTheFly,
    /// Links to clusters of patches, O(n) of them: [`crate::hierarchical`]. For Galerkin's method with constants on patches.
    Hierarchical,
}

/// What to solve, and how well.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// The discretisation.
    pub method: Method,
    /// The solver.
    pub solver: Solver,
    /// How F is kept.
    pub storage: Storage,
    /// The standard error that a row sum Σ_j F_ij may have from sampled visibility.
    pub accuracy: f64,
    /// The residual to reach, ‖r‖∞ relative to ‖f‖∞.
    pub tolerance: f64,
    /// The most iterations.
    pub iterations: usize,
    /// Whether previews of the progressive method have the ambient estimate.
    pub ambient: bool,
    /// The most bytes that a stored matrix may take.
    pub memory: u64,
}

impl Default for Options {
    /// Galerkin by Gauss–Seidel: row sums to 10⁻³, a residual of 10⁻⁶ of the brightest source, 8 GiB.
    fn default() -> Self {
        Self {
            method: Method::Galerkin,
            solver: Solver::GaussSeidel,
            storage: Storage::Dense,
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
        "{patches} {} make a matrix of {} MB, and {} MB are free: take larger patches, the hierarchical operator, or the southwell solver, which stores none",
        if *elements { "coefficients of patches" } else { "patches" }, needed >> 20, available >> 20
    )]
    Memory {
        /// The number of patches, or of coefficients of all of them.
        patches: usize,
        /// Whether it is the coefficients that are counted.
        elements: bool,
        /// Bytes of the matrix.
        needed: u64,
        /// Bytes that it may take.
        available: u64,
    },
    /// The links would not fit.
    #[error(
        "clusters of {patches} patches and their links take about {} MB, and {} MB are free: take larger patches, or allow a larger --factor-accuracy, up to 3e-3",
        needed >> 20, available >> 20
    )]
    Links {
        /// The number of patches.
        patches: usize,
        /// Bytes of clusters and links, about.
        needed: u64,
        /// Bytes that they may take.
        available: u64,
    },
    /// The observer said that there is no time.
    #[error("interrupted; {} of {patches} patches have their links", kept.patches())]
    Interrupted {
        /// The number of patches.
        patches: usize,
        /// The links that there are, to go on with.
        kept: Box<Kept>,
    },
    /// The links that were to be gone on with are of no use.
    #[error(transparent)]
    Kept(#[from] KeptError),
    /// Links are between patches with constant light.
    #[error(
        "the hierarchical operator is for the galerkin method with constants on patches: take the dense one, or on-the-fly"
    )]
    NoLinks,
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
    /// About so many bytes will be taken, for form factors or for those of LU, of which there are none yet.
    fn planned(&mut self, _bytes: u64) {}

    /// Links to go on with: a file of [`Kept`] ones.
    fn kept(&mut self) -> Option<Box<dyn Read>> {
        None
    }

    /// Whether to stop; asked from any thread while there are links to be found.
    fn stops(&self) -> bool {
        false
    }

    /// All links are there.
    fn linked(&mut self, _links: &Hierarchical) {}

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

/// The radiosity of each patch, or each coefficient of a space on the patches, and how well it is known.
#[derive(Clone, Debug)]
pub struct Solution<V> {
    /// B = f + ρ ⊙ (F u) for the solver's last u, W/m²: the residual is added to u, as the progressive method does.
    pub radiosity: Vec<V>,
    /// H, the irradiance of each patch: F u, and what lights that are no surfaces send. W/m².
    pub irradiance: Vec<V>,
    /// The residual that was to be reached, W/m².
    pub target: f64,
    /// How the relaxation went.
    pub report: Report,
    /// ‖ρF‖∞, from the row sums of F.
    pub norm: f64,
    /// How many row sums were computed: all for a stored matrix. From a part of them ‖ρF‖∞ is taken, not proved: the
    /// exact factors of a patch add up to 1 at most, and no row is believed to exceed the largest of 1 and those
    /// computed by more than three times the accuracy.
    pub rows: usize,
    /// Bound of the algebraic error max |B − B̃|, W/m², over patches and channels; `None` when ‖ρF‖∞ ≥ 1.
    pub error_bound: Option<f64>,
    /// The closure test.
    pub closure: Closure,
    /// Form factors computed.
    pub form_factors: u64,
    /// Rays cast for them.
    pub rays: u64,
    /// Seconds to find what lights that are no surfaces send.
    pub light_seconds: f64,
    /// Seconds to compute the form factors that are stored.
    pub assembly_seconds: f64,
    /// Seconds to solve.
    pub solve_seconds: f64,
    /// Of F as links to clusters.
    pub links: Option<Links>,
}

/// Solves the radiosity equation on the patches.
pub fn solve<V: Value>(
    patches: &Patches<V>,
    visibility: &Visibility,
    options: &Options,
    observer: &mut dyn Observer<V>,
) -> Result<Solution<V>, SolveError> {
    let accuracy = options.accuracy;
    let Patches { reflectance, areas, .. } = patches;
    let lit = &Lit::find(|| lights::mean_irradiances(patches, visibility));
    let source = &source(&patches.emission, reflectance, &lit.irradiance);
    let run = Run { patches, visibility, options, source, lit, reflectance, weights: areas, space: None };
    match options.method {
        _ if options.storage == Storage::Hierarchical => {
            if options.method == Method::Galerkin {
                run.link(observer)
            } else {
                Err(SolveError::NoLinks)
            }
        }
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

/// Solves it for the coefficients of a space on the patches: what [`Solution`] has one of for each patch, it has one of for
/// each coefficient.
///
/// Nyström's method takes the space's nodes and weights for its rule. Columns, which the southwell solver shoots, are not
/// found in blocks: it takes as many times longer as an element has coefficients.
pub fn solve_elements<V: Value>(
    space: &Space<'_>,
    patches: &Patches<V>,
    visibility: &Visibility,
    options: &Options,
    observer: &mut dyn Observer<V>,
) -> Result<Solution<V>, SolveError> {
    if options.storage == Storage::Hierarchical {
        return Err(SolveError::NoLinks);
    }
    let reflectance = &space.spread(&patches.reflectance);
    let lit = &Lit::find(|| space.interpolate(|node| lights::irradiance(&patches.lights, visibility, node)));
    let source = &source(&space.spread(&patches.emission), reflectance, &lit.irradiance);
    let weights = space.weights();
    let run = Run { patches, visibility, options, source, lit, reflectance, weights, space: Some(space) };
    let coupling = match options.method {
        Method::Nystrom => {
            let nodes = space.interpolate(|node| *node);
            let rule = Quadrature { nodes, weights: weights.to_vec() };
            let coupling = Nystrom::new(Lambertian::new(visibility), rule);
            return run.keep(&coupling, &|| coupling.kernel().rays.total(), observer);
        }
        Method::Collocation => Elements::collocation(space, patches, visibility, options.accuracy),
        Method::Galerkin => Elements::galerkin(space, patches, visibility, options.accuracy),
    };
    run.keep(&coupling, &|| coupling.rays(), observer)
}

/// f = E + ρ H, of the irradiance H from lights that are no surfaces.
pub fn source<V: Value>(emission: &[V], reflectance: &[V], lit: &[V]) -> Vec<V> {
    emission.iter().zip(reflectance).zip(lit).map(|((e, rho), h)| *e + *rho * *h).collect()
}

struct Run<'a, V> {
    patches: &'a Patches<V>,
    visibility: &'a Visibility,
    options: &'a Options,
    /// f, its H from lights that are no surfaces, ρ and the area that it stands for, of each unknown.
    source: &'a [V],
    lit: &'a Lit<V>,
    reflectance: &'a [V],
    weights: &'a [f64],
    /// Whose coefficients the unknowns are, if they are not the patches' own.
    space: Option<&'a Space<'a>>,
}

/// H from lights that are no surfaces, of each unknown, and the seconds that it took.
struct Lit<V> {
    irradiance: Vec<V>,
    seconds: f64,
}

impl<V> Lit<V> {
    fn find(irradiance: impl FnOnce() -> Vec<V>) -> Self {
        let start = Instant::now();
        Self { irradiance: irradiance(), seconds: start.elapsed().as_secs_f64() }
    }
}

impl<V: Value> Run<'_, V> {
    /// Decides how F is kept, and solves.
    fn keep(
        &self,
        coupling: &impl Coupling,
        rays: &dyn Fn() -> u64,
        observer: &mut dyn Observer<V>,
    ) -> Result<Solution<V>, SolveError> {
        let solution = match (self.options.storage, self.options.solver) {
            (Storage::OnTheFly, Solver::Southwell) => self.shoot(&OnTheFly(coupling), observer),
            (Storage::OnTheFly, _) => self.compute(&OnTheFly(coupling), observer),
            _ => self.gather(coupling, observer),
        };
        solution.map(|solution| Solution { rays: rays(), ..solution })
    }

    /// Solves with columns of F that are computed when shot and not stored.
    fn shoot<F: Rows + Columns>(
        &self,
        operator: &F,
        observer: &mut dyn Observer<V>,
    ) -> Result<Solution<V>, SolveError> {
        let start = Instant::now();
        let n = operator.dim();
        let system = System::new(self.source, self.reflectance, operator)?;
        let southwell = Southwell::new(system, self.weights);
        let mut southwell = if self.options.ambient { southwell.with_ambient() } else { southwell };
        let report = self.relax(&mut southwell, observer)?;
        // Factors between points may add up to anything, and those of polynomials have signs: the bound needs every row.
        let every = self.options.method == Method::Nystrom || self.space.is_some();
        let checked = spread(n, if every { n } else { SAMPLED_ROWS });
        let computed = ((report.residuals.len() + checked.len()) * n) as u64;
        let solution = self.judge(system, &southwell.gathered(), report, &checked);
        Ok(Solution { form_factors: computed, solve_seconds: start.elapsed().as_secs_f64(), ..solution })
    }

    /// Solves with a stored matrix.
    fn gather(
        &self,
        coupling: &impl Coupling,
        observer: &mut dyn Observer<V>,
    ) -> Result<Solution<V>, SolveError> {
        let start = Instant::now();
        let n = coupling.dim();
        observer.planned(self.check_memory(n)?);
        let matrix = Dense::<f32>::assemble(coupling, |entries| observer.assembled(entries))?;
        let assembly_seconds = start.elapsed().as_secs_f64();
        let start = Instant::now();
        let system = System::new(self.source, self.reflectance, &matrix)?;
        let mut relaxation = self.relaxation(system);
        let report = self.relax(&mut *relaxation, observer)?;
        let mut irradiance = vec![V::splat(0.0); n];
        matrix.apply(&relaxation.solution(), &mut irradiance);
        let solution = self.judge(system, &irradiance, report, &spread(n, n));
        let half = if coupling.reciprocity().is_some() { n * (n + 1) / 2 } else { n * n };
        Ok(Solution {
            form_factors: half as u64,
            assembly_seconds,
            solve_seconds: start.elapsed().as_secs_f64(),
            ..solution
        })
    }

    /// Solves with rows of F that are computed at each iteration and not stored.
    fn compute<F: Rows + Columns>(
        &self,
        operator: &F,
        observer: &mut dyn Observer<V>,
    ) -> Result<Solution<V>, SolveError> {
        let start = Instant::now();
        let n = operator.dim();
        self.plan_factors(n, observer)?;
        let system = System::new(self.source, self.reflectance, operator)?;
        let mut relaxation = self.relaxation(system);
        let report = self.relax(&mut *relaxation, observer)?;
        let mut irradiance = vec![V::splat(0.0); n];
        operator.apply(&relaxation.solution(), &mut irradiance);
        // Every iteration, the last residual, the irradiance and the row sums.
        let computed = ((report.residuals.len() + 3) * n * n) as u64;
        let solution = self.judge(system, &irradiance, report, &spread(n, n));
        Ok(Solution { form_factors: computed, solve_seconds: start.elapsed().as_secs_f64(), ..solution })
    }

    fn relaxation<'b, F: Rows + Columns>(&'b self, system: System<'b, V, F>) -> Box<dyn Relaxation<V> + 'b> {
        match self.options.solver {
            Solver::Jacobi => Box::new(Jacobi::new(system)),
            Solver::Successive => Box::new(SuccessiveApproximation::new(system)),
            Solver::Gmres => Box::new(Gmres::new(system)),
            Solver::Direct => Box::new(Direct::new(system)),
            Solver::GaussSeidel => Box::new(GaussSeidel::new(system)),
            Solver::Southwell => {
                let southwell = Southwell::new(system, self.weights);
                Box::new(if self.options.ambient { southwell.with_ambient() } else { southwell })
            }
        }
    }

    /// Tells of the factors of LU, which are a matrix however F is kept, if they fit.
    fn plan_factors(&self, n: usize, observer: &mut dyn Observer<V>) -> Result<(), SolveError> {
        if self.options.solver == Solver::Direct {
            observer.planned(self.check_memory(n)?);
        }
        Ok(())
    }

    /// The bytes that the matrix will take, and for LU the factors of as many channels as are worked on at once, if there are so many.
    fn check_memory(&self, n: usize) -> Result<u64, SolveError> {
        let at_once = V::CHANNELS.min(rayon::current_num_threads()) as u64;
        let bytes = match self.options.solver {
            Solver::Direct => 4 + 16 * at_once,
            _ => 4,
        };
        let (needed, available) = ((n as u64).pow(2) * bytes, self.options.memory);
        if needed > available {
            return Err(SolveError::Memory { patches: n, elements: self.space.is_some(), needed, available });
        }
        Ok(needed)
    }

    fn relax(
        &self,
        relaxation: &mut dyn Relaxation<V>,
        observer: &mut dyn Observer<V>,
    ) -> Result<Report, SolveError> {
        let target = self.target();
        // A second factorisation would find the same.
        let sweeps = if self.options.solver == Solver::Direct { 1 } else { self.options.iterations };
        let stop = Stop { residual: target, sweeps };
        let report =
            relax(relaxation, stop, |k, norm, relaxation| observer.relaxed(k, norm, target, relaxation));
        match report.outcome {
            Outcome::Diverged => {
                Err(SolveError::Diverged { iterations: report.residuals.len(), residual: report.residual })
            }
            _ => Ok(report),
        }
    }

    fn target(&self) -> f64 {
        self.options.tolerance * max_norm(self.source)
    }

    /// The solution from what patches receive of each other, F u, with what the row sums of F say of it.
    fn judge<F: Rows>(
        &self,
        system: System<'_, V, F>,
        received: &[V],
        report: Report,
        checked: &[usize],
    ) -> Solution<V> {
        let radiosity = source(system.source, system.coefficient, received);
        let irradiance = received.iter().zip(&self.lit.irradiance).map(|(h, lit)| *h + *lit).collect();
        let sums = row_sums(system.operator, checked);
        let norm = if sums.len() == system.dim() {
            norm_bound(system.coefficient, &sums)
        } else {
            let largest = sums.iter().fold(1.0, |a: f64, b| a.max(*b)) + 3.0 * self.options.accuracy;
            max_norm(system.coefficient) * largest
        };
        let rows = self.sums_by_patch(system.operator, checked, sums);
        Solution {
            radiosity,
            irradiance,
            target: self.target(),
            error_bound: error_bound(report.residual, norm),
            report,
            norm,
            rows: checked.len(),
            closure: Closure::test(self.patches, self.visibility, &rows),
            form_factors: 0,
            rays: 0,
            light_seconds: self.lit.seconds,
            assembly_seconds: 0.0,
            solve_seconds: 0.0,
            links: None,
        }
    }

    /// Σ_j F_ij of the rows checked, from Σ_j |F_ij|: one for each patch, the furthest from 1 of those of its coefficients.
    fn sums_by_patch<F: Rows>(
        &self,
        operator: &F,
        checked: &[usize],
        of_magnitudes: Vec<f64>,
    ) -> Vec<(usize, f64)> {
        let Some(space) = self.space else { return checked.iter().copied().zip(of_magnitudes).collect() };
        let sum =
            |buffer: &mut Vec<f64>, &i: &usize| (space.element_of(i), operator.row(i, buffer).iter().sum());
        let sums: Vec<(usize, f64)> = checked.par_iter().map_init(Vec::new, sum).collect();
        let further = |a: f64, b: f64| if (b - 1.0).abs() > (a - 1.0).abs() { b } else { a };
        let mut worst: Vec<(usize, f64)> = Vec::new();
        for (patch, sum) in sums {
            match worst.last_mut() {
                Some(last) if last.0 == patch => last.1 = further(last.1, sum),
                _ => worst.push((patch, sum)),
            }
        }
        worst
    }
}

/// Rows of F whose sums are computed where F is not stored: the cost of as many shots.
const SAMPLED_ROWS: usize = 64;

/// `count` numbers spread evenly over 0 … n − 1; all of them when there are fewer.
fn spread(n: usize, count: usize) -> Vec<usize> {
    let count = count.min(n);
    (0..count).map(|k| (2 * k + 1) * n / (2 * count)).collect()
}
