//! `[[light]]` of a scene file: a point, and I in W/sr or cd, or Φ in W or lm.

use super::error::{Error, Problem};
use super::file::{Channels, Source};
use super::{PointLight, Units, check};
use fredholm::value::Rgb;
use glam::DVec3;
use serde::Deserialize;
use toml::Spanned;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LightEntry {
    position: Spanned<[f64; 3]>,
    intensity: Option<Spanned<Channels>>,
    flux: Option<Spanned<Channels>>,
    direction: Option<Spanned<[f64; 3]>>,
}

impl Source<'_> {
    /// The lights of these entries; lengths are so many `metres`.
    pub fn lights(
        &self,
        entries: &[LightEntry],
        metres: f64,
        units: Units,
    ) -> Result<Vec<PointLight<Rgb>>, Error> {
        (1..).zip(entries).map(|(number, entry)| self.light(number, entry, metres, units)).collect()
    }

    fn light(
        &self,
        number: usize,
        entry: &LightEntry,
        metres: f64,
        units: Units,
    ) -> Result<PointLight<Rgb>, Error> {
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
        if units == Units::Photometric && matches!(given.get_ref(), Channels::Colour(_)) {
            let what =
                "a photometric scene has one channel, weighed by the eye: give one number, in cd or lm";
            return bad(what, self.place(&given.span()));
        }
        check::amount_of_light(number, name, &given.get_ref().colour())
            .map_err(|problem| problem.at(self.place(&given.span())))?;
        let mut light = PointLight {
            position: DVec3::from(*entry.position.get_ref()) * metres,
            intensity: given.get_ref().colour(),
            // Zero and NaN stay, for the check to see.
            direction: entry.direction.as_ref().map(|direction| {
                let direction = DVec3::from(*direction.get_ref());
                direction.try_normalize().unwrap_or(DVec3::ZERO)
            }),
        };
        if name == "flux" {
            light.intensity = light.intensity * (1.0 / light.flux_of_unit());
        }
        check::light(number, &light).map_err(|problem| {
            let direction = entry.direction.as_ref().filter(|_| light.position.is_finite());
            problem.at(self.place(&direction.map_or_else(|| entry.position.span(), Spanned::span)))
        })?;
        Ok(light)
    }
}
