//! `fredholm viewfactors` from mesh to files, on scenes whose factors are known.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the message, in its helpers too")]

mod run;

use run::{Case, folder, fredholm, json, names, refuse, text};
use serde_json::Value;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Unit squares opposite each other, a unit apart; and with an edge in common, at right angles.
const OPPOSITE: f64 = 0.199824895698;
const ADJACENT: f64 = 0.200043776075;

/// What scenes are asked in which faces hide one another in part.
const HIDDEN: &str = "--tolerance 1e-4";

/// The corners of the six faces of a box, counter-clockwise seen from within: x, y, z low and high.
const WALLS: [[usize; 4]; 6] =
    [[0, 2, 6, 4], [1, 5, 7, 3], [0, 4, 5, 1], [2, 3, 7, 6], [0, 1, 3, 2], [4, 6, 7, 5]];

/// Appends a box [low, high]³, its fronts within or without, as a group.
fn add_box(obj: &mut String, group: &str, low: f64, high: f64, inward: bool) {
    let first = obj.matches("v ").count() + 1;
    for k in 0..8 {
        let at = |bit: usize| if k & bit == 0 { low } else { high };
        writeln!(obj, "v {} {} {}", at(1), at(2), at(4)).unwrap();
    }
    writeln!(obj, "g {group}").unwrap();
    for wall in WALLS {
        let mut corners = wall.map(|corner| (first + corner).to_string());
        if !inward {
            corners.reverse();
        }
        writeln!(obj, "f {}", corners.join(" ")).unwrap();
    }
}

/// A folder with the scenes.
fn scenes(name: &str) -> PathBuf {
    let folder = folder(name);
    let (mut cube, mut outward, mut nested) = (String::new(), String::new(), String::new());
    add_box(&mut cube, "cube", 0.0, 1.0, true);
    add_box(&mut outward, "cube", 0.0, 1.0, false);
    add_box(&mut nested, "room", 0.0, 1.0, true);
    add_box(&mut nested, "obstacle", 0.3, 0.7, false);
    let open = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
        g floor\nf 1 2 3 4\ng ceiling\nf 8 7 6 5\n";
    let far = open.replace(" 1\nv", " 10000\nv").replace(" 1\ng", " 10000\ng");
    let files = [
        ("far.obj", &*far),
        ("cube.obj", &*cube),
        ("outward.obj", &outward),
        ("nested.obj", &nested),
        ("open.obj", open),
    ];
    for (file, text) in files {
        fs::write(folder.join(file), text).unwrap();
    }
    folder
}

fn report(folder: &Path, words: &str) -> Value {
    let output = fredholm(folder, &format!("viewfactors {words} --json -"));
    assert!(output.status.success(), "{words}: {}", text(&output.stderr));
    json(&output.stdout)
}

fn matrix(report: &Value, key: &str) -> Vec<Vec<f64>> {
    serde_json::from_value(report[key].clone()).unwrap()
}

/// Whether two faces of a box are opposite: 0 and 1, 2 and 3, 4 and 5.
fn cube_factor(i: usize, j: usize) -> f64 {
    match i ^ j {
        0 => 0.0,
        1 => OPPOSITE,
        _ => ADJACENT,
    }
}

#[test]
fn the_cube_has_its_factors_within_their_errors() {
    let folder = scenes("viewfactors_cube");
    for (tolerance, keeps) in [("1e-4", 1e-7), ("1e-7", 1e-15)] {
        let report = report(&folder, &format!("cube.obj --tolerance {tolerance}"));
        let (factors, errors) = (matrix(&report, "F"), matrix(&report, "error"));
        for i in 0..6 {
            for j in 0..6 {
                // The closed forms are given to twelve digits.
                let missed = (factors[i][j] - cube_factor(i, j)).abs();
                assert!(missed <= errors[i][j] + 1e-12, "{i} {j}: {missed:e} of {:e}", errors[i][j]);
                assert!(errors[i][j] <= tolerance.parse().unwrap() && (errors[i][j] > 0.0) == (i != j));
            }
        }
        let number = |key: &str| report[key].as_f64().unwrap();
        assert!(number("closure_defect") <= tolerance.parse().unwrap());
        assert!(number("reciprocity_defect") <= keeps, "{}", report["reciprocity_defect"]);
        assert!(number("largest_row_error") <= tolerance.parse().unwrap());
        assert_eq!((report["closed"].as_bool(), report["closure_rows"].as_u64()), (Some(true), Some(6)));
        assert_eq!(report["areas"], json(b"[1.0, 1.0, 1.0, 1.0, 1.0, 1.0]"));
        assert_eq!(report["names"][5], "cube#6");
        for key in ["rays", "seconds", "peak_memory_bytes"] {
            assert!(report[key].is_number(), "{key}");
        }
    }
}

