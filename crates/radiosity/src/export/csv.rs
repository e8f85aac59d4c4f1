//! Comma-separated values: a header, then a row per patch; numbers so that they are read back exactly.

use super::Field;
use fredholm::value::Value;
use std::io::{self, Write};

/// Writes the field as CSV (RFC 4180, UTF-8, lines end in LF).
///
/// The header is `x,y,z,nx,ny,nz,area,emission_…,reflectance_…,radiosity_…,irradiance_…,surface`, in the units of
/// [the table](super). The channels of a colour are `_r`, `_g`, `_b`, those of a spectrum `_0`, `_1` …; a single
/// channel has no suffix. The surface is given by its name.
pub fn write_csv<V: Value>(field: &Field<'_, V>, out: &mut impl Write) -> io::Result<()> {
    write!(out, "x,y,z,nx,ny,nz,area")?;
    for (name, _) in &field.columns {
        for channel in 0..V::CHANNELS {
            write!(out, ",{name}{}", suffix(channel, V::CHANNELS))?;
        }
    }
    writeln!(out, ",surface")?;
    let names: Vec<String> = field.scene.surfaces.iter().map(|surface| quoted(&surface.name)).collect();
    (0..field.patches.len()).try_for_each(|i| write_row(field, i, &names, out))
}

fn write_row<V: Value>(
    field: &Field<'_, V>,
    i: usize,
    names: &[String],
    out: &mut impl Write,
) -> io::Result<()> {
    let polygon = &field.patches.polygons[i];
    let (centre, normal) = (polygon.centroid(), polygon.normal());
    // `Display` gives the shortest digits that are read back as the same number.
    write!(out, "{},{},{},{},{},{}", centre.x, centre.y, centre.z, normal.x, normal.y, normal.z)?;
    write!(out, ",{}", field.patches.areas[i])?;
    for (_, values) in &field.columns {
        for channel in values[i].channels() {
            write!(out, ",{channel}")?;
        }
    }
    writeln!(out, ",{}", names[field.patches.surface[i] as usize])
}

fn suffix(channel: usize, channels: usize) -> String {
    match channels {
        1 => String::new(),
        3 => format!("_{}", ["r", "g", "b"][channel]),
        _ => format!("_{channel}"),
    }
}

/// A name as a field of CSV: in quotes where it would break the row.
pub(super) fn quoted(name: &str) -> String {
    if name.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", name.replace('"', "\"\""))
    } else {
        name.to_owned()
    }
}
