//! What is known of a surface: how it emits, and either its temperature or its heat.

use super::Bands;
use super::error::ThermalError;

/// A surface of one temperature or one heat flux, grey in each band, diffuse.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// Its name.
    pub name: String,
    /// The emissivity ε ∈ [0, 1] of each band; the reflectance is 1 − ε.
    pub emissivity: Vec<f64>,
    /// What is prescribed.
    pub condition: Condition,
}

/// What is prescribed of a surface; the other of temperature and heat is found.
#[derive(Clone, Debug, PartialEq)]
pub enum Condition {
    /// The temperature, in K.
    Temperature(f64),
    /// The net heat flux B − H that leaves it everywhere, in W/m²; 0 of what is adiabatic, which re-radiates all.
    HeatFlux(f64),
    /// One temperature, not known, with all surfaces of the same body, such as the two sides of a shield. Their net heats
    /// add up to those given: 0 of a body that floats.
    Linked {
        /// The name of the body.
        body: String,
        /// The heat in W that this surface's part of the body is fed from elsewhere.
        heat: f64,
    },
}

impl Surface {
    /// A grey surface of a temperature in K.
    pub fn at(name: &str, temperature: f64, emissivity: f64) -> Self {
        let condition = Condition::Temperature(temperature);
        Self { name: name.to_owned(), emissivity: vec![emissivity], condition }
    }

    /// A grey surface that sends out a net heat flux in W/m²; 0 if it is adiabatic.
    pub fn heated(name: &str, flux: f64, emissivity: f64) -> Self {
        let condition = Condition::HeatFlux(flux);
        Self { name: name.to_owned(), emissivity: vec![emissivity], condition }
    }

    /// A grey surface of a floating body.
    pub fn floating(name: &str, body: &str, emissivity: f64) -> Self {
        let condition = Condition::Linked { body: body.to_owned(), heat: 0.0 };
        Self { name: name.to_owned(), emissivity: vec![emissivity], condition }
    }

    /// Checks it: as many emissivities as bands, in [0, 1]; a temperature that is none below 0; a finite heat.
    pub fn check(&self, bands: &Bands) -> Result<(), ThermalError> {
        let (name, wrong) =
            (|| self.name.clone(), self.emissivity.iter().find(|e| !(0.0..=1.0).contains(*e)));
        if let Some(&value) = wrong {
            return Err(ThermalError::Emissivity { surface: name(), value });
        }
        if self.emissivity.len() != bands.count() {
            let (given, bands) = (self.emissivity.len(), bands.count());
            return Err(ThermalError::EmissivityCount { surface: name(), given, bands });
        }
        match self.condition {
            Condition::Temperature(value) if !(value >= 0.0 && value.is_finite()) => {
                Err(ThermalError::Temperature { surface: name(), value })
            }
            Condition::HeatFlux(value) | Condition::Linked { heat: value, .. } if !value.is_finite() => {
                Err(ThermalError::Heat { surface: name(), value })
            }
            Condition::HeatFlux(value) if value != 0.0 && self.is_mirror() => {
                Err(ThermalError::HeatedMirror { surface: name(), value })
            }
            _ => Ok(()),
        }
    }

    /// Whether it neither emits nor absorbs, in any band.
    pub fn is_mirror(&self) -> bool {
        self.emissivity.iter().all(|e| *e == 0.0)
    }
}
