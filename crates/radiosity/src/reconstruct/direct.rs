//! H(x) = Σ_j E_j F_j(x) V_j(x): the light that reaches a point straight from the lamps.

use crate::form_factor::lambert::point_to_polygon;
use crate::kernel::{SurfacePoint, unoccluded};
use crate::polygon::Polygon;
use crate::reconstruct::{Site, lattice};
use crate::scene::Scene;
use crate::visibility::Visibility;
use fredholm::value::Value;

/// The polygons that emit, each whole.
#[derive(Clone)]
pub struct Lamps<'a, V> {
    lamps: Vec<(&'a Polygon, V)>,
    visibility: &'a Visibility,
}

/// Each lamp costs a form factor and shadow rays at every point. A room's lamps are fewer than this; a shape of
/// thousands of glowing triangles is smooth enough for the gather.
const MOST_LAMPS: usize = 64;

/// Shadow rays that look for a penumbra within a lamp; its corners are looked at too. A straight edge that hides
/// part of the lamp hides a corner; these are for what is smaller than the lamp.
const PROBES: usize = 9;

/// The corners, in the coordinates of [`Polygon::point`], a thousandth within: on the rim a lamp touches its mounting.
const CORNERS: [(f64, f64); 4] = [(0.001, 0.001), (0.999, 0.001), (0.999, 0.999), (0.001, 0.999)];

/// Shadow rays in a penumbra. With 32 its grain shows; 256 are more work than the gather.
const PENUMBRA_RAYS: usize = 80;

impl<'a, V: Value> Lamps<'a, V> {
    /// The lamps of a scene; none when it has more polygons that emit than can be counted one by one.
    pub fn new(scene: &'a Scene<V>, visibility: &'a Visibility) -> Option<Self> {
        let emitting = scene.surfaces.iter().filter(|s| s.emission != V::splat(0.0));
        let lamps: Vec<_> =
            emitting.flat_map(|s| s.polygons.iter().map(|p| (p, s.emission))).take(MOST_LAMPS + 1).collect();
        (lamps.len() <= MOST_LAMPS).then_some(Self { lamps, visibility })
    }

