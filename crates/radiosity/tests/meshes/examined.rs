//! What is found in a mesh, and what is not; the same in millimetres and in kilometres.

use crate::read;
use crate::write::{Mesh, binary_stl, cube, cuboid, obj, together, triangulated};
use glam::{DQuat, DVec3};
use radiosity::scene::{Defect, Face, Report, cornell_box, examine, load};
use std::path::Path;

/// A folder for each test, since they run at the same time.
fn own_folder() -> String {
    std::thread::current().name().unwrap_or("examined").replace("::", "/")
}

fn report(mesh: &Mesh) -> Report {
    let loaded = read(&own_folder(), "a.obj", &obj(mesh)).unwrap();
    examine(&loaded.scene, &loaded.faces)
}

/// The report, after a look at whether it is the same at every scale, and turned.
fn stable(mesh: &Mesh) -> Report {
    let plain = report(mesh);
    let kinds = |report: &Report| {
        let findings: Vec<_> = report.findings.iter().map(|f| (f.kind, f.count, f.faces.clone())).collect();
        let components: Vec<_> =
            report.components.iter().map(|c| (c.faces, c.open_edges, c.is_closed())).collect();
        (findings, components)
    };
    for scale in [1e-6, 1e-3, 1e3, 1e6] {
        let turn = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, 0.5).normalize(), 0.7);
        let vertices = mesh.vertices.iter().map(|&v| turn * (v * scale)).collect();
        let scaled = Mesh { vertices, faces: mesh.faces.clone() };
        assert_eq!(kinds(&report(&scaled)), kinds(&plain), "at {scale}");
    }
    plain
}

fn kinds(report: &Report) -> Vec<(Defect, usize)> {
    report.findings.iter().map(|finding| (finding.kind, finding.count)).collect()
}

fn flipped(mesh: &Mesh, faces: impl Fn(usize) -> bool) -> Mesh {
    let mut mesh = Mesh { vertices: mesh.vertices.clone(), faces: mesh.faces.clone() };
    mesh.faces.iter_mut().enumerate().filter(|(k, _)| faces(*k)).for_each(|(_, face)| face.reverse());
    mesh
}

#[test]
fn a_cube_is_closed() {
    for mesh in [cube(), triangulated(&cube())] {
        let outside = stable(&mesh);
        assert_eq!(kinds(&outside), []);
        assert!(outside.is_closed() && outside.faces_outwards());
        assert!((outside.components[0].volume.unwrap() - 1.0).abs() < 1e-12);
        let inside = stable(&flipped(&mesh, |_| true));
        assert!(inside.is_closed() && !inside.faces_outwards());
        assert!(inside.to_string().contains("closed, a room of 1.000e0 m³"), "{inside}");
    }
}

#[test]
fn a_missing_wall_and_a_turned_one_are_found() {
    let mut open = cube();
    open.faces.remove(2);
    let report = stable(&open);
    assert_eq!(kinds(&report), [(Defect::Open, 4)]);
    assert!(!report.is_closed() && report.components[0].volume.is_none());
    let report = stable(&flipped(&cube(), |face| face == 3));
    assert_eq!(kinds(&report), [(Defect::Flipped, 4)]);
    assert!(report.findings[0].faces.contains(&3), "{report}");
    assert!(!report.is_closed());
    let message = report.findings[0].to_string();
    assert!(
        message.starts_with("4 edges join faces with opposite fronts, the first at `surface#"),
        "{message}"
    );
    assert!(message.contains("a.obj:"), "{message}");
}

