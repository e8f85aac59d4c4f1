//! φ and the null functions at the points, with all digits.

use super::report::{Report, Values};
use std::io::{self, Write};

/// A line per point: its coordinates, φ, null functions; of complex numbers both parts.
pub fn write(report: &Report, out: &mut impl Write) -> io::Result<()> {
    let mut heads: Vec<String> = report.x.names().iter().map(|name| (*name).to_owned()).collect();
    heads.extend(report.phi.names("phi"));
    for (k, function) in report.null_space.iter().enumerate() {
        heads.extend(function.names(&format!("null{}", k + 1)));
    }
    writeln!(out, "{}", heads.join(","))?;
    for k in 0..report.x.len() {
        let functions = std::iter::once(&report.phi).chain(&report.null_space);
        let values = functions.flat_map(Values::components).flat_map(|values| values[k].parts());
        let numbers: Vec<String> = report.x.coordinates(k).iter().chain(values).map(digits).collect();
        writeln!(out, "{}", numbers.join(","))?;
    }
    Ok(())
}

/// 17 digits: what is read is the same double.
fn digits(number: &f64) -> String {
    format!("{number:.16e}")
}
