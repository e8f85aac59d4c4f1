//! What can be wrong with an exchange of heat: what, where, and what to do about it.

use fredholm::operator::NotFinite;
use fredholm::system::SystemError;

/// Why there is no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ThermalError {
    /// An emissivity that no surface has.
    #[error(
        "the emissivity of `{surface}` is {value}; it must lie in [0, 1], 1 is black and polished metal about 0.05"
    )]
    Emissivity {
        /// The surface.
        surface: String,
        /// What it is.
        value: f64,
    },
    /// Emissivities that do not fit the bands.
    #[error(
        "`{surface}` has {given} emissivities for {bands} bands; give one for each: from 0 to the first limit, between \
         limits, from the last to infinity"
    )]
    EmissivityCount {
        /// The surface.
        surface: String,
        /// How many it has.
        given: usize,
        /// How many there are to be.
        bands: usize,
    },
    /// A temperature below the absolute zero.
    #[error(
        "the temperature of `{surface}` is {value} K; it must be finite and not below 0 K: 20 °C are 293.15 K"
    )]
    Temperature {
        /// The surface.
        surface: String,
        /// What it is, in K.
        value: f64,
    },
    /// A heat that is no number.
    #[error(
        "the heat of `{surface}` is {value}; it must be a finite number, in W/m² or W, 0 if it is adiabatic"
    )]
    Heat {
        /// The surface.
        surface: String,
        /// What it is.
        value: f64,
    },
    /// Heat from what cannot emit.
    #[error(
        "`{surface}` has the emissivity 0 and cannot give off {value} W/m²; give it an emissivity above 0, or no heat"
    )]
    HeatedMirror {
        /// The surface.
        surface: String,
        /// The heat flux, or for a body the heat.
        value: f64,
    },
    /// A surface without area.
    #[error("the area of `{surface}` is {value} m²; it must be positive and finite")]
    Area {
        /// The surface.
        surface: String,
        /// What it is, in m².
        value: f64,
    },
    /// A matrix of another size than the surfaces ask for.
    #[error("{surfaces} surfaces need {surfaces} × {surfaces} view factors, and row {row} has {given}")]
    Shape {
        /// How many surfaces.
        surfaces: usize,
        /// The row, from 1.
        row: usize,
        /// How many factors it has.
        given: usize,
    },
    /// A number that is no view factor.
    #[error("the view factor F[{row}][{column}] is {value}; it must lie in [0, 1]")]
    ViewFactor {
        /// The row, from 1.
        row: usize,
        /// The column, from 1.
        column: usize,
        /// What it is.
        value: f64,
    },
    /// More than everything is seen.
    #[error(
        "the view factors of `{surface}` add up to {sum}; a surface sees no more than everything: 1 at most"
    )]
    RowSum {
        /// The surface.
        surface: String,
        /// Their sum.
        sum: f64,
    },
    /// What one gets the other does not send.
    #[error(
        "A F from `{from}` to `{to}` is {there} m² and back {back} m²; reciprocity, A_i F_ij = A_j F_ji, asks for the \
         same: correct an area or a view factor"
    )]
    Reciprocity {
        /// The one surface.
        from: String,
        /// The other.
        to: String,
        /// A_i F_ij, in m².
        there: f64,
        /// A_j F_ji, in m².
        back: f64,
    },
    /// Surfaces that do not make up the shape.
    #[error("{0}")]
    Pairs(String),
    /// The surroundings are no number.
    #[error("the surroundings have {0} K; give a finite temperature that is not below 0 K")]
    Surroundings(f64),
    /// Fredholm's alternative: more heat than nothing goes into a closed part.
    #[error(
        "no solution: no temperature is given of `{surface}` nor of anything that it exchanges heat with, and the heats \
         there add up to {excess:.6e} W, which go nowhere; give a temperature, or heats whose sum is 0"
    )]
    NoSolution {
        /// One of the surfaces.
        surface: String,
        /// Σ Q, in W.
        excess: f64,
    },
    /// Fredholm's alternative: a constant may be added.
    #[error(
        "not unique: no temperature is given of `{surface}` nor of anything that it exchanges heat with, so that B + \
         constant is a solution whenever B is one; give one temperature"
    )]
    NotUnique {
        /// One of the surfaces.
        surface: String,
    },
    /// A surface asked to take in more than there is.
    #[error(
        "no solution: `{surface}` would need σT⁴ = {power:.6e} W/m², below 0, since more heat is drawn from it than \
         reaches it; draw less (a net heat flux is positive where heat leaves by radiation)"
    )]
    TooCold {
        /// The surface.
        surface: String,
        /// What σT⁴ would have to be.
        power: f64,
    },
    /// No step was made.
    #[error("no step of Newton's method was made; allow one at least")]
    Unsolved,
    /// A number beyond what a `f64` holds.
    #[error("{0}; temperatures and heats are too large to be computed with")]
    System(#[from] SystemError),
    /// A form factor is not finite.
    #[error("{0}; do two patches lie in one place? The galerkin and collocation methods do not sample there")]
    FormFactor(#[from] NotFinite),
}