#[test]
fn a_wall_drawn_in_parts_meets_one_drawn_whole() {
    // The top in two halves, whose corners lie in the middles of the edges of two walls.
    let mut mesh = cube();
    mesh.faces.remove(1);
    mesh.vertices.extend([DVec3::new(0.0, 0.25, 2.0), DVec3::new(0.0, 1.25, 2.0)]);
    mesh.faces.extend([vec![4, 8, 9, 6], vec![8, 5, 7, 9]]);
    let report = stable(&mesh);
    assert_eq!(kinds(&report), []);
    assert!(
        (report.components[0].volume.unwrap() - 1.0).abs() < 1e-12,
        "edge to edge, none merely rests: {report}"
    );
    // And in a face that is a triangle in disguise: its corner on an edge is cut off as a shaving.
    mesh.vertices[8].x = 0.125;
    assert_eq!(kinds(&stable(&mesh)), []);
}

#[test]
fn cracks_of_exporters_are_none_but_gaps_are() {
    let cracked = |gap: f64| {
        let mut mesh = cube();
        let moved = mesh.vertices[7] + gap * DVec3::Z;
        mesh.vertices.push(moved);
        for corner in mesh.faces[1].iter_mut().filter(|corner| **corner == 7) {
            *corner = 8;
        }
        stable(&mesh)
    };
    assert!(cracked(1e-7).components[0].volume.is_some(), "edge to edge, none merely rests");
    assert!(!cracked(1e-5).is_closed());
}

#[test]
fn faces_twice_are_found() {
    let mesh = triangulated(&cube());
    let twice = Mesh { faces: [&mesh.faces[..], &mesh.faces[..1]].concat(), vertices: mesh.vertices.clone() };
    let report = stable(&twice);
    assert_eq!(report.finding(Defect::Duplicate).map(|f| (f.count, f.faces.clone())), Some((1, vec![0, 12])));
    assert_eq!(report.finding(Defect::Overlapping), None, "it is told once");
    let mut cracked = Mesh { vertices: twice.vertices.clone(), faces: twice.faces.clone() };
    cracked.vertices.push(mesh.vertices[0] + 1e-7);
    cracked.faces[12][0] = 8;
    assert_eq!(stable(&cracked).finding(Defect::Duplicate).map(|f| f.count), Some(1), "but for rounding");
    let back = flipped(&twice, |face| face == 12);
    let report = stable(&back);
    assert_eq!(report.finding(Defect::Opposite).map(|f| f.count), Some(1));
    assert_eq!(report.finding(Defect::Duplicate), None);
}

#[test]
fn faces_through_each_other_are_found() {
    let corner = cuboid(DVec3::new(0.0, 0.5, 1.5), DVec3::new(1.0, 0.75, 1.75));
    let report = stable(&together(&cube(), &corner));
    // Four walls of the bar go through the wall at x = ½.
    assert_eq!(kinds(&report), [(Defect::Crossing, 4)]);
    assert_eq!(report.findings[0].faces, [5, 6]);
    assert_eq!(report.components.len(), 2);
    assert!(report.is_closed(), "each by itself");
}

#[test]
fn faces_that_only_touch_do_not_cross() {
    // A box on the floor of another, one in its corner, one beside it, and one that shares an edge.
    for (low, high) in [
        (DVec3::new(0.0, 0.5, 1.0), DVec3::new(0.25, 0.75, 1.25)),
        (DVec3::new(-0.5, 0.25, 1.0), DVec3::new(0.25, 0.75, 1.25)),
        (DVec3::new(0.5, 0.25, 1.0), DVec3::new(1.5, 1.25, 2.0)),
        (DVec3::new(0.5, 1.25, 1.0), DVec3::new(1.5, 2.25, 2.0)),
    ] {
        let room = flipped(&cube(), |_| true);
        let report = stable(&together(&room, &cuboid(low, high)));
        assert!(report.finding(Defect::Crossing).is_none(), "{report}");
        assert!(report.finding(Defect::Overlapping).is_none(), "{report}");
    }
}

