//! glTF: the same solid by every way of writing it, materials and textures, lights, a camera, and what is wrong told.

use crate::write::{Mesh, binary_stl, cube, triangulated};
use crate::{folder, read};
use fredholm::value::Spectrum;
use glam::DVec3;
use radiosity::scene::{CleanUp, Distribution, Light, Loaded, PointLight, Spot, load, load_unlit};
use std::f64::consts::PI;

/// A file with one node of one mesh, whose pieces can be exchanged.
#[derive(Clone)]
pub struct Scene {
    bytes: Vec<u8>,
    views: Vec<String>,
    accessors: Vec<String>,
    pub primitive: String,
    pub node: String,
    /// More of the top level, each with a comma before it.
    pub rest: String,
}

const F32: u32 = 5126;

impl Scene {
    /// A mesh of triangles, indexed.
    pub fn new(mesh: &Mesh) -> Self {
        let (bytes, views, accessors, primitive, node, rest) = Default::default();
        let mut scene = Self { bytes, views, accessors, primitive, node, rest };
        let numbers: Vec<f64> = mesh.vertices.iter().flat_map(DVec3::to_array).collect();
        let positions = scene.floats(&numbers, 3);
        let indices: Vec<u8> =
            mesh.faces.iter().flatten().flat_map(|corner| (*corner as u16).to_le_bytes()).collect();
        let indices = scene.accessor(&indices, 5123, "SCALAR", indices.len() / 2);
        scene.primitive = format!("\"attributes\":{{\"POSITION\":{positions}}},\"indices\":{indices}");
        scene
    }

    /// An accessor of new bytes; its number.
    pub fn accessor(&mut self, bytes: &[u8], kind: u32, shape: &str, count: usize) -> usize {
        let view = self.view(bytes);
        let text = format!(
            "{{\"bufferView\":{view},\"componentType\":{kind},\"type\":\"{shape}\",\"count\":{count}}}"
        );
        self.accessors.push(text);
        self.accessors.len() - 1
    }

    pub fn view(&mut self, bytes: &[u8]) -> usize {
        let (at, length) = (self.bytes.len(), bytes.len());
        self.bytes.extend(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.push(format!("{{\"buffer\":0,\"byteOffset\":{at},\"byteLength\":{length}}}"));
        self.views.len() - 1
    }

    /// Floats, with the least and the largest of each component, as positions must have them.
    pub fn floats(&mut self, numbers: &[f64], components: usize) -> usize {
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| (*number as f32).to_le_bytes()).collect();
        let count = numbers.len() / components;
        let accessor = self.accessor(&bytes, F32, ["", "SCALAR", "VEC2", "VEC3"][components], count);
        let by_component = |pick: fn(f64, f64) -> f64| {
            let of =
                |c: usize| numbers.iter().skip(c).step_by(components).copied().reduce(pick).unwrap_or(0.0);
            (0..components).map(|c| of(c).to_string()).collect::<Vec<_>>().join(",")
        };
        let (least, most) = (by_component(f64::min), by_component(f64::max));
        let text = &mut self.accessors[accessor];
        *text = text.replacen('{', &format!("{{\"min\":[{least}],\"max\":[{most}],"), 1);
        accessor
    }

    /// Gives the primitive one more attribute.
    pub fn attribute(&mut self, name: &str, accessor: usize) {
        self.primitive = self.primitive.replacen(
            "\"attributes\":{",
            &format!("\"attributes\":{{\"{name}\":{accessor},"),
            1,
        );
    }

    fn json(&self, uri: &str) -> String {
        format!(
            "{{\"asset\":{{\"version\":\"2.0\"}},\"scene\":0,\"scenes\":[{{\"nodes\":[0]}}],\"nodes\":[{{\"mesh\":0{}}}],\
             \"meshes\":[{{\"name\":\"part\",\"primitives\":[{{{}}}]}}],\"accessors\":[{}],\"bufferViews\":[{}],\
             \"buffers\":[{{{uri}\"byteLength\":{}}}]{}}}",
            self.node,
            self.primitive,
            self.accessors.join(","),
            self.views.join(","),
            self.bytes.len(),
            self.rest
        )
    }

