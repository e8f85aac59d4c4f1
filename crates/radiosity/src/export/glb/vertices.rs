//! The radiance B/π at vertices as `COLOR_0`, linear floats, of materials that are `KHR_materials_unlit`.
//!
//! glTF wants colours from 0 to 1, and an unlit material has no strength. So 1 is the largest radiance of all surfaces that do not emit,
//! and of one that emits its own largest if that is larger: its `extras.radiance_of_1` says how much, in the unit of the file.

use super::buffer::Buffer;
use super::{Parts, write};
use crate::bake::{VertexLight, Vertices};
use crate::render::Colour;
use crate::scene::{Camera, Scene};
use serde_json::{Value as Json, json};
use std::f64::consts::FRAC_1_PI;
use std::io::{self, Write};

/// Writes the triangles of a scene with light at their corners, and a camera. `extras` are said of the whole file.
pub fn write_vertex_glb<V: Colour>(
    scene: &Scene<V>,
    light: &VertexLight<V>,
    camera: &Camera,
    extras: &Json,
    out: &mut impl Write,
) -> io::Result<()> {
    let mut buffer = Buffer::default();
    let (mut primitives, mut materials) = (Vec::new(), Vec::new());
    let largest: Vec<f64> = light.surfaces.iter().map(largest).collect();
    let reflecting = scene.surfaces.iter().zip(&largest).filter(|(s, _)| s.emission == V::splat(0.0));
    let common = reflecting.map(|(_, largest)| *largest).fold(0.0, f64::max);
    for (k, (surface, vertices)) in scene.surfaces.iter().zip(&light.surfaces).enumerate() {
        let one = if surface.emission == V::splat(0.0) { common } else { common.max(largest[k]) };
        // Where no light is at all, black times anything is black.
        let one = if one > 0.0 { one } else { 1.0 };
        if vertices.triangles.is_empty() {
            continue;
        }
        let material = materials.len();
        materials.push(json!({
            "name": surface.name,
            "extensions": { "KHR_materials_unlit": {} },
            "pbrMetallicRoughness": { "metallicFactor": 0.0, "roughnessFactor": 1.0 },
            "extras": { "radiance_of_1": one },
        }));
        primitives.push((surface.name.as_str(), primitive(&mut buffer, vertices, one, material)));
    }
    let more = json!({ "extensionsUsed": ["KHR_materials_unlit"] });
    write(&scene.name, Parts { buffer, primitives, materials, more }, camera, extras, out)
}

/// The largest channel of radiance at the vertices of a surface.
fn largest<V: Colour>(vertices: &Vertices<V>) -> f64 {
    vertices.radiosity.iter().flat_map(|b| b.to_rgb().0).fold(0.0, f64::max) * FRAC_1_PI
}

fn primitive<V: Colour>(buffer: &mut Buffer, vertices: &Vertices<V>, one: f64, material: usize) -> Json {
    let arrays = |vectors: &[glam::DVec3]| -> Vec<[f32; 3]> {
        vectors.iter().map(|vector| vector.as_vec3().to_array()).collect()
    };
    let colour = |b: &V| b.to_rgb().0.map(|c| (c * FRAC_1_PI / one).clamp(0.0, 1.0) as f32);
    let colours: Vec<[f32; 3]> = vertices.radiosity.iter().map(colour).collect();
    let attributes = json!({
        "POSITION": buffer.positions(&arrays(&vertices.points)),
        "NORMAL": buffer.vectors(&arrays(&vertices.normals)),
        "COLOR_0": buffer.vectors(&colours),
    });
    let corners: Vec<u32> = vertices.triangles.iter().flatten().copied().collect();
    json!({ "attributes": attributes, "indices": buffer.indices(corners.into_iter()), "material": material })
}
