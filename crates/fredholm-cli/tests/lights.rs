//! Luminaires in a scene file, by patches and to an accuracy.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the message, in its helpers too")]

mod run;

use run::{folder, fredholm, json, text};
use serde_json::Value;
use std::f64::consts::PI;
use std::fs;
use std::path::Path;

/// A level square of a metre, and nothing else.
const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\no ground\nusemtl grey\nf 1 2 3 4\n";

const LAMP: &str = "IESNA:LM-63-2002\nTILT=NONE\n1 1000 1 2 1 1 2 0.5 0.5 0\n1 1 10\n0 90\n0\n90 90\n";

fn write(folder: &Path, rest: &str) {
    fs::write(folder.join("a.obj"), SQUARE).unwrap();
    fs::write(folder.join("a.ies"), LAMP).unwrap();
    let head = "unit = \"m\"\nmeshes = [\"a.obj\"]\n[materials.grey]\nreflectance = 0.5\n";
    fs::write(folder.join("a.toml"), format!("units = \"photometric\"\n{head}{rest}")).unwrap();
}

fn illuminance(report: &Value) -> f64 {
    report["surfaces"][0]["mean_illuminance"].as_f64().unwrap()
}

#[test]
fn a_luminaire_is_told_with_its_lumens_and_whether_it_is_near() {
    let folder = folder("luminaire");
    let of = |height: f64| format!("[[luminaire]]\nfile = \"a.ies\"\nposition = [0.5, 0.5, {height}]\n");
    write(&folder, &of(10.0));
    for words in ["radiosity a.toml --patch-size 0.25", "radiosity a.toml --accuracy 1%"] {
        let report = json(&fredholm(&folder, &format!("{words} --json -")).stdout);
        // 90 cd below its horizon: 180 π lm, and 0.9 lx from 10 m.
        let luminaire = &report["luminaires"][0];
        let number = |key: &str| luminaire[key].as_f64().unwrap();
        assert!((number("integrated_lumens") / (180.0 * PI) - 1.0).abs() < 1e-12);
        assert_eq!((number("lamp_lumens"), number("size"), number("nearest_surface")), (1000.0, 0.5, 10.0));
        assert!(luminaire["is_near"] == false && report["flux_unit"] == "lm");
        assert!((illuminance(&report) / 0.9 - 1.0).abs() < 0.01, "{report}");
        let table = text(&fredholm(&folder, words).stdout);
        let line = "luminaire  ";
        assert!(
            table.contains(line)
                && table
                    .contains("a.ies: 565.5 lm; of the file 565.5 lm by integration, 1000 lm of its lamps"),
            "{table}"
        );
        assert!(!table.contains("NEAR"), "{table}");
    }
    write(&folder, &of(2.0));
    let table = text(&fredholm(&folder, "radiosity a.toml --patch-size 0.25").stdout);
    let near =
        "NEAR: it is 0.5 m large and 2 m from a surface, where it is no point; from 2.5 m on it is one";
    assert!(table.contains(near), "{table}");
}