    pub fn glb(&self) -> Vec<u8> {
        let mut json = self.json("").into_bytes();
        json.resize(json.len().next_multiple_of(4), b' ');
        let length = 12 + 8 + json.len() + 8 + self.bytes.len();
        let word = |number: usize| (number as u32).to_le_bytes();
        [
            b"glTF",
            &word(2)[..],
            &word(length),
            &word(json.len()),
            b"JSON",
            &json,
            &word(self.bytes.len()),
            b"BIN\0",
            &self.bytes,
        ]
        .concat()
    }

    /// With its buffer in the text.
    pub fn embedded(&self) -> Vec<u8> {
        const LETTERS: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        let mut text = String::new();
        for three in self.bytes.chunks(3) {
            let bits = (0..3).fold(0, |bits, k| bits << 8 | u32::from(three.get(k).copied().unwrap_or(0)));
            for k in 0..4 {
                let letter = char::from(LETTERS[(bits >> (18 - 6 * k) & 63) as usize]);
                text.push(if k <= three.len() { letter } else { '=' });
            }
        }
        self.json(&format!("\"uri\":\"data:application/octet-stream;base64,{text}\",")).into_bytes()
    }
}

fn cube_scene() -> Scene {
    Scene::new(&triangulated(&cube()))
}

fn loaded(test: &str, scene: &Scene) -> Loaded {
    read(test, "a.glb", &scene.glb()).unwrap()
}

#[test]
fn a_cube_is_the_same_in_text_and_binary_embedded_or_beside() {
    let scene = cube_scene();
    let expected: Vec<_> = {
        let obj = crate::write::obj(&triangulated(&cube()));
        read("gltf_ways", "cube.obj", &obj).unwrap().scene.polygons()
    };
    std::fs::write(folder("gltf_ways").join("data of it.bin"), &scene.bytes).unwrap();
    let beside = scene.json("\"uri\":\"data%20of%20it.bin\",");
    for (name, bytes) in
        [("a.glb", scene.glb()), ("b.gltf", scene.embedded()), ("c.gltf", beside.into_bytes())]
    {
        let loaded = read("gltf_ways", name, &bytes).unwrap();
        assert_eq!(loaded.scene.polygons(), expected, "{name}");
        assert_eq!((loaded.warnings.len(), loaded.faces.len()), (0, 12), "{name}: {:?}", loaded.warnings);
        assert_eq!(loaded.scene.surfaces[0].name, "part");
        assert_eq!(loaded.scene.surfaces[0].reflectance.0, [0.5; 3], "grey, as without a material");
    }
}

#[test]
fn strips_fans_and_corners_without_indices_are_triangles() {
    let p = |x, y| DVec3::new(x, y, 0.0);
    let vertices = [p(0.0, 0.0), p(1.0, 0.0), p(0.0, 1.0), p(1.0, 1.0), p(0.0, 2.0)];
    // A strip of three, a fan of three about the first, a triangle of the first three.
    for (mode, order, count) in [(5, vec![0, 1, 2, 3, 4], 3), (6, vec![0, 1, 3, 2], 2), (4, vec![0, 1, 2], 1)]
    {
        let numbers: Vec<f64> = order.iter().flat_map(|&k: &usize| vertices[k].to_array()).collect();
        let mut scene = Scene::new(&Mesh { vertices: vec![], faces: vec![] });
        let positions = scene.floats(&numbers, 3);
        scene.primitive = format!("\"attributes\":{{\"POSITION\":{positions}}},\"mode\":{mode}");
        let polygons = loaded("gltf_modes", &scene).scene.polygons();
        assert_eq!(polygons.len(), count, "{mode}");
        assert!(polygons.iter().all(|polygon| polygon.normal() == DVec3::Z), "{mode}");
        scene.primitive = format!("\"attributes\":{{\"POSITION\":{positions}}},\"mode\":1");
        assert!(read("gltf_modes", "a.glb", &scene.glb()).unwrap_err().to_string().contains("no faces"));
    }
}

