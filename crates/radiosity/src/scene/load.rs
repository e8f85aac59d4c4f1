//! The door of room 1: a path becomes a scene, by the reader that its extension names.

use super::error::{Error, Place, Problem, Warning};
use super::face::Face;
use super::mesh::{self, Assembled, CleanUp, Mesh};
use super::photometric::{self, Units};
use super::vs3::Control;
use super::{Scene, file, gltf, obj, ply, stl, vs3};
use fredholm::value::{Rgb, Value};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;

/// A scene and its author's word on how to solve it.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The scene, checked.
    pub scene: Scene<Rgb>,
    /// What the file says in place of the defaults.
    pub solve: SolveOptions,
    /// What the files call a face, and the polygons of [`Scene::polygons`] that it was cut in; in their order.
    pub faces: Vec<Face>,
    /// What the readers passed over or left out, to be told.
    pub warnings: Vec<Warning>,
    /// What the readers did to the faces.
    pub clean_up: CleanUp,
    /// How a View3D file asks for its view factors; `None` for any other.
    pub control: Option<Control>,
    /// What its light is measured in; where that is lumens all channels are the same: [`Self::grey`].
    pub units: Units,
}

/// How a scene asks to be solved; `None` where it does not say.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SolveOptions {
    /// The largest side of a patch: in the file in its unit of length, after [`load`] in metres.
    #[serde(deserialize_with = "file::positive")]
    pub patch_size: Option<f64>,
    /// The discretisation, by name.
    pub method: Option<String>,
    /// The relaxation or the direct solver, by name.
    pub solver: Option<String>,
    /// The error that the light may have, as a part of one.
    #[serde(deserialize_with = "file::part")]
    pub accuracy: Option<f64>,
    /// The standard error that the form factors of a patch may have in sum.
    #[serde(deserialize_with = "file::positive")]
    pub factor_accuracy: Option<f64>,
    /// The residual at which to stop, relative to the source.
    #[serde(deserialize_with = "file::positive")]
    pub tolerance: Option<f64>,
}

/// Reads a scene: a `.toml` scene file, or a mesh alone, whose lengths are then metres.
///
/// # Errors
///
/// When a file cannot be read or understood, or the scene is none that can be solved: see [`Problem`].
pub fn load(path: &Path) -> Result<Loaded, Error> {
    load_in(path, None)
}

/// The same in these units, whatever a scene file says. In a mesh alone `Ke` is the luminance in cd/m² if they are
/// photometric.
///
/// # Errors
///
/// As of [`load`], and when a photometric scene has colours.
pub fn load_in(path: &Path, units: Option<Units>) -> Result<Loaded, Error> {
    let mut loaded = read(path, units)?;
    loaded.check_masks()?;
    loaded.scene.check_light().map_err(|problem| problem.at(Place::file(path)))?;
    if loaded.scene.surfaces.iter().all(|surface| surface.reflectance.magnitude() == 0.0) {
        let message = "no surface reflects light, so all that does not emit is black; give materials a `reflectance` under \
                       [materials] in a scene file (.toml)";
        loaded.warnings.push(Warning { place: Place::file(path), message: message.to_owned() });
    }
    Ok(loaded)
}

/// Reads a scene as [`load`] does, and takes one in which nothing emits: a view factor is a matter of shape alone,
/// and most mesh files know of no light.
///
/// # Errors
///
/// Those of [`load`], but for [`Problem::NoLight`].
pub fn load_unlit(path: &Path) -> Result<Loaded, Error> {
    read(path, None)
}

fn read(path: &Path, units: Option<Units>) -> Result<Loaded, Error> {
    let loaded = match extension(path).as_str() {
        "toml" => file::load(path, units)?,
        _ => bare_mesh(path, units.unwrap_or_default())?,
    };
    loaded.scene.check_shape().map_err(|problem| problem.at(Place::file(path)))?;
    Ok(loaded)
}

fn bare_mesh(path: &Path, units: Units) -> Result<Loaded, Error> {
    let mut mesh = read_mesh(path, 1.0, &Place::file(path))?;
    let (name, control) = (mesh.title.take().unwrap_or_else(|| file_name(path)), mesh.control.take());
    let (lights, camera) = (std::mem::take(&mut mesh.lights), mesh.camera.take());
    let (meshes, overrides) = (vec![mesh], BTreeMap::new());
    if units == Units::Photometric {
        photometric::check_grey(&meshes, &overrides)?;
    }
    let Assembled { surfaces, faces, warnings, clean_up } = mesh::assemble(meshes, &overrides)?;
    let scene = Scene { name, surfaces, lights, camera };
    Ok(Loaded { scene, solve: SolveOptions::default(), faces, warnings, clean_up, control, units })
}

/// The mesh of a file, by its extension; lengths in the file are so many `metres`.
pub(super) fn read_mesh(path: &Path, metres: f64, named_at: &Place) -> Result<Mesh, Error> {
    match extension(path).as_str() {
        "obj" => obj::read(path, metres, named_at),
        _ if is_gltf(path) => gltf::read(path, metres, named_at),
        "stl" => stl::read(path, metres, named_at),
        "ply" => ply::read(path, metres, named_at),
        "vs3" => vs3::read(path, metres, named_at),
        other => Err(Problem::UnknownFormat(other.to_owned()).at(named_at.clone())),
    }
}

/// Whether a mesh is glTF, by its extension.
pub(super) fn is_gltf(path: &Path) -> bool {
    matches!(extension(path).as_str(), "gltf" | "glb")
}

fn extension(path: &Path) -> String {
    path.extension().map_or_else(String::new, |extension| extension.to_string_lossy().to_lowercase())
}

pub(super) fn file_name(path: &Path) -> String {
    path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}
