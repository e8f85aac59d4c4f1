//! A scene made ready: its patches, and who sees whom.

use super::timing::{Seconds, timed};
use fredholm::value::Value;
use radiosity::patches::{PatchError, Patches};
use radiosity::polygon::Polygon;
use radiosity::scene::Scene;
use radiosity::visibility::Visibility;

/// A scene, cut into patches and ready for rays.
pub struct Domain<'a, V> {
    /// The scene.
    pub scene: &'a Scene<V>,
    /// Its polygons, in the order of its surfaces.
    pub polygons: Vec<Polygon>,
    /// Its patches.
    pub patches: Patches<V>,
    /// Who sees whom.
    pub visibility: Visibility,
}

impl<'a, V: Value> Domain<'a, V> {
    /// Cuts the scene into patches of a size, in metres.
    pub fn new(scene: &'a Scene<V>, size: f64, seconds: &mut Seconds) -> Result<Self, PatchError> {
        let patches = timed(&mut seconds.patches, || Patches::new(scene, size))?;
        let polygons = scene.polygons();
        let visibility = timed(&mut seconds.visibility, || Visibility::new(&polygons));
        Ok(Self { scene, polygons, patches, visibility })
    }
}
