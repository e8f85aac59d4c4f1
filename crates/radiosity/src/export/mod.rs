//! The solved field as a file: a row per patch, with all that the equation knows of it. View factors are written by
//! [`factors`].
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

mod csv;
pub mod factors;
mod npz;

pub use csv::write_csv;
pub use npz::write_npz;

use crate::patches::Patches;
use crate::scene::Scene;

/// A solved scene: what is written.
#[derive(Clone, Copy, Debug)]
pub struct Field<'a, V> {
    /// The scene, which has the names of the surfaces.
    pub scene: &'a Scene<V>,
    /// Its patches.
    pub patches: &'a Patches<V>,
    /// B of each patch, in W/m².
    pub radiosity: &'a [V],
    /// H of each patch, in W/m².
    pub irradiance: &'a [V],
}

impl<'a, V> Field<'a, V> {
    /// The quantities that have channels, by name.
    fn by_channel(&self) -> [(&'static str, &'a [V]); 4] {
        [
            ("emission", &self.patches.emission),
            ("reflectance", &self.patches.reflectance),
            ("radiosity", self.radiosity),
            ("irradiance", self.irradiance),
        ]
    }
}

#[cfg(test)]
mod tests;
