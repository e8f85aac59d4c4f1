//! What View3D's format says beyond polygons.

use crate::read;
use glam::DVec3;
use radiosity::polygon::Polygon;
use radiosity::scene::{Control, Loaded};

/// In a folder for each test, since they run at the same time.
fn vs3(text: &str) -> Loaded {
    let folder = std::thread::current().name().unwrap_or("vs3").replace("::", "/");
    read(&folder, "a.vs3", text.as_bytes()).unwrap()
}

fn area(loaded: &Loaded, name: &str) -> f64 {
    let surface = loaded.scene.surfaces.iter().find(|surface| surface.name == name);
    surface.unwrap_or_else(|| panic!("no {name}")).area()
}

/// A wall of 4 × 3 m, a window of 1 m² and a door in it.
const WALL: &str = "\
V 10 0 0 0\nV 20 4 0 0\nV 30 4 0 3\nV 40 0 0 3
V 1 1 0 1\nV 2 2 0 1\nV 3 2 0 2\nV 4 1 0 2
V 5 3 0 0, ! commas are blanks\nV 6 3.5 0 0\nV 7 3.5 0 2\nV 8 3 0 2\n";

#[test]
fn vertices_may_be_numbered_and_placed_anyhow() {
    let (first, rest) = WALL.split_once('\n').unwrap();
    let loaded = vs3(&format!("F 3\n{rest}S 1 10 20 30 40 0 0 0.9 wall\ns 2 1 2 3 0 0 0 1. part\n{first}\n"));
    assert_eq!(loaded.scene.polygons().len(), 2);
    assert_eq!((area(&loaded, "wall"), area(&loaded, "part")), (12.0, 0.5));
    assert_eq!(loaded.faces[1].place.as_ref().unwrap().line, Some(14));
}

#[test]
fn subsurfaces_are_cut_out_of_their_bases() {
    let surfaces = "S 1 10 20 30 40 0 0 0.9 wall\nS 2 1 2 3 4 1 0 0.9 window\nS 3 5 6 7 8 1 0 0.9 door\n";
    let loaded = vs3(&format!("F 3\n{WALL}{surfaces}"));
    assert!((area(&loaded, "wall") - 10.0).abs() < 1e-12);
    assert_eq!((area(&loaded, "window"), area(&loaded, "door")), (1.0, 1.0));
    let rows: Vec<_> = loaded.rows();
    assert_eq!(rows, [[0], [1], [2]], "three rows, however many polygons");
    let moment: DVec3 = loaded.scene.polygons().iter().map(|p| p.area() * p.centroid()).sum();
    assert!(moment.distance(12.0 * DVec3::new(2.0, 0.0, 1.5)) < 1e-12, "together they are the wall");
}

#[test]
fn null_surfaces_take_away_and_obstructions_only_block() {
    let surfaces = "S 1 10 20 30 40 0 0 0.9 wall\nN 2 4 3 2 1 1 0 0.9 nothing\nO 3 5 6 7 8 0 0 0.9 screen\n";
    let loaded = vs3(&format!("F 3\n{WALL}{surfaces}"));
    assert!((area(&loaded, "wall") - 11.0).abs() < 1e-12);
    let obstructions: Vec<_> = loaded.faces.iter().map(|face| face.is_obstruction).collect();
    assert_eq!(obstructions, [false, true, true]);
    assert_eq!(loaded.rows(), [[0]]);
    let count: usize = loaded.faces.iter().map(|face| face.polygons.len()).sum();
    assert_eq!(count, loaded.scene.polygons().len(), "and still they are in the scene");
    assert_eq!(loaded.scene.surfaces[2].reflectance.0, [0.0; 3]);
}

#[test]
fn combined_surfaces_make_one_row() {
    let surfaces = "S 1 1 2 3 0 0 0 0.9 a\nS 2 5 6 7 8 0 0 0.25 b\nS 3 1 3 4 0 0 1 0.9 a2\n";
    let loaded = vs3(&format!("F 3\n{WALL}{surfaces}"));
    assert_eq!(loaded.rows(), [vec![0, 2], vec![1]]);
    assert_eq!(loaded.faces[2].combined_with, Some(0));
    assert_eq!(loaded.scene.surfaces[1].reflectance.0, [0.75; 3]);
}