#[test]
fn nodes_move_their_meshes_and_mirrors_keep_fronts() {
    let plain = loaded("gltf_nodes", &cube_scene()).scene.polygons();
    // A turn of 90° about z, a scale of 2 and a shift.
    let half = 0.5_f64.sqrt();
    let mut moved = cube_scene();
    moved.node = format!(",\"translation\":[1,2,3],\"rotation\":[0,0,{half},{half}],\"scale\":[2,2,2]");
    for (a, b) in plain.iter().zip(loaded("gltf_nodes", &moved).scene.polygons()) {
        let turned = |v: DVec3| DVec3::new(-v.y, v.x, v.z);
        assert!(b.centroid().distance(2.0 * turned(a.centroid()) + DVec3::new(1.0, 2.0, 3.0)) < 1e-6);
        assert!(b.normal().distance(turned(a.normal())) < 1e-6);
    }
    // Two nodes have the same mesh; the second is a child that mirrors, in a parent that moves.
    let mut both = cube_scene();
    both.node = ",\"children\":[1],\"translation\":[0,0,5]},{\"mesh\":0,\"name\":\"twin\",\"scale\":[-1,1,1]"
        .to_owned();
    let loaded = loaded("gltf_nodes", &both);
    let polygons = loaded.scene.polygons();
    let (first, second) = polygons.split_at(12);
    for (a, b) in first.iter().zip(second) {
        let mirrored = |v: DVec3| DVec3::new(-v.x, v.y, v.z);
        assert!(b.centroid().distance(mirrored(a.centroid())) < 1e-12);
        assert!(b.normal().distance(mirrored(a.normal())) < 1e-12, "fronts stay outside");
    }
    assert_eq!(loaded.scene.surfaces[1].name, "twin");
    assert_eq!(loaded.clean_up, CleanUp { faces_turned_round: 12, ..CleanUp::default() });
    let told = loaded.warnings[0].to_string();
    assert!(told.contains("a.glb: 1 mirrored node: the corners of their faces are turned round"), "{told}");
}

#[test]
fn normals_come_along() {
    for (node, flip) in [("", 1.0), (",\"scale\":[-1,1,0.5]", -1.0)] {
        let mut scene = cube_scene();
        let solid = cube();
        let outwards = solid.vertices.iter().map(|v| (*v - DVec3::new(0.0, 0.75, 1.5)).to_array());
        let normals = scene.floats(&outwards.flatten().collect::<Vec<_>>(), 3);
        scene.attribute("NORMAL", normals);
        scene.node = node.to_owned();
        let loaded = loaded("gltf_normals", &scene);
        assert_eq!(loaded.scene.curved_polygons(), 12);
        for polygon in loaded.scene.polygons() {
            for vertex in polygon.vertices() {
                let centre = DVec3::new(0.0, 0.75, if flip < 0.0 { 0.75 } else { 1.5 });
                let away = *vertex - centre;
                // (M⁻¹)ᵀ n of a scale by ½ along z is 2 n_z, of a vertex by ½: four times as steep.
                let expected =
                    DVec3::new(away.x, away.y, if flip < 0.0 { 4.0 * away.z } else { away.z }).normalize();
                assert!(polygon.on_curve(*vertex).1.distance(expected) < 1e-6);
            }
        }
    }
}

fn with_material(scene: &mut Scene, material: &str, rest: &str) {
    scene.primitive += ",\"material\":0";
    scene.rest = format!(",\"materials\":[{{{material}}}]{rest}");
}

#[test]
fn materials_are_reflectance_and_radiance() {
    let of = |material: &str| {
        let mut scene = cube_scene();
        with_material(&mut scene, material, ",\"extensionsUsed\":[\"KHR_materials_emissive_strength\"]");
        let loaded = loaded("gltf_materials", &scene);
        let surface = loaded.scene.surfaces[0].clone();
        let told: Vec<String> = loaded.warnings.iter().map(ToString::to_string).collect();
        (surface.reflectance.0, surface.emission.0, told.join("\n"))
    };
    let near = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6);
    let (reflectance, emission, told) = of(
        "\"name\":\"wood\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.8,0.4,0.2,1],\"metallicFactor\":0.25},\
         \"emissiveFactor\":[1,0.5,0],\"extensions\":{\"KHR_materials_emissive_strength\":{\"emissiveStrength\":4}}",
    );
    assert!(
        near(reflectance, [0.6, 0.3, 0.15]) && near(emission, [4.0 * PI, 2.0 * PI, 0.0]),
        "{reflectance:?} {emission:?}"
    );
    assert_eq!(told, "");
    let (reflectance, _, told) = of("\"name\":\"steel\",\"doubleSided\":true,\"alphaMode\":\"MASK\"");
    assert_eq!(reflectance, [0.0; 3], "metal is what a material is if it says nothing");
    for words in
        ["`steel` is metal, which reflects no light", "`steel` is double-sided", "`steel` is transparent"]
    {
        assert!(told.contains(words), "{told}");
    }
    let (reflectance, _, told) = of("\"name\":\"chalk\",\"pbrMetallicRoughness\":{\"metallicFactor\":0}");
    assert_eq!(reflectance, [0.95; 3]);
    assert!(told.contains("a.glb: the material `chalk` has the reflectance 1 in some colour"), "{told}");
    // A scene file has the last word.
    let toml = "unit = 'm'\nmeshes = ['a.glb']\n[materials.chalk]\nreflectance = 0.7\n";
    std::fs::write(folder("gltf_materials").join("a.toml"), toml).unwrap();
    let scene = load_unlit(&folder("gltf_materials").join("a.toml")).unwrap().scene;
    assert_eq!(scene.surfaces[0].reflectance.0, [0.7; 3]);
}

