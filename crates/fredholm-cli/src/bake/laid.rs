//! How baked light lies on the surfaces: in the texels of an atlas, or at vertices.

use crate::output::Output;
use crate::radiosity::accuracy::{Progress, Solved};
use crate::radiosity::timing::{Seconds, timed};
use crate::terminal::bar;
use anyhow::Result;
use radiosity::adaptive::Round;
use radiosity::bake::{Atlas, Lightmap, MOST_LOOKS, VertexLight};
use radiosity::export::{write_exr, write_glb, write_vertex_glb};
use radiosity::polygon::Polygon;
use radiosity::render::Colour;
use radiosity::scene::{Camera, Scene, Units};
use serde::Serialize;
use serde_json::{Value as Json, json};
use std::io::Write;
use std::path::PathBuf;

/// The part of the accuracy that light may be off between vertices: at all of it the eye sees the triangles of a half-shadow.
const BETWEEN: f64 = 0.3;

/// What the light is laid on, in numbers.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "form", rename_all = "kebab-case")]
pub enum Laid {
    /// A texture.
    Texture {
        /// Texels across and down.
        size: usize,
        /// The side of a texel on a surface, in metres.
        texel: f64,
    },
    /// Colours of vertices.
    VertexColours {
        /// How many.
        vertices: usize,
        /// Between them.
        triangles: usize,
        /// What is linear between vertices is off the light by so much: relative, in the mean square.
        vertex_error: f64,
    },
}

impl Laid {
    /// What it is off the light by itself; that of texels is as small as they are.
    pub fn error(&self) -> f64 {
        match self {
            Self::Texture { .. } => 0.0,
            Self::VertexColours { vertex_error, .. } => *vertex_error,
        }
    }
}

/// Light that is laid on the surfaces.
pub enum Light<V> {
    /// In texels.
    Texture(Lightmap<V>),
    /// At vertices.
    Vertices(VertexLight<V>),
}

impl<V: Colour> Light<V> {
    /// Looks at the field in all texels of an atlas, or if there is none at vertices, ever more until it is linear between them.
    pub fn new(
        atlas: Option<Atlas>,
        (scene, polygons): (&Scene<V>, &[Polygon]),
        field: Solved<'_, V>,
        accuracy: f64,
    ) -> Self {
        if let Some(atlas) = atlas {
            let bar = bar("texels", polygons.len() as u64);
            let field = field.for_points(atlas.size * atlas.size);
            let lightmap = Lightmap::new(atlas, &*field, polygons, &|done| bar.set_position(done as u64));
            bar.finish_and_clear();
            return Self::Texture(lightmap);
        }
        let field = field.for_points(MOST_LOOKS);
        let accuracy = BETWEEN * accuracy;
        let progress = Progress::new(accuracy);
        let tell = |patches: usize, error: f64| progress.tell(&Round { patches, links: 0, error });
        let light = VertexLight::new(scene, &*field, polygons, accuracy, &tell);
        progress.finish();
        Self::Vertices(light)
    }

    /// The numbers of it.
    pub fn laid(&self) -> Laid {
        match self {
            Self::Texture(Lightmap { atlas, .. }) => {
                Laid::Texture { size: atlas.size, texel: 1.0 / atlas.density }
            }
            Self::Vertices(light) => {
                let [vertices, triangles] = light.size();
                Laid::VertexColours { vertices, triangles, vertex_error: light.error }
            }
        }
    }

    /// Whether there is none at all.
    pub fn is_dark(&self, scene: &Scene<V>) -> bool {
        let is_zero = |value: &V| value.magnitude() == 0.0;
        match self {
            Self::Texture(lightmap) => lightmap.irradiance.iter().all(is_zero),
            Self::Vertices(light) => light.surfaces.iter().zip(&scene.surfaces).all(|(vertices, surface)| {
                vertices.radiosity.iter().all(|b| is_zero(&(*b - surface.emission)))
            }),
        }
    }

    /// What a number in the file is.
    fn quantity(&self) -> &'static str {
        match self {
            Self::Texture(_) => "radiance that leaves the surface, B/π: emissive texture × emissiveStrength",
            Self::Vertices(_) => {
                "radiance that leaves the surface, B/π: COLOR_0, linear, × extras.radiance_of_1 of the material"
            }
        }
    }

    /// Writes the binary glTF.
    pub fn write_glb(
        &self,
        (scene, camera, units): (&Scene<V>, &Camera, Units),
        (accuracy, error): (f64, f64),
        (output, seconds): (Output, &mut Seconds),
    ) -> Result<PathBuf> {
        let mut extras = json!({
            "quantity": self.quantity(), "unit": units.radiance(), "error": error, "accuracy": accuracy,
            "error_is": "of the radiosity that surfaces reflect, in the mean square over all of them, relative to its own",
        });
        if let Self::Vertices(light) = self {
            extras["vertex_error"] = Json::from(light.error);
        }
        timed(&mut seconds.write, || {
            let mut bytes = Vec::new();
            match self {
                Self::Texture(lightmap) => write_glb(scene, lightmap, camera, &extras, &mut bytes)?,
                Self::Vertices(light) => write_vertex_glb(scene, light, camera, &extras, &mut bytes)?,
            }
            output.write(|out| out.write_all(&bytes))
        })
    }

    /// Writes the lightmap of irradiance, which only a texture has.
    pub fn write_exr(&self, output: Output, units: Units, error: f64) -> Result<Option<PathBuf>> {
        let Self::Texture(lightmap) = self else { return Ok(None) };
        // Headers know no Greek.
        let note = format!(
            "irradiance H in {}, linear, Rec. 709; a surface of reflectance rho adds the radiance rho H/pi; error {:.2} %",
            units.irradiance().replace('²', "^2"),
            100.0 * error
        );
        output.write(|out| write_exr(lightmap, &note, out)).map(Some)
    }
}
