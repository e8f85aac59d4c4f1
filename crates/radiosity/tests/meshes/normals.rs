//! The normals of corners: kept by every format that has them, through every cut, or told why not.

use crate::read;
use glam::DVec3;
use radiosity::scene::Loaded;

/// An L that is cut in triangles, a quadrilateral, and a triangle, of a bowl z = (x² + y²)/8: corners and faces.
fn bowl() -> (Vec<DVec3>, Vec<Vec<usize>>) {
    let p = |x: f64, y: f64| DVec3::new(x, y, 0.0);
    let corners = vec![
        p(0.0, 0.0),
        p(4.0, 0.0),
        p(4.0, 1.0),
        p(1.0, 1.0),
        p(1.0, 3.0),
        p(0.0, 3.0),
        p(4.0, 3.0),
        p(9.0, 0.0),
    ];
    (corners, vec![vec![0, 1, 2, 3, 4, 5], vec![3, 2, 6, 4], vec![1, 7, 2]])
}

/// Of a bowl over the corners, of length 3.
fn normal(corner: DVec3) -> DVec3 {
    3.0 * DVec3::new(-corner.x / 4.0, -corner.y / 4.0, 1.0).normalize()
}

pub fn obj() -> String {
    let (corners, faces) = bowl();
    let vertices: String = corners.iter().map(|v| format!("v {} {} {}\n", v.x, v.y, v.z)).collect();
    let normals: String =
        corners.iter().map(|v| normal(*v)).map(|n| format!("vn {} {} {}\n", n.x, n.y, n.z)).collect();
    let face = |face: &Vec<usize>| {
        let corners: String = face.iter().map(|k| format!(" {}/7/{}", k + 1, *k as i64 - 8)).collect();
        format!("f{corners}\n")
    };
    format!("{vertices}{normals}{}", faces.iter().map(face).collect::<String>())
}

pub fn ply(binary: bool) -> Vec<u8> {
    let (corners, faces) = bowl();
    let format = if binary { "binary_big_endian" } else { "ascii" };
    let mut bytes = format!(
        "ply\nformat {format} 1.0\nelement vertex 8\nproperty double nx\nproperty double ny\nproperty double nz\n\
         property double x\nproperty double y\nproperty double z\nelement face 3\n\
         property list uchar int vertex_indices\nend_header\n"
    )
    .into_bytes();
    for v in corners {
        let numbers = [normal(v).to_array(), v.to_array()].concat();
        match binary {
            true => bytes.extend(numbers.iter().flat_map(|c| c.to_be_bytes())),
            false => bytes
                .extend(numbers.iter().map(|c| format!("{c} ")).collect::<String>().bytes().chain(*b"\n")),
        }
    }
    for face in faces {
        match binary {
            true => {
                bytes.push(face.len() as u8);
                bytes.extend(face.iter().flat_map(|k| (*k as i32).to_be_bytes()));
            }
            false => {
                let corners: String = face.iter().map(|k| format!(" {k}")).collect();
                bytes.extend(format!("{}{corners}\n", face.len()).bytes());
            }
        }
    }
    bytes
}

fn assert_is_the_bowl(loaded: &Loaded, name: &str) {
    assert_eq!(loaded.warnings, [], "{name}");
    let polygons = loaded.scene.polygons();
    assert_eq!((polygons.len(), loaded.scene.curved_polygons()), (6, 6), "{name}");
    for polygon in &polygons {
        for vertex in polygon.vertices() {
            let (at, found) = polygon.on_curve(*vertex);
            assert!(at.distance(*vertex) < 1e-12, "{name}");
            assert!(found.distance(normal(*vertex).normalize()) < 1e-12, "{name}: {found} at {vertex}");
        }
    }
    assert_eq!(loaded.scene.clone().flat().curved_polygons(), 0);
}

#[test]
fn every_corner_keeps_its_normal_through_every_cut() {
    for (name, bytes) in [("a.obj", obj().into_bytes()), ("b.ply", ply(false)), ("c.ply", ply(true))] {
        assert_is_the_bowl(&read("bowl", name, &bytes).unwrap(), name);
    }
}

const SQUARE: &str =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvn 0.6 0 0.8\nvn 0 0 0\nvn 1 0 0\nvn 0 nan 1\n";

#[test]
fn normals_that_cannot_be_are_told_once_a_kind_and_leave_their_faces_flat() {
    for (faces, warnings) in [
        ("f 1//2 2//1 3//1 4//1\n", &[][..]),
        ("f 1//1 2//1 3//1 4//1\n", &[]),
        ("f 1//3 2//1 3//1 4//1\n", &["a.obj:10: 1 face is drawn flat here: a normal is zero or not"]),
        ("f 1//5 2//1 3//1 4//1\n", &["a.obj:10: 1 face is drawn flat here: a normal is zero or not"]),
        ("f 1 2//1 3//1 4//1\n", &["a.obj:10: 1 face is drawn flat here: not every corner"]),
        ("f 1/2/ 2//1 3//1 4//1\n", &["a.obj:10: 1 face is drawn flat here: not every corner"]),
        ("f 1//2 2//1 3//1 4//9\n", &["a.obj:10: 1 face is drawn flat here: not every corner"]),
        (
            "f 1//2 2//1 3//1 4//1\nf 1//4 2//1 3//1 4//1\nf 4//1 3//1 2//1 1//1\n",
            &["a.obj:11: 2 faces are drawn flat, the first here: a normal is 90 degrees or more"],
        ),
        (
            "f 1//4 2//1 3//1\nf 1//3 2//1 3//1\nf 1//3 2//1 4//1\n",
            &[
                "a.obj:10: 1 face is drawn flat here: a normal is 90",
                "a.obj:11: 2 faces are drawn flat, the first here",
            ],
        ),
    ] {
        let loaded = read("faults", "a.obj", format!("{SQUARE}{faces}").as_bytes()).unwrap();
        let told: Vec<String> = loaded.warnings.iter().map(ToString::to_string).collect();
        assert_eq!(told.len(), warnings.len(), "{faces}{told:?}");
        assert!(told.iter().zip(warnings).all(|(told, words)| told.contains(words)), "{faces}{told:?}");
        let curved = usize::from(faces.starts_with("f 1//2 2//1 3//1 4//1"));
        assert_eq!(loaded.scene.curved_polygons(), curved, "{faces}");
    }
}
