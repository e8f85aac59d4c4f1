//! A mesh as bytes of each format.

use glam::DVec3;

/// Corners and faces that name them from 0.
pub struct Mesh {
    pub vertices: Vec<DVec3>,
    pub faces: Vec<Vec<usize>>,
}

/// Every way in which this mesh can be written: a file's name and its bytes.
pub fn every_way(mesh: &Mesh) -> Vec<(&'static str, Vec<u8>)> {
    let mut ways = vec![
        ("mesh.obj", obj(mesh)),
        ("ascii.ply", ply(mesh, "ascii")),
        ("little.ply", ply(mesh, "binary_little_endian")),
        ("big.ply", ply(mesh, "binary_big_endian")),
        ("mesh.vs3", vs3(mesh)),
    ];
    if mesh.faces.iter().all(|face| face.len() == 3) {
        ways.extend([
            ("ascii.stl", ascii_stl(mesh)),
            ("binary.stl", binary_stl(mesh, "made by hand")),
            ("solid.stl", binary_stl(mesh, "solid in binary")),
        ]);
    }
    ways
}

/// A box between two corners, its front outside; in coordinates that an `f32` holds.
pub fn cuboid(low: DVec3, high: DVec3) -> Mesh {
    let pick = |bit: usize, a: f64, b: f64| if bit == 0 { a } else { b };
    let vertices = (0..8).map(|k| {
        DVec3::new(pick(k & 1, low.x, high.x), pick(k & 2, low.y, high.y), pick(k & 4, low.z, high.z))
    });
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    Mesh { vertices: vertices.collect(), faces: faces.map(Vec::from).into() }
}

pub fn cube() -> Mesh {
    cuboid(DVec3::new(-0.5, 0.25, 1.0), DVec3::new(0.5, 1.25, 2.0))
}

/// Each quadrilateral abcd as abc and acd.
pub fn triangulated(mesh: &Mesh) -> Mesh {
    let halves = |f: &Vec<usize>| [vec![f[0], f[1], f[2]], vec![f[0], f[2], f[3]]];
    Mesh { vertices: mesh.vertices.clone(), faces: mesh.faces.iter().flat_map(halves).collect() }
}

/// The faces of both.
pub fn together(a: &Mesh, b: &Mesh) -> Mesh {
    let shifted = b.faces.iter().map(|face| face.iter().map(|corner| corner + a.vertices.len()).collect());
    Mesh {
        vertices: [&a.vertices[..], &b.vertices].concat(),
        faces: a.faces.iter().cloned().chain(shifted).collect(),
    }
}

fn numbers(face: &[usize], first: usize) -> String {
    face.iter().map(|corner| format!(" {}", corner + first)).collect()
}

pub fn obj(mesh: &Mesh) -> Vec<u8> {
    let vertices = mesh.vertices.iter().map(|v| format!("v {} {} {}\n", v.x, v.y, v.z));
    let faces = mesh.faces.iter().map(|face| format!("f{}\n", numbers(face, 1)));
    vertices.chain(faces).collect::<String>().into_bytes()
}

fn normal(mesh: &Mesh, face: &[usize]) -> DVec3 {
    let [a, b, c] = [0, 1, 2].map(|k| mesh.vertices[face[k]]);
    (b - a).cross(c - a).normalize()
}

pub fn ascii_stl(mesh: &Mesh) -> Vec<u8> {
    let facets = mesh.faces.iter().map(|face| {
        let n = normal(mesh, face);
        let corners = face.iter().map(|&corner| mesh.vertices[corner]);
        let corners: String =
            corners.map(|v| format!("      vertex {:e} {:e} {:e}\n", v.x, v.y, v.z)).collect();
        format!("  facet normal {} {} {}\n    outer loop\n{corners}    endloop\n  endfacet\n", n.x, n.y, n.z)
    });
    format!("solid a part\n{}endsolid a part\n", facets.collect::<String>()).into_bytes()
}

pub fn binary_stl(mesh: &Mesh, header: &str) -> Vec<u8> {
    let mut bytes = header.as_bytes().to_vec();
    bytes.resize(80, 0);
    bytes.extend((mesh.faces.len() as u32).to_le_bytes());
    for face in &mesh.faces {
        let corners = face.iter().map(|&corner| mesh.vertices[corner]);
        for vector in [normal(mesh, face)].into_iter().chain(corners) {
            bytes.extend(vector.to_array().into_iter().flat_map(|c| (c as f32).to_le_bytes()));
        }
        bytes.extend([0, 0]);
    }
    bytes
}

/// With an element and properties that no one asked for, and vertices in two types.
pub fn ply(mesh: &Mesh, format: &str) -> Vec<u8> {
    let mut bytes = format!(
        "ply\nformat {format} 1.0\ncomment by hand\nelement camera 1\nproperty list uchar short code\n\
         element vertex {}\nproperty float x\nproperty uchar red\nproperty double y\nproperty float z\n\
         element face {}\nproperty list uchar int vertex_indices\nproperty float quality\nend_header\n",
        mesh.vertices.len(),
        mesh.faces.len()
    )
    .into_bytes();
    if format == "ascii" {
        let vertices = mesh.vertices.iter().map(|v| format!("{} 7 {} {}\n", v.x, v.y, v.z));
        let faces = mesh.faces.iter().map(|face| format!("{}{} 0.5\n", face.len(), numbers(face, 0)));
        bytes.extend(format!("2 300 -1\n{}", vertices.chain(faces).collect::<String>()).bytes());
        return bytes;
    }
    let ordered = |word: &[u8]| -> Vec<u8> {
        if format.contains("big") { word.iter().rev().copied().collect() } else { word.to_vec() }
    };
    bytes.extend([&[2][..], &ordered(&300_i16.to_le_bytes()), &ordered(&(-1_i16).to_le_bytes())].concat());
    for v in &mesh.vertices {
        bytes.extend(ordered(&(v.x as f32).to_le_bytes()));
        bytes.push(7);
        bytes.extend(ordered(&v.y.to_le_bytes()));
        bytes.extend(ordered(&(v.z as f32).to_le_bytes()));
    }
    for face in &mesh.faces {
        bytes.push(face.len() as u8);
        face.iter().for_each(|&corner| bytes.extend(ordered(&(corner as i32).to_le_bytes())));
        bytes.extend(ordered(&0.5_f32.to_le_bytes()));
    }
    bytes
}

pub fn vs3(mesh: &Mesh) -> Vec<u8> {
    let vertices =
        mesh.vertices.iter().zip(1..).map(|(v, number)| format!("V {number} {} {} {}\n", v.x, v.y, v.z));
    let surfaces = mesh.faces.iter().zip(1..).map(|(face, number)| {
        let fourth = if face.len() == 3 { " 0" } else { "" };
        format!("S {number} {}{fourth} 0 0 0.5 face-{number}\n", numbers(face, 1))
    });
    let body: String = vertices.chain(surfaces).collect();
    format!("T by hand\n! a comment\nC eps=1e-5 encl=1\nF 3\n{body}End of data\n").into_bytes()
}