    /// These polygons with their exitance, in W/m², as lamps.
    pub(crate) fn of(lamps: Vec<(&'a Polygon, V)>, visibility: &'a Visibility) -> Self {
        Self { lamps, visibility }
    }

    /// The irradiance from the lamps, in W/m².
    pub fn irradiance(&self, site: &Site) -> V {
        self.sum(site, |lamp| self.visible_share(site, lamp))
    }

    /// The irradiance from the lamps, in W/m², as `rays` shadow rays to each find it.
    pub fn roughly(&self, site: &Site, rays: usize) -> V {
        self.sum(site, |lamp| self.share_of_rays(site, lamp, lattice(rays, site.rotation)))
    }

    fn sum(&self, site: &Site, visible_share: impl Fn(&Polygon) -> f64) -> V {
        self.lamps.iter().fold(V::splat(0.0), |sum, (lamp, exitance)| {
            let factor = point_to_polygon(site.point, site.normal, lamp);
            if factor > 0.0 { sum + *exitance * (factor * visible_share(lamp)) } else { sum }
        })
    }

    /// The share of a lamp's light that arrives: few rays where they agree, more in a penumbra.
    fn visible_share(&self, site: &Site, lamp: &Polygon) -> f64 {
        let probes = CORNERS.into_iter().chain(lattice(PROBES, site.rotation));
        let share = self.share_of_rays(site, lamp, probes);
        if share == 0.0 || share == 1.0 {
            return share;
        }
        self.share_of_rays(site, lamp, lattice(PENUMBRA_RAYS, site.rotation))
    }

    fn share_of_rays(&self, site: &Site, lamp: &Polygon, rays: impl Iterator<Item = (f64, f64)>) -> f64 {
        let x = SurfacePoint { position: site.point, normal: site.normal };
        let (mut all, mut arrived) = (0.0, 0.0);
        for (s, t) in rays {
            let source = lamp.point(s, t);
            let y = SurfacePoint { position: source, normal: lamp.normal() };
            let weight = unoccluded(&x, &y) * lamp.density(s, t);
            all += weight;
            if weight > 0.0 && self.visibility.is_clear(site.point, source) {
                arrived += weight;
            }
        }
        // A lamp of which only a sliver rises above the horizon may miss every sample: nothing to weigh.
        if all > 0.0 { arrived / all } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reconstruct::Rotation;
    use crate::scene::Surface;
    use glam::DVec3;

    fn square(z: f64, half: f64) -> Polygon {
        let p = |x, y| DVec3::new(x, y, z);
        Polygon::quadrilateral(p(-half, -half), p(-half, half), p(half, half), p(half, -half))
    }

    fn scene(lamp: Polygon, blocker: Option<Polygon>) -> Scene<f64> {
        let surface = |name: &str, emission, polygons| Surface {
            name: name.into(),
            reflectance: 0.0,
            emission,
            polygons,
        };
        let surfaces = vec![
            surface("lamp", 10.0, vec![lamp]),
            surface("floor", 0.0, vec![square(0.0, 5.0)]),
            surface("shade", 0.0, blocker.into_iter().collect()),
        ];
        Scene { name: "test".into(), surfaces, lights: Vec::new(), camera: None }
    }

    fn irradiance(scene: &Scene<f64>, x: DVec3, rotation: Rotation) -> f64 {
        let visibility = Visibility::new(&scene.polygons());
        let site = Site { point: x, normal: DVec3::Z, rotation };
        Lamps::new(scene, &visibility).unwrap().irradiance(&site)
    }

    #[test]
    fn a_lamp_in_full_sight_is_exact() {
        let expected = 10.0 * point_to_polygon(DVec3::ZERO, DVec3::Z, &square(1.0, 0.5));
        assert_eq!(irradiance(&scene(square(1.0, 0.5), None), DVec3::ZERO, Rotation::of(3)), expected);
    }

    #[test]
    fn a_penumbra_is_the_light_of_the_part_in_sight() {
        // A shade with its edge over the point hides the half of the lamp with x > 0.
        let p = |x, y| DVec3::new(x, y, 0.5);
        let shade = Polygon::quadrilateral(p(0.0, -5.0), p(5.0, -5.0), p(5.0, 5.0), p(0.0, 5.0));
        let scene = scene(square(1.0, 0.5), Some(shade));
        let whole = 10.0 * point_to_polygon(DVec3::ZERO, DVec3::Z, &square(1.0, 0.5));
        for index in 0..20 {
            let share = irradiance(&scene, DVec3::ZERO, Rotation::of(index)) / whole;
            assert!((share - 0.5).abs() < 0.05, "{share}");
            assert_eq!(irradiance(&scene, DVec3::new(2.0, 0.0, 0.0), Rotation::of(index)), 0.0);
        }
    }

    #[test]
    fn a_penumbra_of_a_lamp_that_is_no_parallelogram_weighs_it_by_area() {
        // A trapezoid narrow for x > 0, where it is hidden: Lambert's formula on the other part is what arrives.
        let p = |x, y, z| DVec3::new(x, y, z);
        let lamp = |x0: f64, x1: f64| {
            let half = |x: f64| 0.55 - x;
            Polygon::quadrilateral(
                p(x0, -half(x0), 1.0),
                p(x0, half(x0), 1.0),
                p(x1, half(x1), 1.0),
                p(x1, -half(x1), 1.0),
            )
        };
        let shade =
            Polygon::quadrilateral(p(0.0, -5.0, 0.5), p(5.0, -5.0, 0.5), p(5.0, 5.0, 0.5), p(0.0, 5.0, 0.5));
        let scene = scene(lamp(-0.5, 0.5), Some(shade));
        let expected = 10.0 * point_to_polygon(DVec3::ZERO, DVec3::Z, &lamp(-0.5, 0.0));
        for index in 0..20 {
            let got = irradiance(&scene, DVec3::ZERO, Rotation::of(index));
            assert!((got / expected - 1.0).abs() < 0.05, "{got} for {expected}");
        }
    }

    #[test]
    fn too_many_lamps_are_left_to_the_gather() {
        let mut scene = scene(square(1.0, 0.5), None);
        scene.surfaces[0].polygons = vec![square(1.0, 0.5); MOST_LAMPS + 1];
        assert!(Lamps::new(&scene, &Visibility::new(&[])).is_none());
    }
}
