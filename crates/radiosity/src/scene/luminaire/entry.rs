//! `[[luminaire]]` of a scene file: a photometric file, and where it hangs.

use super::{Aimed, read};
use crate::scene::compass::Compass;
use crate::scene::error::{Error, Problem, Warning};
use crate::scene::file::{Channels, Source};
use crate::scene::{Distribution, PointLight, Units, check};
use fredholm::value::{Rgb, Spectrum};
use glam::DVec3;
use serde::Deserialize;
use std::sync::Arc;
use toml::Spanned;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct LuminaireEntry {
    file: Spanned<String>,
    position: Spanned<[f64; 3]>,
    aim: Option<Spanned<[f64; 3]>>,
    turn: Option<Spanned<f64>>,
    dimming: Option<Spanned<f64>>,
    flux: Option<Spanned<Channels>>,
}

impl Source<'_> {
    /// The luminaires of these entries, and what is to be told of their files; lengths are so many `metres`.
    pub fn luminaires(
        &self,
        entries: &[LuminaireEntry],
        metres: f64,
        compass: &Compass,
        units: Units,
    ) -> Result<(Vec<PointLight<Rgb>>, Vec<Warning>), Error> {
        let mut told = Vec::new();
        let mut luminaires = Vec::new();
        for entry in entries {
            luminaires.push(self.luminaire(entry, metres, compass, units, &mut told)?);
        }
        Ok((luminaires, told))
    }

    fn luminaire(
        &self,
        entry: &LuminaireEntry,
        metres: f64,
        compass: &Compass,
        units: Units,
        told: &mut Vec<Warning>,
    ) -> Result<PointLight<Rgb>, Error> {
        let bad = |what: &str, span: std::ops::Range<usize>| {
            Err(Problem::Malformed(what.to_owned()).at(self.place(&span)))
        };
        let name = entry.file.get_ref();
        let (web, warnings) = read(&self.file.with_file_name(name), &self.place(&entry.file.span()))?;
        // One file may hang in many places.
        told.extend(warnings.into_iter().filter(|warning| !told.contains(warning)).collect::<Vec<_>>());
        let position = DVec3::from(*entry.position.get_ref()) * metres;
        if !position.is_finite() {
            return bad("the position of the luminaire must be three finite numbers", entry.position.span());
        }
        let aim = match &entry.aim {
            None => -compass.up,
            Some(aim) => match DVec3::from(*aim.get_ref()).try_normalize() {
                Some(aim) => aim,
                None => {
                    return bad(
                        "the aim of the luminaire has no length; give the way that it looks",
                        aim.span(),
                    );
                }
            },
        };
        let turn = entry.turn.as_ref().map_or(0.0, |turn| *turn.get_ref());
        if let Some(turn) = entry.turn.as_ref().filter(|turn| !turn.get_ref().is_finite()) {
            return bad("the turn of the luminaire must be a finite number of degrees", turn.span());
        }
        let intensity = match (&entry.flux, &entry.dimming) {
            (Some(_), Some(dimming)) => {
                return bad(
                    "`flux` and `dimming` both say how bright it is; give one of them",
                    dimming.span(),
                );
            }
            (Some(flux), None) => {
                self.check_luminaire_flux(flux, units)?;
                flux.get_ref().colour() * (web.largest() / web.flux())
            }
            (None, _) if units == Units::Radiometric => {
                return bad(
                    "a photometric file is in lumens, and the scene in watts; give the luminaire a `flux` in W, or write \
                     `units = \"photometric\"` above all tables",
                    entry.file.span(),
                );
            }
            (None, Some(dimming)) if !(0.0..f64::INFINITY).contains(dimming.get_ref()) => {
                return bad(
                    "the dimming must be a finite number, 1 for all of the light, and not negative",
                    dimming.span(),
                );
            }
            (None, dimming) => {
                Spectrum([web.largest() * dimming.as_ref().map_or(1.0, |dimming| *dimming.get_ref()); 3])
            }
        };
        let axes = [compass.north.cross(compass.up), compass.north, compass.up];
        let aimed = Aimed::new(Arc::new(web.named(name)), axes, turn.to_radians(), aim);
        Ok(PointLight { position, intensity, distribution: Distribution::Measured(aimed) })
    }

    fn check_luminaire_flux(&self, flux: &Spanned<Channels>, units: Units) -> Result<(), Error> {
        let bad = |what: String| Err(Problem::Malformed(what).at(self.place(&flux.span())));
        if units == Units::Photometric && matches!(flux.get_ref(), Channels::Colour(_)) {
            return bad(
                "a photometric scene has one channel, weighed by the eye: give one number, in lm".to_owned()
            );
        }
        match check::first_outside(&flux.get_ref().colour(), |c| (0.0..f64::INFINITY).contains(&c)) {
            Some((channel, value)) => bad(format!(
                "the flux of the luminaire is {value} in channel {channel}; it must be finite and not negative"
            )),
            None => Ok(()),
        }
    }
}
