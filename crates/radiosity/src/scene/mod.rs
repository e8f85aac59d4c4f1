//! Room 1: a scene is surfaces with materials, in metres, and perhaps a camera.
//!
//! [`load`] reads a mesh (`.obj` with its `.mtl`, `.gltf`, `.glb`, `.stl`, `.ply`, View3D's `.vs3`; in metres) or a scene file (`.toml`:
//! meshes, their unit, materials in place of the meshes' own, a camera, wishes on how to solve). [`load_unlit`] takes
//! scenes without light as well. [`cornell_box`] is built in. Surfaces are diffuse and one-sided. Whatever the door,
//! the same is checked: see [`Problem`]; all tolerances are relative to the size of a face, so that a scene in
//! millimetres behaves like one in kilometres.
//!
//! What a file calls a face may be several polygons of the scene: [`Loaded::faces`] tells which. How the faces hang
//! together is looked at by [`examine()`].

mod camera;
mod check;
mod compass;
mod cornell;
mod cut;
mod error;
mod examine;
mod face;
mod file;
mod gltf;
mod light;
mod load;
mod luminaire;
mod material;
mod mesh;
mod mtl;
mod normals;
mod obj;
mod photometric;
mod ply;
mod stl;
mod text;
mod thermal;
mod vs3;

pub use camera::Camera;
pub use cornell::{cornell_box, cornell_box_spectral};
pub use cut::cut;
pub use error::{Error, Place, Problem, Warning};
pub use examine::{Component, Defect, Finding, Report, examine};
pub use face::Face;
pub use file::percent;
pub use light::{Distribution, Light, PointLight, Sky, Spot, Sun};
pub use load::{Loaded, SolveOptions, load, load_in, load_unlit};
pub use luminaire::{Aimed, Web};
pub use mesh::CleanUp;
pub use photometric::Units;
pub use thermal::{Thermal, ThermalScene, load_thermal};
pub use vs3::Control;

use crate::polygon::Polygon;
use fredholm::value::Value;

/// Surfaces in the order of the file, and where it is looked at from.
#[derive(Clone, Debug)]
pub struct Scene<V> {
    /// What the scene is called: the file's name without its folder, or the name it gives itself.
    pub name: String,
    /// The surfaces, in the order of the file.
    pub surfaces: Vec<Surface<V>>,
    /// What shines beside the surfaces that emit.
    pub lights: Vec<Light<V>>,
    /// Where the file says that the scene is looked at from.
    pub camera: Option<Camera>,
}

/// Polygons of one material that the file calls by one name.
#[derive(Clone, Debug)]
pub struct Surface<V> {
    /// The name, unique in the scene.
    pub name: String,
    /// Diffuse hemispherical reflectance ρ ∈ [0, 1), by channel.
    pub reflectance: V,
    /// Exitance E = π L emitted from the front, in W/m², by channel.
    pub emission: V,
    /// The polygons, in the order of the file.
    pub polygons: Vec<Polygon>,
}

impl<V> Scene<V> {
    /// All polygons, surface by surface: their numbers are those that patches and visibility name them by.
    pub fn polygons(&self) -> Vec<Polygon> {
        self.surfaces.iter().flat_map(|surface| surface.polygons.iter().cloned()).collect()
    }

    /// How many polygons stand for pieces of curved surfaces, with normals of their own at the vertices.
    pub fn curved_polygons(&self) -> usize {
        self.surfaces.iter().flat_map(|surface| &surface.polygons).filter(|p| p.is_curved()).count()
    }

    /// The same with every polygon as flat in pictures as it is.
    pub fn flat(mut self) -> Self {
        for surface in &mut self.surfaces {
            surface.polygons = std::mem::take(&mut surface.polygons).into_iter().map(Polygon::flat).collect();
        }
        self
    }
}

impl<V: Value> Surface<V> {
    /// The area of all polygons, in m².
    pub fn area(&self) -> f64 {
        self.polygons.iter().map(Polygon::area).sum()
    }
}
