//! MatrixMarket's coordinate format: a line for each factor that is not 0, rows and columns counted from 1.

use super::{all, shortest};
use crate::view_factors::ViewFactors;
use std::io::{self, Write};

/// Writes F as MatrixMarket (`matrix coordinate real general`); the comments at its head say what it is, and the name
/// and area of each row.
pub fn write_matrix_market(factors: &ViewFactors, out: &mut impl Write) -> io::Result<()> {
    let n = factors.len();
    writeln!(out, "%%MatrixMarket matrix coordinate real general")?;
    writeln!(
        out,
        "% view factors F_ij, dimensionless: the part of what leaves i (row) that arrives at j (column)"
    )?;
    writeln!(out, "% factors that are not listed are 0")?;
    writeln!(out, "% row, area in m2, name")?;
    for (k, (name, area)) in factors.names().iter().zip(factors.areas()).enumerate() {
        writeln!(out, "% {} {area} {}", k + 1, name.replace(['\n', '\r'], " "))?;
    }
    let listed = all(factors).filter(|factor| *factor != 0.0).count();
    writeln!(out, "{n} {n} {listed}")?;
    for (i, row) in (1..).zip(factors.rows()) {
        for (j, factor) in (1..).zip(row).filter(|(_, factor)| *factor != 0.0) {
            writeln!(out, "{i} {j} {}", shortest(factor, factors.precision()))?;
        }
    }
    Ok(())
}
