//! `fredholm radiosity` from scene to files.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the message, in its helpers too")]

mod run;

use run::{folder, fredholm, json, names, text};
use std::fs;
use std::path::Path;

/// Small pictures, few rays: what is tested is which files there are and what they say.
const QUICK: &str = "radiosity --patch-count 200 --size 32x32 --samples 1 --gather 4";

fn furnace() -> String {
    format!("{}/../../scenes/furnace/furnace.toml", env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn without_options_there_is_a_picture_by_the_scenes_name_and_a_table() {
    let folder = folder("picture");
    let output = fredholm(&folder, QUICK);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(names(&folder), ["cornell-box.png"]);
    assert!(fs::read(folder.join("cornell-box.png")).unwrap().starts_with(b"\x89PNG"));
    let table = text(&output.stdout);
    for line in
        ["patches", "rays", "residual", "error bound", "closure", "time", "written       cornell-box.png"]
    {
        assert!(table.contains(line), "no `{line}` in: {table}");
    }
    assert_eq!(text(&output.stderr), "", "a bar where nobody looks");
}

#[test]
fn the_json_alone_is_on_the_standard_output() {
    let folder = folder("json");
    let output = fredholm(&folder, &format!("{QUICK} --json -"));
    let report = json(&output.stdout);
    assert!(names(&folder).is_empty(), "a picture that nobody asked for");
    assert!(text(&output.stderr).contains("error bound"), "the table is not on the standard error");
    assert_eq!(
        (report["method"].as_str(), report["solver"].as_str()),
        (Some("galerkin"), Some("gauss-seidel"))
    );
    for key in ["patches", "iterations", "residual", "error_bound", "rays", "peak_memory_bytes"] {
        assert!(report[key].as_f64().is_some_and(|number| number > 0.0), "{key}: {}", report[key]);
    }
    assert!(report["closure_defect"].is_null(), "the Cornell box has no front");
    for stage in ["load", "patches", "visibility", "form_factors", "solve", "picture", "total"] {
        assert!(report["seconds"][stage].is_number(), "{stage}");
    }
    let surfaces: Vec<_> =
        report["surfaces"].as_array().unwrap().iter().map(|s| s["name"].as_str().unwrap()).collect();
    assert_eq!((surfaces.len(), surfaces[0], surfaces[15]), (16, "floor", "light"));
}

/// A tent of two faces with a normal over its ridge, and a lamp.
const TENT: &str = "mtllib tent.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 0 0.5\nv -1 0 0.5\nv 1 1 0\nv -1 1 0\nv 0 -2 3\nv 1 -2 3\nv 0 -3 3\n\
    vn 0 0 1\nvn 0 -0.5 1\nvn 0 0.5 1\nusemtl cloth\nf 1//2 2//2 3//1 4//1\nf 4//1 3//1 5//3 6//3\nf 1//1 2//9 3//1\n\
    usemtl lamp\nf 7 8 9\n";

#[test]
fn smooth_normals_are_counted_and_can_be_left_out() {
    let folder = folder("smooth");
    fs::write(folder.join("tent.obj"), TENT).unwrap();
    fs::write(folder.join("tent.mtl"), "newmtl cloth\nKd .5 .5 .5\nnewmtl lamp\nKe 9 9 9\n").unwrap();
    let picture = |words: &str| {
        let output = fredholm(&folder, &format!("radiosity tent.obj --size 32x32 --json - -o a.png {words}"));
        assert!(output.status.success(), "{}", text(&output.stderr));
        let told = text(&output.stderr);
        assert!(told.contains("warning: tent.obj:17: 1 face is drawn flat here: not every corner"), "{told}");
        assert_eq!(json(&output.stdout)["clean_up"]["faces_drawn_flat"], 1);
        assert!(told.contains("clean-up      1 faces drawn flat, for wrong normals"), "{told}");
        let count = json(&output.stdout)["smooth_normals"].as_u64().unwrap();
        assert_eq!(told.contains("normals       of 2 polygons, in the picture"), count > 0, "{told}");
        (count, fs::read(folder.join("a.png")).unwrap())
    };
    for way in ["--patch-count 20", "--accuracy 5%"] {
        let ((smooth, round), (flat, edged)) = (picture(way), picture(&format!("{way} --flat")));
        assert_eq!((smooth, flat), (2, 0), "{way}");
        assert!(round != edged, "{way}: the pictures are the same");
    }
}

#[test]
fn the_furnace_has_its_answer_by_every_method_and_solver() {
    let folder = folder("furnace");
    let run = |words: &str| {
        let output =
            fredholm(&folder, &format!("radiosity {} --patch-count 100 --json - {words}", furnace()));
        assert!(output.status.success(), "{words}: {}", text(&output.stderr));
        json(&output.stdout)
    };
    let solvers = ["gauss-seidel", "southwell", "jacobi", "successive", "gmres", "direct"];
    let words = solvers.map(|solver| format!("--solver {solver}")).into_iter();
    let spaces = ["p1 --solver gmres", "p2 --method collocation --solver direct"];
    for solver in words.chain(spaces.map(|space| format!("--space {space}"))) {
        let report = run(&solver);
        assert!(report["closure_defect"].is_null() == report["closure_rows"].is_null());
        for surface in report["surfaces"].as_array().unwrap() {
            for (channel, expected) in [2.0, 4.0 / 3.0, 4.0].into_iter().enumerate() {
                let mean = |key: &str| surface[key][channel].as_f64().unwrap();
                assert!((mean("mean_radiosity") / expected - 1.0).abs() < 1e-4, "{solver}: {surface}");
                // H = B, since F·1 = 1 and B is the same everywhere.
                assert!((mean("mean_irradiance") / expected - 1.0).abs() < 1e-4, "{solver}: {surface}");
            }
        }
    }
    assert!(run("--method collocation")["closure_defect"].as_f64().unwrap() < 1e-6);
    assert_eq!(run("--method nystrom --tolerance 1e-3")["method"], "nystrom");
}

#[test]
fn the_command_line_overrides_the_scene_file_and_that_the_defaults() {
    let folder = folder("settings");
    let mesh = Path::new(&furnace()).with_file_name("furnace.obj");
    let scene = format!(
        "unit = \"m\"\nmeshes = [{mesh:?}]\n[solve]\npatch_size = 0.5\nsolver = \"jacobi\"\nmethod = \"collocation\"\n"
    );
    fs::write(folder.join("scene.toml"), scene).unwrap();
    let run = |words: &str| {
        let report = json(&fredholm(&folder, &format!("radiosity scene.toml --json - {words}")).stdout);
        let word = |key: &str| report[key].as_str().unwrap().to_owned();
        (report["patches"].as_u64().unwrap(), word("method"), word("solver"))
    };
    assert_eq!(run(""), (24, "collocation".into(), "jacobi".into()));
    assert_eq!(run("--solver gmres --patch-size 1"), (6, "collocation".into(), "gmres".into()));
    assert_eq!(run("--patch-count 54 --method galerkin"), (54, "galerkin".into(), "jacobi".into()));
}

#[test]
fn what_has_not_converged_is_written_and_told() {
    let folder = folder("not_converged");
    let output =
        fredholm(&folder, &format!("{QUICK} --solver successive --iterations 2 --json a.json -o a.png"));
    assert_eq!(output.status.code(), Some(3));
    assert_eq!(names(&folder), ["a.json", "a.png"]);
    let table = text(&output.stdout);
    assert!(table.contains("NOT CONVERGED") && table.contains("each one bounce of light"), "{table}");
    assert_eq!(json(&fs::read(folder.join("a.json")).unwrap())["outcome"], "out of iterations");
}

#[test]
fn frames_are_numbered_by_iteration() {
    let folder = folder("frames");
    let frames = |words: &str| {
        let output = fredholm(&folder, &format!("{QUICK} --frames deep/er --iterations 250 {words}"));
        assert!(output.status.code().is_some_and(|code| code != 1), "{}", text(&output.stderr));
        let names = names(&folder.join("deep/er"));
        fs::remove_dir_all(folder.join("deep")).unwrap();
        names
    };
    assert_eq!(frames("--solver southwell --ambient"), ["00100.png", "00200.png", "00250.png"]);
    assert_eq!(frames("--solver gmres --every 3")[..2], ["00003.png", "00006.png"]);
    assert_eq!(frames("--false-colour")[0], "00001.png");
    assert!(names(&folder).is_empty(), "frames alone make no final picture");
}

#[test]
fn patches_are_written_in_both_formats() {
    let folder = folder("patches");
    fredholm(&folder, &format!("{QUICK} --patches a.csv"));
    fredholm(&folder, &format!("{QUICK} --patches a.npz --json -"));
    assert_eq!(names(&folder), ["a.csv", "a.npz"]);
    let csv = fs::read_to_string(folder.join("a.csv")).unwrap();
    assert!(csv.starts_with("x,y,z,nx,ny,nz,area,emission_r,") && csv.lines().count() > 100);
    assert!(fs::read(folder.join("a.npz")).unwrap().starts_with(b"PK"));
}

#[test]
fn a_spectrum_has_76_channels_of_one_matrix() {
    let folder = folder("spectral");
    let output = fredholm(&folder, &format!("{QUICK} --bands spectral --json - -o a.png"));
    let report = json(&output.stdout);
    assert_eq!(report["surfaces"][0]["mean_radiosity"].as_array().unwrap().len(), 76);
    assert_eq!(names(&folder), ["a.png"]);
}

#[test]
fn a_full_disk_is_told() {
    if Path::new("/dev/full").exists() {
        let output = fredholm(&folder("full"), &format!("{QUICK} --json /dev/full"));
        assert_eq!(output.status.code(), Some(1));
        let message = text(&output.stderr);
        assert!(message.starts_with("error: cannot write /dev/full: No space left"), "{message}");
    }
}

#[test]
fn a_reader_who_goes_away_is_no_error() {
    let folder = folder("pipe");
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_fredholm"));
    command.args(QUICK.split_whitespace()).current_dir(&folder);
    let mut child = command.stdout(std::process::Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    assert!(child.wait().unwrap().success());
    assert_eq!(names(&folder), ["cornell-box.png"]);
}

#[cfg(unix)]
#[test]
fn an_interrupt_leaves_nothing() {
    let folder = folder("interrupt");
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_fredholm"));
    command.args(["radiosity", "--factor-accuracy", "1e-5", "-o", "a.png"]).current_dir(&folder);
    let mut child = command.spawn().unwrap();
    while names(&folder).is_empty() {
        assert_eq!(child.try_wait().unwrap(), None, "it ended before it could be interrupted");
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert!(names(&folder).is_empty());
}

#[test]
fn an_accuracy_is_a_whole_request() {
    let folder = folder("accuracy");
    let words = "--size 32x32 --samples 1";
    let output = fredholm(&folder, &format!("radiosity --accuracy 4% {words}"));
    assert!(output.status.success(), "{}", text(&output.stderr));
    let table = text(&output.stdout);
    for line in ["to an accuracy of 4 %", "of the mesh", "form factors", "iteration", "patches of degree 2"] {
        assert!(table.contains(line), "no `{line}` in: {table}");
    }
    let output = fredholm(
        &folder,
        &format!("radiosity {} --accuracy 0.02 --json - --patches p.csv {words}", furnace()),
    );
    let report = json(&output.stdout);
    let number = |key: &str| report[key].as_f64().unwrap();
    let parts = ["discretisation_error", "form_factor_error", "iteration_error"].map(number);
    assert!((parts.iter().sum::<f64>() - number("error")).abs() < 1e-12);
    assert!(report["outcome"] == "met" && number("error") <= 0.02 && number("accuracy") == 0.02);
    for surface in report["surfaces"].as_array().unwrap() {
        for (channel, expected) in [2.0, 4.0 / 3.0, 4.0].into_iter().enumerate() {
            let mean = surface["mean_radiosity"][channel].as_f64().unwrap();
            assert!((mean / expected - 1.0).abs() < number("error"), "{surface}");
        }
    }
    let rows = fs::read_to_string(folder.join("p.csv")).unwrap().lines().count();
    assert_eq!(rows, 1 + 64 * number("patches") as usize);
}

#[test]
fn a_scene_file_asks_for_an_accuracy_and_the_command_line_comes_first() {
    let folder = folder("accuracy_in_a_file");
    let scene = fs::read_to_string(furnace()).unwrap();
    let mesh = Path::new(&furnace()).with_file_name("furnace.obj");
    let scene = scene.replace("furnace.obj", mesh.to_str().unwrap());
    let (before, _) = scene.split_once("[solve]").unwrap_or((&scene, ""));
    fs::write(folder.join("scene.toml"), format!("{before}\n[solve]\naccuracy = \"3%\"\n")).unwrap();
    let run =
        |words: &str| json(&fredholm(&folder, &format!("radiosity scene.toml --json - {words}")).stdout);
    assert_eq!(run("")["accuracy"].as_f64(), Some(0.03));
    assert_eq!(run("--accuracy 5%")["accuracy"].as_f64(), Some(0.05));
    assert_eq!(run("--patch-count 100")["method"].as_str(), Some("galerkin"));
    fs::write(folder.join("scene.toml"), format!("{before}\n[solve]\naccuracy = \"300%\"\n")).unwrap();
    let output = fredholm(&folder, "radiosity scene.toml");
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stderr).contains("give a percentage such as"), "{}", text(&output.stderr));
}
