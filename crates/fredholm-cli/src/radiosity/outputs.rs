//! Which files a run leaves, each prepared before the work begins.

use super::args::Radiosity;
use crate::json::Json;
use crate::output::{Folder, Output, refuse_twins};
use anyhow::Result;
use fredholm::value::Value;
use image::{ImageFormat, RgbImage};
use radiosity::export::{Field, write_csv, write_npz, write_vtu};
use std::io::{self, Cursor, Write};
use std::path::{Path, PathBuf};

/// What was asked for.
pub struct Outputs {
    /// The final picture.
    pub picture: Option<Output>,
    /// What is known of each patch.
    pub patches: Option<Output>,
    /// A page that shows how the light converges.
    pub html: Option<Output>,
    /// A picture of the links.
    pub links: Option<Output>,
    /// The numbers of the run.
    pub json: Option<Json>,
    /// A picture per iteration.
    pub frames: Option<Folder>,
}

impl Outputs {
    /// Makes sure that all of them can be written. Without any there is a picture by the scene's name.
    pub fn prepare(args: &Radiosity, scene: &str) -> Result<Self> {
        let files = [&args.json, &args.patches, &args.frames, &args.html, &args.links];
        let nothing_else = files.iter().all(|file| file.is_none());
        let picture = args.output.clone().or_else(|| nothing_else.then(|| PathBuf::from(file_name(scene))));
        Self::of(args, picture.as_deref())
    }

    /// The same without a picture by the scene's name, where the numbers are what is asked for.
    pub fn of(args: &Radiosity, picture: Option<&Path>) -> Result<Self> {
        let [json, patches, html, links] =
            [&args.json, &args.patches, &args.html, &args.links].map(Option::as_deref);
        refuse_twins(&[picture, json, patches, html, links])?;
        let prepare = |path: Option<&Path>| path.map(Output::prepare).transpose();
        Ok(Self {
            picture: prepare(picture)?,
            patches: prepare(patches)?,
            html: prepare(html)?,
            links: prepare(links)?,
            json: json.map(Json::prepare).transpose()?,
            frames: args.frames.as_deref().map(Folder::prepare).transpose()?,
        })
    }
}

/// A name for the picture of a scene.
fn file_name(scene: &str) -> String {
    format!("{}.png", stem(scene))
}

/// A name for the files of a scene: small letters, digits and hyphens, whatever the scene is called.
pub fn stem(scene: &str) -> String {
    let stem = [".obj", ".toml", ".glb", ".gltf"]
        .iter()
        .find_map(|ending| scene.strip_suffix(ending))
        .unwrap_or(scene);
    let words: Vec<String> =
        stem.split(|c: char| !c.is_alphanumeric()).filter(|w| !w.is_empty()).map(str::to_lowercase).collect();
    // File systems take 255 bytes; nobody reads that far.
    let name: String = words.join("-").chars().take(60).collect();
    if name.is_empty() { "scene".to_owned() } else { name }
}

/// Writes a picture as PNG.
pub fn write_png(output: Output, image: &RgbImage) -> Result<PathBuf> {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, ImageFormat::Png)?;
    output.write(|out| out.write_all(bytes.get_ref()))
}

/// Writes the field in the format that the file's name asks for.
pub fn write_field<V: Value>(output: Output, field: &Field<'_, V>) -> Result<PathBuf> {
    let extension = output.path().extension().unwrap_or_default().to_ascii_lowercase();
    match extension.to_str() {
        Some("npz") => {
            // The archive is made whole first: its writer, dropped on a full disk, complains on its own.
            let mut bytes = Cursor::new(Vec::new());
            write_npz(field, &mut bytes)?;
            output.write(|out| out.write_all(bytes.get_ref()))
        }
        Some("vtu") => output.write(|out| -> io::Result<()> { write_vtu(field, out) }),
        _ => output.write(|out| -> io::Result<()> { write_csv(field, out) }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_picture_has_a_safe_name() {
        for (scene, name) in [
            ("Cornell box", "cornell-box.png"),
            ("room.obj", "room.png"),
            ("../../etc/passwd", "etc-passwd.png"),
            ("Büro: 2. Stock", "büro-2-stock.png"),
            ("…", "scene.png"),
        ] {
            assert_eq!(file_name(scene), name);
        }
        assert!(file_name(&"x".repeat(999)).len() < 70);
    }
}
