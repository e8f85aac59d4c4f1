//! `fredholm bake` from scene to files.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the message, in its helpers too")]

mod run;

use run::{folder, fredholm, json, names, refuse, text};
use std::f64::consts::PI;
use std::fs;
use std::path::Path;

#[test]
fn a_scene_is_baked_by_its_name_and_the_table_says_what_it_is() {
    let folder = folder("bake");
    let output = fredholm(&folder, "bake --accuracy 10% --size 64");
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(names(&folder), ["cornell-box.glb"]);
    assert!(fs::read(folder.join("cornell-box.glb")).unwrap().starts_with(b"glTF"));
    let table = text(&output.stdout);
    for words in
        ["baked to an accuracy of 10 %", "64 × 64 texels of", "radiance B/π, in W/(m² sr)", "cornell-box.glb"]
    {
        assert!(table.contains(words), "no `{words}` in: {table}");
    }
}

#[test]
fn all_outputs_are_written_and_the_numbers_told() {
    let folder = folder("bake-all");
    let output = fredholm(&folder, "bake --accuracy 10% --size 64 -o a.glb --irradiance a.exr --json -");
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(names(&folder), ["a.exr", "a.glb"]);
    assert!(fs::read(folder.join("a.exr")).unwrap().starts_with(&[0x76, 0x2f, 0x31, 0x01]));
    let report = json(&output.stdout);
    let number = |key: &str| report[key].as_f64().unwrap();
    assert!(number("error") <= 0.1 && report["outcome"] == "met");
    // The box is 5.5 m² of walls and blocks in metres, in 64² texels.
    assert!((0.02..0.08).contains(&number("texel")), "{}", number("texel"));
}

#[test]
fn light_goes_to_vertices_and_how_far_it_is_off_between_them_is_told() {
    let folder = folder("bake-vertices");
    let output = fredholm(&folder, "bake --accuracy 10% --vertex-colours -o a.glb --json -");
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(names(&folder), ["a.glb"]);
    let (report, table) = (json(&output.stdout), text(&output.stderr));
    let number = |key: &str| report[key].as_f64().unwrap();
    assert_eq!((&report["form"], &report["outcome"]), (&"vertex-colours".into(), &"met".into()));
    assert!(number("vertex_error") <= 0.1 && number("triangles") > number("vertices"), "{report}");
    for words in ["linear between vertices is", "radiance B/π, in W/(m² sr) by the materials' radiance_of_1"]
    {
        assert!(table.contains(words), "no `{words}` in: {table}");
    }
    let bytes = fs::read(folder.join("a.glb")).unwrap();
    let file = String::from_utf8_lossy(&bytes);
    assert!(file.contains("COLOR_0") && file.contains("× extras.radiance_of_1 of the material"));
}

#[test]
fn what_is_done_to_a_mesh_and_that_no_light_is_there_are_told() {
    let folder = folder("bake-told");
    fs::write(folder.join("a.mtl"), "newmtl floor\nKd .5 .5 .5\nnewmtl lamp\nKe 1 1 1\n").unwrap();
    let floor = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 -1\nusemtl floor\nf 1//1 2//1 3//1 4//1\n";
    // It looks away from the floor.
    let lamp = "v 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nusemtl lamp\nf 5 6 7 8\n";
    fs::write(folder.join("a.obj"), format!("mtllib a.mtl\n{floor}{lamp}")).unwrap();
    let output = fredholm(&folder, "bake a.obj --size 64 --json -");
    assert!(output.status.success(), "{}", text(&output.stderr));
    let (report, table) = (json(&output.stdout), text(&output.stderr));
    assert!(report["dark"] == true && report["clean_up"]["faces_drawn_flat"] == 1, "{report}");
    assert!(table.contains("NONE reaches any surface") && table.contains("1 faces drawn flat"), "{table}");
}

#[test]
fn what_cannot_be_baked_is_told_and_leaves_nothing() {
    let folder = folder("bake-bad");
    fs::write(folder.join("empty.obj"), "v 0 0 0\n").unwrap();
    refuse(
        &folder,
        &[
            ("bake --size 16", 1, &["polygons do not fit into 16 × 16 texels", "a larger atlas"]),
            ("bake empty.obj", 1, &["empty.obj"]),
            ("bake none.obj", 1, &["none.obj"]),
            ("bake -o none/a.glb", 1, &["cannot write none/a.glb"]),
            ("bake -o a.glb --irradiance a.glb", 1, &["two outputs", "a.glb"]),
            ("bake --accuracy 0%", 2, &["a percentage such as 1%"]),
            ("bake --vertex-colours --irradiance a.exr", 2, &["--vertex-colours", "--irradiance"]),
        ],
        |words| fredholm(&folder, words),
    );
}

