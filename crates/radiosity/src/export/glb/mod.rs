//! A baked scene as binary glTF 2.0: surfaces that show the light that leaves them, and reflect none.
//!
//! Light is a texture ([`write_glb`]) or colours of vertices ([`write_vertex_glb`]). Either is radiance, B/π, in W/(m² sr) or cd/m²
//! once it is multiplied by what the material says; three.js and Bevy show it as it is, whatever lamps they have. Lengths are metres;
//! the up direction of the scene is turned to +Y. The unit, the quantity and the error stand in `asset.extras`.

mod buffer;
mod lightmap;
mod vertices;

pub use lightmap::write_glb;
pub use vertices::write_vertex_glb;

use self::buffer::{Buffer, write_chunks};
use crate::scene::Camera;
use glam::{DMat3, DQuat, DVec3};
use serde_json::{Value as Json, json};
use std::io::{self, Write};

/// What a document is made of: a primitive and a material for each surface, and whatever else it has.
struct Parts<'a> {
    buffer: Buffer,
    primitives: Vec<(&'a str, Json)>,
    materials: Vec<Json>,
    more: Json,
}

/// Writes the document: a node for each surface and one for the camera, under one that turns the scene upright.
fn write(
    name: &str,
    parts: Parts<'_>,
    camera: &Camera,
    extras: &Json,
    out: &mut impl Write,
) -> io::Result<()> {
    let Parts { buffer, primitives, materials, more } = parts;
    let mut nodes: Vec<Json> =
        primitives.iter().enumerate().map(|(k, (name, _))| json!({ "name": name, "mesh": k })).collect();
    let meshes: Vec<Json> = primitives
        .into_iter()
        .map(|(name, primitive)| json!({ "name": name, "primitives": [primitive] }))
        .collect();
    nodes.push(camera_node(camera));
    let children: Vec<usize> = (0..nodes.len()).collect();
    let turn = DQuat::from_rotation_arc(upward(camera.up), DVec3::Y);
    nodes.push(json!({ "name": name, "children": children, "rotation": turn.to_array() }));
    let mut document = json!({
        "asset": { "version": "2.0", "generator": concat!("fredholm ", env!("CARGO_PKG_VERSION")), "extras": extras },
        "scene": 0,
        "scenes": [{ "name": name, "nodes": [nodes.len() - 1] }],
        "nodes": nodes,
        "cameras": [{ "type": "perspective", "perspective": {
            "yfov": camera.vertical_angle, "znear": 1e-3 * (camera.target - camera.position).length() } }],
        "meshes": meshes,
        "materials": materials,
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{ "byteLength": buffer.bytes.len() }],
    });
    for (key, value) in more.as_object().into_iter().flatten() {
        document[key] = value.clone();
    }
    write_chunks(&serde_json::to_vec(&document)?, &buffer.bytes, out)
}

/// The axis that is nearest to the camera's up: scenes stand upright.
fn upward(up: DVec3) -> DVec3 {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| [axis, -axis]);
    axes.max_by(|a, b| a.dot(up).total_cmp(&b.dot(up))).unwrap_or(DVec3::Y)
}

fn camera_node(camera: &Camera) -> Json {
    let back = (camera.position - camera.target).normalize();
    let right = camera.up.cross(back).normalize();
    let turn = DQuat::from_mat3(&DMat3::from_cols(right, back.cross(right), back));
    json!({ "name": "camera", "camera": 0, "translation": camera.position.to_array(), "rotation": turn.to_array() })
}
