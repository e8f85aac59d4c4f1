//! Radiosity as a Fredholm equation of the second kind: B = E + ρ ∫ K B.

pub mod closure;
pub mod export;
pub mod form_factor;
pub mod kernel;
pub mod patches;
pub mod polygon;
pub mod reconstruct;
pub mod render;
pub mod scene;
pub mod solve;
pub mod visibility;
