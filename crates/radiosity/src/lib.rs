//! Radiosity as a Fredholm equation of the second kind: B = E + ρ ∫ K B.

pub mod form_factor;
pub mod patches;
pub mod polygon;
pub mod reconstruct;
pub mod render;
pub mod scene;
pub mod visibility;
