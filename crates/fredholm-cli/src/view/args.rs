//! What may be said to `fredholm view`.

use crate::args::{at_least_one, number, positive};
use crate::radiosity::args::{Bands, Method, Solver, Space};
use clap::Args;
use std::path::PathBuf;

/// What stands below the options.
pub const EXAMPLES: &str = "\
The page is served to this machine alone, at the address that is printed, until Ctrl-C. Each window has
a solver of its own, which can be paused, stepped, scrubbed back, raced against another and restarted
with another method; lamps are dimmed and materials changed while one looks. Nothing is loaded from the network.

Examples:
  fredholm view                                       the Cornell box
  fredholm view room.toml --patch-size 0.1            a scene of yours, in patches of 10 cm
  fredholm view room.obj --solver gauss-seidel        gathering, a sweep a second
  fredholm view room.obj --no-open --port 8000        the address alone, for a browser of your choice
  fredholm radiosity room.toml --html room.html       the same page as a file, with its frames, to be sent";

/// Options of `fredholm view`. What is `None` is left to the scene file, and then to a default.
#[derive(Debug, Args)]
pub struct View {
    /// The scene: .toml, or a mesh in metres (.obj with its .mtl, .glb, .gltf, .stl, .ply); the Cornell box if left out
    #[arg(help_heading = "Scene")]
    pub scene: Option<PathBuf>,

    /// Lumens in place of watts: lx and cd/m² [default: as the scene's `units` say]
    #[arg(long, requires = "scene", help_heading = "Scene")]
    pub photometric: bool,

    /// Red, green and blue are what windows solve; all bands are refused with what to do instead
    #[arg(long, value_enum, default_value_t = Bands::Rgb, hide = true)]
    pub bands: Bands,

    /// The longest that an edge of a patch may be, in metres
    #[arg(long, value_name = "METRES", value_parser = positive, help_heading = "Scene")]
    pub patch_size: Option<f64>,

    /// About how many patches to make, instead of their size [default: 3000]
    #[arg(
        long,
        value_name = "N",
        value_parser = at_least_one,
        conflicts_with = "patch_size",
        help_heading = "Scene"
    )]
    pub patch_count: Option<usize>,

    /// How the equation becomes numbers at first [default: galerkin]
    #[arg(long, value_enum, help_heading = "Equation")]
    pub method: Option<Method>,

    /// What light is on each patch at first: what is shown is its mean
    #[arg(long, value_enum, default_value_t = Space::P0, help_heading = "Equation")]
    pub space: Space,

    /// How the numbers are solved for at first [default: southwell]
    #[arg(long, value_enum, help_heading = "Equation")]
    pub solver: Option<Solver>,

    /// The standard error that the form factors of a patch may have in sum [default: 1e-3]
    #[arg(long, value_name = "ERROR", value_parser = positive, help_heading = "Equation")]
    pub factor_accuracy: Option<f64>,

    /// The residual at which to stop, relative to the brightest emission [default: 1e-6]
    #[arg(long, value_name = "RESIDUAL", value_parser = positive, help_heading = "Equation")]
    pub tolerance: Option<f64>,

    /// Threads to work with [default: one per core]
    #[arg(long, value_name = "N", value_parser = number(1, 1024), help_heading = "Equation")]
    pub threads: Option<usize>,

    /// The port of 127.0.0.1 to listen at; 0 takes any that is free [default: 8731, or any if that is taken]
    #[arg(long, value_name = "PORT", help_heading = "Server")]
    pub port: Option<u16>,

    /// Do not open a browser
    #[arg(long, help_heading = "Server")]
    pub no_open: bool,
}