#[test]
fn a_box_in_a_box_has_its_factors_by_groups() {
    let folder = scenes("viewfactors_nested");
    let report = report(&folder, &format!("nested.obj --groups {HIDDEN}"));
    assert_eq!(report["names"], json(b"[\"room\", \"obstacle\"]"));
    assert_eq!((report["faces"].as_u64(), report["groups"].as_u64()), (Some(12), Some(2)));
    let (factors, errors) = (matrix(&report, "F"), matrix(&report, "error"));
    // All that leaves the obstacle arrives at the room, and by reciprocity 0.96 m² / 6 m² comes from there.
    for (i, j, expected) in [(0, 0, 0.84), (0, 1, 0.16), (1, 0, 1.0), (1, 1, 0.0)] {
        assert!((factors[i][j] - expected).abs() <= errors[i][j], "{i} {j}: {}", factors[i][j]);
    }
    let areas: Vec<f64> = serde_json::from_value(report["areas"].clone()).unwrap();
    assert!((areas[0] - 6.0).abs() < 1e-12 && (areas[1] - 0.96).abs() < 1e-12);
}

#[test]
fn an_open_scene_is_told_and_not_closed() {
    let folder = scenes("viewfactors_open");
    let report = report(&folder, "open.obj");
    assert_eq!(
        (report["closed"].as_bool(), report["names"].clone()),
        (Some(false), json(b"[\"floor\", \"ceiling\"]"))
    );
    let factors = matrix(&report, "F");
    assert!(
        (factors[0][1] - OPPOSITE).abs() < 1e-4 && factors[0][0] == 0.0 && factors[0][1] == factors[1][0]
    );
    assert!((report["closure_defect"].as_f64().unwrap() - (1.0 - OPPOSITE)).abs() < 1e-4);
    let table = text(&fredholm(&folder, "viewfactors open.obj").stdout);
    assert!(table.contains("open: ") && table.contains("% of the sight lines leave the scene"), "{table}");
}

#[test]
fn the_table_has_the_matrix_of_few_faces_and_what_is_wrong() {
    let folder = scenes("viewfactors_table");
    let output = fredholm(&folder, "viewfactors cube.obj");
    let table = text(&output.stdout);
    for part in
        ["cube.obj: view factors", "faces         6", "15 in full sight", "1.0e-4 allowed", "closed: ", "sum"]
    {
        assert!(table.contains(part), "no `{part}` in: {table}");
    }
    let row = table.lines().find(|line| line.trim_start().starts_with("cube#1 ")).unwrap();
    let numbers: Vec<f64> = row.split_whitespace().skip(1).map(|word| word.parse().unwrap()).collect();
    assert!(
        numbers.len() == 7 && (numbers[1] - OPPOSITE).abs() < 1e-4 && (numbers[6] - 1.0).abs() < 1e-4,
        "{row}"
    );
    assert_eq!((text(&output.stderr), names(&folder).len()), (String::new(), 5));
    let outward = text(&fredholm(&folder, "viewfactors outward.obj").stdout);
    assert!(outward.contains("NONE face each other"), "{outward}");
}

#[test]
fn enforced_factors_add_up_and_say_by_how_much_they_were_changed() {
    let folder = scenes("viewfactors_enforce");
    for words in ["cube.obj", "nested.obj", "nested.obj --groups"] {
        let before = report(&folder, &format!("{words} {HIDDEN}"));
        assert!(
            before["correction"].is_null() && before["closure_defect"].as_f64() > Some(1e-10),
            "never silently"
        );
        let output = fredholm(&folder, &format!("viewfactors {words} {HIDDEN} --enforce --json -"));
        let (report, table) = (json(&output.stdout), text(&output.stderr));
        assert!(report["closure_defect"].as_f64().unwrap() <= 1e-12, "{}", report["closure_defect"]);
        assert!(report["reciprocity_defect"].as_f64().unwrap() <= 1e-15);
        let (old, new, errors) = (matrix(&before, "F"), matrix(&report, "F"), matrix(&report, "error"));
        let largest = report["correction"]["largest"].as_f64().unwrap();
        for (i, row) in new.iter().enumerate() {
            assert!((row.iter().sum::<f64>() - 1.0).abs() <= 1e-12);
            for (j, factor) in row.iter().enumerate() {
                let change = (factor - old[i][j]).abs();
                assert!(*factor >= 0.0 && change <= errors[i][j] + 1e-15, "{i} {j}");
                assert!(words.ends_with("--groups") || change <= largest + 1e-7, "{i} {j}");
            }
        }
        assert!(table.contains("enforced") && table.contains("of the errors"), "{table}");
    }
}

