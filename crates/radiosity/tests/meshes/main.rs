//! Mesh files: what is read from each format, what is refused or told, what is found in a mesh, and that no file,
//! however broken, does worse than to be refused.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the message, in its helpers too")]

mod errors;
mod examined;
mod files;
mod gltf;
mod mutations;
mod normals;
mod view3d;
mod write;

use radiosity::scene::{Error, Loaded, load_unlit};
use std::path::PathBuf;

/// The folder of a test.
fn folder(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("meshes").join(name);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// Loads a file with these bytes from the folder of a test.
fn read(test: &str, name: &str, bytes: &[u8]) -> Result<Loaded, Error> {
    let path = folder(test).join(name);
    std::fs::write(&path, bytes).unwrap();
    load_unlit(&path)
}
