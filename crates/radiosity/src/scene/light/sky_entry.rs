//! `[sky]` of a scene file: a kind, and how bright it is: L of the zenith, or H of the horizontal.

use super::Sky;
use super::sun_entry::Said;
use crate::scene::Units;
use crate::scene::compass::Compass;
use crate::scene::error::{Error, Problem};
use crate::scene::file::{Channels, Source};
use crate::sky::{Dome, Kind, Model};
use fredholm::value::Rgb;
use glam::DVec3;
use serde::Deserialize;
use std::sync::Arc;
use toml::Spanned;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct SkyEntry {
    kind: Spanned<String>,
    #[serde(rename = "type")]
    number: Option<Spanned<i64>>,
    direction: Option<Spanned<[f64; 3]>>,
    azimuth: Option<Spanned<f64>>,
    elevation: Option<Spanned<f64>>,
    zenith_radiance: Option<Spanned<Channels>>,
    zenith_luminance: Option<Spanned<f64>>,
    horizontal_irradiance: Option<Spanned<Channels>>,
    horizontal_illuminance: Option<Spanned<f64>>,
}

impl Source<'_> {
    /// The sky of a scene in which the sun may be in a direction.
    pub fn sky(
        &self,
        entry: &Spanned<SkyEntry>,
        compass: &Compass,
        sun: Option<DVec3>,
        units: Units,
    ) -> Result<Sky<Rgb>, Error> {
        let kind = self.kind_of_sky(entry.get_ref())?;
        let sun = self.sun_of_sky(entry, kind, compass, sun)?;
        let dome = Dome::new(Model::new(kind, compass.up, sun));
        let zenith = self.zenith(entry, &dome, units)?;
        Ok(Sky { zenith, dome: Arc::new(dome) })
    }

    fn kind_of_sky(&self, entry: &SkyEntry) -> Result<Kind, Error> {
        let bad = |what: String, span| Err(Problem::Malformed(what).at(self.place(&span)));
        match (entry.kind.get_ref().as_str(), &entry.number) {
            ("uniform", None) => Ok(Kind::Uniform),
            ("cie-overcast", None) => Ok(Kind::Overcast),
            ("cie", Some(number)) => match usize::try_from(*number.get_ref()).ok().and_then(Kind::general) {
                Some(kind) => Ok(kind),
                None => bad(
                    format!("there is no CIE sky of type {}; they are 1 to 15", number.get_ref()),
                    number.span(),
                ),
            },
            ("cie", None) => {
                bad("a sky of the kind \"cie\" needs a `type` from 1 to 15".to_owned(), entry.kind.span())
            }
            ("uniform" | "cie-overcast", Some(number)) => bad(
                format!("a sky of the kind \"{}\" has no types; leave it out", entry.kind.get_ref()),
                number.span(),
            ),
            (other, _) => bad(
                format!(
                    "there is no sky of the kind \"{other}\"; there are \"uniform\", \"cie-overcast\" and \"cie\""
                ),
                entry.kind.span(),
            ),
        }
    }

    /// The direction towards the sun of a sky: its own, or that of the scene's sun.
    fn sun_of_sky(
        &self,
        entry: &Spanned<SkyEntry>,
        kind: Kind,
        compass: &Compass,
        sun: Option<DVec3>,
    ) -> Result<DVec3, Error> {
        let SkyEntry { direction, azimuth, elevation, .. } = entry.get_ref();
        let says = direction.is_some() || azimuth.is_some() || elevation.is_some();
        let sun = if says {
            let own = Said {
                direction: direction.as_ref(),
                azimuth: azimuth.as_ref(),
                elevation: elevation.as_ref(),
            };
            Some(self.towards_sun(&own, &entry.span(), compass)?)
        } else {
            sun
        };
        let bad = |what: &str| {
            Err(Problem::Malformed(what.to_owned()).at(self.place(&entry.get_ref().kind.span())))
        };
        match sun {
            _ if !kind.needs_sun() => Ok(compass.up),
            Some(sun) if sun.dot(compass.up) < 0.0 => bad(
                "the sun of this sky is below the horizon, where the CIE has none; give it an elevation from 0 on",
            ),
            Some(sun) => Ok(sun),
            None => bad(
                "this sky depends on where the sun is; give it an `azimuth` and an `elevation`, or the scene a [sun]",
            ),
        }
    }

    fn zenith(&self, entry: &Spanned<SkyEntry>, dome: &Dome, units: Units) -> Result<Rgb, Error> {
        let SkyEntry {
            zenith_radiance, zenith_luminance, horizontal_irradiance, horizontal_illuminance, ..
        } = entry.get_ref();
        let by_zenith = zenith_radiance.is_some() || zenith_luminance.is_some();
        let by_horizontal = horizontal_irradiance.is_some() || horizontal_illuminance.is_some();
        if by_zenith == by_horizontal {
            let [zenith, horizontal] = match units {
                Units::Radiometric => ["zenith_radiance", "horizontal_irradiance"],
                Units::Photometric => ["zenith_luminance", "horizontal_illuminance"],
            };
            let what = format!("a sky needs either a `{zenith}` or a `{horizontal}`; give one of them");
            return Err(Problem::Malformed(what).at(self.place(&entry.span())));
        }
        let (watts, lumens) = if by_zenith {
            (("zenith_radiance", zenith_radiance.as_ref()), ("zenith_luminance", zenith_luminance.as_ref()))
        } else {
            (
                ("horizontal_irradiance", horizontal_irradiance.as_ref()),
                ("horizontal_illuminance", horizontal_illuminance.as_ref()),
            )
        };
        let amount = self.amount(watts, lumens, &entry.span(), units)?;
        Ok(if by_zenith { amount } else { amount * (1.0 / dome.horizontal()) })
    }
}
