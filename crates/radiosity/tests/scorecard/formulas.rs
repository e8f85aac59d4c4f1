//! Form factors from a point to a rectangle, in closed form and by no code of the crate.

use std::f64::consts::TAU;

/// From a point to a rectangle in a parallel plane at distance c, given by its limits as seen from the point.
pub fn parallel(x: [f64; 2], y: [f64; 2], c: f64) -> f64 {
    let corner = |a: f64, b: f64| {
        let (p, q) = (a.hypot(c), b.hypot(c));
        (a / p * (b / p).atan() + b / q * (a / q).atan()) / TAU
    };
    corner(x[1], y[1]) - corner(x[0], y[1]) - corner(x[1], y[0]) + corner(x[0], y[0])
}

/// From a point to a rectangle in a plane at a right angle to its own, at distance c; `up` are the limits along the point's
/// normal, not negative, and `across` those along both planes.
pub fn perpendicular(across: [f64; 2], up: [f64; 2], c: f64) -> f64 {
    let corner = |b: f64, a: f64| ((b / c).atan() - c / a.hypot(c) * (b / a.hypot(c)).atan()) / TAU;
    corner(across[1], up[1]) - corner(across[0], up[1]) - corner(across[1], up[0]) + corner(across[0], up[0])
}
