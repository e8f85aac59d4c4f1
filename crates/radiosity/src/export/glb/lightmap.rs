//! The radiance B/π of all surfaces as one texture, which each material's `KHR_materials_emissive_strength` brings to its unit;
//! base colour and specular reflectance are 0, so that a viewer's own lamps add nothing.

use super::buffer::Buffer;
use super::{Parts, write};
use crate::bake::Lightmap;
use crate::render::{Colour, srgb};
use crate::scene::{Camera, Scene, Surface};
use fredholm::value::{Rgb, Value};
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
    let mut buffer = Buffer::default();
    let mut first = 0;
    let (mut primitives, mut materials) = (Vec::new(), Vec::new());
    let mut texture = RgbImage::new(lightmap.atlas.size as u32, lightmap.atlas.size as u32);
    for (k, surface) in scene.surfaces.iter().enumerate() {
        let strength = paint(&mut texture, surface, first, lightmap);
        primitives.push((surface.name.as_str(), primitive(&mut buffer, surface, first, lightmap, k)));
        materials.push(material(&surface.name, strength));
        first += surface.polygons.len();
    }
    let mut png = Cursor::new(Vec::new());
    texture.write_to(&mut png, ImageFormat::Png).map_err(io::Error::other)?;
    let image = buffer.view(png.get_ref());
    let textures = json!({
        "extensionsUsed": ["KHR_materials_emissive_strength", "KHR_materials_specular"],
        "textures": [{ "source": 0, "sampler": 0 }],
        "images": [{ "bufferView": image, "mimeType": "image/png" }],
        // Bilinear without mipmaps, which would mix what lies side by side in the atlas; clamped.
        "samplers": [{ "magFilter": 9729, "minFilter": 9729, "wrapS": 33071, "wrapT": 33071 }],
    });
    write(&scene.name, Parts { buffer, primitives, materials, more: textures }, camera, extras, out)
}

/// The polygons of a surface, the first of which has this number, as triangles.
fn primitive<V: Value>(
    buffer: &mut Buffer,
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
    let attributes = json!({
        "POSITION": buffer.positions(&positions),
        "NORMAL": buffer.vectors(&normals),
        "TEXCOORD_0": buffer.vectors(&places),
    });
    json!({ "attributes": attributes, "indices": buffer.indices(corners.into_iter()), "material": material })
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
