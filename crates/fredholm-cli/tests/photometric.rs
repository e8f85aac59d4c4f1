//! `fredholm radiosity --photometric`: lux and candela, after CIE 171:2006.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the message, in its helpers too")]

mod run;

use run::{folder, fredholm, json, names, text};
use std::f64::consts::PI;
use std::fs;
use std::path::Path;

/// A quadrilateral of a group and a material, from its corners.
fn face(name: &str, material: &str, corners: [[f64; 3]; 4]) -> String {
    let vertices: String = corners.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n")).collect();
    format!("{vertices}o {name}\nusemtl {material}\nf -4 -3 -2 -1\n")
}

/// The cube of 4 m seen from within.
fn room() -> String {
    let a = 4.0;
    [
        ("floor", [[0., 0., 0.], [a, 0., 0.], [a, a, 0.], [0., a, 0.]]),
        ("ceiling", [[0., 0., a], [0., a, a], [a, a, a], [a, 0., a]]),
        ("south", [[0., 0., 0.], [0., 0., a], [a, 0., a], [a, 0., 0.]]),
        ("north", [[0., a, 0.], [a, a, 0.], [a, a, a], [0., a, a]]),
        ("west", [[0., 0., 0.], [0., a, 0.], [0., a, a], [0., 0., a]]),
        ("east", [[a, 0., 0.], [a, 0., a], [a, a, a], [a, a, 0.]]),
    ]
    .map(|(name, corners)| face(name, if name == "ceiling" { "lit" } else { "wall" }, corners))
    .concat()
}

fn write(folder: &Path, mesh: &str, scene: &str) {
    fs::write(folder.join("a.obj"), mesh).unwrap();
    fs::write(folder.join("a.toml"), format!("unit = \"m\"\nmeshes = [\"a.obj\"]\n{scene}")).unwrap();
}

#[test]
fn a_closed_room_of_one_reflectance_as_tc_5_8() {
    // 10 000 lm into a cube of 4 m, all of one ρ: the mean indirect illuminance is Φρ/(S(1 − ρ)), however Φ gets there.
    let folder = folder("tc_5_8");
    for (reflectance, expected) in [(0.05, 5.4825), (0.5, 104.1667), (0.8, 416.6667), (0.95, 1979.1667)] {
        write(
            &folder,
            &room(),
            &format!(
                "[materials.lit]\nreflectance = {reflectance}\nluminous_flux = 10000\n\
                 [materials.wall]\nreflectance = {reflectance}\n"
            ),
        );
        let words = "radiosity a.toml --photometric --patch-size 0.5 --tolerance 1e-9 --json -";
        let report = json(&fredholm(&folder, words).stdout);
        assert_eq!(
            (report["units"]["illuminance"].as_str(), report["units"]["luminance"].as_str()),
            (Some("lx"), Some("cd/m²"))
        );
        let mut indirect = 0.0;
        for surface in report["surfaces"].as_array().unwrap() {
            let number = |key: &str| surface[key].as_f64().unwrap();
            indirect += number("mean_illuminance") * 16.0 / 96.0;
            let exitance = surface["mean_radiosity"][0].as_f64().unwrap();
            assert!((number("mean_luminance") - exitance / PI).abs() < 1e-9 * exitance);
        }
        indirect -= 10_000.0 / 96.0;
        assert!((indirect / expected - 1.0).abs() < 1e-4, "ρ = {reflectance}: {indirect} lx for {expected}");
    }
}

