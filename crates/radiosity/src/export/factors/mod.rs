//! View factors as a file: F_ij from the face of row i to that of column j, with all the digits that are known.
//!
//! | format | function | errors, areas, names | zeros |
//! |---|---|---|---|
//! | NPZ, for NumPy | [`write_npz`] | all | written |
//! | CSV | [`write_csv`] | names | written |
//! | MatrixMarket, coordinate | [`write_matrix_market`] | names and areas, as comments | left out |
//! | View3D's text format | [`write_view3d`] | areas, and emittances | written |
//! | View3D's binary format, in `f32` | [`write_view3d_binary`] | areas, and emittances | written |
//!
//! Factors go through row by row: no second matrix is made in memory.

mod csv;
mod matrix_market;
mod npz;
mod sticky;
mod view3d;

pub use csv::write_csv;
pub use matrix_market::write_matrix_market;
pub use npz::write_npz;
pub use view3d::{Surroundings, write_view3d, write_view3d_binary};

use crate::view_factors::{Storage, ViewFactors};

/// A factor at its shortest: the digits from which the number that is kept is read back, and no others.
fn shortest(factor: f64, precision: Storage) -> String {
    let is_large = factor == 0.0 || factor.abs() >= 1e-4;
    match (precision, is_large) {
        (Storage::Single, true) => (factor as f32).to_string(),
        (Storage::Single, false) => format!("{:e}", factor as f32),
        (Storage::Double, true) => factor.to_string(),
        (Storage::Double, false) => format!("{factor:e}"),
    }
}

/// All factors, row by row.
fn all(factors: &ViewFactors) -> impl Iterator<Item = f64> + '_ {
    factors.rows().flatten()
}

#[cfg(test)]
mod tests;
