//! Light as the eye weighs it: one channel, lumens in place of watts.
//!
//! A photometric scene is grey. What the eye makes of a colour depends on its whole spectrum, of which red, green and blue
//! numbers in watts do not tell; so a coloured reflectance or emission is refused there, and not weighted in silence.

use super::error::{Error, Place, Problem};
use super::load::Loaded;
use super::material::{Located, Material};
use super::mesh::Mesh;
use super::{Light, Scene, Surface};
use fredholm::value::{Rgb, Spectrum};
use serde::Deserialize;
use std::collections::BTreeMap;

/// What the light of a scene is measured in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Units {
    /// Watts.
    #[default]
    Radiometric,
    /// Lumens.
    Photometric,
}

impl Units {
    /// The unit of B and of E, what leaves a surface: of the exitance.
    pub fn exitance(self) -> &'static str {
        match self {
            Self::Radiometric => "W/m²",
            Self::Photometric => "lm/m²",
        }
    }

    /// The unit of H, what reaches a surface: of the irradiance, or illuminance.
    pub fn irradiance(self) -> &'static str {
        match self {
            Self::Radiometric => "W/m²",
            Self::Photometric => "lx",
        }
    }

    /// The unit of L = B/π, what a camera or an eye sees: of the radiance, or luminance.
    pub fn radiance(self) -> &'static str {
        match self {
            Self::Radiometric => "W/(m² sr)",
            Self::Photometric => "cd/m²",
        }
    }
}

impl Loaded {
    /// The one channel of a photometric scene: exitances in lm/m².
    pub fn grey(&self) -> Scene<f64> {
        let grey = |colour: Rgb| colour.0[0];
        let surface = |surface: &Surface<Rgb>| Surface {
            name: surface.name.clone(),
            reflectance: grey(surface.reflectance),
            emission: grey(surface.emission),
            polygons: surface.polygons.clone(),
        };
        let Scene { name, surfaces, lights, camera } = &self.scene;
        Scene {
            name: name.clone(),
            surfaces: surfaces.iter().map(surface).collect(),
            lights: lights.iter().map(|light| light.with(grey(light.amount()))).collect(),
            camera: *camera,
        }
    }
}

/// Refuses colours of materials that some face is of, and of lights.
pub(super) fn check_grey(meshes: &[Mesh], overrides: &BTreeMap<String, Material>) -> Result<(), Error> {
    let nothing = Material::default();
    for mesh in meshes {
        if let Some(light) =
            mesh.lights.iter().map(Light::amount).find(|Spectrum([r, g, b])| r != g || g != b)
        {
            let [r, g, b] = light.0;
            let what = format!(
                "a light of the file is the colour [{r}, {g}, {b}], and a photometric scene has one channel, weighed by the eye: \
                 make it white"
            );
            return Err(Problem::Malformed(what).at(Place::file(&mesh.file)));
        }
        for group in &mesh.groups {
            let Some(name) = group.material.as_ref().map(|material| &material.name) else { continue };
            let own = group.paint.as_ref().or_else(|| mesh.materials.get(name)).unwrap_or(&nothing);
            let material = own.overridden_by(overrides.get(name).unwrap_or(&nothing));
            grey(name, "reflectance", material.reflectance.as_ref())?;
            grey(name, "emission", material.emission.as_ref())?;
        }
    }
    Ok(())
}

fn grey(name: &str, what: &str, given: Option<&Located>) -> Result<(), Error> {
    match given {
        Some(Located { value: Spectrum([r, g, b]), place }) if r != g || g != b => {
            let what = format!(
                "the {what} of material `{name}` is a colour, and a photometric scene has one channel, weighed by the eye: \
                 give one number for it"
            );
            Err(Problem::Malformed(what).at(place.clone()))
        }
        _ => Ok(()),
    }
}

/// The exitance in lm/m² or the flux in lm of a material, as its entry gives one of them in this unit.
pub(super) fn check_photometric(name: &str, key: &str, value: f64, place: &Place) -> Result<(), Error> {
    if value >= 0.0 && value.is_finite() {
        return Ok(());
    }
    let what = format!("the {key} of material `{name}` is {value}; it must be finite and not negative");
    Err(Problem::Malformed(what).at(place.clone()))
}
