//! The numbers of a thermal run: what `--json` writes and the table shows.

use super::super::timing::Seconds;
use fredholm::operator::Rows;
use radiosity::thermal::{Answer, Condition, Exchange, SurfaceHeat};
use serde::Serialize;
use std::path::PathBuf;

/// What was solved.
pub struct Given<'a, F> {
    /// The name of the scene.
    pub name: &'a str,
    /// Who exchanged heat with whom.
    pub exchange: &'a Exchange<'a, F>,
    /// The patches, if there is a mesh.
    pub mesh: Option<Scene>,
    /// max |Σ_j F_ij − 1| of what is closed.
    pub closed: Option<f64>,
    /// Where the time went.
    pub seconds: Seconds,
    /// The files written.
    pub files: Vec<PathBuf>,
}

/// How a scene was cut into patches.
#[derive(Clone, Debug, Serialize)]
pub struct Scene {
    /// How many.
    pub patches: usize,
    /// The longest that their edges may be, in m.
    pub patch_size: f64,
    /// The standard error that was asked for of a row sum.
    pub accuracy: f64,
    /// The share of the sight lines that meet nothing; none in a closed scene.
    pub escaping: Option<f64>,
    /// Rays cast for the form factors.
    pub rays: u64,
}

/// The numbers of a run, in the order of the JSON.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// What the scene is called.
    pub scene: String,
    /// `thermal`.
    pub mode: &'static str,
    /// The wavelengths between bands; none where surfaces are grey.
    pub bands: Vec<f64>,
    /// In words.
    #[serde(skip)]
    pub bands_in_words: String,
    /// The temperature of the surroundings.
    pub surroundings: f64,
    /// The patches, if there is a mesh.
    pub mesh: Option<Scene>,
    /// max |Σ_j F_ij − 1| of what is closed; none of what is open.
    pub closure_defect: Option<f64>,
    /// `converged` or `out of iterations`.
    pub outcome: &'static str,
    /// Steps of Newton's method.
    pub steps: usize,
    /// max |ε e(T) + (1 − ε) H − B|.
    pub residual: f64,
    /// max B.
    pub largest_radiosity: f64,
    /// Σ Q of all surfaces.
    pub total_heat: f64,
    /// What of it goes to the surroundings.
    pub heat_to_surroundings: f64,
    /// By how much the two differ.
    pub balance_defect: f64,
    /// ½ Σ |Q|.
    pub heat_exchanged: f64,
    /// What the numbers are in.
    pub units: Units,
    /// Each surface.
    pub surfaces: Vec<Surface>,
    /// Where the time went.
    pub seconds: Seconds,
    /// The files written.
    pub files: Vec<PathBuf>,
}

/// The units of a report.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Units {
    bands: &'static str,
    area: &'static str,
    patch_size: &'static str,
    emissivity: &'static str,
    temperature: &'static str,
    surroundings: &'static str,
    radiosity: &'static str,
    irradiance: &'static str,
    heat_flux: &'static str,
    residual: &'static str,
    heat: &'static str,
    balance_defect: &'static str,
}

const UNITS: Units = Units {
    bands: "µm",
    area: "m²",
    patch_size: "m",
    emissivity: "1",
    temperature: "K",
    surroundings: "K",
    radiosity: "W/m²",
    irradiance: "W/m²",
    heat_flux: "W/m²",
    residual: "W/m²",
    heat: "W",
    balance_defect: "W",
};

/// A surface: means over its area.
#[derive(Clone, Debug, Serialize)]
pub struct Surface {
    /// Its name.
    pub name: String,
    /// Its area.
    pub area: f64,
    /// ε of each band.
    pub emissivity: Vec<f64>,
    /// What was given: `temperature`, `heat flux` or `linked`.
    pub given: &'static str,
    /// The body that it belongs to.
    pub linked: Option<String>,
    /// The temperature of the mean σT⁴.
    pub temperature: Option<f64>,
    /// The lowest of its patches.
    pub lowest_temperature: Option<f64>,
    /// The highest.
    pub highest_temperature: Option<f64>,
    /// B.
    pub radiosity: f64,
    /// H.
    pub irradiance: f64,
    /// q = B − H, out of the surface.
    pub heat_flux: f64,
    /// Q.
    pub heat: f64,
    /// Bounds of the errors of the numbers above, as answers of the discrete equation.
    pub error_bounds: Option<Errors>,
}

/// How far the numbers of a surface can be off.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Errors {
    /// Of the temperature.
    pub temperature: Option<f64>,
    /// Of B.
    pub radiosity: f64,
    /// Of H.
    pub irradiance: f64,
    /// Of q.
    pub heat_flux: f64,
    /// Of Q.
    pub heat: f64,
}

impl Report {
    /// The numbers of an answer.
    pub fn new<F: Rows>(given: &Given<'_, F>, answer: &Answer) -> Self {
        let Given { exchange, .. } = given;
        let heats = answer.by_surface(exchange);
        Self {
            scene: given.name.to_owned(),
            mode: "thermal",
            bands: exchange.bands.limits().to_vec(),
            bands_in_words: super::bands(exchange.bands),
            surroundings: exchange.surroundings,
            mesh: given.mesh.clone(),
            closure_defect: given.closed,
            outcome: if answer.converged { "converged" } else { "out of iterations" },
            steps: answer.steps,
            residual: answer.residual,
            largest_radiosity: answer.largest,
            total_heat: answer.balance.heat,
            heat_to_surroundings: answer.balance.to_surroundings,
            balance_defect: answer.balance.defect(),
            heat_exchanged: answer.balance.exchanged,
            units: UNITS,
            surfaces: exchange
                .surfaces
                .iter()
                .zip(&heats)
                .map(|(surface, heat)| row(surface, heat))
                .collect(),
            seconds: given.seconds,
            files: given.files.clone(),
        }
    }
}

fn row(surface: &radiosity::thermal::Surface, heat: &SurfaceHeat) -> Surface {
    let (given, linked) = match &surface.condition {
        Condition::Temperature(_) => ("temperature", None),
        Condition::HeatFlux(_) => ("heat flux", None),
        Condition::Linked { body, .. } => ("linked", Some(body.clone())),
    };
    let errors = heat.error.zip(heat.heat_error).map(|(error, heat)| Errors {
        temperature: error.temperature,
        radiosity: error.radiosity,
        irradiance: error.irradiance,
        heat_flux: error.heat_flux,
        heat,
    });
    Surface {
        name: surface.name.clone(),
        area: heat.area,
        emissivity: surface.emissivity.clone(),
        given,
        linked,
        temperature: heat.mean.temperature,
        lowest_temperature: heat.temperatures.map(|(lowest, _)| lowest),
        highest_temperature: heat.temperatures.map(|(_, highest)| highest),
        radiosity: heat.mean.radiosity,
        irradiance: heat.mean.irradiance,
        heat_flux: heat.mean.heat_flux,
        heat: heat.heat,
        error_bounds: errors,
    }
}
