//! What may be said to `fredholm radiosity`.

use crate::args::{at_least_one, number, percent, positive, with_extension};
use clap::{Args, ValueEnum};
use radiosity::elements::Degree;
use radiosity::solve;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// What stands below the options.
pub const EXAMPLES: &str = "\
A face has a front, from which its corners run counter-clockwise; it emits and reflects from there
and blocks light from both sides. In an MTL file Kd is the reflectance and Ke the radiance emitted,
in W/(m² sr), so that the surface sends out π Ke W/m². A scene file, of which only unit and meshes
must be there:

  unit = \"mm\"                          # of the meshes and of all lengths below
  meshes = [\"room.obj\"]
  [materials.lamp]                     # as named by usemtl
  radiance = [30, 28, 20]              # or emission, in W/m²; reflectance is a number or three
  [[light]]                            # a point light; as many as there are
  position = [4000, 2500, 2400]
  intensity = 20                       # W/sr, or three; or flux, in W
  direction = [0, 0, -1]               # if it is diffuse, I cosθ; else alike in all directions
  cone = [20, 35]                      # a spot: degrees from its axis, whole up to the first
  [[luminaire]]                        # IES LM-63 or EULUMDAT; also aim, turn, dimming or flux
  file = \"downlight.ies\"
  position = [2200, 1900, 2750]
  [sun]                                # or direction, the way that its light goes
  azimuth = 205                        # degrees clockwise from north, y
  elevation = 42
  normal_irradiance = 800              # W/m² across the beam, or three
  [sky]                                # uniform, cie-overcast, or cie with a type from 1 to 15
  kind = \"cie-overcast\"
  horizontal_irradiance = 100          # W/m² of the sky alone; or zenith_radiance, in W/(m² sr)
  [camera]                             # found by itself if left out
  position = [8500, 500, 1700]
  target = [2200, 4600, 1600]
  [solve]                              # accuracy = \"1%\"; or patch_size, method …
  patch_size = 250

\
With --thermal materials have an emissivity and a temperature in K or a net heat_flux in W/m², and
the file may have bands (limits in µm), surroundings (K), or in place of meshes an enclosure whose
view factors are known. Here a shield floats between two plates:

  [enclosure]
  shape = \"plates\"                   # in pairs; or \"nested\", or view_factors = [[…], …] and areas
  surface = [
    { name = \"hot\", emissivity = 0.8, temperature = 500 },
    { name = \"shield, hot side\", emissivity = 0.05, linked = \"shield\" },
    { name = \"shield, cold side\", emissivity = 0.05, linked = \"shield\" },
    { name = \"cold\", emissivity = 0.8, temperature = 300 },
  ]

With units = \"photometric\" materials have a luminance in cd/m², a luminous_exitance in lm/m² or a
luminous_flux in lm, lights an intensity in cd or a flux in lm, the sun a normal_illuminance in lx,
the sky a horizontal_illuminance in lx or a zenith_luminance in cd/m², and all is grey.

\
Examples:
  fredholm radiosity                                  the Cornell box, as cornell-box.png
  fredholm radiosity room.toml --patch-size 0.1       a scene of yours, in patches of 10 cm
  fredholm radiosity room.toml --accuracy 1%          all the rest is found for you
  fredholm radiosity --space p1 --patch-count 1000    linear on each patch: fewer of them do
  fredholm radiosity --false-colour -o map.png        radiosity in W/m² as a map
  fredholm radiosity oven.toml --thermal              temperatures and heat fluxes, with their errors
  fredholm radiosity office.toml --map illuminance    lux as a map, of a photometric scene
  fredholm radiosity --html box.html                  the light while it converges, as one page
  fredholm radiosity --json - | jq .closure_defect    the numbers alone
  fredholm radiosity --solver southwell --ambient --frames shots    the light, shot by shot

Exit codes: 0 solved; 1 an error; 2 a mistake on the command line; 3 all is written, but the
residual did not reach the tolerance within the iterations; 4 no answer, or more than one (--thermal);
130 interrupted.";

/// What says how to find the answer, and has no place where only its error is asked for.
const WAYS: [&str; 14] = [
    "thermal",
    "patch_size",
    "patch_count",
    "method",
    "space",
    "solver",
    "operator",
    "ambient",
    "factor_accuracy",
    "tolerance",
    "iterations",
    "frames",
    "html",
    "gather",
];

/// Options of `fredholm radiosity`. What is `None` is left to the scene file, and then to a default.
#[derive(Debug, Args)]
pub struct Radiosity {
    /// The scene: .toml, or a mesh in metres (.obj with its .mtl, .glb, .gltf …); the Cornell box if left out
    #[arg(help_heading = "Scene")]
    pub scene: Option<PathBuf>,

    /// The channels of light; `spectral` is for the Cornell box
    #[arg(long, value_enum, default_value_t = Bands::Rgb, help_heading = "Scene")]
    pub bands: Bands,

    /// Heat in place of light: temperatures or heat fluxes in, heat fluxes and temperatures out
    #[arg(
        long,
        requires = "scene",
        conflicts_with_all = ["bands", "photometric", "method", "solver", "operator", "ambient", "frames", "html", "gather"],
        help_heading = "Scene"
    )]
    pub thermal: bool,

    /// Lumens in place of watts: lx and cd/m² out [default: as the scene's `units` say]
    #[arg(long, requires = "scene", conflicts_with = "bands", help_heading = "Scene")]
    pub photometric: bool,

    /// The longest that an edge of a patch may be, in metres
    #[arg(long, value_name = "METRES", value_parser = positive, help_heading = "Scene")]
    pub patch_size: Option<f64>,

    /// About how many patches to make, instead of their size [default: 5000]
    #[arg(
        long,
        value_name = "N",
        value_parser = at_least_one,
        conflicts_with = "patch_size",
        help_heading = "Scene"
    )]
    pub patch_count: Option<usize>,

    /// How the equation becomes numbers [default: galerkin]
    #[arg(long, value_enum, help_heading = "Equation")]
    pub method: Option<Method>,

    /// What light is on each patch: a constant, or a polynomial with coefficients of its own
    #[arg(long, value_enum, default_value_t = Space::P0, help_heading = "Equation")]
    pub space: Space,

    /// How the numbers are solved for [default: gauss-seidel; gmres for the hierarchical operator]
    #[arg(long, value_enum, help_heading = "Equation")]
    pub solver: Option<Solver>,

    /// How form factors are kept [default: dense; on-the-fly for southwell; hierarchical from 10 000 patches or 1000 faces on]
    #[arg(long, value_enum, help_heading = "Equation")]
    pub operator: Option<Operator>,

    /// Add the ambient estimate of the light still to be shot to the frames of the southwell solver
    #[arg(long, requires = "frames", help_heading = "Equation")]
    pub ambient: bool,

    /// The error that the light may have, such as 1%: mesh, form factors and iterations are found for it
    #[arg(
        long,
        value_name = "PERCENT",
        value_parser = percent,
        conflicts_with_all = WAYS,
        help_heading = "Equation"
    )]
    pub accuracy: Option<f64>,

    /// The standard error that the form factors of a patch may have in sum [default: 1e-3]
    #[arg(long, value_name = "ERROR", value_parser = positive, help_heading = "Equation")]
    pub factor_accuracy: Option<f64>,

    /// The residual at which to stop, relative to the brightest emission [default: 1e-6]
    #[arg(long, value_name = "RESIDUAL", value_parser = positive, help_heading = "Equation")]
    pub tolerance: Option<f64>,

    /// The most iterations [default: 1000; for southwell, 1000 per patch]
    #[arg(long, value_name = "N", value_parser = at_least_one, help_heading = "Equation")]
    pub iterations: Option<usize>,

    /// Where to keep the links that are found if the run is interrupted with Ctrl-C before it is solved (hierarchical operator)
    #[arg(long, value_name = "FILE", conflicts_with_all = ["thermal", "accuracy"], help_heading = "Equation")]
    pub checkpoint: Option<PathBuf>,

    /// Go on from a checkpoint, with the same scene, patches and --factor-accuracy
    #[arg(long, value_name = "FILE", conflicts_with_all = ["thermal", "accuracy"], help_heading = "Equation")]
    pub resume: Option<PathBuf>,

    /// Threads to work with [default: one per core]
    #[arg(long, value_name = "N", value_parser = number(1, 1024), help_heading = "Equation")]
    pub threads: Option<usize>,

    /// Show radiosity as a colour, with a scale that says which
    #[arg(long, alias = "false-color", help_heading = "Picture")]
    pub false_colour: bool,

    /// What to show as a colour, patch by patch, in place of a picture [default with --thermal: temperature]
    #[arg(long, value_enum, value_name = "QUANTITY", help_heading = "Picture")]
    pub map: Option<Quantity>,

    /// Draw every polygon flat, also where the mesh has the normals of a curved surface
    #[arg(long, conflicts_with = "thermal", help_heading = "Picture")]
    pub flat: bool,

    /// Pixels across and down
    #[arg(long, value_name = "WxH", value_parser = size, default_value = "640x640", help_heading = "Picture")]
    pub size: Size,

    /// Rays per pixel that smooth the edges
    #[arg(
        long,
        value_name = "K",
        value_parser = number(1, 4096),
        default_value = "9",
        help_heading = "Picture"
    )]
    pub samples: usize,

    /// Rays per pixel that gather the light of other surfaces
    #[arg(
        long,
        value_name = "N",
        value_parser = number(1, 1_000_000),
        default_value = "64",
        help_heading = "Picture"
    )]
    pub gather: usize,

    /// The final picture [default: the scene's name, if no other output is asked for]
    #[arg(short, long, value_name = "FILE.png", value_parser = png, help_heading = "Output")]
    pub output: Option<PathBuf>,

    /// A picture of the patches after each iteration, as 00001.png … in this folder
    #[arg(long, value_name = "DIR", help_heading = "Output")]
    pub frames: Option<PathBuf>,

    /// Iterations from one frame to the next [default: 1; for southwell, 100 shots]
    #[arg(
        long,
        value_name = "K",
        value_parser = at_least_one,
        requires = "frames",
        help_heading = "Output"
    )]
    pub every: Option<usize>,

    /// How the light converges, as one page for any browser: nothing is loaded, and nothing need be installed
    #[arg(long, value_name = "FILE.html", value_parser = html, help_heading = "Output")]
    pub html: Option<PathBuf>,

    /// The numbers of the run as JSON; `-` writes them alone to the standard output
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub json: Option<PathBuf>,

    /// Who gathers from what, as a picture of the links (hierarchical operator)
    #[arg(
        long,
        value_name = "FILE.svg",
        value_parser = svg,
        conflicts_with_all = ["thermal", "accuracy"],
        help_heading = "Output"
    )]
    pub links: Option<PathBuf>,

    /// What is known of each patch, as a table or as NumPy arrays
    #[arg(long, value_name = "FILE.csv|.npz|.vtu", value_parser = patches, help_heading = "Output")]
    pub patches: Option<PathBuf>,
}