#[test]
fn every_format_has_the_same_factors() {
    let folder = scenes("viewfactors_formats");
    let words =
        "nested.obj --tolerance 1e-2 --groups -o a.csv -o a.mtx -o a.npz -o a.out -o b.vf --json a.json";
    let output = fredholm(&folder, &format!("viewfactors {words}"));
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("written       a.csv, a.mtx, a.npz, a.out, b.vf, a.json"));
    let read = |name: &str| fs::read(folder.join(name)).unwrap();
    let factors = matrix(&json(&read("a.json")), "F");
    let numbers = |line: &str| -> Vec<f64> {
        line.split([',', ' ']).filter(|word| !word.is_empty()).map(|word| word.parse().unwrap()).collect()
    };
    let csv = text(&read("a.csv"));
    assert!(csv.starts_with("room,obstacle\n"));
    // The reader of JSON is off by a last digit now and then.
    let alike =
        |row: &[f64], other: &[f64]| row.iter().zip(other).all(|(a, b)| (a - b).abs() <= 2.0 * f64::EPSILON);
    assert!(csv.lines().skip(1).map(numbers).zip(&factors).all(|(row, other)| alike(&row, other)), "{csv}");
    let market = text(&read("a.mtx"));
    let entries: Vec<Vec<f64>> = market.lines().filter(|line| !line.starts_with('%')).map(numbers).collect();
    assert_eq!(entries[0], [2.0, 2.0, 3.0], "the obstacle does not see itself");
    assert!(alike(&entries[2], &[1.0, 2.0, factors[0][1]]), "{market}");
    let view3d = text(&read("a.out"));
    assert!(
        view3d.starts_with("fredholm ") && view3d.lines().next().unwrap().trim_end().ends_with(" 0 1 0 2")
    );
    assert!((numbers(view3d.lines().nth(2).unwrap())[1] - factors[0][1]).abs() < 1e-8);
    assert_eq!(view3d.lines().last(), Some("0.500 0.500"), "1 − ρ of what has no material");
    assert_eq!(read("b.vf"), read("a.out"));
    // The names stand in NumPy's UTF-32, in the last array of the archive.
    let archive = read("a.npz");
    let name: Vec<u8> = "obstacle".bytes().flat_map(|letter| [letter, 0, 0, 0]).collect();
    assert!(archive.starts_with(b"PK") && archive.windows(name.len()).any(|bytes| bytes == name));
}

/// A unit cube as View3D has it, or so many of its six faces, with a control line.
fn view3d_cube(control: &str, faces: usize) -> String {
    let mut text = format!("T cube\n{control}\nF 3\n");
    for k in 0..8 {
        writeln!(text, "V {} {} {} {}", k + 1, k & 1, k >> 1 & 1, k >> 2).unwrap();
    }
    for (k, wall) in WALLS.iter().enumerate().take(faces) {
        let [a, b, c, d] = wall.map(|corner| corner + 1);
        writeln!(text, "S {} {a} {b} {c} {d} 0 0 0.{}5 w{k}", k + 1, 9 - k).unwrap();
    }
    text
}

/// A file in View3D's binary format: the words of its first line, areas, rows of F, emittances.
fn binary(bytes: &[u8]) -> (Vec<String>, Vec<f32>, Vec<Vec<f32>>, Vec<f32>) {
    let header = std::str::from_utf8(&bytes[..32]).unwrap();
    assert!(header.ends_with("\r\n") && !header[..30].contains(['\r', '\n', '\0']), "{header:?}");
    let words: Vec<String> = header.split_whitespace().map(str::to_owned).collect();
    let n: usize = words[5].parse().unwrap();
    let numbers: Vec<f32> =
        bytes[32..].chunks(4).map(|bytes| f32::from_le_bytes(bytes.try_into().unwrap())).collect();
    assert_eq!(numbers.len(), n * (n + 2));
    let rows: Vec<Vec<f32>> = numbers.chunks(n).map(<[f32]>::to_vec).collect();
    (words, rows[0].clone(), rows[1..=n].to_vec(), rows[n + 1].clone())
}

