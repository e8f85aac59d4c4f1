//! Baked light, read back by a library that did not write it.

#![expect(clippy::unwrap_used, reason = "a test may panic")]

use exr::prelude::{ReadChannels, ReadLayers, read};
use fredholm::value::Rgb;
use glam::DVec3;
use radiosity::adaptive::{Domain, Field, Request, solve};
use radiosity::bake::{Atlas, Lightmap, VertexLight};
use radiosity::export::{write_exr, write_glb, write_vertex_glb};
use radiosity::polygon::Polygon;
use radiosity::reconstruct::Lit;
use radiosity::scene::{Camera, Scene, cornell_box};
use std::f64::consts::{FRAC_1_PI, PI};
use std::io::Cursor;

const SIZE: usize = 128;

fn camera() -> Camera {
    Camera {
        position: DVec3::new(0.3, 0.3, -0.8),
        target: DVec3::new(0.3, 0.3, 0.3),
        up: DVec3::Y,
        vertical_angle: 0.7,
    }
}

fn baked<R>(look: impl FnOnce(&Scene<Rgb>, &[Polygon], &Field<'_, Rgb>, &Lightmap<Rgb>) -> R) -> R {
    let scene = cornell_box();
    let polygons = scene.polygons();
    let domain = Domain::new(&scene, &polygons).unwrap();
    let field = solve(&domain, &Request { accuracy: 0.1, ..Request::default() }, |_| true);
    let lightmap = Lightmap::new(Atlas::new(&polygons, SIZE).unwrap(), &field, &polygons, &|_| ());
    look(&scene, &polygons, &field, &lightmap)
}

/// IEC 61966-2-1, backwards.
fn linear(byte: u8) -> f64 {
    let c = f64::from(byte) / 255.0;
    if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}

#[test]
fn a_gltf_shows_the_radiance_of_every_surface() {
    baked(|scene, polygons, field, lightmap| {
        let mut bytes = Vec::new();
        let extras = serde_json::json!({ "unit": "W/(m² sr)" });
        write_glb(scene, lightmap, &camera(), &extras, &mut bytes).unwrap();
        let gltf::Gltf { document, blob } = gltf::Gltf::from_slice(&bytes).unwrap();
        let blob = blob.unwrap();
        assert_eq!(document.meshes().count(), scene.surfaces.len());
        let gltf::image::Source::View { view, mime_type: "image/png" } =
            document.images().next().unwrap().source()
        else {
            panic!("the texture is elsewhere")
        };
        let texture = image::load_from_memory(&blob[view.offset()..][..view.length()]).unwrap().into_rgb8();
        assert_eq!(texture.dimensions(), (SIZE as u32, SIZE as u32));
        let mut first = 0;
        for (mesh, surface) in document.meshes().zip(&scene.surfaces) {
            assert_eq!(mesh.name(), Some(surface.name.as_str()));
            let primitive = mesh.primitives().next().unwrap();
            let reader = primitive.reader(|_| Some(&blob));
            let positions: Vec<[f32; 3]> = reader.read_positions().unwrap().collect();
            let places: Vec<[f32; 2]> = reader.read_tex_coords(0).unwrap().into_f32().collect();
            let corners: Vec<usize> = reader.read_indices().unwrap().into_u32().map(|k| k as usize).collect();
            let strength = f64::from(primitive.material().emissive_strength().unwrap());
            let vector = |k: usize| DVec3::from(positions[k].map(f64::from));
            let area: f64 = corners
                .chunks(3)
                .map(|t| 0.5 * (vector(t[1]) - vector(t[0])).cross(vector(t[2]) - vector(t[0])).length())
                .sum();
            assert!((area / surface.area() - 1.0).abs() < 1e-6, "{}", surface.name);
            // In the middle of each triangle, where the nearest texel is at most half a diagonal away.
            for corner in corners.chunks(3) {
                let third = |k: usize| corner.iter().map(|&c| f64::from(places[c][k])).sum::<f64>() / 3.0;
                let [x, y] = [third(0), third(1)].map(|c| (c * SIZE as f64) as usize);
                let pixel = &texture.get_pixel(x as u32, y as u32).0;
                let middle = corner.iter().map(|&c| vector(c)).sum::<DVec3>() / 3.0;
                let face = (first..first + surface.polygons.len())
                    .min_by(|&a, &b| {
                        let outside = |k: usize| {
                            polygons[k].distance_outside(middle) + polygons[k].height_of(middle).abs()
                        };
                        outside(a).total_cmp(&outside(b))
                    })
                    .unwrap();
                // What is under a block nobody sees.
                if field.is_covered(face as u32, middle) {
                    continue;
                }
                let expected = field.radiosity(face as u32, middle).0.map(|b| b * FRAC_1_PI);
                for (byte, expected) in pixel.iter().zip(expected) {
                    let got = linear(*byte) * strength;
                    // Light changes by so much within a texel of 2 cm.
                    assert!(
                        (got - expected).abs() < 0.08 * strength,
                        "{}: {got} for {expected}",
                        surface.name
                    );
                }
            }
            first += surface.polygons.len();
        }
        let looks = document.nodes().find(|node| node.camera().is_some()).unwrap();
        assert!(matches!(
            looks.camera().unwrap().projection(),
            gltf::camera::Projection::Perspective(p) if (p.yfov() - 0.7).abs() < 1e-6
        ));
    });
}

/// A lightmap between its texels, as a bilinear filter has it.
fn filtered(lightmap: &Lightmap<Rgb>, k: usize, point: DVec3) -> f64 {
    let at = lightmap.atlas.place(k, point) * SIZE as f64 - 0.5;
    let (first, part) = (at.floor(), at - at.floor());
    let of =
        |x: usize, y: usize| lightmap.irradiance[(first.y as usize + y) * SIZE + first.x as usize + x].0[1];
    let row = |y: usize| of(0, y) * (1.0 - part.x) + of(1, y) * part.x;
    row(0) * (1.0 - part.y) + row(1) * part.y
}

#[test]
fn there_is_no_dark_seam_along_the_foot_of_what_stands_on_a_floor() {
    baked(|_, _, field, lightmap| {
        // The side of the tall block that is nearer to the lamp, seen from a tenth of a texel before it.
        let (from, to) = (DVec3::new(0.423, 0.0, 0.247), DVec3::new(0.265, 0.0, 0.296));
        let before = (to - from).cross(DVec3::Y).normalize() * (0.1 / lightmap.atlas.density);
        assert!(before.z < 0.0);
        for k in 1..20 {
            let point = from.lerp(to, f64::from(k) / 20.0) + before;
            let expected = field.irradiance(0, point).0[1];
            let got = filtered(lightmap, 0, point);
            assert!((got / expected - 1.0).abs() < 0.1, "{point}: {got} for {expected}");
        }
    });
}

#[test]
fn openexr_has_the_irradiance_and_its_unit() {
    baked(|_, _, _, lightmap| {
        let mut bytes = Vec::new();
        write_exr(lightmap, "irradiance in W/m²", &mut bytes).unwrap();
        let image = read()
            .no_deep_data()
            .largest_resolution_level()
            .rgb_channels(
                |size, _| vec![[0.0_f32; 3]; size.0 * size.1],
                |pixels, at, (r, g, b): (f32, f32, f32)| pixels[at.1 * SIZE + at.0] = [r, g, b],
            )
            .first_valid_layer()
            .all_attributes()
            .from_buffered(Cursor::new(bytes))
            .unwrap();
        let pixels = &image.layer_data.channel_data.pixels;
        for (got, expected) in pixels.iter().zip(&lightmap.irradiance) {
            assert_eq!(*got, expected.0.map(|c| c as f32));
        }
        assert!(image.layer_data.attributes.comments.unwrap().to_string().contains("W/m²"));
        // A note that would be lost is not written as none.
        assert!(write_exr(lightmap, "ρ H/π", &mut Vec::new()).is_err());
        // The lamp's power is 1 in all, and all of it arrives somewhere first.
        assert!(lightmap.irradiance.iter().any(|h| h.0[0] > 0.1 * PI));
    });
}

#[test]
fn the_same_bytes_come_from_any_number_of_threads() {
    let bytes = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut bytes = Vec::new();
            baked(|scene, _, _, lightmap| {
                write_glb(scene, lightmap, &camera(), &serde_json::json!({}), &mut bytes).unwrap();
                write_exr(lightmap, "", &mut bytes).unwrap();
            });
            with_vertices(|scene, _, _, light| {
                write_vertex_glb(scene, light, &camera(), &serde_json::json!({}), &mut bytes).unwrap();
            });
            bytes
        })
    };
    assert!(bytes(1) == bytes(3));
}

