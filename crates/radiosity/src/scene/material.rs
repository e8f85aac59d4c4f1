//! What files say of a material, and the ρ and E = π L that come of it.

use super::check;
use super::error::{Error, Place};
use fredholm::value::{Rgb, Value};

/// A colour, and where it stands.
#[derive(Clone, Debug)]
pub(super) struct Located {
    pub value: Rgb,
    pub place: Place,
}

/// A material as far as a file tells.
#[derive(Clone, Debug, Default)]
pub(super) struct Material {
    pub reflectance: Option<Located>,
    /// The exitance, in W/m².
    pub emission: Option<Located>,
    /// In its place the power of each surface of the material, here of the area 1.
    pub power: Option<Located>,
}

impl Material {
    /// What `over` says, and this where `over` is silent.
    pub fn overridden_by(&self, over: &Self) -> Self {
        Self {
            reflectance: over.reflectance.clone().or_else(|| self.reflectance.clone()),
            emission: match over.power {
                Some(_) => None,
                None => over.emission.clone().or_else(|| self.emission.clone()),
            },
            power: over.power.clone(),
        }
    }

    /// Reflectance and emission of a surface of some area. Without an emission given it is 0; without a reflectance given
    /// that is 0 for what emits, as of a lamp, and ½ for what does not.
    pub fn resolve(&self, name: &str, area: f64) -> Result<(Rgb, Rgb), Error> {
        let owner = format!("material `{name}`");
        let spread =
            |power: &Located| Located { value: power.value * (1.0 / area), place: power.place.clone() };
        let emission = match &self.emission.clone().or_else(|| self.power.as_ref().map(spread)) {
            Some(Located { value, place }) => {
                check::emission(&owner, value).map_err(|problem| problem.at(place.clone()))?;
                *value
            }
            None => Rgb::splat(0.0),
        };
        let reflectance = match &self.reflectance {
            Some(Located { value, place }) => {
                check::reflectance(&owner, value).map_err(|problem| problem.at(place.clone()))?;
                *value
            }
            None => Rgb::splat(if emission.magnitude() > 0.0 { 0.0 } else { 0.5 }),
        };
        Ok((reflectance, emission))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn given(number: f64) -> Option<Located> {
        Some(Located { value: Rgb::splat(number), place: Place::file(Path::new("a.mtl")) })
    }

    #[test]
    fn a_silent_material_is_grey_and_a_silent_lamp_black() {
        let resolved = |reflectance, emission| {
            Material { reflectance, emission, power: None }.resolve("m", 1.0).unwrap()
        };
        assert_eq!(resolved(None, None), (Rgb::splat(0.5), Rgb::splat(0.0)));
        assert_eq!(resolved(None, given(0.0)), (Rgb::splat(0.5), Rgb::splat(0.0)));
        assert_eq!(resolved(None, given(2.0)), (Rgb::splat(0.0), Rgb::splat(2.0)));
        assert_eq!(resolved(given(0.3), given(2.0)), (Rgb::splat(0.3), Rgb::splat(2.0)));
    }

    #[test]
    fn an_override_leaves_alone_what_it_does_not_name() {
        let mesh = Material { reflectance: given(0.3), emission: given(1.0), power: None };
        let over = Material { reflectance: given(0.6), emission: None, power: None };
        assert_eq!(mesh.overridden_by(&over).resolve("m", 1.0).unwrap(), (Rgb::splat(0.6), Rgb::splat(1.0)));
    }

    #[test]
    fn a_power_is_spread_over_the_area_and_goes_before_the_meshs_emission() {
        let mesh = Material { reflectance: given(0.3), emission: given(1.0), power: None };
        let over = Material { reflectance: None, emission: None, power: given(10.0) };
        assert_eq!(mesh.overridden_by(&over).resolve("m", 4.0).unwrap(), (Rgb::splat(0.3), Rgb::splat(2.5)));
    }
}
