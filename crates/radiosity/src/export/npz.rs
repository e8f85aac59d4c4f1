//! NumPy's archive: an array per quantity, opened by `numpy.load`.

use super::Field;
use crate::patches::Patches;
use fredholm::value::Value;
use npyz::npz::NpzWriter;
use npyz::zip::CompressionMethod;
use npyz::zip::write::FileOptions;
use npyz::{AutoSerialize, DType, Serialize, TypeStr, WriterBuilder};
use std::io::{self, BufWriter, Seek, Write};

/// Writes the field as NPZ, in the units of [the table](super).
///
/// | array | shape | type |
/// |---|---|---|
/// | `centre`, `normal` | (n, 3) | f64 |
/// | `area` | (n,) | f64 |
/// | `emission`, `reflectance`, `radiosity`, `irradiance`, or as [the module](super) says | (n, channels) | f64 |
/// | `surface` | (n,) | u32: an index into `surface_names` |
/// | `surface_names` | (surfaces,) | str |
pub fn write_npz<V: Value>(field: &Field<'_, V>, out: impl Write + Seek) -> io::Result<()> {
    let patches: &Patches<V> = field.patches;
    let mut archive = Archive::new(out);
    let vectors = |of: fn(&crate::polygon::Polygon) -> glam::DVec3| {
        patches.polygons.iter().flat_map(move |polygon| of(polygon).to_array())
    };
    archive.matrix("centre", patches.len(), 3, vectors(|polygon| polygon.centroid()))?;
    archive.matrix("normal", patches.len(), 3, vectors(|polygon| polygon.normal()))?;
    archive.column("area", patches.areas.iter().copied())?;
    for (name, values) in &field.columns {
        let channels = values.iter().flat_map(|value| value.channels().iter().copied());
        archive.matrix(name, values.len(), V::CHANNELS, channels)?;
    }
    archive.column("surface", patches.surface.iter().copied())?;
    archive.names("surface_names", field.scene.surfaces.iter().map(|surface| surface.name.as_str()))?;
    archive.finish()
}

/// An archive to which arrays are added one by one.
pub(super) struct Archive<W: Write + Seek>(NpzWriter<W>);

impl<W: Write + Seek> Archive<W> {
    pub(super) fn new(out: W) -> Self {
        Self(NpzWriter::new(out))
    }

    pub(super) fn finish(mut self) -> io::Result<()> {
        self.0.zip_writer().finish()?.flush()
    }

    pub(super) fn matrix<T: AutoSerialize>(
        &mut self,
        name: &str,
        rows: usize,
        columns: usize,
        entries: impl Iterator<Item = T>,
    ) -> io::Result<()> {
        self.array(name, &T::default_dtype(), &[rows as u64, columns as u64], entries)
    }

    pub(super) fn column<T: AutoSerialize>(
        &mut self,
        name: &str,
        entries: impl ExactSizeIterator<Item = T>,
    ) -> io::Result<()> {
        self.array(name, &T::default_dtype(), &[entries.len() as u64], entries)
    }

    /// Strings, in UTF-32 as NumPy keeps them, all of the length of the longest.
    pub(super) fn names<'a>(
        &mut self,
        name: &str,
        names: impl ExactSizeIterator<Item = &'a str> + Clone,
    ) -> io::Result<()> {
        let longest = names.clone().map(|name| name.chars().count()).max().unwrap_or(0).max(1);
        let kind: TypeStr = format!("<U{longest}").parse().map_err(io::Error::other)?;
        let length = names.len() as u64;
        self.array(
            name,
            &DType::Plain(kind),
            &[length],
            names.map(|name| name.chars().collect::<Vec<char>>()),
        )
    }

    fn array<T: Serialize>(
        &mut self,
        name: &str,
        kind: &DType,
        shape: &[u64],
        entries: impl Iterator<Item = T>,
    ) -> io::Result<()> {
        // As `numpy.savez` does: stored, since solutions hardly shrink, and ready for more than 4 GB.
        let options = FileOptions::default().compression_method(CompressionMethod::Stored).large_file(true);
        let file = npyz::npz::file_name_from_array_name(name);
        self.0.zip_writer().start_file(file, options)?;
        let out = BufWriter::new(self.0.zip_writer());
        let mut array = npyz::WriteOptions::new().dtype(kind.clone()).shape(shape).writer(out).begin_nd()?;
        array.extend(entries)?;
        array.finish()
    }
}
