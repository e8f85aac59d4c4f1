//! The numbers of a run: what `--json` writes and the table shows.

use super::domain::Domain;
use super::memory;
use super::settings::Settings;
use super::timing::Seconds;
use crate::args::name;
use fredholm::relax::Outcome;
use fredholm::value::Value;
use radiosity::closure::Closure;
use radiosity::elements::Space;
use radiosity::patches::Patches;
use radiosity::solve::Solution;
use serde::Serialize;
use std::path::PathBuf;

/// The numbers of a run, in the order of the JSON.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// What the scene is called.
    pub scene: String,
    /// How many patches.
    pub patches: usize,
    /// The longest that their edges may be, in metres.
    pub patch_size: f64,
    /// The polynomials on each patch: `p0`, `p1` or `p2`.
    pub space: String,
    /// Their coefficients, all together: as many as patches for `p0`.
    pub unknowns: usize,
    /// The discretisation.
    pub method: String,
    /// The solver.
    pub solver: String,
    /// `converged`, `out of iterations` or `stalled at rounding`.
    pub outcome: &'static str,
    /// Iterations made.
    pub iterations: usize,
    /// ‖E + ρ ⊙ (F u) − u‖∞ of the last u.
    pub residual: f64,
    /// The residual that was asked for.
    pub target: f64,
    /// Bound of max |B − B̃|, the error that the solver left.
    pub error_bound: Option<f64>,
    /// ‖ρF‖∞, from so many row sums.
    pub norm: f64,
    /// Row sums computed: all, or for a solver that stores no matrix a sample of them.
    pub norm_rows: usize,
    /// max |Σ_j F_ij − 1| over the rows checked.
    pub closure_defect: Option<f64>,
    /// How many rows were checked.
    pub closure_rows: Option<usize>,
    /// The share of the light that meets nothing; none in a closed scene.
    pub escaping: Option<f64>,
    /// The standard error that was asked for of a row sum.
    pub accuracy: f64,
    /// Whether no light at all reaches any surface.
    pub dark: bool,
    /// Form factors computed.
    pub form_factors: u64,
    /// Rays cast for them.
    pub rays: u64,
    /// Where the time went.
    pub seconds: Seconds,
    /// The most memory used at once.
    pub peak_memory_bytes: Option<u64>,
    /// What the numbers are in.
    pub units: Units,
    /// Means over each surface.
    pub surfaces: Vec<Surface>,
    /// The files written.
    pub files: Vec<PathBuf>,
}

/// The units of a report.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Units {
    length: &'static str,
    area: &'static str,
    radiosity: &'static str,
    irradiance: &'static str,
    emission: &'static str,
    residual: &'static str,
    error_bound: &'static str,
}

const UNITS: Units = Units {
    length: "m",
    area: "m²",
    radiosity: "W/m²",
    irradiance: "W/m²",
    emission: "W/m²",
    residual: "W/m²",
    error_bound: "W/m²",
};

/// A surface of the scene: means over its whole area, by channel.
#[derive(Clone, Debug, Serialize)]
pub struct Surface {
    name: String,
    area: f64,
    mean_radiosity: Vec<f64>,
    mean_irradiance: Vec<f64>,
    emission: Vec<f64>,
}

impl Report {
    /// The numbers of a solved scene.
    pub fn new<V: Value>(
        domain: &Domain<'_, V>,
        settings: &Settings,
        space: Option<&Space<'_>>,
        solution: &Solution<V>,
        seconds: Seconds,
        files: Vec<PathBuf>,
    ) -> Self {
        let unknowns = space.map_or(domain.patches.len(), Space::dim);
        let options = settings.options(unknowns);
        let brightest = fredholm::value::max_norm(&domain.patches.emission);
        let (closure_defect, closure_rows, escaping) = match solution.closure {
            Closure::Open { escaping } => (None, None, Some(escaping)),
            Closure::Closed { rows: 0, .. } => (None, Some(0), None),
            Closure::Closed { defect, rows } => (Some(defect), Some(rows), None),
        };
        Self {
            scene: domain.scene.name.clone(),
            patches: domain.patches.len(),
            patch_size: settings.size(domain.scene),
            space: name(&settings.space),
            unknowns,
            method: name(&settings.method),
            solver: name(&settings.solver),
            outcome: match solution.report.outcome {
                Outcome::Converged => "converged",
                Outcome::Stalled => "stalled at rounding",
                Outcome::OutOfSweeps | Outcome::Diverged | Outcome::Interrupted => "out of iterations",
            },
            iterations: solution.report.residuals.len(),
            residual: solution.report.residual,
            target: options.tolerance * brightest,
            error_bound: solution.error_bound,
            norm: solution.norm,
            norm_rows: solution.rows,
            closure_defect,
            closure_rows,
            escaping,
            accuracy: options.accuracy,
            dark: solution.irradiance.iter().all(|h| h.magnitude() == 0.0),
            form_factors: solution.form_factors,
            rays: solution.rays,
            seconds,
            peak_memory_bytes: memory::peak(),
            units: UNITS,
            surfaces: surfaces(domain, solution),
            files,
        }
    }
}

fn surfaces<V: Value>(domain: &Domain<'_, V>, solution: &Solution<V>) -> Vec<Surface> {
    let radiosity = totals(domain, &solution.radiosity);
    let irradiance = totals(domain, &solution.irradiance);
    let means = radiosity.into_iter().zip(irradiance).zip(&domain.scene.surfaces);
    means
        .map(|((radiosity, irradiance), surface)| {
            let area = surface.area();
            let mean = |total: V| (total * (1.0 / area)).channels().to_vec();
            Surface {
                name: surface.name.clone(),
                area,
                mean_radiosity: mean(radiosity),
                mean_irradiance: mean(irradiance),
                emission: surface.emission.channels().to_vec(),
            }
        })
        .collect()
}

/// ∫ over each surface of what is constant on each patch.
fn totals<V: Value>(domain: &Domain<'_, V>, values: &[V]) -> Vec<V> {
    let mut totals = vec![V::splat(0.0); domain.scene.surfaces.len()];
    let Patches { areas, surface, .. } = &domain.patches;
    for ((value, area), &surface) in values.iter().zip(areas).zip(surface) {
        totals[surface as usize] += *value * *area;
    }
    totals
}
