//! What the page and the server say to each other: commands in JSON, numbers in little-endian arrays.
//!
//! The page asks for `/scene.json` ([`super::description`]) and `/geometry.bin` once, then opens a WebSocket at `/session`
//! and has a solver of its own there. It says [`Command`]s, in text; it is told [`Remark`]s, in text, and numbers:
//!
//! | kind | what | header | then |
//! |---|---|---|---|
//! | – | `/geometry.bin` | | the corners of each patch, 12 × f32 in m; a triangle has its third corner twice |
//! | 1 | a frame | kind, lane, run, iteration, shot, state: u32; work, residual, bound, unshot: f64 | B of each patch, 3 × f32; \|r\| of each patch, f32 |
//! | 2 | form factors | kind, patch: u32 | F_ij for all j, f32; F_ji for all j, f32 |
//! | 3 | light of a lamp | kind, lamp, version, state: u32 | B of each patch for that lamp alone, 3 × f32 |
//! | 4 | a file | kind, bytes of its name: u32 | the name, UTF-8; the file |
//!
//! B is what the method shows (u, or u + r where it shoots), the mean over the patch, r = f + ρFu − u, the largest on the patch, both in the unit of exitance; `work` is form
//! factors used over n², n the number of unknowns, `residual` ‖r‖∞, `bound` that of max |u − ũ| (NaN where ‖ρF‖∞ ≥ 1), `unshot` Σ A_i |r_i| as
//! luminance, in W or lm. `shot` is the patch shot last, or [`NONE`].

use super::discrete::Kind;
use super::solvers::Solver;
use fredholm::value::Rgb;
use serde::{Deserialize, Serialize};

/// In place of the number of a patch: there is none.
pub const NONE: u32 = u32::MAX;

/// What a page may ask for.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
pub enum Command {
    /// Begin anew: with a method, one solver or two that race, each lamp so many times as bright as in the file, and a
    /// reflectance for each surface.
    Start {
        /// The method and the polynomials on patches; those that a window begins with if left out.
        kind: Option<Kind>,
        /// The solvers, one or two.
        solvers: Vec<Solver>,
        /// A factor for each lamp.
        lamps: Vec<f64>,
        /// Red, green and blue for each surface.
        reflectance: Vec<[f64; 3]>,
    },
    /// Go on by itself, so many passes (n² form factors) a second.
    Play {
        /// Passes a second.
        passes: f64,
    },
    /// Stop until told otherwise.
    Pause,
    /// Make one step: an iteration; in a race one pass of both.
    Step,
    /// What a patch receives from each other one and sends to it.
    Factors {
        /// Which patch.
        patch: u32,
    },
    /// The light of each lamp alone, with these reflectances.
    Relight {
        /// Red, green and blue for each surface.
        reflectance: Vec<[f64; 3]>,
        /// Is said again with the answers.
        version: u32,
    },
    /// A file of the light that the page shows, or if it does not say of the first solver's as it is now.
    Export {
        /// What kind of file.
        format: Format,
        /// Where a picture is taken from; the scene's camera if left out.
        camera: Option<Eye>,
        /// The light that is shown.
        shown: Option<Box<Shown>>,
    },
}

/// Light that a page shows, which the solver has long left behind or never had.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shown {
    /// B of each patch, 3 × f32 in little-endian order, in base64.
    pub radiosity: String,
    /// A factor for each lamp that it is of.
    pub lamps: Vec<f64>,
    /// Red, green and blue of each surface that it is of.
    pub reflectance: Vec<[f64; 3]>,
    /// The moment of the solver's course; none of a sum over lamps.
    pub moment: Option<Moment>,
}

/// A moment of a solver's course, as its frame told.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Moment {
    /// Iterations made.
    pub iteration: usize,
    /// Form factors used, in passes.
    pub work: f64,
    /// ‖r‖∞.
    pub residual: f64,
}

/// A kind of file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Format {
    /// A table of patches.
    Csv,
    /// The same as NumPy arrays.
    Npz,
    /// Means over surfaces, and how well they are known.
    Json,
    /// A picture with sharp shadows: direct light by formula, the rest gathered.
    Png,
    /// The same, linear, in W/(m² sr) or cd/m².
    Exr,
    /// The patches for ParaView.
    Vtu,
    /// The patches as binary glTF, with radiance as colours of vertices.
    Glb,
}

