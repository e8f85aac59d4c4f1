//! `fredholm bake` from scene to files.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the message, in its helpers too")]

mod run;

use run::{folder, fredholm, json, names, refuse, text};
use std::fs;

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
