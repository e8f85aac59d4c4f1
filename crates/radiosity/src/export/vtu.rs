//! VTK's unstructured grid in XML, which ParaView opens: a cell for each patch, with its quantities.

use super::Field;
use fredholm::value::Value;
use std::fmt::Display;
use std::io::{self, Write};

/// VTK's numbers of cells with three and four corners.
const TRIANGLE: u8 = 5;
const QUAD: u8 = 9;

/// Writes the field as `.vtu`, in the units of [the table](super), which stand behind the names. Corners are not shared: a
/// quantity belongs to a patch.
pub fn write_vtu<V: Value>(field: &Field<'_, V>, out: &mut impl Write) -> io::Result<()> {
    let polygons = &field.patches.polygons;
    let corners = || polygons.iter().flat_map(|polygon| polygon.vertices().iter().copied());
    let (points, cells) = (corners().count(), polygons.len());
    writeln!(out, "<?xml version=\"1.0\"?>")?;
    writeln!(out, "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">")?;
    writeln!(out, "<UnstructuredGrid><Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{cells}\">")?;
    writeln!(out, "<Points>")?;
    array(out, "Float64", "position (m)", 3, corners().flat_map(|corner| corner.to_array()))?;
    writeln!(out, "</Points>\n<Cells>")?;
    array(out, "Int64", "connectivity", 1, 0..points)?;
    let ends = polygons.iter().scan(0, |end, polygon| {
        *end += polygon.vertices().len();
        Some(*end)
    });
    array(out, "Int64", "offsets", 1, ends)?;
    let kinds = polygons.iter().map(|polygon| if polygon.vertices().len() == 3 { TRIANGLE } else { QUAD });
    array(out, "UInt8", "types", 1, kinds)?;
    writeln!(out, "</Cells>\n<CellData>")?;
    for (name, values) in &field.columns {
        let channels = values.iter().flat_map(|value| value.channels().iter().copied());
        array(out, "Float64", &with_unit(name), V::CHANNELS, channels)?;
    }
    array(out, "Float64", "area (m²)", 1, field.patches.areas.iter().copied())?;
    array(out, "UInt32", "surface", 1, field.patches.surface.iter().copied())?;
    writeln!(out, "</CellData>\n</Piece></UnstructuredGrid></VTKFile>")
}

fn array(
    out: &mut impl Write,
    kind: &str,
    name: &str,
    components: usize,
    values: impl Iterator<Item = impl Display>,
) -> io::Result<()> {
    write!(
        out,
        "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"ascii\">"
    )?;
    for value in values {
        // `Display` gives the shortest digits that are read back as the same number.
        write!(out, " {value}")?;
    }
    writeln!(out, "</DataArray>")
}

/// The name of a quantity with its unit.
fn with_unit(name: &str) -> String {
    match name {
        "reflectance" => name.to_owned(),
        // These say it already.
        _ if name.contains('_') => name.to_owned(),
        _ => format!("{name} (W/m²)"),
    }
}
