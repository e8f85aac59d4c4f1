//! The files of view factors that View3D writes (Walton, NISTIR 6925; section 6 of its manual), for its readers.
//!
//! A line of what it is, `program version out encl emit n`; then areas; the rows of F; emittances. As text (`out` = 0)
//! each is a line of numbers with a space between them; as binary (`out` = 1) the first line has 32 bytes, the last two
//! of which are CR and LF, and the numbers are `f32` with nothing between them.

use crate::view_factors::{Storage, ViewFactors};
use std::io::{self, Write};

/// What the format says of the faces besides their factors.
#[derive(Clone, Copy, Debug)]
pub struct Surroundings<'a> {
    /// Whether the faces are an enclosure.
    pub is_closed: bool,
    /// Whether the factors are script F, with reflections in them.
    pub with_reflections: bool,
    /// The emittance of each face, 1 − ρ.
    pub emittances: &'a [f64],
}

/// The length to which the first line is padded; readers of the text take 34 characters and not more, and those of the
/// binary file 32 bytes with the end of the line.
const HEADER: usize = 30;

/// Writes F in View3D's text format (`out = 0`; `emit = 1` where reflections are in the factors).
///
/// Factors have 8 digits behind the point where they are kept in `f32`, else 12: View3D itself writes 6.
pub fn write_view3d(
    factors: &ViewFactors,
    surroundings: &Surroundings<'_>,
    out: &mut impl Write,
) -> io::Result<()> {
    writeln!(out, "{}", header(0, factors, surroundings))?;
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

/// Writes F in View3D's binary format (`out = 1`; `emit = 1` where reflections are in the factors): all numbers as `f32`,
/// little-endian as on the machines that View3D runs on, areas in m².
///
/// # Errors
///
/// Of the writer; and if the first line has more than its 30 characters, as with 10⁸ faces.
pub fn write_view3d_binary(
    factors: &ViewFactors,
    surroundings: &Surroundings<'_>,
    out: &mut impl Write,
) -> io::Result<()> {
    let header = header(1, factors, surroundings);
    if header.len() != HEADER {
        let problem = format!("`{header}` is longer than the {HEADER} characters that the format has for it");
        return Err(io::Error::new(io::ErrorKind::InvalidInput, problem));
    }
    write!(out, "{header}\r\n")?;
    singles(factors.areas().iter().copied(), out)?;
    for row in factors.rows() {
        singles(row.into_iter(), out)?;
    }
    singles(surroundings.emittances.iter().copied(), out)
}

/// The first line, padded, without its end.
fn header(format: u8, factors: &ViewFactors, surroundings: &Surroundings<'_>) -> String {
    let (version, closed) = (env!("CARGO_PKG_VERSION"), u8::from(surroundings.is_closed));
    let emit = u8::from(surroundings.with_reflections);
    let header = format!("fredholm {version} {format} {closed} {emit} {}", factors.len());
    format!("{header:<HEADER$}")
}

fn singles(numbers: impl Iterator<Item = f64>, out: &mut impl Write) -> io::Result<()> {
    let bytes: Vec<u8> = numbers.flat_map(|number| (number as f32).to_le_bytes()).collect();
    out.write_all(&bytes)
}

fn line(words: impl Iterator<Item = String>, out: &mut impl Write) -> io::Result<()> {
    for (k, word) in words.enumerate() {
        let space = if k == 0 { "" } else { " " };
        write!(out, "{space}{word}")?;
    }
    writeln!(out)
}
