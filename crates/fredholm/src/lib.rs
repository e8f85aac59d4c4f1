//! Fredholm integral equations of the second kind, φ = f + ρ ∫ K φ.

pub mod value;
