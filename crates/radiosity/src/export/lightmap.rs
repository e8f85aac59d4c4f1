//! A lightmap as OpenEXR: linear, in 32 bits, with its unit in the header.

use crate::bake::Lightmap;
use crate::render::Colour;
use exr::error::Error;
use exr::prelude::{Image, SpecificChannels, Text, Vec2, WritableImage};
use std::io::{self, Cursor, Write};

/// Writes the irradiance of all texels, red, green and blue. `note` is the header's comment.
pub fn write_exr<V: Colour>(lightmap: &Lightmap<V>, note: &str, out: &mut impl Write) -> io::Result<()> {
    let size = lightmap.atlas.size;
    let channels = SpecificChannels::rgb(|Vec2(x, y): Vec2<usize>| {
        let [r, g, b] = lightmap.irradiance[y * size + x].to_rgb().0.map(|c| c as f32);
        (r, g, b)
    });
    let mut image = Image::from_channels((size, size), channels);
    image.layer_data.attributes.comments = Text::new_or_none(note);
    let mut bytes = Cursor::new(Vec::new());
    image.write().to_buffered(&mut bytes).map_err(|error| match error {
        Error::Io(error) => error,
        other => io::Error::other(other.to_string()),
    })?;
    out.write_all(bytes.get_ref())
}