impl Radiosity {
    /// Whether the command line says how to find the answer, so that a scene file's accuracy is not meant.
    pub fn has_ways(&self) -> bool {
        self.patch_size.is_some()
            || self.patch_count.is_some()
            || self.method.is_some()
            || self.space != Space::P0
            || self.solver.is_some()
            || self.operator.is_some()
            || self.checkpoint.is_some()
            || self.resume.is_some()
            || self.links.is_some()
            || self.factor_accuracy.is_some()
            || self.tolerance.is_some()
            || self.iterations.is_some()
            || self.frames.is_some()
            || self.html.is_some()
    }
}

/// A number of every patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Quantity {
    /// With --thermal: the temperature, in K
    Temperature,
    /// With --thermal: the net heat flux, in W/m²
    HeatFlux,
    /// With --photometric: what reaches a patch, in lx
    Illuminance,
    /// With --photometric: how bright a patch is, in cd/m²
    Luminance,
}

/// The channels of light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Bands {
    /// Red, green and blue
    Rgb,
    /// The 76 measured bands of wavelength, with one matrix for all of them
    Spectral,
}

/// [`solve::Method`], with words for the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// Patch to patch: means over patches, orthogonal projection
    Galerkin,
    /// Point to patch: exact at the centres of patches, interpolation
    Collocation,
    /// Point to point: the kernel at the centres, with the areas as a quadrature
    Nystrom,
}

