//! A baked scene as binary glTF 2.0: surfaces that glow with the light that leaves them, and reflect none.
//!
//! The radiance B/π of all surfaces is one texture, which each material's `KHR_materials_emissive_strength` brings to its unit,
//! W/(m² sr) or cd/m²; base colour and specular reflectance are 0, so that a viewer's own lamps add nothing. Lengths are
//! metres; the up direction of the scene is turned to +Y. The unit, the quantity and the error stand in `asset.extras`.

use crate::bake::Lightmap;
use crate::render::{Colour, srgb};
use crate::scene::{Camera, Scene, Surface};
use fredholm::value::{Rgb, Value};
use glam::{DMat3, DQuat, DVec3};
use image::{ImageFormat, RgbImage};
use serde_json::{Value as Json, json};
use std::f64::consts::FRAC_1_PI;
use std::io::{self, Cursor, Write};

/// Writes the surfaces of a scene with a lightmap of them, and a camera. `extras` are said of the whole file.
pub fn write_glb<V: Colour>(
    scene: &Scene<V>,
    lightmap: &Lightmap<V>,
    camera: &Camera,
    extras: &Json,
    out: &mut impl Write,
) -> io::Result<()> {
    let mut file = File::default();
    let mut first = 0;
    let (mut meshes, mut materials, mut nodes) = (Vec::new(), Vec::new(), Vec::new());
    let mut texture = RgbImage::new(lightmap.atlas.size as u32, lightmap.atlas.size as u32);
    for (k, surface) in scene.surfaces.iter().enumerate() {
        let strength = paint(&mut texture, surface, first, lightmap);
        meshes.push(
            json!({ "name": surface.name, "primitives": [file.primitive(surface, first, lightmap, k)] }),
        );
        materials.push(material(&surface.name, strength));
        nodes.push(json!({ "name": surface.name, "mesh": k }));
        first += surface.polygons.len();
    }
    let up = upward(camera.up);
    let turn = DQuat::from_rotation_arc(up, DVec3::Y);
    nodes.push(camera_node(camera));
    let children: Vec<usize> = (0..nodes.len()).collect();
    nodes.push(json!({ "name": scene.name, "children": children, "rotation": turn.to_array() }));
    let mut png = Cursor::new(Vec::new());
    texture.write_to(&mut png, ImageFormat::Png).map_err(io::Error::other)?;
    let image = file.view(png.get_ref());
    let document = json!({
        "asset": { "version": "2.0", "generator": concat!("fredholm ", env!("CARGO_PKG_VERSION")), "extras": extras },
        "extensionsUsed": ["KHR_materials_emissive_strength", "KHR_materials_specular"],
        "scene": 0,
        "scenes": [{ "name": scene.name, "nodes": [nodes.len() - 1] }],
        "nodes": nodes,
        "cameras": [{ "type": "perspective", "perspective": {
            "yfov": camera.vertical_angle, "znear": 1e-3 * (camera.target - camera.position).length() } }],
        "meshes": meshes,
        "materials": materials,
        "textures": [{ "source": 0, "sampler": 0 }],
        "images": [{ "bufferView": image, "mimeType": "image/png" }],
        // Bilinear without mipmaps, which would mix what lies side by side in the atlas; clamped.
        "samplers": [{ "magFilter": 9729, "minFilter": 9729, "wrapS": 33071, "wrapT": 33071 }],
        "accessors": file.accessors,
        "bufferViews": file.views,
        "buffers": [{ "byteLength": file.bytes.len() }],
    });
    write_chunks(&serde_json::to_vec(&document)?, &file.bytes, out)
}

/// The binary buffer, and what is where in it.
#[derive(Default)]
struct File {
    bytes: Vec<u8>,
    views: Vec<Json>,
    accessors: Vec<Json>,
}

/// Component types of glTF.
const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;