/// A triangle of a file: its surface's name, its corners, and the radiance there.
struct Triangle {
    surface: String,
    corners: [DVec3; 3],
    radiance: [[f64; 3]; 3],
}

/// The triangles of a binary glTF with colours of vertices, as the `gltf` crate reads them.
fn triangles(bytes: &[u8]) -> Vec<Triangle> {
    let gltf::Gltf { document, blob } = gltf::Gltf::from_slice(bytes).unwrap();
    let blob = blob.unwrap();
    let mut all = Vec::new();
    for mesh in document.meshes() {
        let primitive = mesh.primitives().next().unwrap();
        let material = primitive.material();
        assert!(material.unlit(), "a viewer would add light of its own");
        let extras: serde_json::Value =
            serde_json::from_str(material.extras().as_ref().unwrap().get()).unwrap();
        let one = extras["radiance_of_1"].as_f64().unwrap();
        let reader = primitive.reader(|_| Some(&blob));
        let positions: Vec<[f32; 3]> = reader.read_positions().unwrap().collect();
        let gltf::mesh::util::ReadColors::RgbF32(colours) = reader.read_colors(0).unwrap() else {
            panic!("no floats")
        };
        let colours: Vec<[f32; 3]> = colours.collect();
        assert!(colours.iter().flatten().all(|c| (0.0..=1.0).contains(c)), "glTF wants colours from 0 to 1");
        let corners: Vec<u32> = reader.read_indices().unwrap().into_u32().collect();
        all.extend(corners.chunks(3).map(|t| {
            let at = |k: usize| t[k] as usize;
            Triangle {
                surface: mesh.name().unwrap().to_owned(),
                corners: [0, 1, 2].map(|k| DVec3::from(positions[at(k)].map(f64::from))),
                radiance: [0, 1, 2].map(|k| colours[at(k)].map(|c| f64::from(c) * one)),
            }
        }));
    }
    all
}

