//! The solved field as a file: a row per patch, with all that the equation knows of it. View factors are written by
//! [`factors`]; baked light as binary glTF ([`write_glb`], [`write_vertex_glb`]) and OpenEXR ([`write_exr`]),
//! pictures as OpenEXR ([`write_exr_picture`]).
//!
//! | column | unit | |
//! |---|---|---|
//! | centre | m | the centre of mass |
//! | normal | 1 | of unit length, on the front |
//! | area | m² | |
//! | emission | W/m² | E, the exitance, by channel |
//! | reflectance | 1 | ρ, by channel |
//! | radiosity | W/m² | B, by channel |
//! | irradiance | W/m² | H, by channel |
//! | surface | | which surface of the scene the patch lies on |
//!
//! Photometric scenes have `emission_lm_m2`, `reflectance`, `luminous_exitance_lm_m2`, `illuminance_lx` and
//! `luminance_cd_m2` in place of these four, thermal ones `temperature_K`, `radiosity_W_m2`, `irradiance_W_m2` and
//! `heat_flux_W_m2`.

mod csv;
mod exr;
pub mod factors;
mod glb;
mod npz;
mod vtu;

pub use csv::write_csv;
pub use exr::{write_exr, write_exr_picture};
pub use glb::{write_glb, write_vertex_glb};
pub use npz::write_npz;
pub use vtu::write_vtu;

use crate::patches::Patches;
use crate::scene::{Scene, Units};
use crate::thermal::State;
use fredholm::value::Value;
use std::borrow::Cow;
use std::f64::consts::FRAC_1_PI;

/// A solved scene: what is written.
#[derive(Clone, Debug)]
pub struct Field<'a, V: Value> {
    /// The scene, which has the names of the surfaces.
    pub scene: &'a Scene<V>,
    /// Its patches.
    pub patches: &'a Patches<V>,
    /// The quantities that have channels, by name.
    columns: Vec<(&'static str, Cow<'a, [V]>)>,
}

impl<'a, V: Value> Field<'a, V> {
    /// Light: B and H of each patch, in W/m², or in lm/m² and lx.
    pub fn light(
        scene: &'a Scene<V>,
        patches: &'a Patches<V>,
        (radiosity, irradiance): (&'a [V], &'a [V]),
        units: Units,
    ) -> Self {
        let Patches { emission, reflectance, .. } = patches;
        let columns = match units {
            Units::Radiometric => vec![
                ("emission", emission.into()),
                ("reflectance", reflectance.into()),
                ("radiosity", radiosity.into()),
                ("irradiance", irradiance.into()),
            ],
            Units::Photometric => vec![
                ("emission_lm_m2", emission.into()),
                ("reflectance", reflectance.into()),
                ("luminous_exitance_lm_m2", radiosity.into()),
                ("illuminance_lx", irradiance.into()),
                ("luminance_cd_m2", radiosity.iter().map(|b| *b * FRAC_1_PI).collect()),
            ],
        };
        Self { scene, patches, columns }
    }
}

impl<'a> Field<'a, f64> {
    /// Heat: the state of each patch. A patch without a temperature has NaN for one.
    pub fn heat(scene: &'a Scene<f64>, patches: &'a Patches<f64>, states: &[State]) -> Self {
        let column = |of: fn(&State) -> f64| states.iter().map(of).collect();
        let columns = vec![
            ("temperature_K", column(|state| state.temperature.unwrap_or(f64::NAN))),
            ("radiosity_W_m2", column(|state| state.radiosity)),
            ("irradiance_W_m2", column(|state| state.irradiance)),
            ("heat_flux_W_m2", column(|state| state.heat_flux)),
        ];
        Self { scene, patches, columns }
    }
}

#[cfg(test)]
mod tests;