#[test]
fn the_control_line_of_a_view3d_file_is_followed() {
    let folder = folder("viewfactors_control");
    fs::write(folder.join("cube.vs3"), view3d_cube("C eps=1e-3 encl=1 out=1", 6)).unwrap();
    let run = |words: &str| {
        let output = fredholm(&folder, &format!("viewfactors cube.vs3 {words} --json a.json"));
        assert!(output.status.success() && output.stderr.is_empty(), "{}", text(&output.stderr));
        (text(&output.stdout), json(&fs::read(folder.join("a.json")).unwrap()))
    };
    let (table, report) = run("-o a.out -o b.VF -o c.vfb");
    assert!(
        table.contains(
            "the file      eps=1e-3 is the tolerance; encl=1: closure is checked, and not enforced"
        )
    );
    assert!(table.contains("out=1: .out and .vf are binary") && table.contains("1.0e-3 allowed"), "{table}");
    assert_eq!((report["tolerance"].as_f64(), report["tolerance_from"].as_str()), (Some(1e-3), Some("file")));
    assert_eq!((report["encl"].as_bool(), report["correction"].is_null()), (Some(true), true));
    let read = |name: &str| fs::read(folder.join(name)).unwrap();
    let (words, areas, rows, emittances) = binary(&read("a.out"));
    assert_eq!((&*words[0], &words[2..]), ("fredholm", &["1", "1", "0", "6"].map(String::from)[..]));
    assert_eq!(areas, [1.0; 6]);
    assert_eq!(emittances, [0.95, 0.85, 0.75, 0.65, 0.55, 0.45]);
    for (row, factors) in rows.iter().zip(matrix(&report, "F")) {
        assert_eq!(*row, factors.iter().map(|factor| *factor as f32).collect::<Vec<_>>());
    }
    assert_eq!((read("b.VF"), read("c.vfb")), (read("a.out"), read("a.out")));

    let (table, report) = run("--tolerance 1e-5");
    assert!(
        table.contains("eps=1e-3, but --tolerance is given") && table.contains("1.0e-5 allowed"),
        "{table}"
    );
    assert_eq!(
        (report["tolerance"].as_f64(), report["tolerance_from"].as_str()),
        (Some(1e-5), Some("option"))
    );
}

/// Two surfaces, of which the first is flat, have 1/𝓕 = ρ₁/ε₁ + 1 + A₁/A₂ ρ₂/ε₂.
#[test]
fn reflections_are_put_into_the_factors_where_the_file_asks_for_them() {
    let folder = folder("viewfactors_reflections");
    let cube = view3d_cube("C emit=1 encl=1", 6);
    let combined = ["w2", "w3", "w4", "w5"].iter().fold(cube.clone(), |text, name| {
        let at = text.find(name).unwrap() - " 0 0.00 ".len();
        format!("{}2{}", &text[..=at], &text[at + 2..])
    });
    fs::write(folder.join("two.vs3"), combined).unwrap();
    let report = report(&folder, "two.vs3 -o a.out -o a.csv --tolerance 1e-6");
    let (factors, errors) = (matrix(&report, "F"), matrix(&report, "error"));
    let (emittances, areas): ([f64; 2], [f64; 2]) = ([0.95, 0.85], [1.0, 5.0]);
    let straight = 1.0 / (0.05 / 0.95 + 1.0 + 0.2 * 0.15 / 0.85);
    for i in 0..2 {
        for j in 0..2 {
            let expected = if i == j { emittances[i] - straight / areas[i] } else { straight / areas[i] };
            let error = (factors[i][j] - expected).abs();
            assert!(error <= errors[i][j] && errors[i][j] < 1e-6, "{i} {j}: {error:e} {:e}", errors[i][j]);
        }
    }
    assert!(
        report["emittance_defect"].as_f64().unwrap() < 1e-6
            && report["closure_defect"].as_f64().unwrap() < 1e-6
    );
    assert_eq!(report["emittances"], serde_json::json!(emittances));
    let written = text(&fs::read(folder.join("a.out")).unwrap());
    assert!(written.lines().next().unwrap().trim_end().ends_with(" 0 1 1 2"), "{written}");
    let first: f64 = written.lines().nth(2).unwrap().split(' ').next().unwrap().parse().unwrap();
    assert!((first - factors[0][0]).abs() < 1e-11, "{written}");

    fs::write(folder.join("six.vs3"), &cube).unwrap();
    let output = fredholm(&folder, "viewfactors six.vs3");
    let table = text(&output.stdout);
    for words in [
        "script F\n",
        "emit=1: the factors are Hottel's script F",
        "rows of script F add up to the emittances",
        "script F  ",
    ] {
        assert!(table.contains(words), "no `{words}` in {table}");
    }
}

