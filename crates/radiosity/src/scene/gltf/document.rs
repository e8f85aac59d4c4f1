//! The JSON of a file and the bytes behind it: what the container holds, checked until the crate `gltf` cannot stumble on it.

use super::malformed;
use crate::scene::error::Problem;
use ::gltf::json::camera::Type;
use ::gltf::json::mesh::Semantic;
use ::gltf::json::validation::Checked;
use ::gltf::json::{Root, deserialize};
use ::gltf::{Document, Error};

/// The document, and its binary chunk if it has one.
pub(super) fn parsed(bytes: &[u8]) -> Result<(Document, Option<&[u8]>), Problem> {
    let (json, binary) = if bytes.starts_with(MAGIC) { chunks(bytes)? } else { (bytes, None) };
    let root: Root = deserialize::from_slice(json).map_err(|error| broken(&error.to_string()))?;
    check(&root)?;
    let document = Document::from_json(root).map_err(|error| match error {
        Error::Validation(errors) => {
            let first = errors.first().map_or_else(String::new, |(path, error)| format!("{path}: {error}"));
            let more = errors.len().saturating_sub(1);
            broken(&if more > 0 { format!("{first}, and {more} more") } else { first })
        }
        other => broken(&other.to_string()),
    })?;
    Ok((document, binary))
}

/// What the parser of the JSON says, in a line that is not too long.
fn broken(said: &str) -> Problem {
    let shown: String = said.chars().map(|c| if c.is_control() { ' ' } else { c }).take(200).collect();
    malformed(format!("this is no glTF 2.0 that can be read ({shown}); export it again, without compression"))
}

const MAGIC: &[u8] = b"glTF";

/// The JSON of a binary file, and the chunk behind it.
fn chunks(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), Problem> {
    let word = |at: usize| Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?) as usize);
    let (version, length) = (word(4), word(8));
    if version != Some(2) {
        let version = version.unwrap_or_default();
        return Err(malformed(format!(
            "this is a binary glTF of version {version}, and 2 is read; export it again"
        )));
    }
    let whole = length.and_then(|length| bytes.get(..length)).ok_or_else(|| {
        let length = length.unwrap_or_default();
        malformed(format!("the file has {} bytes of {length}: it was cut off; export it again", bytes.len()))
    })?;
    // A chunk: its length, its kind, and its bytes.
    let chunk = |at: usize, kind: &[u8]| {
        let end = word(at)?.checked_add(at + 8)?;
        (whole.get(at + 4..at + 8)? == kind).then(|| whole.get(at + 8..end)).flatten()
    };
    let json = chunk(12, b"JSON").ok_or_else(|| broken("its first chunk is not JSON, or is cut off"))?;
    let next = 12 + 8 + json.len();
    let binary = chunk(next, b"BIN\0");
    if binary.is_none() && next < whole.len() {
        return Err(broken("its second chunk is not binary, or is cut off"));
    }
    Ok((json, binary))
}

/// What the crate takes for granted.
fn check(root: &Root) -> Result<(), Problem> {
    for (number, mesh) in root.meshes.iter().enumerate() {
        for primitive in &mesh.primitives {
            let position = primitive.attributes.get(&Checked::Valid(Semantic::Positions));
            match position.map(|index| index.value()) {
                Some(index) if index < root.accessors.len() => {}
                Some(index) => {
                    return Err(malformed(format!(
                        "mesh {number} has its positions in accessor {index}, and there are {}; export the scene again",
                        root.accessors.len()
                    )));
                }
                None => {
                    return Err(malformed(format!(
                        "mesh {number} has no positions; export the scene again, without compression"
                    )));
                }
            }
        }
    }
    for (number, image) in root.images.iter().enumerate() {
        if image.uri.is_none() && (image.buffer_view.is_none() || image.mime_type.is_none()) {
            return Err(malformed(format!("image {number} is nowhere; export the scene with its pictures")));
        }
    }
    for (number, camera) in root.cameras.iter().enumerate() {
        let is_whole = match camera.type_ {
            Checked::Valid(Type::Perspective) => camera.perspective.is_some(),
            Checked::Valid(Type::Orthographic) => camera.orthographic.is_some(),
            Checked::Invalid => false,
        };
        if !is_whole {
            return Err(malformed(format!(
                "camera {number} has no lens; export the scene again, or leave it out"
            )));
        }
    }
    Ok(())
}
