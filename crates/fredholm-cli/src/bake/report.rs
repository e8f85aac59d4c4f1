//! The numbers of a baked scene: what `--json` writes and the table shows.

use super::laid::Laid;
use crate::radiosity::lights::Lights;
use crate::radiosity::table::{grouped, last, of_mesh};
use crate::radiosity::timing::Seconds;
use crate::text::{self, percent};
use fredholm::memory;
use fredholm::value::Value;
use radiosity::adaptive::Bound;
use radiosity::scene::{CleanUp, Scene, Units};
use serde::Serialize;
use std::path::PathBuf;

/// The numbers of a run, in the order of the JSON. Errors are relative: of the mean square over all surfaces, to that of the
/// light that they reflect.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    scene: String,
    /// `met`, or `not met`.
    outcome: &'static str,
    accuracy: f64,
    error: f64,
    discretisation_error: f64,
    form_factor_error: f64,
    iteration_error: f64,
    /// A texture, or vertices.
    #[serde(flatten)]
    laid: Laid,
    polygons: usize,
    /// What shines beside the surfaces.
    #[serde(flatten)]
    lights: Lights,
    /// Polygons that are lit about the normals of a curved surface.
    smooth_normals: usize,
    /// What the readers did to the mesh.
    pub clean_up: CleanUp,
    /// Whether no light at all reaches any surface.
    pub dark: bool,
    radiance_unit: &'static str,
    irradiance_unit: &'static str,
    seconds: Seconds,
    peak_memory_bytes: Option<u64>,
    files: Vec<PathBuf>,
}

impl Report {
    /// The numbers of a scene whose light is laid on something.
    pub fn new<V: Value>(
        scene: &Scene<V>,
        accuracy: f64,
        bound: Bound,
        laid: Laid,
        units: Units,
        seconds: Seconds,
        files: Vec<PathBuf>,
    ) -> Self {
        let error = bound.total();
        Self {
            scene: scene.name.clone(),
            outcome: if error <= accuracy && laid.error() <= accuracy { "met" } else { "not met" },
            accuracy,
            error,
            discretisation_error: bound.discretisation,
            form_factor_error: bound.form_factors,
            iteration_error: bound.iteration,
            laid,
            polygons: scene.surfaces.iter().map(|surface| surface.polygons.len()).sum(),
            lights: Lights::new(scene, units),
            smooth_normals: scene.curved_polygons(),
            clean_up: CleanUp::default(),
            dark: false,
            radiance_unit: units.radiance(),
            irradiance_unit: units.irradiance(),
            seconds,
            peak_memory_bytes: memory::peak(),
            files,
        }
    }

    /// Whether the light is as good as was asked.
    pub fn is_met(&self) -> bool {
        self.outcome == "met"
    }

    /// The table, a line per matter.
    pub fn table(&self) -> String {
        let not_met = |error: f64, why: &str| match error <= self.accuracy {
            true => String::new(),
            false => format!("; NOT MET: {why}"),
        };
        let mut lines = vec![(
            "error",
            format!(
                "{} of the light that surfaces reflect, in the mean square{}",
                percent(self.error),
                not_met(self.error, "no more patches fit")
            ),
        )];
        match self.laid {
            Laid::Texture { size, texel } => lines.extend([
                (
                    "atlas",
                    format!(
                        "{size} × {size} texels of {} m, {} polygons",
                        text::short(round(texel)),
                        self.polygons
                    ),
                ),
                ("texture", format!("radiance B/π, in {}", self.radiance_unit)),
            ]),
            Laid::VertexColours { vertices, triangles, vertex_error } => lines.extend([
                (
                    "mesh",
                    format!(
                        "{} vertices, {} triangles; linear between vertices is {} off{}",
                        grouped(vertices as u64),
                        grouped(triangles as u64),
                        percent(vertex_error),
                        not_met(vertex_error, "no more triangles fit")
                    ),
                ),
                (
                    "colours",
                    format!("radiance B/π, in {} by the materials' radiance_of_1", self.radiance_unit),
                ),
            ]),
        }
        lines.splice(0..0, self.lights.lines());
        lines.extend(of_mesh(self.smooth_normals, self.clean_up));
        lines.extend(last(self.peak_memory_bytes, self.dark, &self.seconds, &self.files));
        format!(
            "{}: baked to an accuracy of {}\n\n{}",
            self.scene,
            percent(self.accuracy),
            text::lines(&lines)
        )
    }
}

/// Three digits.
fn round(number: f64) -> f64 {
    let step = 10_f64.powf(number.log10().floor() - 2.0);
    (number / step).round() * step
}