#[test]
fn faces_partly_in_one_place_are_found() {
    let mut wall = cube();
    wall.vertices
        .extend([(0.0, 0.5), (0.25, 0.5), (0.25, 0.75), (0.0, 0.75)].map(|(x, y)| DVec3::new(x, y, 2.0)));
    wall.faces.push(vec![8, 9, 10, 11]);
    let report = stable(&wall);
    assert_eq!(
        report.finding(Defect::Overlapping).map(|f| (f.count, f.faces.clone())),
        Some((1, vec![1, 6]))
    );
    wall.faces[6].reverse();
    assert_eq!(stable(&wall).finding(Defect::Overlapping), None, "face to face is a box on a floor");
}

#[test]
fn a_block_without_a_bottom_stands_on_the_floor() {
    let mut block = cuboid(DVec3::new(0.0, 0.5, 1.0), DVec3::new(0.25, 0.75, 1.25));
    block.faces.remove(0);
    let report = stable(&together(&flipped(&cube(), |_| true), &block));
    assert_eq!(kinds(&report), []);
    assert_eq!(report.components[1].resting_edges, 4);
    assert!(report.is_closed() && !report.faces_outwards());
    for vertex in &mut block.vertices {
        vertex.z += 1e-3;
    }
    assert_eq!(kinds(&stable(&together(&flipped(&cube(), |_| true), &block))), [(Defect::Open, 4)]);
}

#[test]
fn the_cornell_box_is_open_to_the_camera_alone() {
    let scene = cornell_box();
    let report = examine(&scene, &Face::of_polygons(&scene));
    // The floor, two walls, and the ceiling in three parts, since the lamp is in a hole of it.
    assert_eq!(kinds(&report), [(Defect::Open, 6)], "{report}");
    assert_eq!(report.components.iter().map(|c| c.resting_edges).collect::<Vec<_>>(), [0, 4, 4], "{report}");
}

#[test]
fn the_scenes_of_the_repository_are_well() {
    for scene in ["furnace/furnace.toml", "gallery/gallery.toml"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(scene);
        let loaded = load(&path).unwrap();
        let report = examine(&loaded.scene, &loaded.faces);
        assert_eq!(kinds(&report), [], "{report}");
        assert!(report.is_closed(), "{report}");
    }
}

/// A sphere of 10⁵ triangles, and a copy of it through itself: what took n² would take minutes.
#[test]
fn large_meshes_are_examined() {
    let point = |i: usize, j: usize| {
        let (u, v) =
            (std::f64::consts::TAU * (i % 320) as f64 / 320.0, std::f64::consts::PI * j as f64 / 160.0);
        DVec3::new(v.sin() * u.cos(), v.sin() * u.sin(), v.cos())
    };
    let mut sphere = Mesh { vertices: Vec::new(), faces: Vec::new() };
    for (i, j) in (0..320).flat_map(|i| (0..160).map(move |j| (i, j))) {
        let first = sphere.vertices.len();
        sphere.vertices.extend([point(i, j), point(i, j + 1), point(i + 1, j + 1), point(i + 1, j)]);
        sphere.faces.extend([vec![first, first + 1, first + 2], vec![first, first + 2, first + 3]]);
    }
    let examined = |mesh: &Mesh| {
        let loaded = read(&own_folder(), "sphere.stl", &binary_stl(mesh, "sphere")).unwrap();
        (loaded.warnings.len(), examine(&loaded.scene, &loaded.faces))
    };
    let (warnings, report) = examined(&sphere);
    assert_eq!(warnings, 1, "the poles have triangles without area");
    assert_eq!((kinds(&report), report.components.len()), (vec![], 1), "{report}");
    assert!((report.components[0].volume.unwrap() - 4.1888).abs() < 1e-2);
    let shifted = Mesh {
        vertices: sphere.vertices.iter().map(|v| v + DVec3::new(0.5, 0.1, 0.2)).collect(),
        faces: sphere.faces.clone(),
    };
    let (_, report) = examined(&together(&sphere, &shifted));
    let crossing = report.finding(Defect::Crossing).unwrap();
    assert!(crossing.count > 300 && crossing.count <= 1000, "{}", crossing.count);
}
