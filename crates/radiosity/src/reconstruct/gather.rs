//! H(x) = mean of B over rays from x whose density is cosθ/π: the light that reaches a point from patches.
//!
//! A patch is the mean of what lies on it: a block's foot, a shadow's edge. Seen from afar that is enough; a ray that
//! ends nearer than the patch is large asks for the light at its very end instead, with a few rays of its own.

use crate::kernel::SurfacePoint;
use crate::lights;
use crate::patches::Patches;
use crate::polygon::Polygon;
use crate::reconstruct::{Lamps, Rays, Site, lattice};
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
    /// The radiosity of each patch, in W/m²; without its emission when `lamps` are counted on their own.
    pub radiosity: Vec<V>,
    /// The lamps that are counted on their own.
    pub lamps: Option<Lamps<'a, V>>,
    /// How far the end of a ray is lifted off its surface, in m, before rays leave it.
    pub lift: f64,
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

/// A ray is near its end when it is shorter than this, in sizes (root areas) of the patch there. At 0.5 patches that
/// are half under a block show at its foot; at 2 the near ends take most of the time.
const NEAR: f64 = 1.0;

/// Rays, and shadow rays per lamp, from a near end: its noise is one of many in a mean.
const NEAR_RAYS: usize = 4;

impl<V: Value> Gather<'_, V> {
    /// The irradiance at a site. A ray that meets a back, or nothing, brings nothing.
    pub fn at(&self, site: &Site) -> Gathered<V> {
        self.mean_of_rays(site, self.rays, |gather, end, patch, distance| {
            if distance * distance < NEAR * NEAR * gather.patches.areas[patch] {
                gather.radiosity_at(end, patch)
            } else {
                gather.radiosity[patch]
            }
        })
    }

    /// The radiosity at a point of a patch, as a few rays find it.
    fn radiosity_at(&self, site: &Site, patch: usize) -> V {
        let gathered = self.mean_of_rays(site, NEAR_RAYS, |gather, _, patch, _| gather.radiosity[patch]);
        let reflectance = self.patches.reflectance[patch];
        let irradiance =
            gathered.irradiance + self.of_points(site, Rays { count: NEAR_RAYS, rotation: site.rotation });
        match &self.lamps {
            Some(lamps) => reflectance * (irradiance + lamps.roughly(site, NEAR_RAYS)),
            None => self.patches.emission[patch] + reflectance * irradiance,
        }
    }

    /// The irradiance straight from lamps and from what is no surface, in W/m², but for that of lamps which are not counted
    /// on their own.
    pub fn direct(&self, site: &Site) -> V {
        let lamps = self.lamps.as_ref().map_or(V::splat(0.0), |lamps| lamps.irradiance(site));
        lamps + self.of_points(site, Rays::turned(site.rotation))
    }

    fn of_points(&self, site: &Site, rays: Rays) -> V {
        let at = SurfacePoint { position: site.point, normal: site.normal };
        lights::irradiance_by(rays, &self.patches.lights, self.visibility, &at)
    }

    /// The mean of what `seen` at the ends of the rays: (self, end, patch, length).
    fn mean_of_rays(
        &self,
        site: &Site,
        rays: usize,
        seen: impl Fn(&Self, &Site, usize, f64) -> V,
    ) -> Gathered<V> {
        let frame = site.normal.any_orthonormal_pair();
        let (mut sum, mut nearness) = (V::splat(0.0), 0.0);
        for (i, (s, t)) in lattice(rays, site.rotation).enumerate() {
            let direction = about(site.normal, frame, cosine_distributed(s, t));
            let Some(hit) = self.visibility.nearest(site.point, direction) else { continue };
            nearness += 1.0 / hit.distance;
            let normal = self.polygons[hit.polygon as usize].normal();
            if direction.dot(normal) < 0.0 {
                let point = site.point + direction * hit.distance;
                let patch = self.patches.patch_at(hit.polygon, point);
                let end = Site { point: point + normal * self.lift, normal, rotation: site.rotation.next(i) };
                sum += seen(self, &end, patch, hit.distance);
            }
        }
        let rays = rays as f64;
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
    use crate::form_factor::lambert::point_to_polygon;
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

    #[test]
    fn a_near_end_is_lit_by_itself_whatever_its_patch_says() {
        // The lamp is high up: few of the rays from the floor meet its patch.
        let p = DVec3::new;
        let floor =
            Polygon::quadrilateral(p(0.0, 0.0, 0.0), p(1.0, 0.0, 0.0), p(1.0, 1.0, 0.0), p(0.0, 1.0, 0.0));
        let lamp =
            Polygon::quadrilateral(p(0.0, 0.0, 9.0), p(0.0, 1.0, 9.0), p(1.0, 1.0, 9.0), p(1.0, 0.0, 9.0));
        let surface = |name: &str, emission, polygon: &Polygon| Surface {
            name: name.into(),
            reflectance: 0.5,
            emission,
            polygons: vec![polygon.clone()],
        };
        let surfaces = vec![surface("floor", 0.0, &floor), surface("lamp", 100.0, &lamp)];
        let scene = Scene { name: "test".into(), surfaces, lights: Vec::new(), camera: None };
        let (polygons, patches) = (vec![floor, lamp], Patches::new(&scene, 1.0).unwrap());
        let visibility = Visibility::new(&polygons);
        let gather = Gather {
            polygons: &polygons,
            radiosity: vec![1e9, 0.0],
            lamps: Lamps::new(&scene, &visibility),
            patches: &patches,
            visibility: &visibility,
            lift: 1e-7,
            rays: 1,
        };
        let site = Site { point: p(0.5, 0.5, 1e-7), normal: DVec3::Z, rotation: Rotation::of(1) };
        let lit = 0.5 * 100.0 * point_to_polygon(site.point, site.normal, &polygons[1]);
        assert!((gather.radiosity_at(&site, 0) / lit - 1.0).abs() < 0.01, "not lit by the lamp");
        let above = Site { point: p(0.5, 0.5, 0.5), normal: -DVec3::Z, ..site };
        assert!(gather.at(&above).irradiance < 1e9 * 0.51, "the patch itself was read");
    }

    fn gathered(polygons: &[Polygon]) -> f64 {
        let surface =
            Surface { name: "s".into(), reflectance: 0.5, emission: 0.0, polygons: polygons.to_vec() };
        let scene = Scene { name: "test".into(), surfaces: vec![surface], lights: Vec::new(), camera: None };
        let patches = Patches::new(&scene, 0.5).unwrap();
        let gather = Gather {
            polygons,
            radiosity: vec![3.0; patches.len()],
            patches: &patches,
            visibility: &Visibility::new(polygons),
            lamps: None,
            lift: 1e-7,
            rays: 10_000,
        };
        gather.at(&Site { point: DVec3::ZERO, normal: DVec3::Z, rotation: Rotation::of(5) }).irradiance
    }
}
