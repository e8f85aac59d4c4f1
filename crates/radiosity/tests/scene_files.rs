//! Scenes read from files: the example scenes of the repository and small ones written for the purpose.

use fredholm::value::{Rgb, Spectrum, Value};
use glam::DVec3;
use radiosity::polygon::Polygon;
use radiosity::scene::{Error, Loaded, Scene, SolveOptions, load};
use std::f64::consts::{PI, SQRT_2};
use std::path::{Path, PathBuf};

fn repository(path: &str) -> Loaded {
    load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(path))
        .unwrap_or_else(|e| panic!("{e}"))
}

/// Loads the first of some files, written into a folder of their own.
fn written(folder: &str, files: &[(&str, &str)]) -> Result<Loaded, Error> {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("scene_files").join(folder);
    std::fs::create_dir_all(&folder).unwrap_or_else(|e| panic!("{e}"));
    for (name, text) in files {
        std::fs::write(folder.join(name), text).unwrap_or_else(|e| panic!("{e}"));
    }
    load(&folder.join(files[0].0))
}

fn polygons(scene: &Scene<Rgb>) -> impl Iterator<Item = &Polygon> {
    scene.surfaces.iter().flat_map(|surface| &surface.polygons)
}

/// ∮ n dA, zero for what is closed.
fn vector_area(scene: &Scene<Rgb>) -> DVec3 {
    polygons(scene).map(|p| p.area() * p.normal()).sum()
}

/// ⅓ ∮ x·n dA: the volume of solids less that of rooms.
fn signed_volume(scene: &Scene<Rgb>) -> f64 {
    polygons(scene).map(|p| p.area() * p.normal().dot(p.centroid()) / 3.0).sum()
}

#[test]
fn the_furnace_is_a_closed_room_of_one_material() {
    let scene = repository("furnace/furnace.toml").scene;
    assert_eq!(scene.surfaces.len(), 6);
    assert!(vector_area(&scene).length() < 1e-15);
    assert!((signed_volume(&scene) + 1.0).abs() < 1e-15);
    for surface in &scene.surfaces {
        assert_eq!(surface.reflectance, Spectrum([0.5, 0.25, 0.75]));
        assert!((surface.emission - Rgb::splat(1.0)).magnitude() < 1e-15);
    }
}

/// The plan of a column in m²: an octagon of radius 0.25 m, but for the rounding of its corners to 0.1 mm.
const COLUMN: f64 = 2.0 * SQRT_2 * 0.25 * 0.25;

#[test]
fn the_gallery_is_a_closed_room_with_solids_in_it() {
    let scene = repository("gallery/gallery.toml").scene;
    let octahedra: f64 = [0.5_f64, 0.3, 0.35].iter().map(|r| 2.0 * r.powi(3)).sum();
    let solids = 2.0 * 2.4 * 0.5 * 0.37 + 2.0 * 0.6 * 0.6 * 0.1 + octahedra;
    let room = (9.0 * 4.0 + 5.0 * 5.0 - 3.0 * COLUMN) * 4.0;
    assert!(vector_area(&scene).length() < 1e-12);
    assert!((signed_volume(&scene) - (solids - room)).abs() < 1e-3, "{}", signed_volume(&scene));
}

#[test]
fn the_gallerys_faces_meet_in_whole_edges() {
    // What closes without leaks, and with each edge walked once in either direction.
    let scene = repository("gallery/gallery.toml").scene;
    let key = |p: DVec3| (p * 1e5).round().to_array().map(|c| format!("{c}"));
    let edges: Vec<_> = polygons(&scene)
        .flat_map(|polygon| {
            let v = polygon.vertices();
            (0..v.len()).map(|i| (key(v[i]), key(v[(i + 1) % v.len()]))).collect::<Vec<_>>()
        })
        .collect();
    let open = edges.iter().filter(|(a, b)| !edges.contains(&(b.clone(), a.clone()))).count();
    assert_eq!(open, 0, "of {} edges", edges.len());
}

