//! û at any point of any face: D there, and H as it is linear between the middles and the corners of patches.

use super::direct::Direct;
use super::error::Error;
use super::inverse;
use crate::adaptive::Bound;
use crate::patches::{Corners, Patches};
use crate::polygon::Polygon;
use crate::reconstruct::{Lit, Rotation};
use crate::scene::Light;
use fredholm::value::Value;
use glam::DVec3;

/// The answer: light at any point of any face, with its error.
pub struct Field<'a, V> {
    pub(super) direct: Direct<'a, V>,
    patches: Patches<V>,
    /// The radiosity û and the irradiance D + H of each patch, in W/m².
    radiosity: Vec<V>,
    irradiance: Vec<V>,
    /// H in the middle of each patch, a mean over what of it is not buried, and at the corners, in W/m².
    at_middles: Vec<V>,
    at_corners: Vec<V>,
    /// The mean of H over each patch, in W/m².
    pub(super) arriving: Vec<V>,
    corners: Corners,
    links: usize,
    pub(super) error: Error,
}

impl<'a, V: Value> Field<'a, V> {
    pub(super) fn new(
        direct: Direct<'a, V>,
        patches: Patches<V>,
        (lit, arriving, exposed): (Vec<V>, Vec<V>, &[f64]),
        links: usize,
    ) -> Self {
        let corners = Corners::new(&patches);
        let irradiance: Vec<V> = lit.into_iter().zip(&arriving).map(|(d, h)| d + *h).collect();
        let all = patches.emission.iter().zip(&patches.reflectance).zip(&irradiance);
        let at_middles: Vec<V> = arriving.iter().zip(exposed).map(|(h, part)| *h * inverse(*part)).collect();
        Self {
            direct,
            radiosity: all.map(|((e, rho), h)| *e + *rho * *h).collect(),
            irradiance,
            at_corners: corners.means(&patches, &at_middles, exposed),
            at_middles,
            arriving,
            corners,
            patches,
            links,
            error: Error::default(),
        }
    }

    /// The patches of the last round.
    pub fn patches(&self) -> &Patches<V> {
        &self.patches
    }

    /// The mean radiosity of each patch, in W/m².
    pub fn radiosity(&self) -> &[V] {
        &self.radiosity
    }

    /// The mean irradiance of each patch, in W/m².
    pub fn irradiance(&self) -> &[V] {
        &self.irradiance
    }

    /// How many patches there are, and how many links.
    pub fn size(&self) -> [usize; 2] {
        [self.patches.len(), self.links]
    }

    /// The error of the radiosity, as the residual of the equation tells it.
    pub fn bound(&self) -> Bound {
        let Error { links, mesh, iteration, .. } = self.error;
        Bound { discretisation: mesh, form_factors: links, iteration }
    }

    /// D + H at a point of a face, with rays of a rotation.
    pub(super) fn irradiance_at(&self, face: u32, point: DVec3, rotation: Rotation) -> V {
        if self.direct.is_buried(face, point) {
            return V::splat(0.0);
        }
        self.direct.at(face, point, rotation) + self.between(face, point)
    }

    /// H at a point of a face.
    fn between(&self, face: u32, point: DVec3) -> V {
        let patch = self.patches.patch_at(face, point);
        self.corners.between(&self.patches, (patch, point), &self.at_corners, self.at_middles[patch])
    }
}

impl<V: Value> Lit<V> for Field<'_, V> {
    fn seen(&self, points: &mut dyn Iterator<Item = (u32, DVec3)>) -> Vec<[V; 2]> {
        let at = |(face, point): (u32, DVec3)| {
            let patch = self.patches.patch_at(face, point);
            let irradiance = self.irradiance_at(face, point, Rotation::at(point));
            [self.patches.emission[patch] + self.patches.reflectance[patch] * irradiance, irradiance]
        };
        points.map(at).collect()
    }

    fn is_covered(&self, face: u32, point: DVec3) -> bool {
        self.direct.is_buried(face, point)
    }

    fn cells(&self) -> Vec<(u32, Polygon)> {
        self.patches.face_of_each().into_iter().zip(self.patches.polygons.iter().cloned()).collect()
    }

    fn scale(&self) -> f64 {
        let Patches { areas, emission, .. } = &self.patches;
        let reflected = self.radiosity.iter().zip(emission).map(|(b, e)| (*b - *e).square());
        let sum: f64 = areas.iter().zip(reflected).map(|(area, square)| area * square).sum();
        (sum / areas.iter().sum::<f64>()).sqrt()
    }

    fn lights(&self) -> &[Light<V>] {
        self.direct.lights
    }
}