/// A PNG of 2 × 1 texels, the left red and the right black, with stored blocks: made by hand.
fn png() -> Vec<u8> {
    let crc = |bytes: &[u8]| {
        !bytes.iter().fold(!0_u32, |crc, byte| {
            (0..8).fold(
                crc ^ u32::from(*byte),
                |crc, _| if crc & 1 == 1 { crc >> 1 ^ 0xEDB8_8320 } else { crc >> 1 },
            )
        })
    };
    let chunk = |kind: &[u8], data: &[u8]| {
        let body = [kind, data].concat();
        [&(data.len() as u32).to_be_bytes(), &body[..], &crc(&body).to_be_bytes()].concat()
    };
    let row = [0, 188, 0, 0, 0, 0, 0];
    let (mut a, mut b) = (1_u32, 0_u32);
    for byte in row {
        (a, b) = ((a + u32::from(byte)) % 65_521, (b + a + u32::from(byte)) % 65_521);
    }
    let zlib = [&[0x78, 1, 1, 7, 0, 248, 255], &row[..], &(b << 16 | a).to_be_bytes()].concat();
    let size = [&2_u32.to_be_bytes()[..], &1_u32.to_be_bytes(), &[8, 2, 0, 0, 0]].concat();
    [b"\x89PNG\r\n\x1a\n".to_vec(), chunk(b"IHDR", &size), chunk(b"IDAT", &zlib), chunk(b"IEND", &[])]
        .concat()
}

/// A square of two triangles with the picture on it, as far as `u` goes.
pub fn pictured(u: f64, material: &str) -> Scene {
    let p = |x, y| DVec3::new(x, y, 0.0);
    let vertices = vec![p(0.0, 0.0), p(1.0, 0.0), p(1.0, 1.0), p(0.0, 1.0)];
    let mut scene = Scene::new(&Mesh { vertices, faces: vec![vec![0, 1, 2], vec![0, 2, 3]] });
    let places = scene.floats(&[0.0, 0.0, u, 0.0, u, 1.0, 0.0, 1.0], 2);
    scene.attribute("TEXCOORD_0", places);
    let image = scene.view(&png());
    let rest = format!(
        ",\"textures\":[{{\"source\":0,\"sampler\":0}}],\"samplers\":[{{\"wrapS\":33071}}],\
         \"images\":[{{\"bufferView\":{image},\"mimeType\":\"image/png\"}}]"
    );
    with_material(&mut scene, material, &rest);
    scene
}

