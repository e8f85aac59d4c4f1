//! `fredholm radiosity --thermal`: the textbook from a file to the table, and the pictures of a scene.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the message, in its helpers too")]

mod run;

use run::{folder, fredholm, json, names, text};
use serde_json::Value;
use std::fs;
use std::path::Path;

fn scenes(name: &str) -> String {
    format!("{}/../../scenes/{name}", env!("CARGO_MANIFEST_DIR"))
}

/// The report of a scene file.
fn report(folder: &Path, file: &str, words: &str) -> Value {
    let output = fredholm(folder, &format!("radiosity {file} --thermal --json - {words}"));
    assert!(output.status.success(), "{file}: {}", text(&output.stderr));
    json(&output.stdout)
}

fn number(report: &Value, surface: usize, key: &str) -> f64 {
    report["surfaces"][surface][key].as_f64().unwrap()
}

#[test]
fn textbook_enclosures_to_ten_digits() {
    let folder = folder("textbook");
    let sigma = 5.670_374_419e-8;
    let area = 4.0 * std::f64::consts::PI;
    let dewar =
        area * sigma * (77_f64.powi(4) - 293.15_f64.powi(4)) / (1.0 / 0.05 + 0.25 * (1.0 / 0.1 - 1.0));
    for (file, surface, key, expected) in [
        ("plates", 0, "heat_flux", 4.0 / 9.0),
        ("plates", 1, "heat_flux", -4.0 / 9.0),
        ("shields", 0, "heat_flux", 1.0 / 76.0),
        ("shields", 7, "heat", -1.0 / 76.0),
        ("spheres", 0, "heat", dewar),
        ("spheres", 1, "heat", -dewar),
        ("cube", 0, "radiosity", 1.160_714_295_535),
        ("cube", 1, "radiosity", 0.267_773_389_574),
        ("cube", 5, "radiosity", 0.267_878_078_723),
    ] {
        let report = report(&folder, &scenes(&format!("enclosures/{file}.toml")), "");
        let found = number(&report, surface, key);
        assert!((found / expected - 1.0).abs() < 1e-10, "{file}: {found} for {expected}");
        let bound = report["surfaces"][surface]["error_bounds"][key].as_f64().unwrap();
        assert!(bound < 1e-10 * expected.abs(), "{file}: {bound}");
        assert!(
            report["balance_defect"].as_f64().unwrap() < 1e-10 * report["heat_exchanged"].as_f64().unwrap()
        );
    }
}

#[test]
fn the_table_has_its_units() {
    let folder = folder("thermal_table");
    let output = fredholm(&folder, &format!("radiosity {} --thermal", scenes("enclosures/shields.toml")));
    let table = text(&output.stdout);
    for words in
        ["T, K", "q, W/m²", "Q, W", "area, m²", "0.01315789474", "Σ Q = 0 within", "linked: 2", "grey"]
    {
        assert!(table.contains(words), "no `{words}` in: {table}");
    }
    assert!(names(&folder).is_empty(), "an enclosure has no picture");
    let report = report(&folder, &scenes("enclosures/shields.toml"), "");
    for (key, unit) in [("temperature", "K"), ("heat_flux", "W/m²"), ("heat", "W"), ("area", "m²")] {
        assert_eq!(report["units"][key], unit);
    }
}

#[test]
fn a_scene_has_maps_and_a_field() {
    let folder = folder("thermal_scene");
    let oven = format!("radiosity {} --thermal --patch-size 0.1 --size 48x48", scenes("oven/oven.toml"));
    let output = fredholm(&folder, &format!("{oven} --patches a.csv -o t.png"));
    assert!(output.status.success(), "{}", text(&output.stderr));
    let table = text(&output.stdout);
    for words in ["3 bands, cut at 3, 6 µm", "open:", "at 293.15 K", "Newton's method", "tin", "a.csv"] {
        assert!(table.contains(words), "no `{words}` in: {table}");
    }
    fredholm(&folder, &format!("{oven} --map heat-flux --patches a.npz -o q.png"));
    fredholm(&folder, &oven);
    assert_eq!(names(&folder), ["a.csv", "a.npz", "oven.png", "q.png", "t.png"]);
    assert_ne!(fs::read(folder.join("q.png")).unwrap(), fs::read(folder.join("t.png")).unwrap());
    assert_eq!(fs::read(folder.join("oven.png")).unwrap(), fs::read(folder.join("t.png")).unwrap());
    let csv = fs::read_to_string(folder.join("a.csv")).unwrap();
    let header = "x,y,z,nx,ny,nz,area,temperature_K,radiosity_W_m2,irradiance_W_m2,heat_flux_W_m2,surface\n";
    assert!(csv.starts_with(header), "{csv}");
    let report = report(&folder, &scenes("oven/oven.toml"), "--patch-size 0.1");
    let surfaces = report["surfaces"].as_array().unwrap();
    let tin = surfaces.iter().find(|surface| surface["name"] == "tin").unwrap();
    assert!((tin["heat"].as_f64().unwrap() + 60.0).abs() < 1e-6);
    // What the heater sends and the bread does not take goes out of the door.
    let balance = ["total_heat", "heat_to_surroundings"].map(|key| report[key].as_f64().unwrap());
    assert!((balance[0] - balance[1]).abs() < 1e-5 * balance[0]);
    assert_eq!(report["mesh"]["patch_size"], 0.1);
}

#[test]
fn fredholms_alternative_has_its_exit_code() {
    let folder = folder("thermal_alternative");
    for (heat, words) in [("1", ["no solution", "3.000000e0 W"]), ("-2", ["not unique", "constant"])] {
        let surface = |name: &str, heat: &str| {
            format!("{{ name = '{name}', area = 1, emissivity = 0.5, heat = {heat} }}")
        };
        let text_of = format!(
            "[enclosure]\nshape = 'plates'\nsurface = [{}, {}]\n",
            surface("hot", "2"),
            surface("cold", heat)
        );
        fs::write(folder.join("a.toml"), text_of).unwrap();
        let output = fredholm(&folder, "radiosity a.toml --thermal");
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(4), "{message}");
        assert!(message.starts_with("error: a.toml: ") && message.lines().count() == 1, "{message}");
        assert!(words.iter().all(|word| message.contains(word)), "{message}");
    }
}

#[test]
fn options_that_mean_nothing_for_heat_are_refused() {
    let folder = folder("thermal_options");
    fs::copy(scenes("enclosures/plates.toml"), folder.join("a.toml")).unwrap();
    for (words, code, expected) in [
        ("a.toml --thermal --solver jacobi", 2, "cannot be used with"),
        ("a.toml --thermal --bands spectral", 2, "cannot be used with"),
        ("a.toml --thermal --photometric", 2, "cannot be used with"),
        ("--thermal", 2, "<SCENE>"),
        ("a.toml --thermal -o a.png", 1, "no shape"),
        ("a.toml --thermal --map illuminance", 1, "of light"),
        ("--map temperature", 1, "--thermal"),
        ("--map illuminance", 1, "--photometric"),
    ] {
        let output = fredholm(&folder, &format!("radiosity {words}"));
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{words}: {message}");
        assert!(message.contains(expected), "{words}: {message}");
        assert_eq!(names(&folder), ["a.toml"]);
    }
}
