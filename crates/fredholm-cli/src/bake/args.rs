//! What may be said to `fredholm bake`.

use crate::args::{number, percent, with_extension};
use clap::Args;
use std::path::PathBuf;

/// What stands below the options.
pub const EXAMPLES: &str = "\
The .glb holds the surfaces as they are, and one texture with the radiance that leaves them, B/π, which
each material's emissive strength brings to W/(m² sr), or to cd/m² with --photometric. Viewers show it as
it is: base colours are black, so that lamps of theirs add nothing. An --irradiance map has H itself, linear,
in the same (u, v): multiply by reflectance/π to have the radiance that a lightmap adds.

With --vertex-colours there is no texture: faces are cut until light is linear between vertices to the
accuracy, and COLOR_0, linear, is the radiance B/π over the largest; materials are unlit, and their
extras.radiance_of_1 is the radiance of a colour of 1.

Examples:
  fredholm bake                                       the Cornell box, cornell-box.glb
  fredholm bake room.toml -o room.glb                 to an accuracy of 1 %
  fredholm bake room.obj --accuracy 0.3% --size 2048  finer in light, and in texels
  fredholm bake room.toml --irradiance room.exr       the lightmap alone as well, for an engine
  fredholm bake room.obj --vertex-colours             no texture: light at the vertices of a finer mesh";

/// Options of `fredholm bake`.
#[derive(Debug, Args)]
pub struct Bake {
    /// The scene: .toml, or a mesh in metres (.obj with its .mtl, .glb, .gltf, .stl, .ply); the Cornell box if left out
    pub scene: Option<PathBuf>,

    /// The binary glTF to write [default: the scene's name, .glb]
    #[arg(short, long, value_name = "FILE.glb", value_parser = glb)]
    pub output: Option<PathBuf>,

    /// The irradiance of every texel as well, as OpenEXR
    #[arg(long, value_name = "FILE.exr")]
    pub irradiance: Option<PathBuf>,

    /// Light as colours of vertices, of faces that are cut where it asks for that, in place of a texture
    #[arg(long, conflicts_with_all = ["irradiance", "size"])]
    pub vertex_colours: bool,

    /// The error that the light may have, in the mean square over all surfaces [default: 1%]
    #[arg(long, value_name = "PERCENT", value_parser = percent)]
    pub accuracy: Option<f64>,

    /// Texels across and down
    #[arg(long, value_name = "TEXELS", value_parser = number(16, 8192), default_value = "1024")]
    pub size: usize,

    /// Lumens in place of watts: lx and cd/m² [default: as the scene's `units` say]
    #[arg(long, requires = "scene")]
    pub photometric: bool,

    /// The numbers of the run as JSON; - for the standard output
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,

    /// Threads to work with [default: one per core]
    #[arg(long, value_name = "N", value_parser = number(1, 1024))]
    pub threads: Option<usize>,
}

fn glb(text: &str) -> Result<PathBuf, String> {
    with_extension(text, &["glb"])
}
