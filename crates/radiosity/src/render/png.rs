//! PNG files that are whole or not there.

use image::{ImageFormat, RgbImage};
use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};

/// A picture that could not be written.
#[derive(Debug, thiserror::Error)]
pub enum PngError {
    /// The file system refused.
    #[error("cannot write the picture {}: {source}", path.display())]
    Write {
        /// The file that was to be.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The encoder refused.
    #[error("cannot encode the picture {} as PNG: {source}", path.display())]
    Encode {
        /// The file that was to be.
        path: PathBuf,
        /// What the encoder said.
        source: image::ImageError,
    },
}

/// Writes an image as PNG under a neighbouring name, and gives it its own when it is complete.
pub fn write_png(image: &RgbImage, path: &Path) -> Result<(), PngError> {
    let mut bytes = Cursor::new(Vec::new());
    image
        .write_to(&mut bytes, ImageFormat::Png)
        .map_err(|source| PngError::Encode { path: path.into(), source })?;
    let neighbour = neighbour_of(path);
    fs::write(&neighbour, bytes.into_inner()).and_then(|()| fs::rename(&neighbour, path)).map_err(|source| {
        // What is half written is of no use; that it may not be there is no second error.
        let _ = fs::remove_file(&neighbour);
        PngError::Write { path: path.into(), source }
    })
}

/// A name beside `path` that no other process writes to.
fn neighbour_of(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{}.part", std::process::id()));
    path.with_file_name(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_is_read_back_as_it_was_written() {
        let folder = std::env::temp_dir().join(format!("fredholm-png-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let written = RgbImage::from_fn(3, 2, |x, y| image::Rgb([x as u8, y as u8, 200]));
        write_png(&written, &folder.join("a.png")).unwrap();
        assert_eq!(image::open(folder.join("a.png")).unwrap().into_rgb8(), written);
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1, "a part is left over");
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn an_error_names_the_file_and_leaves_nothing() {
        let path = std::env::temp_dir().join("fredholm-no-such-folder/a.png");
        let error = write_png(&RgbImage::new(1, 1), &path).unwrap_err();
        assert!(error.to_string().contains("fredholm-no-such-folder/a.png"), "{error}");
        // A folder of that name: the part is written, and cannot take its place.
        let folder = std::env::temp_dir().join(format!("fredholm-folder-{}", std::process::id()));
        fs::create_dir_all(folder.join("a.png/inside")).unwrap();
        assert!(write_png(&RgbImage::new(1, 1), &folder.join("a.png")).is_err());
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1, "a part is left over");
        fs::remove_dir_all(&folder).unwrap();
    }
}