/// A camera as the page has it: positions in metres, an angle in degrees.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Eye {
    /// The pinhole.
    pub position: [f64; 3],
    /// A point in the middle of the picture.
    pub target: [f64; 3],
    /// What is up in it.
    pub up: [f64; 3],
    /// The whole vertical angle of view.
    pub vertical_angle: f64,
    /// Width over height.
    pub aspect: f64,
}

/// What is told in words.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum Remark {
    /// So many of the form factors are computed.
    Assembly {
        /// How many are.
        done: u64,
        /// How many there will be.
        of: u64,
    },
    /// A run begins.
    Started {
        /// Its number, which its frames have too.
        run: u32,
        /// Its method, and the polynomials on patches.
        kind: Kind,
        /// Its solvers.
        solvers: Vec<Solver>,
        /// How many unknowns there are.
        unknowns: usize,
        /// Whether F is stored, or going to be, without which there is only shooting.
        stored: bool,
        /// max_i Σ_j |F_ij|, at most; none where that is not known.
        row_sum: Option<f64>,
        /// ‖ρF‖∞; none where that is not known.
        norm: Option<f64>,
        /// The residual at which it ends.
        target: f64,
    },
    /// A command could not be followed.
    Error {
        /// Why.
        message: String,
    },
}

/// A message to a page.
#[derive(Clone, Debug, PartialEq)]
pub enum Message {
    /// In words.
    Text(String),
    /// In numbers.
    Bytes(Vec<u8>),
}

impl From<&Remark> for Message {
    fn from(remark: &Remark) -> Self {
        // A remark is names and numbers; that it cannot be written is not to be expected, and then it is not told.
        Self::Text(serde_json::to_string(remark).unwrap_or_default())
    }
}

/// How a solver stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// There is more to do.
    Running = 0,
    /// The residual is as small as was asked.
    Converged = 1,
    /// It grows.
    Diverged = 2,
    /// Rounding lets it fall no further.
    Stalled = 3,
}

/// The head of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Head {
    /// Which of the solvers.
    pub lane: u32,
    /// Which run.
    pub run: u32,
    /// Iterations made.
    pub iteration: u32,
    /// The patch shot last.
    pub shot: Option<usize>,
    /// How the solver stands.
    pub state: State,
    /// Form factors used, in passes.
    pub work: f64,
    /// ‖r‖∞.
    pub residual: f64,
    /// Bound of max |u − ũ|.
    pub bound: Option<f64>,
    /// Σ A |r|.
    pub unshot: f64,
}

/// The head of a frame: kind 1.
pub fn head(head: &Head) -> Vec<u8> {
    let shot = head.shot.map_or(NONE, |patch| patch as u32);
    let mut bytes = Vec::new();
    words(&mut bytes, &[1, head.lane, head.run, head.iteration, shot, head.state as u32]);
    for number in [head.work, head.residual, head.bound.unwrap_or(f64::NAN), head.unshot] {
        bytes.extend(number.to_le_bytes());
    }
    bytes
}

/// A frame: kind 1.
pub fn frame(told: &Head, radiosity: &[Rgb], residual: impl Iterator<Item = f64>) -> Vec<u8> {
    let mut bytes = head(told);
    bytes.reserve(16 * radiosity.len());
    colours(&mut bytes, radiosity);
    numbers(&mut bytes, residual);
    bytes
}

/// A row and a column of F: kind 2.
pub fn factors(patch: u32, row: &[f64], column: &[f64]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(8 + 8 * row.len());
    words(&mut bytes, &[2, patch]);
    numbers(&mut bytes, row.iter().chain(column).copied());
    bytes
}

/// The light of a lamp: kind 3.
pub fn lamp(lamp: u32, version: u32, state: State, radiosity: &[Rgb]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(16 + 12 * radiosity.len());
    words(&mut bytes, &[3, lamp, version, state as u32]);
    colours(&mut bytes, radiosity);
    bytes
}

/// A file: kind 4.
pub fn file(name: &str, content: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(8 + name.len() + content.len());
    words(&mut bytes, &[4, name.len() as u32]);
    bytes.extend(name.as_bytes());
    bytes.extend(content);
    bytes
}

fn words(bytes: &mut Vec<u8>, words: &[u32]) {
    words.iter().for_each(|word| bytes.extend(word.to_le_bytes()));
}

/// Numbers as f32.
pub fn numbers(bytes: &mut Vec<u8>, numbers: impl Iterator<Item = f64>) {
    numbers.for_each(|number| bytes.extend((number as f32).to_le_bytes()));
}

fn colours(bytes: &mut Vec<u8>, colours: &[Rgb]) {
    numbers(bytes, colours.iter().flat_map(|colour| colour.0));
}
