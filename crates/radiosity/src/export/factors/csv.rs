//! Comma-separated values: the names, then a row per face.

use super::shortest;
use crate::export::csv::quoted;
use crate::view_factors::ViewFactors;
use std::io::{self, Write};

/// Writes F as CSV (RFC 4180, UTF-8, lines end in LF): the names of the faces, then F_i0, F_i1, … for each face i in
/// the same order.
pub fn write_csv(factors: &ViewFactors, out: &mut impl Write) -> io::Result<()> {
    let names: Vec<String> = factors.names().iter().map(|name| quoted(name)).collect();
    writeln!(out, "{}", names.join(","))?;
    for row in factors.rows() {
        for (j, factor) in row.into_iter().enumerate() {
            let comma = if j == 0 { "" } else { "," };
            write!(out, "{comma}{}", shortest(factor, factors.precision()))?;
        }
        writeln!(out)?;
    }
    Ok(())
}