#[test]
fn the_gallerys_file_overrides_its_materials() {
    let Loaded { scene, solve, .. } = repository("gallery/gallery.toml");
    let surface =
        |name: &str| scene.surfaces.iter().find(|s| s.name == name).unwrap_or_else(|| panic!("no {name}"));
    assert_eq!(surface("bench").reflectance, Spectrum([0.46, 0.30, 0.17]));
    assert_eq!(surface("windows").reflectance, Rgb::splat(0.06));
    assert_eq!(surface("windows").emission, Spectrum([9.0, 10.0, 11.5]) * PI);
    assert_eq!(surface("windows").polygons.len(), 3);
    assert_eq!(surface("pendant/lamp").reflectance, Rgb::splat(0.0));
    assert!((surface("floor").area() - (61.0 - 3.0 * COLUMN)).abs() < 1e-3);
    assert_eq!(solve, SolveOptions { patch_size: Some(0.25), ..SolveOptions::default() });
}

const MESH: &str = "v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nusemtl paint\nf 1 2 3 4\n";

#[test]
fn lengths_are_in_the_unit_of_the_file() {
    for (unit, metres) in
        [("'mm'", 1e-3), ("'cm'", 1e-2), ("'m'", 1.0), ("'in'", 0.0254), ("'ft'", 0.3048), ("7", 7.0)]
    {
        let text = format!(
            "unit = {unit}\nmeshes = ['a.obj']\nmaterials.paint.emission = 1\n[camera]\nposition = [0, 0, 10]\n\
             target = [0, 10, 10]\nvertical_angle = 90\n[solve]\npatch_size = 2\nmethod = 'galerkin'\ntolerance = 1e-6"
        );
        let Loaded { scene, solve, .. } = written("unit", &[("a.toml", &text), ("a.obj", MESH)]).unwrap();
        assert!((scene.surfaces[0].area() / (100.0 * metres * metres) - 1.0).abs() < 1e-12);
        let camera = scene.camera.unwrap();
        assert!(camera.target.distance(DVec3::new(0.0, 10.0, 10.0) * metres) < 1e-12);
        assert_eq!((camera.up, camera.vertical_angle), (DVec3::Z, PI / 2.0));
        assert_eq!(solve.patch_size, Some(2.0 * metres));
        assert_eq!(
            (solve.method.as_deref(), solve.tolerance, solve.solver),
            (Some("galerkin"), Some(1e-6), None)
        );
    }
}

#[test]
fn up_is_z_unless_the_camera_looks_along_it() {
    let up = |direction: &str| {
        let text = format!(
            "unit = 'm'\nmeshes = ['a.obj']\nmaterials.paint.radiance = [1, 2, 3]\n[camera]\nposition = [0, 0, 10]\n\
             direction = {direction}\nvertical_angle = 90"
        );
        written("up", &[("a.toml", &text), ("a.obj", MESH)]).unwrap().scene.camera.unwrap().up
    };
    assert_eq!(up("[0, 0, -3]"), DVec3::Y);
    assert_eq!(up("[0, 1, -3]"), DVec3::Z);
}

#[test]
fn a_mesh_alone_is_in_metres_and_called_after_its_file() {
    let lamp = "newmtl paint\r\nKd .5\r\nKe 1 2 3\r\n";
    let mesh = format!("\u{feff}mtllib my lamp.mtl\r\n{}", MESH.replace('\n', "\r\n"));
    let scene = written("alone", &[("a.OBJ", &mesh), ("my lamp.mtl", lamp)]).unwrap().scene;
    assert_eq!((scene.name.as_str(), scene.surfaces[0].name.as_str()), ("a.OBJ", "paint"));
    assert!((scene.surfaces[0].area() - 100.0).abs() < 1e-12);
    assert_eq!(scene.surfaces[0].reflectance, Rgb::splat(0.5));
    assert_eq!(scene.surfaces[0].emission, Spectrum([1.0, 2.0, 3.0]) * PI);
}

#[test]
fn an_override_mends_what_would_be_refused() {
    let files = |over: &str| {
        let text = format!("unit = 'm'\nmeshes = ['a.obj']\n[materials.paint]\n{over}");
        let mesh = format!("mtllib a.mtl\n{MESH}");
        written("mend", &[("a.toml", &text), ("a.obj", &mesh), ("a.mtl", "newmtl paint\nKd 1 1 1\nKe 1 1 1")])
    };
    assert!(files("").is_err());
    assert_eq!(files("reflectance = 0.9").unwrap().scene.surfaces[0].reflectance, Rgb::splat(0.9));
}
