//! Heat by radiation: B = ε e(T) + (1 − ε) H, the same equation u = f + ρ ⊙ (F u), and q = B − H.
//!
//! Of each surface either the temperature is given, and then f = ε σT⁴ and ρ = 1 − ε, or the net heat flux, and then f = q
//! and ρ = 1. That ρ is why the norm of ρF no longer says anything, and why the answer may not exist, or not be the only
//! one: Fredholm's alternative ([`ThermalError::NoSolution`], [`ThermalError::NotUnique`]). With bands of wavelength there
//! is an equation in each, and one temperature for all of them, found by Newton's method.
//!
//! The net heat flux is positive where heat leaves a surface by radiation.
//!
//! ```
//! use radiosity::thermal::{Bands, Enclosure, Options, Surface};
//!
//! // A shield between a plate at 500 K and one at 300 K; its two sides have one temperature, which is to be found.
//! let surfaces = vec![
//!     Surface::at("hot", 500.0, 0.8),
//!     Surface::floating("shield, hot side", "shield", 0.05),
//!     Surface::floating("shield, cold side", "shield", 0.05),
//!     Surface::at("cold", 300.0, 0.8),
//! ];
//! let enclosure = Enclosure::nested(surfaces, &[1.0; 4], Bands::grey())?;
//! let answer = enclosure.solve(&Options::default())?;
//!
//! let powers = radiosity::thermal::emissive_power(500.0) - radiosity::thermal::emissive_power(300.0);
//! let q = powers / (2.0 * (1.0 / 0.8 + 1.0 / 0.05 - 1.0));
//! assert!((answer.nodes[0].heat_flux - q).abs() < 1e-10);
//! // (500⁴ + 300⁴)/2 is the fourth power of 433.5 K.
//! assert!(answer.nodes[1].temperature.is_some_and(|kelvin| (kelvin - 433.5).abs() < 0.1));
//! # Ok::<(), radiosity::thermal::ThermalError>(())
//! ```

mod alternative;
mod bands;
mod bound;
mod enclosure;
mod error;
mod linear;
mod network;
mod planck;
mod solve;
mod summary;
mod surface;

pub use bands::{BandError, Bands};
pub use enclosure::Enclosure;
pub use error::ThermalError;
pub use planck::{SECOND_RADIATION, STEFAN_BOLTZMANN, black_body_fraction, emissive_power, temperature};
pub use solve::Options;
pub use summary::SurfaceHeat;
pub use surface::{Condition, Surface};

/// Who exchanges heat with whom: surfaces, the nodes that they consist of, and what these see of each other.
#[derive(Clone, Copy, Debug)]
pub struct Exchange<'a, F> {
    /// What is known of each surface.
    pub surfaces: &'a [Surface],
    /// The unknowns: whole surfaces, or patches of them.
    pub nodes: &'a [Node],
    /// The bands of wavelength.
    pub bands: &'a Bands,
    /// F, one row per node; no entry is negative, and A_i F_ij = A_j F_ji.
    pub operator: &'a F,
    /// The temperature of what is seen beyond all surfaces, which is black, in K.
    pub surroundings: f64,
    /// Whether nothing is seen beyond all surfaces: what the rows of F miss of 1 is error then.
    pub closed: bool,
}

/// A surface, or a patch of one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// Which surface it belongs to.
    pub surface: usize,
    /// Its area, in m².
    pub area: f64,
}

/// What is found.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// The state of each node.
    pub nodes: Vec<State>,
    /// How far each number of it can be from the exact answer of the discrete equation; with several bands to first
    /// order. `None` where no bound is found.
    pub errors: Option<Vec<State>>,
    /// Where all heat goes.
    pub balance: Balance,
    /// Steps of Newton's method: 1 where surfaces are grey.
    pub steps: usize,
    /// max |ε e(T) + (1 − ε) H − B|, in W/m², over nodes and bands.
    pub residual: f64,
    /// max B, in W/m², over nodes and bands.
    pub largest: f64,
    /// Whether the residual is as small as was asked.
    pub converged: bool,
}

/// The state of a node, all bands together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// The temperature, in K; none of a mirror of which only the heat is known.
    pub temperature: Option<f64>,
    /// B, what leaves it, in W/m².
    pub radiosity: f64,
    /// H, what reaches it, in W/m².
    pub irradiance: f64,
    /// q = B − H = ε (e(T) − H), the net heat flux out of it, in W/m².
    pub heat_flux: f64,
}

/// The first law: what surfaces give off goes to the surroundings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Balance {
    /// Σ Q of all surfaces, in W.
    pub heat: f64,
    /// The heat that goes to the surroundings, in W.
    pub to_surroundings: f64,
    /// ½ Σ |Q|, the surroundings' included, in W: what the difference of the two is to be compared with.
    pub exchanged: f64,
}

impl Balance {
    /// By how much the heat that surfaces give off differs from what the surroundings get, in W.
    pub fn defect(&self) -> f64 {
        (self.heat - self.to_surroundings).abs()
    }
}