#[test]
fn title_and_control_are_read_and_the_unknown_is_told() {
    let text = "T  Two rooms \nc EPS = 1e-5, row=2 col=1 encl=1 emit=0 out=2 list=3 maxU=8 maxo=8 mino=1 foo=7 bar=0\n";
    let text =
        format!("{text}F 3\n{WALL}X 1 2 3\nS 1 1 2 3 4 0 0 0 a\nS 2 5 6 7 8 0 0 1 a\nEnd\nS nonsense\n");
    let loaded = vs3(&text);
    assert_eq!(loaded.scene.name, "Two rooms");
    let control = Control {
        line: Some(2),
        accuracy: Some(1e-5),
        row: Some(2),
        column: Some(1),
        is_enclosure: true,
        with_reflection: false,
        output: 2,
    };
    assert_eq!(loaded.control, Some(control));
    let warnings: Vec<_> = loaded.warnings.iter().map(ToString::to_string).collect();
    for (warning, words) in warnings.iter().zip([
        "a.vs3:2: the control word `foo`",
        "`bar`",
        "a.vs3:16: `X`",
        "replaced by 0.001",
    ]) {
        assert!(warning.contains(words), "no {words} in {warning}");
    }
    assert_eq!(warnings.len(), 4);
    assert_eq!(loaded.scene.surfaces[1].name, "a.2", "names differ");
}

/// The L-shaped room of Pinney and Bean's test 4, once by vertices and once by planes: 10 walls in 12 parts.
#[test]
fn both_geometries_make_the_same_room() {
    let by_planes = "F 3a
S 1 R 0 0 0.9 south\n 3. 0. 0.    0  90    3. 3.
S 2 R 0 0 0.9 east\n 3. 1. 0.  270  90    1. 3.
S 3 r 0 0 0.9 inner-1\n 1. 1. 0.  180  90    2. 3.
S 4 R 0 0 0.9 inner-2\n 1. 3. 0.  270  90    2. 3.
S 5 R 0 0 0.9 north\n 0. 3. 0.  180  90    1. 3.
S 6 R 0 0 0.9 west\n 0. 0. 0.   90  90    3. 3.
S 7 Q 0 0 0.9 ceiling-1\n 3. 0. 3.    0  180\n 2. 0.   3. 0.   3. 1.   2. 1.
S 8 Q 0 7 0.9 ceiling-2\n 3. 0. 3.    0  180\n 2. 1.   3. 1.   3. 3.   2. 3.
S 9 Q 0 7 0.9 ceiling-3\n 3. 0. 3.    0  180\n 0. 0.   2. 0.   2. 1.   0. 1.
S 10 Q 0 0 0.9 floor-1\n 0. 0. 0.  180 0\n 0. 0.   1. 0.   1. 1.   0. 1.
S 11 Q 0 10 0.9 floor-2\n 0. 0. 0.  180. 0.\n 0. 1.   1. 1.   1. 3.   0. 3.
S 12 q 0 10 0.9 floor-3\n 0. 0. 0.  180. 0.\n 1. 0.   3. 0.   3. 1.   1. 1.
End of data";
    let by_vertices = "F 3
V 1 0 3 3\nV 2 1 3 3\nV 3 0 3 0\nV 4 1 3 0\nV 5 0 1 0\nV 6 1 1 0\nV 7 3 1 0\nV 8 0 0 0
V 9 1 0 0\nV 10 3 0 0\nV 11 0 0 3\nV 12 1 0 3\nV 13 3 0 3\nV 14 0 1 3\nV 15 1 1 3\nV 16 3 1 3
S 1 11 13 10 8 0 0 .9 south\nS 2 10 13 16 7 0 0 .9 east\nS 3 6 7 16 15 0 0 .9 inner-1
S 4 4 6 15 2 0 0 .9 inner-2\nS 5 3 4 2 1 0 0 .9 north\nS 6 8 3 1 11 0 0 .9 west
S 7 11 14 15 12 0 0 .9 ceiling-1\nS 8 1 2 15 14 0 7 .9 ceiling-2\nS 9 15 16 13 12 0 7 .9 ceiling-3
S 10 8 9 6 5 0 0 .9 floor-1\nS 11 5 6 4 3 0 10 .9 floor-2\nS 12 9 10 7 6 0 10 .9 floor-3";
    let (planes, vertices) = (vs3(by_planes), vs3(by_vertices));
    assert_eq!(planes.rows(), vertices.rows());
    for (a, b) in planes.scene.surfaces.iter().zip(&vertices.scene.surfaces) {
        assert_eq!(a.name, b.name);
        let close = |a: &Polygon, b: &Polygon| {
            (a.area() - b.area()).abs() + (a.area() * (a.normal() - b.normal())).length() < 1e-12
        };
        assert!(close(&a.polygons[0], &b.polygons[0]), "{}: {a:?} {b:?}", a.name);
        let (a, b) = (a.polygons[0].centroid(), b.polygons[0].centroid());
        assert!(a.distance(b) < 1e-12, "{a} {b}");
    }
    let volume = |loaded: &Loaded| -> f64 {
        loaded.scene.polygons().iter().map(|p| p.area() * p.normal().dot(p.centroid()) / 3.0).sum()
    };
    assert!((volume(&vertices) + 15.0).abs() < 1e-12, "{}", volume(&vertices));
    assert!((volume(&planes) + 15.0).abs() < 1e-12, "{}", volume(&planes));
}
