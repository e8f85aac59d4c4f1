//! D(x): what comes straight from lamps and from what is no face.

use crate::kernel::SurfacePoint;
use crate::lights;
use crate::patches::Patches;
use crate::polygon::Polygon;
use crate::reconstruct::{Lamps, Rays, Rotation, Site, lattice, on_surface};
use crate::scene::{Light, Scene};
use crate::visibility::Visibility;
use fredholm::value::Value;
use glam::DVec3;
use rayon::prelude::*;

/// Points of a patch in which its mean is looked at, and the rays to each lamp from there.
const POINTS: usize = 4;
const RAYS: usize = 9;

/// Lamps and lights, and the faces that they shine on.
#[derive(Clone)]
pub(super) struct Direct<'a, V> {
    pub faces: &'a [Polygon],
    pub visibility: &'a Visibility,
    pub lights: &'a [Light<V>],
    /// Those that emit; `None` where they are too many to be looked at one by one: then they are patches like all.
    lamps: Option<Lamps<'a, V>>,
    lift: f64,
}

impl<'a, V: Value> Direct<'a, V> {
    pub fn new(scene: &'a Scene<V>, faces: &'a [Polygon], visibility: &'a Visibility) -> Self {
        let lamps = Lamps::new(scene, visibility);
        Self { faces, visibility, lights: &scene.lights, lamps, lift: visibility.lift() }
    }

    /// D at a point of a face, in W/m², about the smooth normal where it stands for a piece of a curved surface.
    pub fn at(&self, face: u32, point: DVec3, rotation: Rotation) -> V {
        let face = &self.faces[face as usize];
        let at = if face.is_curved() {
            on_surface(face, point, self.visibility, self.lift)
        } else {
            SurfacePoint { position: point + face.normal() * self.lift, normal: face.normal() }
        };
        let site = Site { point: at.position, normal: at.normal, rotation };
        let from_lamps = self.lamps.as_ref().map_or(V::splat(0.0), |lamps| lamps.irradiance(&site));
        from_lamps + lights::irradiance_by(Rays::turned(rotation), self.lights, self.visibility, &at)
    }

    /// The mean of D over each patch, in W/m².
    pub fn means(&self, patches: &Patches<V>) -> Vec<V> {
        let mut means = lights::mean_irradiances(patches, self.visibility);
        let Some(lamps) = &self.lamps else { return means };
        let mean = |(k, polygon): (usize, &Polygon)| {
            let rotation = Rotation::of(k);
            let from = |(s, t): (f64, f64)| {
                let point = polygon.point(s, t) + polygon.normal() * self.lift;
                lamps.roughly(&Site { point, normal: polygon.normal(), rotation }, RAYS)
            };
            lattice(POINTS, rotation).map(from).fold(V::splat(0.0), |sum, h| sum + h) * (1.0 / POINTS as f64)
        };
        let from_lamps: Vec<V> = patches.polygons.par_iter().enumerate().map(mean).collect();
        means.iter_mut().zip(from_lamps).for_each(|(mean, lamps)| *mean += lamps);
        means
    }

    /// What patches send of themselves, for links: what they reflect of D, and if lamps are none of D what they emit.
    pub fn source(&self, patches: &Patches<V>, means: &[V]) -> Vec<V> {
        let all = patches.emission.iter().zip(&patches.reflectance).zip(means);
        let emits = self.lamps.is_none();
        all.map(|((e, rho), d)| *rho * *d + if emits { *e } else { V::splat(0.0) }).collect()
    }

    /// Whether a point of a face is within a body that stands there.
    pub fn is_buried(&self, face: u32, point: DVec3) -> bool {
        self.visibility.is_buried(point, self.faces[face as usize].normal())
    }
}