/// A quarter of a wall is masked: it sees the mask, and the mask sees it.
#[test]
fn a_masking_surface_sees_its_base_alone() {
    let folder = folder("viewfactors_mask");
    // The walls see the back of the mask, and nothing checks their rows.
    let cube = view3d_cube("C eps=1e-6", 6);
    let corners = "V 11 0 0.5 0.5\nV 12 0 1 0.5\nV 13 0 1 1\nV 14 0 0.5 1\n";
    // The first face of the cube is its wall x = 0.
    let factors_of = |name: &str, part: &str| {
        fs::write(folder.join(name), format!("{cube}{corners}{part}")).unwrap();
        let report = report(&folder, name);
        assert!(
            report["closed"].as_bool().unwrap()
                && report["closure_rows"] == 2 - u64::from(part.starts_with('N'))
        );
        (report["areas"].clone(), matrix(&report, "F"), report["closure_defect"].as_f64().unwrap())
    };
    let (areas, masked, defect) = factors_of("mask.vs3", "M 7 14 13 12 11 1 0 0.5 mask\n");
    let (null_areas, null, null_defect) = factors_of("null.vs3", "N 7 14 13 12 11 1 0 0.5 null\n");
    assert!(defect < 1e-6 && null_defect < 1e-6, "{defect:e} {null_defect:e}");
    assert_eq!(
        (areas[0].as_f64(), areas[6].as_f64(), null_areas[0].as_f64()),
        (Some(1.0), Some(0.25), Some(0.75))
    );
    assert_eq!(masked[6], [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    assert_eq!((masked[0][6], masked[1][6]), (0.25, 0.0));
    for j in 1..6 {
        assert!((masked[0][j] - 0.75 * null[0][j]).abs() < 1e-7, "{j}");
        assert!((masked[j][0] - null[j][0]).abs() < 1e-7, "{j}");
    }
    for words in ["radiosity", "radiosity --thermal"] {
        fs::write(folder.join("mask.toml"), "unit = 'm'\nmeshes = ['mask.vs3']\n").unwrap();
        let message = text(&fredholm(&folder, &format!("{words} mask.toml")).stderr);
        assert!(message.contains("mask.vs3:22: `mask` is a masking surface (`M`)"), "{message}");
    }
}

#[test]
fn what_a_view3d_file_asks_for_and_does_not_get_is_told() {
    let folder = folder("viewfactors_control_not_done");
    fs::write(folder.join("open.vs3"), view3d_cube("C encl=1 row=2 out=2", 5)).unwrap();
    fs::write(folder.join("plain.vs3"), view3d_cube("C out=0", 6)).unwrap();
    let output = fredholm(&folder, "viewfactors open.vs3 -o a.out -o b.vfb");
    assert!(output.status.success());
    let told = text(&output.stderr);
    for word in ["`row=2`", "`out=2`", "`encl=1`"] {
        assert!(
            told.lines().any(|line| line.starts_with("warning: open.vs3:2: ") && line.contains(word)),
            "{told}"
        );
    }
    assert_eq!(told.lines().count(), 3 + 1, "and that edges are open: {told}");
    let table = text(&output.stdout);
    assert!(table.contains("open, ALTHOUGH THE FILE SAYS encl=1: "), "{table}");
    assert!(table.contains("1.0e-4 allowed"), "the default: {table}");
    assert!(
        text(&fs::read(folder.join("a.out")).unwrap())
            .lines()
            .next()
            .unwrap()
            .trim_end()
            .ends_with(" 0 0 0 5")
    );
    assert_eq!(binary(&fs::read(folder.join("b.vfb")).unwrap()).0[2..], ["1", "0", "0", "5"]);

    let output = fredholm(&folder, "viewfactors plain.vs3 -o c.out");
    assert!(output.stderr.is_empty() && !text(&output.stdout).contains("the file"));
    assert!(text(&fs::read(folder.join("c.out")).unwrap()).contains(" 0 1 0 6 "));
}

#[test]
fn the_digits_are_the_same_for_any_number_of_threads() {
    let folder = scenes("viewfactors_threads");
    let run = |threads: &str, option: &[&str]| {
        let words = "viewfactors nested.obj --tolerance 1e-2 --enforce -o a.csv --json a.json".split(' ');
        let mut command = Command::new(env!("CARGO_BIN_EXE_fredholm"));
        let output =
            command.args(words).args(option).env("RAYON_NUM_THREADS", threads).current_dir(&folder).output();
        // What is corrected may be more than the tolerance.
        assert!(matches!(output.unwrap().status.code(), Some(0 | 3)));
        let report = json(&fs::read(folder.join("a.json")).unwrap());
        (
            fs::read(folder.join("a.csv")).unwrap(),
            report["error"].to_string(),
            report["correction"].to_string(),
        )
    };
    let one = run("1", &[]);
    assert_eq!(one, run("2", &[]));
    assert_eq!(one, run("1", &["--threads", "3"]));
}

#[test]
fn a_tolerance_that_is_not_met_is_told() {
    let folder = scenes("viewfactors_not_met");
    // No error but 0 is stored as less than 1.2e-15 of a face.
    let output = fredholm(&folder, "viewfactors far.obj --tolerance 1e-15 -o a.csv");
    assert_eq!(output.status.code(), Some(3));
    let table = text(&output.stdout);
    assert!(table.contains("TOLERANCE NOT MET, 1.0e-15") && table.contains("written       a.csv"), "{table}");
    assert!(folder.join("a.csv").exists());
}

const BAD: &[Case] = &[
    ("", 2, &["<MESH>"]),
    ("missing.obj", 1, &["missing.obj", "cannot read"]),
    ("mesh.xyz", 1, &["mesh.xyz", "`xyz`"]),
    ("empty.obj", 1, &["no faces"]),
    ("flat.obj", 1, &["flat.obj:4", "no area"]),
    ("open.obj --enforce", 1, &["open.obj", "open", "% of the sight lines", "--enforce"]),
    ("outward.obj --enforce", 1, &["100.0 % of the sight lines", "fronts inside"]),
    ("cube.obj --tolerance 0", 2, &["positive finite number"]),
    ("cube.obj --tolerance nan", 2, &["positive finite number"]),
    ("cube.obj --tolerance -1", 2, &["positive finite number"]),
    ("cube.obj --threads 0", 2, &["1 to 1024"]),
    ("cube.obj -o a.txt", 2, &["a.txt", ".npz or .csv or .mtx or .vf or .out or .vfb"]),
    ("cube.obj -o no/such.npz", 1, &["cannot write no/such.npz", "folder no"]),
    ("cube.obj -o a.npz -o b.csv --json no/such.json", 1, &["cannot write no/such.json"]),
    ("cube.obj -o a.csv -o a.csv", 1, &["two outputs", "a.csv"]),
    ("cube.obj -o a.csv --json a.csv", 1, &["two outputs", "a.csv"]),
    ("cube.obj --json .", 1, &["it is a folder"]),
    ("masked.vs3", 1, &["masked.vs3:18", "masking surface 7 has no base"]),
    ("eps.vs3", 1, &["eps.vs3:2", "`eps=0`", "positive"]),
    ("out.vs3", 1, &["out.vs3:2", "`out=3`"]),
];

#[test]
fn bad_input_is_told_in_one_message() {
    let folder = scenes("viewfactors_bad");
    fs::write(folder.join("empty.obj"), "").unwrap();
    fs::write(folder.join("mesh.xyz"), "0 0 0\n").unwrap();
    fs::write(folder.join("flat.obj"), "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n").unwrap();
    let masked = view3d_cube("C encl=1", 6) + "M 7 1 2 4 3 0 0 0.9 mask\n";
    fs::write(folder.join("masked.vs3"), masked).unwrap();
    fs::write(folder.join("eps.vs3"), view3d_cube("C eps=0", 6)).unwrap();
    fs::write(folder.join("out.vs3"), view3d_cube("C out=3", 6)).unwrap();
    let messages = refuse(&folder, BAD, |words| fredholm(&folder, &format!("viewfactors {words}")));
    for (message, (words, code, _)) in messages.iter().zip(BAD) {
        assert!(*code == 2 || message.lines().count() == 1, "`{words}`: {message}");
    }
}
