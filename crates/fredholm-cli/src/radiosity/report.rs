//! The numbers of a run: what `--json` writes and the table shows.

use super::domain::Domain;
use super::lights::Lights;
use super::settings::Settings;
use super::timing::Seconds;
use crate::args::name;
use fredholm::memory;
use fredholm::relax::Outcome;
use fredholm::value::Value;
use radiosity::closure::Closure;
use radiosity::elements::Space;
use radiosity::patches::Patches;
use radiosity::scene::{CleanUp, Scene, Units};
use radiosity::solve::Solution;
use serde::Serialize;
use std::f64::consts::PI;
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
    /// How form factors are kept.
    pub operator: String,
    /// Of form factors that are links to clusters.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub links: Option<Links>,
    /// `converged`, `out of iterations` or `stalled at rounding`.
    pub outcome: &'static str,
    /// Iterations made.
    pub iterations: usize,
    /// ‖f + ρ ⊙ (F u) − u‖∞ of the last u.
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
    /// The share of the light that meets nothing, or the sky; none in a closed scene.
    pub escaping: Option<f64>,
    /// The standard error that was asked for of a row sum.
    pub accuracy: f64,
    /// Whether no light at all reaches any surface.
    pub dark: bool,
    /// What shines beside the surfaces.
    #[serde(flatten)]
    pub lights: Lights,
    /// How many polygons are drawn with the normals of a curved surface; the light on them is solved as if they were flat.
    pub smooth_normals: usize,
    /// What the readers did to the mesh.
    pub clean_up: CleanUp,
    /// Form factors computed.
    pub form_factors: u64,
    /// Rays cast for them.
    pub rays: u64,
    /// Where the time went.
    pub seconds: Seconds,
    /// The most memory used at once.
    pub peak_memory_bytes: Option<u64>,
    /// What the numbers are in.
    pub units: Named,
    /// Means over each surface.
    pub surfaces: Vec<Surface>,
    /// The files written.
    pub files: Vec<PathBuf>,
}

/// Links to clusters, and the error of the light that they bring: in the mean square over all surfaces, relative to all that these
/// send.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Links {
    /// Links from a patch to a cluster.
    pub links: u64,
    /// Clusters, single patches among them.
    pub clusters: usize,
    /// What they take.
    pub bytes: u64,
    /// What they were expected to take.
    pub planned_bytes: u64,
    /// In all.
    pub error: f64,
    /// Of the patches, on each of which light is taken to be constant.
    pub discretisation_error: f64,
    /// Of the links: clusters, form factors, visibility; and of the iteration.
    pub link_error: f64,
    /// The part of what surfaces send that they reflect: the errors divided by it are relative to that.
    pub reflected: f64,
}

impl From<radiosity::solve::Links> for Links {
    fn from(links: radiosity::solve::Links) -> Self {
        let radiosity::solve::Links { statistics, planned_bytes, judged } = links;
        Self {
            links: statistics.links,
            clusters: statistics.clusters,
            bytes: statistics.bytes,
            planned_bytes,
            error: judged.error,
            discretisation_error: judged.patches,
            link_error: judged.links,
            reflected: judged.reflected,
        }
    }
}

/// The units of a report.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Named {
    length: &'static str,
    area: &'static str,
    /// Of B.
    pub radiosity: &'static str,
    irradiance: &'static str,
    emission: &'static str,
    residual: &'static str,
    error_bound: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    luminance: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    illuminance: Option<&'static str>,
}

impl Named {
    /// Of light.
    pub fn new(units: Units) -> Self {
        let (exitance, irradiance) = (units.exitance(), units.irradiance());
        Self {
            length: "m",
            area: "m²",
            radiosity: exitance,
            irradiance,
            emission: exitance,
            residual: exitance,
            error_bound: exitance,
            luminance: (units == Units::Photometric).then(|| units.radiance()),
            illuminance: (units == Units::Photometric).then_some(irradiance),
        }
    }
}

/// A surface of the scene: means over its whole area, by channel.
#[derive(Clone, Debug, Serialize)]
pub struct Surface {
    /// Its name.
    pub name: String,
    /// In m².
    pub area: f64,
    mean_radiosity: Vec<f64>,
    mean_irradiance: Vec<f64>,
    emission: Vec<f64>,
    /// H, as a number in lx.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mean_illuminance: Option<f64>,
    /// B/π, as a number in cd/m².
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mean_luminance: Option<f64>,
}

impl Surface {
    /// Whether no light reaches it.
    pub fn is_dark(&self) -> bool {
        self.mean_irradiance.iter().all(|h| *h == 0.0)
    }
}

impl Report {
    /// The numbers of a solved scene.
    pub fn new<V: Value>(
        domain: &Domain<'_, V>,
        (settings, units): (&Settings, Units),
        space: Option<&Space<'_>>,
        solution: &Solution<V>,
        seconds: Seconds,
        files: Vec<PathBuf>,
    ) -> Self {
        let unknowns = space.map_or(domain.patches.len(), Space::dim);
        let options = settings.options(unknowns);
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
            operator: name(&settings.operator),
            links: solution.links.map(Links::from),
            outcome: match solution.report.outcome {
                Outcome::Converged => "converged",
                Outcome::Stalled => "stalled at rounding",
                Outcome::OutOfSweeps | Outcome::Diverged | Outcome::Interrupted => "out of iterations",
            },
            iterations: solution.report.residuals.len(),
            residual: solution.report.residual,
            target: solution.target,
            error_bound: solution.error_bound,
            norm: solution.norm,
            norm_rows: solution.rows,
            closure_defect,
            closure_rows,
            escaping,
            accuracy: options.accuracy,
            dark: solution.irradiance.iter().all(|h| h.magnitude() == 0.0),
            lights: Lights::new(domain.scene, units),
            smooth_normals: domain.scene.curved_polygons(),
            clean_up: CleanUp::default(),
            form_factors: solution.form_factors,
            rays: solution.rays,
            seconds,
            peak_memory_bytes: memory::peak(),
            units: Named::new(units),
            surfaces: surfaces(
                domain.scene,
                &domain.patches,
                units,
                (&solution.radiosity, &solution.irradiance),
            ),
            files,
        }
    }
}

/// The means over each surface of radiosities and irradiances of patches.
pub fn surfaces<V: Value>(
    scene: &Scene<V>,
    patches: &Patches<V>,
    units: Units,
    (radiosity, irradiance): (&[V], &[V]),
) -> Vec<Surface> {
    let is_seen = units == Units::Photometric;
    let radiosity = totals(scene, patches, radiosity);
    let irradiance = totals(scene, patches, irradiance);
    let means = radiosity.into_iter().zip(irradiance).zip(&scene.surfaces);
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
                mean_illuminance: is_seen.then(|| irradiance.channels()[0] / area),
                mean_luminance: is_seen.then(|| radiosity.channels()[0] / area / PI),
            }
        })
        .collect()
}

/// ∫ over each surface of what is constant on each patch.
fn totals<V: Value>(scene: &Scene<V>, patches: &Patches<V>, values: &[V]) -> Vec<V> {
    let mut totals = vec![V::splat(0.0); scene.surfaces.len()];
    let Patches { areas, surface, .. } = patches;
    for ((value, area), &surface) in values.iter().zip(areas).zip(surface) {
        totals[surface as usize] += *value * *area;
    }
    totals
}