#[test]
fn textures_are_their_means_over_each_triangle() {
    let base = "\"name\":\"wall\",\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"baseColorFactor\":[0.8,1,1,1],\
                \"baseColorTexture\":{\"index\":0}}";
    // 188 of 255 is 0.503 in linear light. The lower triangle has a quarter of its area on the left, the upper three.
    let red =
        |loaded: &Loaded| -> Vec<f64> { loaded.scene.surfaces.iter().map(|s| s.reflectance.0[0]).collect() };
    let shares =
        |loaded: &Loaded| -> Vec<f64> { red(loaded).iter().map(|red| red / (0.8 * 0.503)).collect() };
    let found = loaded("gltf_textures", &pictured(1.0, base));
    assert!(
        shares(&found).iter().zip([0.25, 0.75]).all(|(a, b)| (a - b).abs() < 0.02),
        "{:?}",
        shares(&found)
    );
    assert_eq!(found.scene.surfaces[1].name, "part~2");
    assert!(found.scene.surfaces.iter().all(|surface| surface.reflectance.0[1] == 0.0));
    // All of the left texel: one surface. Clamped at the right edge all beyond is black.
    let one = loaded("gltf_textures", &pictured(0.5, base));
    assert_eq!((one.scene.surfaces.len(), shares(&one)[0] > 0.99), (1, true));
    let clamped = loaded("gltf_textures", &pictured(2.0, base));
    assert!(
        shares(&clamped).iter().zip([1.0 / 16.0, 7.0 / 16.0]).all(|(a, b)| (a - b).abs() < 0.02),
        "{:?}",
        shares(&clamped)
    );
    // Colours of vertices multiply: 0, 1, 1 of a triangle's corners is two thirds.
    let mut coloured = pictured(0.5, base);
    let colours = coloured.accessor(&[0, 0, 0, 0, 255, 9, 9, 0, 255, 9, 9, 0, 0, 0, 0, 0], 5121, "VEC3", 4);
    let colours_text = coloured.accessors[colours].replace("\"count\"", "\"normalized\":true,\"count\"");
    coloured.accessors[colours] = colours_text;
    let view = coloured.views.last_mut().unwrap();
    *view = view.replace("\"byteLength\"", "\"byteStride\":4,\"byteLength\"");
    coloured.attribute("COLOR_0", colours);
    let found = shares(&loaded("gltf_textures", &coloured));
    assert!(found.iter().zip([2.0 / 3.0, 1.0 / 3.0]).all(|(a, b)| (a - b).abs() < 0.005), "{found:?}");
    // A picture that glows.
    let glow = "\"emissiveFactor\":[1,1,1],\"emissiveTexture\":{\"index\":0}";
    let emission = loaded("gltf_textures", &pictured(0.5, glow)).scene.surfaces[0].emission.0;
    assert!((emission[0] - PI * 0.503).abs() < 0.003 && emission[1] == 0.0, "{emission:?}");
}

#[test]
fn lights_and_the_camera_stand_where_their_nodes_do() {
    let mut scene = cube_scene();
    let light = |k: usize| format!("\"extensions\":{{\"KHR_lights_punctual\":{{\"light\":{k}}}}}");
    // The sun's node is turned about x by a quarter, so that −z becomes y; the spot's is stretched, which no axis minds.
    let quarter = "\"rotation\":[0.70710678,0,0,0.70710678]";
    scene.node = format!(
        ",\"translation\":[0,0,1],\"children\":[1,2,3,4]}},{{\"translation\":[4,5,6],{}}},{{\"name\":\"sun\",{quarter},{}}},\
         {{\"camera\":0,\"translation\":[0,-9,0],{quarter}}},{{\"name\":\"beam\",\"scale\":[3,1,2],{}",
        light(0),
        light(1),
        light(2)
    );
    scene.rest = ",\"extensionsUsed\":[\"KHR_lights_punctual\",\"EXT_other\"],\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[\
         {\"type\":\"point\",\"color\":[1,0.5,0.25],\"intensity\":40},{\"type\":\"directional\",\"intensity\":900},\
         {\"type\":\"spot\",\"intensity\":7,\"range\":3,\"spot\":{\"innerConeAngle\":0.25,\"outerConeAngle\":1.5707964}}]}},\
         \"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":0.5,\"znear\":0.1}}]"
        .to_owned();
    let loaded = loaded("gltf_lights", &scene);
    let [Light::Point(point), Light::Sun(sun), Light::Point(spot)] = &loaded.scene.lights[..] else {
        panic!("{:?}", loaded.scene.lights)
    };
    assert_eq!(*point, PointLight::uniform(DVec3::new(4.0, 5.0, 7.0), Spectrum([40.0, 20.0, 10.0])));
    assert!(sun.irradiance == Spectrum([900.0; 3]) && sun.direction.distance(DVec3::Y) < 1e-6, "{sun:?}");
    let beam = Spot { direction: -DVec3::Z, inner: 0.25, outer: std::f64::consts::FRAC_PI_2 };
    assert_eq!((&spot.distribution, spot.intensity), (&Distribution::Spot(beam), Spectrum([7.0; 3])));
    let camera = loaded.scene.camera.unwrap();
    assert_eq!(camera.position, DVec3::new(0.0, -9.0, 1.0));
    assert!(
        (camera.target - camera.position).distance(DVec3::Y) < 1e-6 && camera.up.distance(DVec3::Z) < 1e-6
    );
    assert_eq!(camera.vertical_angle, 0.5);
    let told: Vec<String> = loaded.warnings.iter().map(ToString::to_string).collect();
    assert!(told[0].contains("the range of the light of the node `beam` is passed over"), "{told:?}");
    assert!(told[1].contains("the extension `EXT_other` is passed over"), "{told:?}");
    // In millimetres of a scene file.
    let toml = "unit = 'mm'\nmeshes = ['a.glb']\n[[light]]\nposition = [1, 1, 1]\nintensity = 2\n";
    std::fs::write(folder("gltf_lights").join("a.toml"), toml).unwrap();
    let lights = load_unlit(&folder("gltf_lights").join("a.toml")).unwrap().scene.lights;
    let Light::Point(first) = &lights[0] else { panic!("{lights:?}") };
    assert!(lights.len() == 4 && first.position.distance(DVec3::new(4e-3, 5e-3, 7e-3)) < 1e-12);
    // Its point light is a colour, which lumens have not.
    std::fs::write(folder("gltf_lights").join("b.toml"), format!("units = 'photometric'\n{toml}")).unwrap();
    let message = load_unlit(&folder("gltf_lights").join("b.toml")).unwrap_err().to_string();
    assert!(message.contains("a.glb: a light of the file is the colour [40, 20, 10]"), "{message}");
    // A beam that ends before it begins, and the axis of a node without an extent along it.
    for (from, to, what) in [
        ("innerConeAngle\":0.25", "innerConeAngle\":1.75", "its beam is whole up to 100.26"),
        ("\"scale\":[3,1,2]", "\"scale\":[3,1,0]", "its direction has no length"),
    ] {
        let mut bad = cube_scene();
        (bad.node, bad.rest) = (scene.node.replace(from, to), scene.rest.replace(from, to));
        let message = read("gltf_bad_lights", "a.glb", &bad.glb()).unwrap_err().to_string();
        assert!(message.contains("a.glb: light 3") && message.contains(what), "{message}");
    }
}

