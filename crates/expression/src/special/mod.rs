//! Special functions of real arguments, each to about 10⁻¹⁵, away from its zeros; NaN where there is no real value.

mod bessel;
mod bessel_modified;
mod dilogarithm;
mod elliptic;
mod exponential;
mod reciprocal_gamma;

#[cfg(test)]
mod tests;

pub(crate) use bessel::{bessel_j, bessel_y};
pub(crate) use bessel_modified::{bessel_i, bessel_k};
pub(crate) use dilogarithm::li2;
pub(crate) use elliptic::{ellip_e, ellip_k};
pub(crate) use exponential::{ei, expint};

/// Orders beyond this are refused: the recurrences take a step for each.
const HIGHEST_ORDER: f64 = 1e5;

/// cos πx and sin πx, exact where they are 0 or ±1: a rounded zero would meet infinite factors.
fn turn(x: f64) -> (f64, f64) {
    let x = x.rem_euclid(2.0);
    let (cos, sin) = match (2.0 * x).rem_euclid(1.0) == 0.0 {
        true => [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)][(2.0 * x) as usize % 4],
        false => ((std::f64::consts::PI * x).cos(), (std::f64::consts::PI * x).sin()),
    };
    (cos, sin)
}
