//! H(x) = Σ I cosθ V / r² + Σ H_⊥ cosθ V + ∫ L cosθ V dω: what points, suns and a sky send to surfaces, which makes the
//! equation's source f = E + ρ H.

mod far;
mod mean;

pub use far::{FAR, nearest_lit};
pub use mean::mean_irradiances;

use crate::kernel::SurfacePoint;
use crate::reconstruct::Rays;
use crate::scene::{Light, PointLight, Sun};
use crate::visibility::Visibility;
use fredholm::value::Value;
use glam::DVec3;

/// The radiance that comes from beyond the scene in a direction, a unit vector: that of the sky, in W/(m² sr) or cd/m².
pub fn beyond<V: Value>(lights: &[Light<V>], direction: DVec3) -> V {
    lights.iter().fold(V::splat(0.0), |sum, light| match light {
        Light::Sky(sky) => sum + sky.zenith * sky.dome.model().relative(direction),
        Light::Point(_) | Light::Sun(_) => sum,
    })
}

/// The irradiance at a point from lights that nothing hides from it, in W/m² or lx: exact, with one ray to each point or sun, and
/// of a sky as near as [`Dome::error`](crate::sky::Dome::error) says where polygons are few ([`Visibility::clips_sky`]); of many
/// 256 rays find how much of it is seen, mostly to half a hundredth of the light of all of it.
pub fn irradiance<V: Value>(lights: &[Light<V>], visibility: &Visibility, at: &SurfacePoint) -> V {
    irradiance_by(Rays::from(at.position), lights, visibility, at)
}

/// The same by rays of one's own, if it is by rays.
pub(crate) fn irradiance_by<V: Value>(
    rays: Rays,
    lights: &[Light<V>],
    visibility: &Visibility,
    at: &SurfacePoint,
) -> V {
    let sent = |light: &Light<V>| light.amount() * received(light, visibility, at, rays);
    lights.iter().fold(V::splat(0.0), |sum, light| sum + sent(light))
}

/// The irradiance from a light of amount 1: cosθ/r² times the part of the intensity that goes there in sr/m², or cosθ, or what is
/// seen of the sky in sr.
fn received<V>(light: &Light<V>, visibility: &Visibility, at: &SurfacePoint, rays: Rays) -> f64 {
    let part = match light {
        Light::Point(light) => of_point(light, at),
        Light::Sun(sun) => (-sun.direction).dot(at.normal).max(0.0),
        Light::Sky(sky) => return visibility.received_from(&sky.dome, at, rays),
    };
    if part > 0.0 && arrives(light, visibility, at.position) { part } else { 0.0 }
}

fn of_point<V>(light: &PointLight<V>, at: &SurfacePoint) -> f64 {
    let between = light.position - at.position;
    let distance = between.length();
    let cosine = between.dot(at.normal) / distance;
    if cosine > 0.0 { light.part_towards(at.position) * cosine / (distance * distance) } else { 0.0 }
}

/// Whether nothing is between a light and a point of a surface. The light may be anywhere, outside of all walls too, where
/// only the nearest hit leaves out none of them.
fn arrives<V>(light: &Light<V>, visibility: &Visibility, point: DVec3) -> bool {
    match light {
        Light::Point(light) => {
            let between = light.position - point;
            let distance = between.length();
            // A light on a surface is not hidden by it.
            visibility
                .nearest(point, between / distance)
                .is_none_or(|hit| hit.distance > distance * (1.0 - ON_SURFACE))
        }
        Light::Sun(Sun { direction, .. }) => visibility.nearest(point, -*direction).is_none(),
        // How much of it arrives is asked of the sky itself.
        Light::Sky(_) => true,
    }
}

/// How near the end of a ray counts as its end.
const ON_SURFACE: f64 = 1e-9;

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::polygon::Polygon;
    use crate::scene::{Distribution, Spot};
    use std::f64::consts::PI;

    pub const POSITION: DVec3 = DVec3::new(0.3, -0.2, 1.5);

    pub fn square(z: f64, half: f64) -> Polygon {
        let p = |x, y| DVec3::new(x, y, z);
        Polygon::quadrilateral(p(-half, -half), p(half, -half), p(half, half), p(-half, half))
    }

    pub fn points() -> [PointLight<f64>; 5] {
        let towards = |x, y, z| DVec3::new(x, y, z).normalize();
        let spot = |direction, inner, outer| PointLight {
            distribution: Distribution::Spot(Spot { direction, inner, outer }),
            ..PointLight::uniform(POSITION, 1.0)
        };
        [
            PointLight::uniform(POSITION, 1.0),
            PointLight::diffuse(POSITION, 1.0, towards(0.2, 0.5, -1.0)),
            // The square reaches above and below its horizon.
            PointLight::diffuse(POSITION, 1.0, towards(1.0, 0.1, -0.1)),
            spot(towards(0.2, 0.3, -1.0), 0.2, 0.5),
            spot(towards(1.0, 0.1, -0.6), 0.3, 1.5),
        ]
    }

    #[test]
    fn walls_keep_light_out_and_backs_get_none() {
        let visibility = Visibility::new(&[square(0.0, 1.0), square(1.0, 3.0)]);
        let below = PointLight::uniform(DVec3::new(0.0, 0.0, -1.0), 1.0);
        let above = Sun { direction: -DVec3::Z, irradiance: 1.0 };
        let at = SurfacePoint { position: DVec3::ZERO, normal: DVec3::Z };
        let of = |light: Light<f64>| irradiance(&[light], &visibility, &at);
        let isotropic = PointLight::uniform(POSITION, 1.0);
        for hidden in [
            isotropic.clone().into(),
            below.into(),
            above.into(),
            Sun { direction: DVec3::Z, ..above }.into(),
        ] {
            assert_eq!(of(hidden), 0.0);
        }
        // On the ceiling, not behind it.
        let on = PointLight { position: DVec3::Z, ..isotropic };
        assert!((of(on.into()) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_spot_and_a_sun_light_a_point_as_their_angles_say() {
        let visibility = Visibility::new(&[square(0.0, 1.0)]);
        let spot = Spot { direction: -DVec3::Z, inner: 0.2, outer: 0.6 };
        let light = PointLight {
            distribution: Distribution::Spot(spot),
            ..PointLight::uniform(3.0 * DVec3::Z, 90.0)
        };
        let sun = Sun { direction: DVec3::new(0.0, 0.6, -0.8), irradiance: 100.0 };
        for x in [0.0, 0.5, 1.5, 2.5] {
            let at = SurfacePoint { position: DVec3::new(x, 0.0, 0.0), normal: DVec3::Z };
            let angle = (x / 3.0).atan();
            let soft = ((angle.cos() - 0.6_f64.cos()) / (0.2_f64.cos() - 0.6_f64.cos())).clamp(0.0, 1.0);
            let expected = 90.0 * soft * soft * angle.cos().powi(3) / 9.0;
            let found = irradiance(&[light.clone().into()], &visibility, &at);
            assert!((found - expected).abs() < 1e-13, "{found} {expected}");
            assert!((irradiance(&[sun.into()], &visibility, &at) - 80.0).abs() < 1e-12);
        }
        let flat = Light::<f64>::Sun(sun).scaled(0.5).amount();
        assert!((flat - 50.0).abs() < PI * f64::EPSILON);
    }
}