#[test]
fn sparse_accessors_replace_some_numbers() {
    let mut scene = cube_scene();
    let indices = scene.view(&[3, 0]);
    let values = scene.view(&[9.0_f32, 9.0, 9.0].map(f32::to_le_bytes).concat());
    let sparse = format!(
        "\"sparse\":{{\"count\":1,\"indices\":{{\"bufferView\":{indices},\"componentType\":5121}},\"values\":{{\"bufferView\":{values}}}}},\"count\""
    );
    scene.accessors[0] = scene.accessors[0].replacen("\"count\"", &sparse, 1);
    let loaded = loaded("gltf_sparse", &scene);
    let vertices: Vec<DVec3> = loaded.scene.polygons().iter().flat_map(|p| p.vertices().to_vec()).collect();
    assert!(vertices.contains(&DVec3::splat(9.0)) && !vertices.contains(&cube().vertices[3]));
}

#[test]
fn what_is_wrong_is_told_in_a_line() {
    let changed = |from: &str, to: &str| {
        let text = String::from_utf8(cube_scene().embedded()).unwrap();
        assert!(text.contains(from), "{from}");
        text.replacen(from, to, 1).into_bytes()
    };
    let glb = cube_scene().glb();
    let mut nan = cube_scene();
    nan.bytes[..4].copy_from_slice(&f32::NAN.to_le_bytes());
    let mut far = cube_scene();
    let at = far.bytes.len() - 72;
    far.bytes[at..at + 2].copy_from_slice(&77_u16.to_le_bytes());
    let mut mapped = pictured(1.0, "\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}");
    mapped.primitive = mapped.primitive.replace("\"TEXCOORD_0\":2,", "");
    for (name, bytes, words) in [
        ("a.gltf", b"{}".to_vec(), &["no glTF 2.0", "export it again"][..]),
        ("a.gltf", b"{\"asset\":".to_vec(), &["EOF while parsing"]),
        ("a.glb", glb[..40].to_vec(), &["it was cut off"]),
        ("a.glb", [&glb[..4], &[1, 0, 0, 0], &glb[8..]].concat(), &["version 1, and 2 is read"]),
        ("a.gltf", changed("\"count\":8", "\"count\":9"), &["accessor 0 reaches beyond"]),
        ("a.gltf", changed("\"count\":8", "\"count\":18446744073709551615"), &["accessor 0 reaches beyond"]),
        ("a.gltf", changed("\"VEC3\"", "\"VEC2\""), &["accessor 0 has 2 components where 3 are needed"]),
        (
            "a.gltf",
            changed("\"byteLength\":96", "\"byteLength\":960"),
            &["buffer view 0 reaches beyond its buffer"],
        ),
        (
            "a.gltf",
            changed("\"POSITION\":0", "\"POSITION\":7"),
            &["mesh 0 has its positions in accessor 7, and there are 2"],
        ),
        ("a.gltf", changed("\"POSITION\"", "\"NORMAL\""), &["mesh 0 has no positions"]),
        ("a.gltf", changed("base64,", "base64,*"), &["data of buffer 0 are not base64"]),
        (
            "a.gltf",
            changed("data:application/octet-stream;base64,", "https://a.b/"),
            &["only files are read"],
        ),
        ("a.gltf", changed("data:application/octet-stream;base64,", "no.bin?"), &["cannot read", "no.bin"]),
        ("a.gltf", changed("\"mesh\":0", "\"mesh\":0,\"children\":[0]"), &["node 0 is reached in two ways"]),
        (
            "a.gltf",
            changed("\"mesh\":0", "\"mesh\":0,\"rotation\":[0,0,0,0]"),
            &["the rotation of node 0 is none"],
        ),
        (
            "a.gltf",
            changed("\"mesh\":0", "\"mesh\":0,\"translation\":[1e39,0,0]"),
            &["the transform of node 0 is not finite", "export"],
        ),
        ("a.glb", nan.glb(), &["a.glb, triangle", "NaN is not a finite number"]),
        ("a.glb", far.glb(), &["primitive 0 of mesh 0 names vertex 77", "there are 8"]),
        ("a.glb", mapped.glb(), &["has a texture and no coordinates `TEXCOORD_0`"]),
        (
            "a.gltf",
            changed("\"asset\"", "\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],\"asset\""),
            &["KHR_draco", "without compression"],
        ),
    ] {
        let message = read("gltf_errors", name, &bytes).map(|_| ()).unwrap_err().to_string();
        assert!(message.contains(name) && !message.contains('\n') && message.len() < 600, "{message}");
        for word in words {
            assert!(message.contains(word), "no `{word}` in: {message}");
        }
    }
}