impl File {
    fn view(&mut self, bytes: &[u8]) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.push(json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() }));
        self.bytes.extend_from_slice(bytes);
        self.views.len() - 1
    }

    fn accessor(&mut self, bytes: &[u8], kind: &str, component: u32, count: usize) -> usize {
        let view = self.view(bytes);
        self.accessors
            .push(json!({ "bufferView": view, "componentType": component, "count": count, "type": kind }));
        self.accessors.len() - 1
    }

    fn vectors<const N: usize>(&mut self, vectors: &[[f32; N]]) -> usize {
        let bytes: Vec<u8> = vectors.iter().flatten().flat_map(|c| c.to_le_bytes()).collect();
        self.accessor(&bytes, &format!("VEC{N}"), FLOAT, vectors.len())
    }

    /// The polygons of a surface, the first of which has this number, as triangles.
    fn primitive<V: Value>(
        &mut self,
        surface: &Surface<V>,
        first: usize,
        lightmap: &Lightmap<V>,
        material: usize,
    ) -> Json {
        let (mut positions, mut normals, mut places, mut corners) =
            (Vec::new(), Vec::new(), Vec::new(), Vec::<u32>::new());
        for (polygon, number) in surface.polygons.iter().zip(first..) {
            let base = positions.len() as u32;
            for &vertex in polygon.vertices() {
                positions.push(vertex.as_vec3().to_array());
                normals.push(polygon.on_curve(vertex).1.as_vec3().to_array());
                places.push(lightmap.atlas.place(number, vertex).as_vec2().to_array());
            }
            (2..polygon.vertices().len() as u32).for_each(|k| corners.extend([base, base + k - 1, base + k]));
        }
        let position = self.vectors(&positions);
        let bound = |pick: fn(f32, f32) -> f32| {
            positions.iter().copied().reduce(|a, b| [0, 1, 2].map(|c| pick(a[c], b[c]))).unwrap_or_default()
        };
        self.accessors[position]["min"] = json!(bound(f32::min));
        self.accessors[position]["max"] = json!(bound(f32::max));
        let attributes = json!({
            "POSITION": position, "NORMAL": self.vectors(&normals), "TEXCOORD_0": self.vectors(&places) });
        let bytes: Vec<u8> = corners.iter().flat_map(|corner| corner.to_le_bytes()).collect();
        let indices = self.accessor(&bytes, "SCALAR", UNSIGNED_INT, corners.len());
        json!({ "attributes": attributes, "indices": indices, "material": material })
    }
}

/// Paints the radiance of a surface, as a part of its largest one, which is returned.
fn paint<V: Colour>(
    texture: &mut RgbImage,
    surface: &Surface<V>,
    first: usize,
    lightmap: &Lightmap<V>,
) -> f64 {
    let size = lightmap.atlas.size;
    let texels = surface.polygons.iter().zip(first..).flat_map(|(p, k)| lightmap.atlas.texels(k, p));
    let light: Vec<(usize, Rgb)> =
        texels.map(|(texel, _)| (texel, lightmap.radiosity[texel].to_rgb() * FRAC_1_PI)).collect();
    let largest = light.iter().flat_map(|(_, radiance)| radiance.0).fold(0.0, f64::max);
    for (texel, radiance) in light.into_iter().filter(|_| largest > 0.0) {
        let pixel = radiance.0.map(|c| (255.0 * srgb((c / largest).max(0.0))).round() as u8);
        texture.put_pixel((texel % size) as u32, (texel / size) as u32, image::Rgb(pixel));
    }
    largest
}

fn material(name: &str, strength: f64) -> Json {
    json!({
        "name": name,
        "pbrMetallicRoughness": { "baseColorFactor": [0.0, 0.0, 0.0, 1.0], "metallicFactor": 0.0, "roughnessFactor": 1.0 },
        "emissiveTexture": { "index": 0 },
        "emissiveFactor": [1.0, 1.0, 1.0],
        "extensions": {
            "KHR_materials_emissive_strength": { "emissiveStrength": strength },
            "KHR_materials_specular": { "specularFactor": 0.0 },
        },
    })
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

/// The container: a header, the JSON, the buffer; each chunk a multiple of four bytes long.
fn write_chunks(json: &[u8], bytes: &[u8], out: &mut impl Write) -> io::Result<()> {
    let padded = |length: usize| length.next_multiple_of(4);
    let total = 12 + 8 + padded(json.len()) + 8 + padded(bytes.len());
    let total = u32::try_from(total).map_err(|_| io::Error::other("a GLB file has 4 GB at most"))?;
    out.write_all(b"glTF")?;
    out.write_all(&[2_u32, total].map(u32::to_le_bytes).concat())?;
    for (kind, chunk, filler) in [(b"JSON", json, b' '), (b"BIN\0", bytes, 0)] {
        out.write_all(&(padded(chunk.len()) as u32).to_le_bytes())?;
        out.write_all(kind)?;
        out.write_all(chunk)?;
        out.write_all(&vec![filler; padded(chunk.len()) - chunk.len()])?;
    }
    Ok(())
}