#[test]
fn a_point_source_as_tc_5_8() {
    // The same from a point in the middle: the direct light is no emission of the walls, which is what files must say.
    let folder = folder("tc_5_8_point");
    let lit = "[[light]]\nposition = [2, 2, 2]\nflux = 10000\n";
    write(
        &folder,
        &room(),
        &format!("{lit}[materials.lit]\nreflectance = 0.5\n[materials.wall]\nreflectance = 0.5\n"),
    );
    for space in ["p0", "p1"] {
        let words =
            format!("radiosity a.toml --photometric --patch-size 1 --space {space} --patches p.csv --json -");
        let report = json(&fredholm(&folder, &words).stdout);
        assert_eq!(report["point_lights"], 1);
        for surface in report["surfaces"].as_array().unwrap() {
            let number = |key: &str| surface[key].as_f64().unwrap();
            assert_eq!(surface["emission"][0], 0.0);
            assert!((number("mean_illuminance") / 208.3333 - 1.0).abs() < 1e-3, "{space}: {surface}");
            assert!((number("mean_luminance") * PI / 104.1667 - 1.0).abs() < 1e-3, "{space}: {surface}");
        }
        let csv = fs::read_to_string(folder.join("p.csv")).unwrap();
        assert!(csv.lines().skip(1).all(|row| row.split(',').nth(7) == Some("0")), "{csv}");
    }
    let table = text(
        &fredholm(&folder, "radiosity a.toml --photometric --patch-size 2 --size 32x32 -o a.png").stdout,
    );
    assert!(table.contains("point lights  1"), "{table}");
}

#[test]
fn a_lambertian_source_in_a_ceiling_as_tc_5_3() {
    // L = 1000 cd/m², 1 × 1 m in the middle of a ceiling of 4 × 4 m, 3 m high; black walls. Small patches of the wall
    // y = 0 stand for the standard's points, at x = 2 and the heights z.
    let points = [
        (2.75, 32.6769),
        (2.25, 75.1939),
        (1.75, 81.3232),
        (1.25, 69.0606),
        (0.75, 53.4035),
        (0.25, 40.0019),
    ];
    let source = face("source", "source", [[1.5, 1.5, 3.], [1.5, 2.5, 3.], [2.5, 2.5, 3.], [2.5, 1.5, 3.]]);
    let patch = |(k, (z, _)): (usize, &(f64, f64))| {
        let (s, z) = (0.005, *z);
        let corners = [[2. - s, 0., z - s], [2. - s, 0., z + s], [2. + s, 0., z + s], [2. + s, 0., z - s]];
        face(&format!("point{k}"), "black", corners)
    };
    let mesh = source + &points.iter().enumerate().map(patch).collect::<String>();
    let folder = folder("tc_5_3");
    write(&folder, &mesh, "[materials.source]\nluminance = 1000\n[materials.black]\nreflectance = 0\n");
    let report = json(&fredholm(&folder, "radiosity a.toml --photometric --patch-size 0.1 --json -").stdout);
    for (k, (z, lux)) in points.iter().enumerate() {
        let surface = &report["surfaces"][k + 1];
        assert_eq!(surface["name"], format!("point{k}"));
        let found = surface["mean_illuminance"].as_f64().unwrap();
        assert!((found / lux - 1.0).abs() < 2e-4, "z = {z}: {found} lx for {lux}");
    }
}

#[test]
fn every_output_says_its_unit() {
    let folder = folder("photometric_outputs");
    write(&folder, &room(), "[materials.lit]\nluminance = 500\n[materials.wall]\nreflectance = 0.5\n");
    // What the file says of units needs no flag.
    let scene = fs::read_to_string(folder.join("a.toml")).unwrap();
    fs::write(folder.join("a.toml"), format!("units = \"photometric\"\n{scene}")).unwrap();
    let quick = "radiosity a.toml --patch-count 200 --size 64x64 --samples 1 --gather 4";
    let table = text(&fredholm(&folder, &format!("{quick} --patches p.csv -o a.png")).stdout);
    for words in ["lm/m²", "illuminance, lx", "luminance, cd/m²", "ceiling"] {
        assert!(table.contains(words), "no `{words}` in: {table}");
    }
    assert!(!table.contains("W/m²"), "{table}");
    let csv = fs::read_to_string(folder.join("p.csv")).unwrap();
    let columns =
        "emission_lm_m2,reflectance,luminous_exitance_lm_m2,illuminance_lx,luminance_cd_m2,surface\n";
    assert!(csv.lines().next().unwrap().ends_with(columns.trim()), "{csv}");
    for words in ["--false-colour -o l.png", "--map illuminance -o lux.png", "--map luminance -o cd.png"] {
        let output = fredholm(&folder, &format!("{quick} {words}"));
        assert!(output.status.success(), "{words}: {}", text(&output.stderr));
    }
    assert_eq!(names(&folder), ["a.obj", "a.png", "a.toml", "cd.png", "l.png", "lux.png", "p.csv"]);
}