#[test]
fn a_sky_is_above_what_gltf_calls_up_and_meshes_that_are_all_black_are_told() {
    let folder = folder("gltf_sky");
    let mut steel = cube_scene();
    with_material(&mut steel, "\"name\":\"steel\"", "");
    std::fs::write(folder.join("a.glb"), steel.glb()).unwrap();
    std::fs::write(folder.join("b.stl"), binary_stl(&triangulated(&cube()), "")).unwrap();
    let of = |meshes: &str, rest: &str| {
        let text = format!(
            "unit = 'm'\nmeshes = [{meshes}]\n{rest}\n[sun]\nazimuth = 90\nelevation = 0\nnormal_irradiance = 9\n\
             [sky]\nkind = 'uniform'\nzenith_radiance = 1\n"
        );
        std::fs::write(folder.join("a.toml"), text).unwrap();
        let loaded = load(&folder.join("a.toml")).unwrap();
        let (mut up, mut west) = (DVec3::ZERO, DVec3::ZERO);
        for light in &loaded.scene.lights {
            match light {
                Light::Sky(sky) => up = sky.dome.model().up(),
                Light::Sun(sun) => west = sun.direction,
                Light::Point(_) => (),
            }
        }
        let told: Vec<String> = loaded.warnings.iter().map(ToString::to_string).collect();
        (up, west.distance(DVec3::NEG_X) < 1e-12, told.join("\n"))
    };
    let (up, is_east, told) = of("'a.glb'", "");
    assert_eq!((up, is_east), (DVec3::Y, true));
    assert!(told.contains("a.toml: no surface reflects light") && told.contains("[materials]"), "{told}");
    // Where others are with it z is up, and where it is said; so is what y is.
    let (up, is_east, told) = of("'a.glb', 'b.stl'", "");
    assert_eq!((up, is_east, told.contains("no surface reflects")), (DVec3::Z, true, false), "{told}");
    assert_eq!(of("'a.glb'", "up = [0, 0, 1]").0, DVec3::Z);
    let (up, is_east, _) = of("'a.glb'", "up = [0, 1, 0]");
    assert_eq!((up, is_east), (DVec3::Y, true));
    // A reflectance that is said is one.
    assert!(!of("'a.glb'", "[materials.steel]\nreflectance = 0.5").2.contains("no surface reflects"));
}
