//! Fredholm integral equations of the second kind, φ = f + ρ ∫ K φ.

pub mod direct;
pub mod discretize;
pub mod kernel;
pub mod krylov;
pub mod neumann;
pub mod operator;
pub mod quadrature;
pub mod relax;
pub mod space;
pub mod system;
pub mod value;
