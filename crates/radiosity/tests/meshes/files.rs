//! The same solid is the same polygons, whatever the format.

use crate::read;
use crate::write::{self, Mesh, cube, every_way, triangulated};
use glam::DVec3;
use radiosity::polygon::Polygon;
use radiosity::scene::{Loaded, load};

fn expected(mesh: &Mesh) -> Vec<Polygon> {
    let polygon = |face: &Vec<usize>| {
        let corners: Vec<DVec3> = face.iter().map(|&corner| mesh.vertices[corner]).collect();
        match corners[..] {
            [a, b, c] => Polygon::triangle(a, b, c),
            [a, b, c, d] => Polygon::quadrilateral(a, b, c, d),
            _ => panic!("{face:?}"),
        }
    };
    mesh.faces.iter().map(polygon).collect()
}

#[test]
fn a_cube_is_the_same_in_every_format() {
    for mesh in [cube(), triangulated(&cube())] {
        for (name, bytes) in every_way(&mesh) {
            let loaded = read("cube", name, &bytes).unwrap();
            assert_eq!(loaded.scene.polygons(), expected(&mesh), "{name}");
            assert_eq!(loaded.faces.len(), mesh.faces.len(), "{name}");
            assert_eq!(loaded.rows().len(), mesh.faces.len(), "{name}");
            assert_eq!(loaded.warnings, [], "{name}");
        }
    }
}

/// The binary file, whose header may begin with `solid`, is not taken for text, and the names are those of the formats.
#[test]
fn surfaces_have_names() {
    let triangles = triangulated(&cube());
    let name = |file: &str| {
        let ways = every_way(&triangles);
        let (_, bytes) = ways.iter().find(|(name, _)| *name == file).unwrap();
        read("names", file, bytes).unwrap().scene.surfaces[0].name.clone()
    };
    let named = ["ascii.stl", "binary.stl", "solid.stl", "little.ply", "mesh.vs3"].map(name);
    assert_eq!(named, ["a part", "binary", "solid", "little", "face-1"]);
}

fn facets(count: usize) -> String {
    let facet =
        "facet normal 0 0 1\n outer loop\n vertex 0 0 0\n vertex 1 0 0\n VERTEX 0 1 0\n endloop\nendfacet\n";
    facet.repeat(count)
}

#[test]
fn each_solid_is_a_surface() {
    let one = facets(1);
    let text =
        format!("solid lid\r\n{}endsolid lid\n\nSOLID\n{one}endsolid\nsolid lid\nendsolid\n", facets(2));
    let loaded = read("solids", "box.stl", text.as_bytes()).unwrap();
    let surfaces = &loaded.scene.surfaces;
    let counts: Vec<_> = surfaces.iter().map(|s| (s.name.as_str(), s.polygons.len())).collect();
    assert_eq!(counts, [("lid", 2), ("box", 1)], "a solid without facets is none");
    let faces: Vec<_> =
        loaded.faces.iter().map(|f| (f.name.as_str(), f.surface, f.polygons.clone())).collect();
    assert_eq!(faces, [("lid#1", 0, 0..1), ("lid#2", 0, 1..2), ("box", 1, 2..3)]);
    assert_eq!(loaded.faces[1].place.as_ref().unwrap().line, Some(9));
}

#[test]
fn a_face_of_many_corners_knows_its_polygons() {
    let l = "ply\nformat ascii 1.0\nelement vertex 6\nproperty int x\nproperty int y\nproperty int z\n\
             element face 2\nproperty list uchar uint vertex_index\nend_header\n\
             0 0 0\n4 0 0\n4 1 0\n1 1 0\n1 3 0\n0 3 0\n6 0 1 2 3 4 5\n3 2 1 0\n";
    let loaded = read("many", "l.ply", l.as_bytes()).unwrap();
    let ranges: Vec<_> = loaded.faces.iter().map(|face| face.polygons.clone()).collect();
    assert_eq!(ranges, [0..4, 4..5]);
    let polygons = loaded.scene.polygons();
    assert!((polygons[ranges[0].clone()].iter().map(Polygon::area).sum::<f64>() - 6.0).abs() < 1e-12);
    assert_eq!(loaded.faces[1].place.as_ref().unwrap().line, Some(17));
}

#[test]
fn triangles_without_area_are_left_out_and_counted() {
    let with_empty = |face: &[usize], apart: DVec3| {
        let mut mesh = triangulated(&cube());
        mesh.vertices.push(apart);
        mesh.faces.insert(3, face.to_vec());
        mesh.faces.insert(8, face.to_vec());
        mesh
    };
    let repeated = with_empty(&[0, 1, 1], DVec3::ZERO);
    let on_a_line = with_empty(&[0, 8, 1], DVec3::new(0.125, 0.25, 1.0));
    for mesh in [&repeated, &on_a_line] {
        for (name, bytes) in every_way(mesh) {
            let read = read("empty", name, &bytes);
            if name.ends_with(".obj") || name.ends_with(".vs3") {
                let message = read.unwrap_err().to_string();
                assert!(message.contains("no area") || message.contains("same point"), "{message}");
                continue;
            }
            let loaded = read.unwrap();
            assert_eq!(loaded.scene.polygons().len(), 12, "{name}");
            let message = loaded.warnings[0].to_string();
            assert!(
                message.contains(name) && message.contains("2 faces without area are left out"),
                "{message}"
            );
        }
    }
}

#[test]
fn contradicting_normals_are_told() {
    let text = format!("solid\n{}endsolid\n", facets(2)).replacen("normal 0 0 1", "normal 0 0 -1", 1);
    let loaded = read("normals", "a.stl", text.as_bytes()).unwrap();
    assert_eq!(loaded.warnings.len(), 1);
    let message = loaded.warnings[0].to_string();
    assert!(message.contains("a.stl:2: 1 facets have a normal opposite"), "{message}");
    assert!(loaded.scene.polygons().iter().all(|polygon| polygon.normal() == DVec3::Z));
}

#[test]
fn what_follows_the_last_element_is_told() {
    for format in ["ascii", "binary_little_endian"] {
        let mut bytes = write::ply(&cube(), format);
        bytes.extend(b"\nmore\n");
        let loaded = read("rest", "a.ply", &bytes).unwrap();
        assert!(loaded.warnings[0].to_string().contains("passed over"));
    }
}

#[test]
fn a_scene_file_names_meshes_of_every_format() {
    let triangles = triangulated(&cube());
    for (name, bytes) in every_way(&triangles) {
        let material = match name.split_once('.').unwrap() {
            (_, "vs3") => "face-7".to_owned(),
            ("ascii", "stl") => "a part".to_owned(),
            (_, "obj") => continue,
            (stem, _) => stem.to_owned(),
        };
        read("scene", name, &bytes).unwrap();
        let scene = format!(
            "unit = 'mm'\nmeshes = ['{name}']\n[materials.\"{material}\"]\nreflectance = 0.25\nradiance = 1"
        );
        read("scene", "a.toml", scene.as_bytes()).unwrap();
        let Loaded { scene, .. } = load(&crate::folder("scene").join("a.toml")).unwrap();
        let lit: Vec<_> = scene.surfaces.iter().filter(|surface| surface.name == material).collect();
        assert_eq!(lit.len(), 1, "{name}");
        assert_eq!(lit[0].reflectance.0, [0.25; 3]);
        let area: f64 = scene.polygons().iter().map(Polygon::area).sum();
        assert!((area * 1e6 - 6.0).abs() < 1e-9, "{name} is in millimetres");
    }
}
