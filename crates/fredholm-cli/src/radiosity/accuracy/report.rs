//! The numbers of a run to an accuracy: what `--json` writes and the table shows.

use crate::radiosity::lights::Lights;
use crate::radiosity::report::{Named, Surface};
use crate::radiosity::timing::Seconds;
use fredholm::memory;
use fredholm::value::Value;
use radiosity::adaptive::{Bound, Round};
use radiosity::scene::{CleanUp, Scene, Units};
use serde::Serialize;
use std::path::PathBuf;

/// The numbers of a run, in the order of the JSON. Errors are relative: of the mean square over all surfaces, to that of the
/// light that they reflect.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// What the scene is called.
    pub scene: String,
    /// `met`, or `not met`.
    pub outcome: &'static str,
    /// What was asked for.
    pub accuracy: f64,
    /// What the answer has: the sum of its three parts.
    pub error: f64,
    /// Of the mesh.
    pub discretisation_error: f64,
    /// Of the form factors.
    pub form_factor_error: f64,
    /// Of the iteration.
    pub iteration_error: f64,
    /// What light is on a patch, for the table.
    #[serde(skip)]
    pub elements: &'static str,
    /// Patches of the last mesh.
    pub patches: usize,
    /// Form factors of the last mesh.
    pub form_factors: usize,
    /// The meshes on the way, and the last one.
    pub rounds: Vec<Mesh>,
    /// Whether no light at all reaches any surface.
    pub dark: bool,
    /// What shines beside the surfaces.
    #[serde(flatten)]
    pub lights: Lights,
    /// How many polygons are drawn with the normals of a curved surface; the light on them is solved as if they were flat.
    pub smooth_normals: usize,
    /// What the readers did to the mesh.
    pub clean_up: CleanUp,
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

/// A mesh and the error on it.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Mesh {
    /// How many patches.
    pub patches: usize,
    /// How many form factors.
    pub form_factors: usize,
    /// The whole error, or the residual where that alone is larger than the error may be.
    pub error: f64,
}

impl Report {
    /// The numbers of a solved scene.
    pub fn new<V: Value>(
        scene: &Scene<V>,
        accuracy: f64,
        (rounds, elements): (&[Round], &'static str),
        bound: Bound,
        (units, surfaces): (Units, Vec<Surface>),
        seconds: Seconds,
        files: Vec<PathBuf>,
    ) -> Self {
        let mesh =
            |round: &Round| Mesh { patches: round.patches, form_factors: round.links, error: round.error };
        let rounds: Vec<Mesh> = rounds.iter().map(mesh).collect();
        let [patches, form_factors] = rounds.last().map_or([0; 2], |mesh| [mesh.patches, mesh.form_factors]);
        let error = bound.total();
        Self {
            scene: scene.name.clone(),
            outcome: if error <= accuracy { "met" } else { "not met" },
            accuracy,
            error,
            discretisation_error: bound.discretisation,
            form_factor_error: bound.form_factors,
            iteration_error: bound.iteration,
            elements,
            patches,
            form_factors,
            rounds,
            lights: Lights::new(scene, units),
            smooth_normals: scene.curved_polygons(),
            clean_up: CleanUp::default(),
            dark: surfaces.iter().all(Surface::is_dark),
            seconds,
            peak_memory_bytes: memory::peak(),
            units: Named::new(units),
            surfaces,
            files,
        }
    }

    /// Whether the answer is as good as was asked.
    pub fn is_met(&self) -> bool {
        self.outcome == "met"
    }
}
