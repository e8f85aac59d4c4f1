//! NumPy's archive: factors, errors, areas, names, opened by `numpy.load`.

use super::all;
use super::sticky::Sticky;
use crate::export::npz::Archive;
use crate::view_factors::{Storage, ViewFactors};
use std::io::{self, Seek, Write};

/// Writes the factors as NPZ.
///
/// | array | shape | type |
/// |---|---|---|
/// | `F` | (n, n): row = from, column = to | f32 or f64, as [`ViewFactors::precision`] |
/// | `error` | (n, n), of the factors in the same places | f32, rounded up |
/// | `areas` | (n,), in m² | f64 |
/// | `names` | (n,) | str |
pub fn write_npz(factors: &ViewFactors, out: impl Write + Seek) -> io::Result<()> {
    let mut out = Sticky::new(out);
    write(factors, &mut out)?;
    out.result()
}

fn write(factors: &ViewFactors, out: impl Write + Seek) -> io::Result<()> {
    let n = factors.len();
    let mut archive = Archive::new(out);
    match factors.precision() {
        Storage::Single => archive.matrix("F", n, n, all(factors).map(|factor| factor as f32))?,
        Storage::Double => archive.matrix("F", n, n, all(factors))?,
    }
    let errors = factors.rows_of_errors().flatten().map(rounded_up);
    archive.matrix("error", n, n, errors)?;
    archive.column("areas", factors.areas().iter().copied())?;
    archive.names("names", factors.names().iter().map(String::as_str))?;
    archive.finish()
}

/// The least `f32` that is not less.
fn rounded_up(error: f64) -> f32 {
    let nearest = error as f32;
    if f64::from(nearest) < error { nearest.next_up() } else { nearest }
}