/// A room of 4 m × 4 m × 3 m with a lamp and a ball of 2 k² faces, as OBJ and MTL.
fn room_with_a_ball(folder: &Path, k: usize) {
    let mut vertices = String::new();
    let mut faces = [const { String::new() }; 2];
    let mut count = 0;
    let mut add = |into: usize, corners: &[[f64; 3]]| {
        corners.iter().for_each(|[x, y, z]| vertices += &format!("v {x} {y} {z}\n"));
        let numbers: Vec<String> = (1..=corners.len()).map(|i| (count + i).to_string()).collect();
        count += corners.len();
        faces[into] += &format!("f {}\n", numbers.join(" "));
    };
    let (w, h) = (4.0, 3.0);
    add(0, &[[0.0, 0.0, 0.0], [w, 0.0, 0.0], [w, w, 0.0], [0.0, w, 0.0]]);
    add(0, &[[0.0, 0.0, h], [0.0, w, h], [w, w, h], [w, 0.0, h]]);
    add(0, &[[0.0, 0.0, 0.0], [0.0, w, 0.0], [0.0, w, h], [0.0, 0.0, h]]);
    add(0, &[[w, 0.0, 0.0], [w, 0.0, h], [w, w, h], [w, w, 0.0]]);
    add(0, &[[0.0, w, 0.0], [w, w, 0.0], [w, w, h], [0.0, w, h]]);
    add(0, &[[0.0, 0.0, 0.0], [0.0, 0.0, h], [w, 0.0, h], [w, 0.0, 0.0]]);
    add(1, &[[1.5, 1.5, 2.9], [1.5, 2.5, 2.9], [2.5, 2.5, 2.9], [2.5, 1.5, 2.9]]);
    let point = |i: usize, j: usize| {
        let [theta, phi] = [i, j].map(|n| PI * n as f64 / k as f64);
        [2.0 + 0.8 * theta.sin() * phi.cos(), 2.0 + 0.8 * theta.sin() * phi.sin(), 1.0 + 0.8 * theta.cos()]
    };
    for i in 0..k {
        for j in 0..2 * k {
            let corners = [point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)];
            match i {
                0 => add(0, &corners[..3]),
                _ if i + 1 == k => add(0, &[corners[0], corners[1], corners[3]]),
                _ => add(0, &corners),
            }
        }
    }
    let [white, lamp] = faces;
    let obj = format!("mtllib room.mtl\n{vertices}usemtl white\n{white}usemtl lamp\n{lamp}");
    fs::write(folder.join("room.obj"), obj).unwrap();
    fs::write(folder.join("room.mtl"), "newmtl white\nKd .7 .7 .7\nnewmtl lamp\nKd 0 0 0\nKe 20 20 20\n")
        .unwrap();
}

#[test]
fn a_scene_of_thousands_of_faces_is_baked_to_an_accuracy_too() {
    let folder = folder("bake-many");
    room_with_a_ball(&folder, 32);
    for (words, form) in [("--size 512", "texture"), ("--vertex-colours", "vertex-colours")] {
        let output = fredholm(&folder, &format!("bake room.obj --accuracy 5% -o a.glb --json - {words}"));
        assert!(output.status.success(), "{}", text(&output.stderr));
        let report = json(&output.stdout);
        assert_eq!((&report["form"], &report["outcome"]), (&form.into(), &"met".into()), "{report}");
        assert!(report["polygons"].as_u64().is_none_or(|polygons| polygons > 2000), "{report}");
        assert!(fs::read(folder.join("a.glb")).unwrap().starts_with(b"glTF"));
    }
    let output = fredholm(&folder, "radiosity room.obj --accuracy 5% --size 64x64 --json -");
    assert!(output.status.success(), "{}", text(&output.stderr));
    let report = json(&output.stdout);
    let number = |key: &str| report[key].as_f64().unwrap();
    assert!(number("error") <= 0.05 && number("patches") >= 4000.0, "{report}");
    // In a closed room all that the lamp emits is absorbed: .3 of what arrives at white, and all that comes back to the lamp.
    let total = |of: &str, absorptance: [f64; 2]| {
        let surfaces = report["surfaces"].as_array().unwrap().iter().zip(absorptance);
        surfaces.map(|(s, part)| part * s["area"].as_f64().unwrap() * s[of][0].as_f64().unwrap()).sum::<f64>()
    };
    let [absorbed, emitted] = [total("mean_irradiance", [0.3, 1.0]), total("emission", [1.0, 1.0])];
    assert!(emitted > 0.0 && (absorbed / emitted - 1.0).abs() < 0.03, "{absorbed} W of {emitted}");
}
