//! What must hold of a scene, by whichever door it came in: 0 ≤ ρ < 1, 0 ≤ E < ∞, some face, some light.

use super::error::Problem;
use super::{Camera, Distribution, Light, PointLight, Scene, Spot, Surface};
use fredholm::value::Value;
use glam::DVec3;
use std::f64::consts::FRAC_PI_2;

impl<V: Value> Scene<V> {
    /// Checks a scene that was built by hand as the readers check theirs; faces are checked by [`super::cut()`].
    ///
    /// # Errors
    ///
    /// When a reflectance lies outside [0, 1), an emission is negative or infinite, a polygon has no area, the camera
    /// cannot see, a light is nowhere or takes light away, or there are no faces or no light at all.
    pub fn check(&self) -> Result<(), Problem> {
        self.check_shape()?;
        self.check_light()
    }

    /// Checks all but that there is light.
    pub(super) fn check_shape(&self) -> Result<(), Problem> {
        self.surfaces.iter().try_for_each(surface)?;
        if self.surfaces.iter().all(|surface| surface.polygons.is_empty()) {
            return Err(Problem::NoFaces);
        }
        (1..).zip(&self.lights).try_for_each(|(number, given)| light(number, given))?;
        self.camera.as_ref().map_or(Ok(()), Camera::check)
    }

    pub(super) fn check_light(&self) -> Result<(), Problem> {
        let dark = self.surfaces.iter().all(|surface| surface.emission.magnitude() == 0.0);
        if dark && self.lights.iter().all(|light| light.amount().magnitude() == 0.0) {
            return Err(Problem::NoLight);
        }
        Ok(())
    }
}

fn surface<V: Value>(surface: &Surface<V>) -> Result<(), Problem> {
    let owner = format!("surface `{}`", surface.name);
    reflectance(&owner, &surface.reflectance)?;
    emission(&owner, &surface.emission)?;
    match surface.polygons.iter().find(|polygon| !(polygon.area() > 0.0 && polygon.area().is_finite())) {
        Some(polygon) => Err(Problem::Degenerate(polygon.vertices().len())),
        None => Ok(()),
    }
}

pub(super) fn reflectance<V: Value>(owner: &str, reflectance: &V) -> Result<(), Problem> {
    match first_outside(reflectance, |c| (0.0..1.0).contains(&c)) {
        Some((channel, value)) => Err(Problem::Reflectance { owner: owner.to_owned(), channel, value }),
        None => Ok(()),
    }
}

pub(super) fn emission<V: Value>(owner: &str, emission: &V) -> Result<(), Problem> {
    match first_outside(emission, |c| (0.0..f64::INFINITY).contains(&c)) {
        Some((channel, value)) => Err(Problem::Emission { owner: owner.to_owned(), channel, value }),
        None => Ok(()),
    }
}

/// The light of a number, counted from 1.
pub(super) fn light<V: Value>(number: usize, light: &Light<V>) -> Result<(), Problem> {
    match light {
        Light::Point(light) => point_light(number, light),
        Light::Sun(sun) => {
            is_direction(number, sun.direction)?;
            amount_of_light(number, "irradiance", &sun.irradiance)
        }
        Light::Sky(sky) => amount_of_light(number, "radiance at the zenith", &sky.zenith),
    }
}

fn point_light<V: Value>(number: usize, light: &PointLight<V>) -> Result<(), Problem> {
    let bad = |what: String| Err(Problem::Light { number, what });
    if !light.position.is_finite() {
        return bad("its position must be three finite numbers".to_owned());
    }
    match light.distribution {
        Distribution::Uniform | Distribution::Measured(_) => (),
        Distribution::Diffuse(direction) => is_direction(number, direction)?,
        Distribution::Spot(Spot { direction, inner, outer }) => {
            is_direction(number, direction)?;
            if !(0.0 <= inner && inner < outer && outer <= FRAC_PI_2) {
                let [inner, outer] = [inner, outer].map(f64::to_degrees);
                return bad(format!(
                    "its beam is whole up to {inner:.5} degrees from its axis and ends at {outer:.5}; the first must be at \
                     least 0 and less than the second, and that at most 90"
                ));
            }
        }
    }
    amount_of_light(number, "intensity", &light.intensity)
}

fn is_direction(number: usize, direction: DVec3) -> Result<(), Problem> {
    if direction.is_normalized() {
        return Ok(());
    }
    let what = "its direction has no length; give a vector, or leave it out".to_owned();
    Err(Problem::Light { number, what })
}

/// The intensity or the flux of a light, or the irradiance of a sun.
pub(super) fn amount_of_light<V: Value>(number: usize, name: &str, value: &V) -> Result<(), Problem> {
    match first_outside(value, |c| (0.0..f64::INFINITY).contains(&c)) {
        Some((channel, value)) => Err(Problem::Light {
            number,
            what: format!("its {name} is {value} in channel {channel}; it must be finite and not negative"),
        }),
        None => Ok(()),
    }
}

/// The first channel, counted from 1, that is not as it should be.
pub(super) fn first_outside<V: Value>(value: &V, is_good: impl Fn(f64) -> bool) -> Option<(usize, f64)> {
    (1..).zip(value.channels().iter().copied()).find(|&(_, c)| !is_good(c))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::Polygon;
    use fredholm::value::{Rgb, Spectrum};
    use glam::DVec3;

    fn lamp(reflectance: Rgb, emission: Rgb) -> Scene<Rgb> {
        let polygons = vec![Polygon::triangle(DVec3::ZERO, DVec3::X, DVec3::Y)];
        let surfaces = vec![Surface { name: "lamp".to_owned(), reflectance, emission, polygons }];
        Scene { name: "test".to_owned(), surfaces, lights: Vec::new(), camera: None }
    }

    #[test]
    fn reflectance_and_emission_are_checked_by_channel() {
        let one = Rgb::splat(1.0);
        assert!(lamp(Rgb::splat(0.0), one).check().is_ok());
        assert!(lamp(Rgb::splat(1.0 - f64::EPSILON), one).check().is_ok());
        for bad in [1.0, -1e-300, f64::NAN] {
            let problem = lamp(Spectrum([0.5, bad, 0.5]), one).check().unwrap_err();
            assert!(
                matches!(&problem, Problem::Reflectance { owner, channel: 2, .. } if owner == "surface `lamp`")
            );
        }
        for bad in [f64::INFINITY, -1.0, f64::NAN] {
            let problem = lamp(Rgb::splat(0.5), Spectrum([1.0, 1.0, bad])).check().unwrap_err();
            assert!(matches!(problem, Problem::Emission { channel: 3, .. }));
        }
    }

    #[test]
    fn a_scene_needs_faces_with_area_and_light() {
        assert!(matches!(lamp(Rgb::splat(0.5), Rgb::splat(0.0)).check(), Err(Problem::NoLight)));
        let mut scene = lamp(Rgb::splat(0.5), Rgb::splat(1.0));
        scene.surfaces[0].polygons = vec![Polygon::triangle(DVec3::ZERO, DVec3::X, 2.0 * DVec3::X)];
        assert!(matches!(scene.check(), Err(Problem::Degenerate(3))));
        scene.surfaces[0].polygons.clear();
        assert!(matches!(scene.check(), Err(Problem::NoFaces)));
        scene.surfaces.clear();
        assert!(matches!(scene.check(), Err(Problem::NoFaces)));
    }
}