/// [`Degree`], with words for the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Space {
    /// Constant
    P0,
    /// Linear on triangles (P1), bilinear on quadrilaterals (Q1)
    P1,
    /// Quadratic on triangles (P2), biquadratic on quadrilaterals (Q2)
    P2,
}

impl Space {
    /// The degree of the polynomials, where they are more than constants.
    pub fn degree(self) -> Option<Degree> {
        match self {
            Self::P0 => None,
            Self::P1 => Some(Degree::Linear),
            Self::P2 => Some(Degree::Quadratic),
        }
    }
}

/// [`solve::Storage`], with words for the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Operator {
    /// All of them, as a matrix: memory and time grow with the square of the patches
    Dense,
    /// None: they are computed whenever they are asked for
    OnTheFly,
    /// From patches to clusters of others, as large as the error allows: for very many patches
    Hierarchical,
}

impl From<Operator> for solve::Storage {
    fn from(operator: Operator) -> Self {
        match operator {
            Operator::Dense => Self::Dense,
            Operator::OnTheFly => Self::OnTheFly,
            Operator::Hierarchical => Self::Hierarchical,
        }
    }
}

/// [`solve::Solver`], with words for the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Solver {
    /// Classical radiosity: each patch in turn gathers, by rows
    GaussSeidel,
    /// Progressive radiosity: the brightest patch shoots, by columns that are not stored
    Southwell,
    /// All patches gather at once
    Jacobi,
    /// Successive approximations: each iteration is one bounce of light
    Successive,
    /// Krylov's method: the least residual in the space of all bounces so far
    Gmres,
    /// LU factorisation: no iteration, and the time grows with the cube of the patches
    Direct,
}

