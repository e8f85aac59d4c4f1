//! `[sun]` of a scene file: a direction, and H in W/m² or lx across the beam.

use super::Sun;
use crate::scene::compass::Compass;
use crate::scene::error::{Error, Problem};
use crate::scene::file::{Channels, Source};
use crate::scene::{Units, check};
use fredholm::value::Rgb;
use glam::DVec3;
use serde::Deserialize;
use std::ops::Range;
use toml::Spanned;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct SunEntry {
    direction: Option<Spanned<[f64; 3]>>,
    azimuth: Option<Spanned<f64>>,
    elevation: Option<Spanned<f64>>,
    normal_irradiance: Option<Spanned<Channels>>,
    normal_illuminance: Option<Spanned<f64>>,
}

/// Where a sun is said to be.
pub(super) struct Said<'a> {
    pub direction: Option<&'a Spanned<[f64; 3]>>,
    pub azimuth: Option<&'a Spanned<f64>>,
    pub elevation: Option<&'a Spanned<f64>>,
}

impl Source<'_> {
    /// The sun of a scene.
    pub fn sun(&self, entry: &Spanned<SunEntry>, compass: &Compass, units: Units) -> Result<Sun<Rgb>, Error> {
        let SunEntry { direction, azimuth, elevation, normal_irradiance, normal_illuminance } =
            entry.get_ref();
        let said =
            Said { direction: direction.as_ref(), azimuth: azimuth.as_ref(), elevation: elevation.as_ref() };
        let towards = self.towards_sun(&said, &entry.span(), compass)?;
        let irradiance = self.amount(
            ("normal_irradiance", normal_irradiance.as_ref()),
            ("normal_illuminance", normal_illuminance.as_ref()),
            &entry.span(),
            units,
        )?;
        Ok(Sun { direction: -towards, irradiance })
    }

    /// The unit vector towards the sun, from the way that its light goes, or from two angles in degrees.
    pub(super) fn towards_sun(
        &self,
        said: &Said<'_>,
        span: &Range<usize>,
        compass: &Compass,
    ) -> Result<DVec3, Error> {
        let bad =
            |what: &str, span: &Range<usize>| Err(Problem::Malformed(what.to_owned()).at(self.place(span)));
        match (said.direction, said.azimuth, said.elevation) {
            (Some(given), None, None) => match DVec3::from(*given.get_ref()).try_normalize() {
                Some(direction) => Ok(-direction),
                None => bad(
                    "the direction of the sun has no length; give the way that its light goes",
                    &given.span(),
                ),
            },
            (None, Some(azimuth), Some(elevation)) => {
                if !azimuth.get_ref().is_finite() {
                    return bad("the azimuth of the sun must be a finite number of degrees", &azimuth.span());
                }
                if !(-90.0..=90.0).contains(elevation.get_ref()) {
                    return bad("the elevation of the sun must be from -90 to 90 degrees", &elevation.span());
                }
                Ok(compass.towards(*azimuth.get_ref(), *elevation.get_ref()))
            }
            _ => bad(
                "the sun needs either an `azimuth` and an `elevation`, in degrees, or a `direction`, the way that its light goes",
                span,
            ),
        }
    }

    /// An amount of light that has a name in watts and another in lumens.
    pub fn amount(
        &self,
        (in_watts, watts): (&str, Option<&Spanned<Channels>>),
        (in_lumens, lumens): (&str, Option<&Spanned<f64>>),
        span: &Range<usize>,
        units: Units,
    ) -> Result<Rgb, Error> {
        let bad = |what: String, span: &Range<usize>| Err(Problem::Malformed(what).at(self.place(span)));
        let (name, value, span) = match (units, watts, lumens) {
            (Units::Radiometric, Some(watts), None) => (in_watts, watts.get_ref().colour(), watts.span()),
            (Units::Photometric, None, Some(lumens)) => {
                (in_lumens, Channels::Grey(*lumens.get_ref()).colour(), lumens.span())
            }
            (Units::Radiometric, ..) => {
                let span = lumens.map_or_else(|| span.clone(), Spanned::span);
                return bad(format!("the scene is in watts; give `{in_watts}`"), &span);
            }
            (Units::Photometric, ..) => {
                let span = watts.map_or_else(|| span.clone(), Spanned::span);
                return bad(format!("the scene is photometric; give `{in_lumens}`"), &span);
            }
        };
        match check::first_outside(&value, |c| (0.0..f64::INFINITY).contains(&c)) {
            Some((channel, value)) => bad(
                format!("the {name} is {value} in channel {channel}; it must be finite and not negative"),
                &span,
            ),
            None => Ok(value),
        }
    }
}
