//! The entries of a thermal scene file, and what is prescribed by them.

use super::super::file::{CameraEntry, Unit};
use super::super::load::SolveOptions;
use crate::thermal::{Condition, temperature as temperature_of};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::ops::Range;
use toml::Spanned;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Entry {
    pub name: Option<String>,
    pub bands: Option<Spanned<Vec<f64>>>,
    pub surroundings: Option<Spanned<f64>>,
    pub enclosure: Option<Spanned<EnclosureEntry>>,
    pub unit: Option<Unit>,
    pub meshes: Option<Spanned<Vec<Spanned<String>>>>,
    #[serde(default)]
    pub materials: BTreeMap<Spanned<String>, Spanned<SurfaceEntry>>,
    pub camera: Option<Spanned<CameraEntry>>,
    #[serde(default)]
    pub solve: SolveOptions,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct EnclosureEntry {
    pub shape: Option<Spanned<String>>,
    pub view_factors: Option<Spanned<Vec<Vec<f64>>>>,
    pub surface: Vec<Spanned<SurfaceEntry>>,
}

/// A material, or a surface of an enclosure, which has a name and an area too.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SurfaceEntry {
    pub name: Option<Spanned<String>>,
    pub area: Option<Spanned<f64>>,
    pub emissivity: Option<Spanned<PerBand>>,
    pub temperature: Option<Spanned<f64>>,
    pub emissive_power: Option<Spanned<f64>>,
    pub heat_flux: Option<Spanned<f64>>,
    pub heat: Option<Spanned<f64>>,
    pub linked: Option<Spanned<String>>,
    pub reflectance: Option<Spanned<toml::Value>>,
    pub radiance: Option<Spanned<toml::Value>>,
    pub emission: Option<Spanned<toml::Value>>,
}

#[derive(Clone, Deserialize)]
#[serde(untagged, expecting = "expected a number, or a list with one for each band")]
pub(super) enum PerBand {
    Grey(f64),
    Bands(Vec<f64>),
}

/// What is prescribed, and where; or what is wrong with it.
pub(super) fn condition(owner: &str, entry: &SurfaceEntry) -> Result<(Condition, Range<usize>), String> {
    let SurfaceEntry { temperature, emissive_power, heat_flux, heat, linked, .. } = entry;
    if let Some(body) = linked {
        if temperature.is_some() || emissive_power.is_some() || heat_flux.is_some() {
            return Err(format!(
                "{owner} is `linked`: its temperature is to be found, and its heat shared; leave out `temperature`, \
                 `emissive_power` and `heat_flux`, or `linked`"
            ));
        }
        let total = heat.as_ref().map_or(0.0, |heat| *heat.get_ref());
        return Ok((Condition::Linked { body: body.get_ref().clone(), heat: total }, body.span()));
    }
    if let Some(power) = emissive_power
        && (*power.get_ref() < 0.0 || power.get_ref().is_nan())
    {
        return Err(format!("the emissive power of {owner} is {} W/m²; σT⁴ is not below 0", power.get_ref()));
    }
    let given = [
        temperature.as_ref().map(|kelvin| (Condition::Temperature(*kelvin.get_ref()), kelvin.span())),
        emissive_power
            .as_ref()
            .map(|power| (Condition::Temperature(temperature_of(*power.get_ref())), power.span())),
        heat_flux.as_ref().map(|flux| (Condition::HeatFlux(*flux.get_ref()), flux.span())),
        heat.as_ref().map(|heat| (Condition::HeatFlux(*heat.get_ref()), heat.span())),
    ];
    let mut given = given.into_iter().flatten();
    match (given.next(), given.next()) {
        (Some(only), None) => Ok(only),
        (None, _) => Err(format!(
            "{owner} has neither a temperature nor a heat; give `temperature` in K, or `heat_flux` in W/m², 0 if it is \
             adiabatic"
        )),
        _ => Err(format!(
            "{owner} has more than one of temperature, emissive_power, heat_flux and heat; each follows from the other: \
             give one of them"
        )),
    }
}
