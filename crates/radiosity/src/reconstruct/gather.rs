//! H(x) = mean of B over rays from x whose density is cosθ/π: the light that reaches a point from patches.

use crate::patches::Patches;
use crate::polygon::Polygon;
use crate::reconstruct::{Site, lattice};
use crate::visibility::Visibility;
use fredholm::value::Value;
use glam::DVec3;
use std::f64::consts::TAU;

/// What the rays of a gather meet: patches, each with the radiosity that it is seen to have.
pub struct Gather<'a, V> {
    /// The input polygons, in the order of surfaces.
    pub polygons: &'a [Polygon],
    /// Their patches.
    pub patches: &'a Patches<V>,
    /// What the rays meet.
    pub visibility: &'a Visibility,
    /// The radiosity of each patch, in W/m²; without the emission of lamps that are counted on their own.
    pub radiosity: Vec<V>,
    /// How many rays.
    pub rays: usize,
}

/// The light that a gather found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gathered<V> {
    /// The irradiance, in W/m².
    pub irradiance: V,
    /// The harmonic mean of the rays' lengths, in metres: how far the irradiance is alike
    /// (Ward's irradiance gradient); infinite in the open.
    pub openness: f64,
}

impl<V: Value> Gather<'_, V> {
    /// The irradiance at a site. A ray that meets a back, or nothing, brings nothing.
    pub fn at(&self, site: &Site) -> Gathered<V> {
        let frame = site.normal.any_orthonormal_pair();
        let (mut sum, mut nearness) = (V::splat(0.0), 0.0);
        for (s, t) in lattice(self.rays, site.rotation) {
            let direction = about(site.normal, frame, cosine_distributed(s, t));
            if let Some(hit) = self.visibility.nearest(site.point, direction) {
                nearness += 1.0 / hit.distance;
                if direction.dot(self.polygons[hit.polygon as usize].normal()) < 0.0 {
                    let met = site.point + direction * hit.distance;
                    sum += self.radiosity[self.patches.patch_at(hit.polygon, met)];
                }
            }
        }
        let rays = self.rays as f64;
        Gathered { irradiance: sum * (1.0 / rays), openness: rays / nearness }
    }
}

/// A direction of the hemisphere about z with density cosθ/π: the point of the unit disc below it is uniform.
fn cosine_distributed(s: f64, t: f64) -> DVec3 {
    let (sine, cosine) = (TAU * t).sin_cos();
    DVec3::new(s.sqrt() * cosine, s.sqrt() * sine, (1.0 - s).sqrt())
}

fn about(normal: DVec3, (x, y): (DVec3, DVec3), local: DVec3) -> DVec3 {
    x * local.x + y * local.y + normal * local.z
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::form_factor::point_to_polygon;
    use crate::reconstruct::Rotation;
    use crate::scene::{Scene, Surface};

    #[test]
    fn a_patch_is_seen_by_its_form_factor_and_from_its_front_only() {
        let p = |x: f64, y: f64| DVec3::new(x, y, 1.0);
        let down = vec![Polygon::quadrilateral(p(-1.0, -1.0), p(-1.0, 1.0), p(1.0, 1.0), p(1.0, -1.0))];
        let up = vec![Polygon::quadrilateral(p(1.0, -1.0), p(1.0, 1.0), p(-1.0, 1.0), p(-1.0, -1.0))];
        let expected = 3.0 * point_to_polygon(DVec3::ZERO, DVec3::Z, &down[0]);
        assert!((gathered(&down) - expected).abs() < 0.01 * expected);
        assert_eq!(gathered(&up), 0.0);
    }

    fn gathered(polygons: &[Polygon]) -> f64 {
        let surface =
            Surface { name: "s".into(), reflectance: 0.5, emission: 0.0, polygons: polygons.to_vec() };
        let scene = Scene { name: "test".into(), surfaces: vec![surface], camera: None };
        let patches = Patches::new(&scene, 0.5).unwrap();
        let gather = Gather {
            polygons,
            radiosity: vec![3.0; patches.len()],
            patches: &patches,
            visibility: &Visibility::new(polygons),
            rays: 10_000,
        };
        gather.at(&Site { point: DVec3::ZERO, normal: DVec3::Z, rotation: Rotation::of(5) }).irradiance
    }
}
