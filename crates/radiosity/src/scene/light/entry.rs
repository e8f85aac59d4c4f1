//! `[[light]]` of a scene file: a point, and I in W/sr or cd, or Φ in W or lm.

use super::{Distribution, Light, PointLight, Spot};
use crate::scene::error::{Error, Problem};
use crate::scene::file::{Channels, Source};
use crate::scene::{Units, check};
use fredholm::value::Rgb;
use glam::DVec3;
use serde::Deserialize;
use toml::Spanned;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct LightEntry {
    position: Spanned<[f64; 3]>,
    intensity: Option<Spanned<Channels>>,
    flux: Option<Spanned<Channels>>,
    direction: Option<Spanned<[f64; 3]>>,
    cone: Option<Spanned<[f64; 2]>>,
}

impl Source<'_> {
    /// The lights of these entries; lengths are so many `metres`.
    pub fn lights(
        &self,
        entries: &[LightEntry],
        metres: f64,
        units: Units,
    ) -> Result<Vec<Light<Rgb>>, Error> {
        (1..).zip(entries).map(|(number, entry)| self.light(number, entry, metres, units)).collect()
    }

    fn light(
        &self,
        number: usize,
        entry: &LightEntry,
        metres: f64,
        units: Units,
    ) -> Result<Light<Rgb>, Error> {
        let bad = |what: &str, place| Err(Problem::Light { number, what: what.to_owned() }.at(place));
        let (given, name) = match (&entry.intensity, &entry.flux) {
            (Some(intensity), None) => (intensity, "intensity"),
            (None, Some(flux)) => (flux, "flux"),
            (_, flux) => {
                let span = flux.as_ref().map_or_else(|| entry.position.span(), Spanned::span);
                return bad(
                    "it needs either an `intensity` or a `flux`; give one of them",
                    self.place(&span),
                );
            }
        };
        self.check_amount((number, name), given, units)?;
        let mut light = PointLight {
            position: DVec3::from(*entry.position.get_ref()) * metres,
            intensity: given.get_ref().colour(),
            distribution: self.distribution(number, entry)?,
        };
        if name == "flux" {
            light.intensity = light.intensity * (1.0 / light.distribution.flux_of_unit());
        }
        let is_placed = light.position.is_finite();
        let light = Light::Point(light);
        check::light(number, &light).map_err(|problem| {
            let cone = entry.cone.as_ref().map(Spanned::span);
            let shape = cone.or(entry.direction.as_ref().map(Spanned::span)).filter(|_| is_placed);
            problem.at(self.place(&shape.unwrap_or_else(|| entry.position.span())))
        })?;
        Ok(light)
    }
    fn distribution(&self, number: usize, entry: &LightEntry) -> Result<Distribution, Error> {
        // Zero and NaN stay, for the check to see.
        let unit = |direction: &Spanned<[f64; 3]>| {
            DVec3::from(*direction.get_ref()).try_normalize().unwrap_or(DVec3::ZERO)
        };
        match (&entry.direction, &entry.cone) {
            (None, None) => Ok(Distribution::Uniform),
            (Some(direction), None) => Ok(Distribution::Diffuse(unit(direction))),
            (Some(direction), Some(cone)) => {
                let [inner, outer] = cone.get_ref().map(f64::to_radians);
                Ok(Distribution::Spot(Spot { direction: unit(direction), inner, outer }))
            }
            (None, Some(cone)) => {
                let what = "it has a `cone` and no `direction`; give the direction of its axis".to_owned();
                Err(Problem::Light { number, what }.at(self.place(&cone.span())))
            }
        }
    }

    /// That an amount of light, by its name, is one, and of one channel in a photometric scene.
    pub fn check_amount(
        &self,
        (number, name): (usize, &str),
        given: &Spanned<Channels>,
        units: Units,
    ) -> Result<(), Error> {
        let at = |problem: Problem| problem.at(self.place(&given.span()));
        if units == Units::Photometric && matches!(given.get_ref(), Channels::Colour(_)) {
            let what =
                "a photometric scene has one channel, weighed by the eye: give one number, in cd or lm"
                    .to_owned();
            return Err(at(Problem::Light { number, what }));
        }
        check::amount_of_light(number, name, &given.get_ref().colour()).map_err(at)
    }
}
