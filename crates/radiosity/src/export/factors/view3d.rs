//! The text file of view factors that View3D writes (Walton, NISTIR 6925; section 6 of its manual), for its readers.
//!
//! A line of what it is, `program version out encl emit n`; a line of areas; a line for each row of F; a line of
//! emittances. Numbers are separated by a space.

use crate::view_factors::{Storage, ViewFactors};
use std::io::{self, Write};

/// What the format says of the faces besides their factors.
#[derive(Clone, Copy, Debug)]
pub struct Surroundings<'a> {
    /// Whether the faces are an enclosure.
    pub is_closed: bool,
    /// The emittance of each face, 1 − ρ.
    pub emittances: &'a [f64],
}

/// The length to which the first line is padded; readers take 34 characters and not more.
const HEADER: usize = 30;

/// Writes F in View3D's text format (`out = 0`, without emittances in the factors: `emit = 0`).
///
/// Factors have 8 digits behind the point where they are kept in `f32`, else 12: View3D itself writes 6.
pub fn write_view3d(
    factors: &ViewFactors,
    surroundings: &Surroundings<'_>,
    out: &mut impl Write,
) -> io::Result<()> {
    let n = factors.len();
    let header =
        format!("fredholm {} 0 {} 0 {n}", env!("CARGO_PKG_VERSION"), u8::from(surroundings.is_closed));
    writeln!(out, "{header:<HEADER$}")?;
    line(factors.areas().iter().map(f64::to_string), out)?;
    let digits = match factors.precision() {
        Storage::Single => 8,
        Storage::Double => 12,
    };
    for row in factors.rows() {
        line(row.into_iter().map(|factor| format!("{factor:.digits$}")), out)?;
    }
    line(surroundings.emittances.iter().map(|emittance| format!("{emittance:.3}")), out)
}

fn line(words: impl Iterator<Item = String>, out: &mut impl Write) -> io::Result<()> {
    for (k, word) in words.enumerate() {
        let space = if k == 0 { "" } else { " " };
        write!(out, "{space}{word}")?;
    }
    writeln!(out)
}