fn with_vertices<R>(
    look: impl FnOnce(&Scene<Rgb>, &[Polygon], &Field<'_, Rgb>, &VertexLight<Rgb>) -> R,
) -> R {
    let scene = cornell_box();
    let polygons = scene.polygons();
    let domain = Domain::new(&scene, &polygons).unwrap();
    let field = || solve(&domain, &Request { accuracy: 0.1, ..Request::default() }, |_| true);
    let light = VertexLight::new(&scene, &field(), &polygons, VERTEX_ERROR, &|_, _| ());
    look(&scene, &polygons, &field(), &light)
}

const VERTEX_ERROR: f64 = 0.03;

#[test]
fn colours_of_vertices_are_the_radiance_of_every_surface() {
    with_vertices(|scene, polygons, field, light| {
        assert!(light.error <= VERTEX_ERROR, "{}", light.error);
        let mut bytes = Vec::new();
        write_vertex_glb(scene, light, &camera(), &serde_json::json!({}), &mut bytes).unwrap();
        let all = triangles(&bytes);
        assert_eq!(all.len(), light.size()[1]);
        let (mut square, mut whole) = (0.0, 0.0);
        for triangle in &all {
            let [a, b, c] = triangle.corners;
            let area = 0.5 * (b - a).cross(c - a).length();
            let middle = (a + b + c) / 3.0;
            let outside = |k: &usize| {
                polygons[*k].distance_outside(middle).max(0.0) + polygons[*k].height_of(middle).abs()
            };
            let face = (0..polygons.len()).min_by(|k, l| outside(k).total_cmp(&outside(l))).unwrap();
            // Fronts are where they were.
            assert!((b - a).cross(c - a).dot(polygons[face].normal()) > 0.0, "{}", triangle.surface);
            if field.is_covered(face as u32, middle) {
                continue;
            }
            let expected = field.radiosity(face as u32, middle).0;
            for (c, expected) in expected.iter().enumerate() {
                let mean = triangle.radiance.iter().map(|corner| corner[c]).sum::<f64>() / 3.0;
                square += area * (PI * mean - expected).powi(2);
            }
            whole += area;
        }
        // The middles are further from the corners than the points that are looked at, or nearer: at random.
        let error = (square / whole).sqrt() / field.scale();
        assert!(error < 1.5 * VERTEX_ERROR, "{error}");
        let area = |name: &str| -> f64 {
            let own = all.iter().filter(|triangle| triangle.surface == name);
            own.map(|t| 0.5 * (t.corners[1] - t.corners[0]).cross(t.corners[2] - t.corners[0]).length()).sum()
        };
        for surface in &scene.surfaces {
            assert!((area(&surface.name) / surface.area() - 1.0).abs() < 1e-6, "{}", surface.name);
        }
    });
}

#[test]
fn a_mesh_with_colours_has_no_cracks() {
    with_vertices(|_, polygons, _, light| {
        for surface in &light.surfaces {
            let mut edges = std::collections::HashMap::new();
            let bits = |k: u32| surface.points[k as usize].as_vec3().to_array().map(f32::to_bits);
            for t in &surface.triangles {
                for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                    *edges.entry([bits(a), bits(b)]).or_insert(0) += 1;
                }
            }
            // Within a face each edge is that of a neighbour as well, the other way; at its rim it lies on an edge of the face.
            for [a, b] in edges.keys().filter(|[a, b]| !edges.contains_key(&[*b, *a])) {
                let middle = [a, b].map(|v| DVec3::from(v.map(|c| f64::from(f32::from_bits(c)))));
                let middle = middle[0].midpoint(middle[1]);
                let is_rim = |polygon: &Polygon| {
                    polygon.height_of(middle).abs() < 1e-6 && polygon.distance_outside(middle).abs() < 1e-6
                };
                assert!(polygons.iter().any(is_rim), "a crack at {middle}");
            }
        }
    });
}