impl From<Method> for solve::Method {
    fn from(method: Method) -> Self {
        match method {
            Method::Galerkin => Self::Galerkin,
            Method::Collocation => Self::Collocation,
            Method::Nystrom => Self::Nystrom,
        }
    }
}

impl From<Solver> for solve::Solver {
    fn from(solver: Solver) -> Self {
        match solver {
            Solver::GaussSeidel => Self::GaussSeidel,
            Solver::Southwell => Self::Southwell,
            Solver::Jacobi => Self::Jacobi,
            Solver::Successive => Self::Successive,
            Solver::Gmres => Self::Gmres,
            Solver::Direct => Self::Direct,
        }
    }
}

/// Pixels of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// Across.
    pub width: usize,
    /// Down.
    pub height: usize,
}

/// The name of a drawing.
fn svg(text: &str) -> Result<PathBuf, String> {
    with_extension(text, &["svg"])
}

/// The longest side of a picture, and the most pixels: 8192 × 8192 of them take some 4 GB while they are drawn.
const LONGEST: usize = 1 << 16;
const MOST_PIXELS: usize = 1 << 26;

fn size(text: &str) -> Result<Size, String> {
    let side = |side: &str| side.parse().ok().filter(|side| (1..=LONGEST).contains(side));
    text.split_once(['x', 'X'])
        .and_then(|(width, height)| Some(Size { width: side(width)?, height: side(height)? }))
        .filter(|size| size.width * size.height <= MOST_PIXELS)
        .ok_or_else(|| {
            format!("write width and height as 640x480, not more than {MOST_PIXELS} pixels in all")
        })
}

fn png(text: &str) -> Result<PathBuf, String> {
    with_extension(text, &["png"])
}

fn html(text: &str) -> Result<PathBuf, String> {
    with_extension(text, &["html"])
}

fn patches(text: &str) -> Result<PathBuf, String> {
    with_extension(text, &["csv", "npz", "vtu"])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read() {
        assert_eq!(size("640x480"), Ok(Size { width: 640, height: 480 }));
        for bad in ["0x0", "640", "x", "-1x5", "99999x1", "1x1x1"] {
            assert!(size(bad).is_err(), "{bad}");
        }
    }
}
