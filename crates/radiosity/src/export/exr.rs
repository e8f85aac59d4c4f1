//! Light as OpenEXR: linear, with the primaries of Rec. 709, in 32 bits, with its unit in the header.

use crate::bake::Lightmap;
use crate::render::{Colour, Picture};
use ::exr::error::Error;
use ::exr::prelude::{Image, SpecificChannels, Text, Vec2, WritableImage};
use fredholm::value::Rgb;
use std::io::{self, Cursor, ErrorKind, Write};

/// Writes the irradiance of all texels, red, green and blue. `note` is the header's comment.
///
/// # Errors
///
/// When the note has letters that no header can have (not in Latin-1), and when nothing can be written.
pub fn write_exr<V: Colour>(lightmap: &Lightmap<V>, note: &str, out: &mut impl Write) -> io::Result<()> {
    let size = lightmap.atlas.size;
    write((size, size), |k| lightmap.irradiance[k].to_rgb(), note, out)
}

/// Writes the radiance that reaches each pixel, red, green and blue. `note` is the header's comment.
///
/// # Errors
///
/// Those of [`write_exr`].
pub fn write_exr_picture(picture: &Picture, note: &str, out: &mut impl Write) -> io::Result<()> {
    write((picture.width, picture.height), |k| picture.pixels[k], note, out)
}

/// Writes what is at each place, row by row from above.
fn write(
    (width, height): (usize, usize),
    at: impl Fn(usize) -> Rgb + Sync,
    note: &str,
    out: &mut impl Write,
) -> io::Result<()> {
    let channels = SpecificChannels::rgb(|Vec2(x, y): Vec2<usize>| {
        let [r, g, b] = at(y * width + x).0.map(|c| c as f32);
        (r, g, b)
    });
    let mut image = Image::from_channels((width, height), channels);
    let note = Text::new_or_none(note)
        .ok_or_else(|| io::Error::new(ErrorKind::InvalidInput, format!("no header can say `{note}`")))?;
    image.layer_data.attributes.comments = Some(note);
    let mut bytes = Cursor::new(Vec::new());
    image.write().to_buffered(&mut bytes).map_err(|error| match error {
        Error::Io(error) => error,
        other => io::Error::other(other.to_string()),
    })?;
    out.write_all(bytes.get_ref())
}
