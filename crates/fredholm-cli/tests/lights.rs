//! Luminaires, a sun and a sky in a scene file, by every way through the command: by patches, to an accuracy, baked.

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

/// 7/9 π L_z of the overcast sky, and the cosine of the sun's.
const DAY: &str = "[sun]\nazimuth = 180\nelevation = 30\nnormal_illuminance = 20000\n\
    [sky]\nkind = \"cie-overcast\"\nzenith_luminance = 900\n";

#[test]
fn the_sun_and_the_sky_are_told_with_their_units() {
    let folder = folder("day");
    write(&folder, DAY);
    let sky = 7.0 / 9.0 * PI * 900.0;
    for words in ["radiosity a.toml --patch-size 0.5", "radiosity a.toml --accuracy 1%"] {
        let report = json(&fredholm(&folder, &format!("{words} --json -")).stdout);
        assert!((illuminance(&report) / (10_000.0 + sky) - 1.0).abs() < 1e-9, "{words}: {report}");
        assert_eq!(report["sky"]["kind"], "CIE overcast (1 + 2 sin of the elevation)/3");
        assert_eq!(report["sky"]["zenith_unit"], "cd/m²");
        let horizontal = report["sky"]["horizontal_irradiance"][0].as_f64().unwrap();
        assert!((horizontal / sky - 1.0).abs() < 1e-12 && report["units"]["irradiance"] == "lx");
        assert_eq!(report["suns"][0]["normal_irradiance"][0], 20_000.0);
        let table = text(&fredholm(&folder, words).stdout);
        for part in [
            "sun  ",
            "20000 lx across its beam, with sharp shadows",
            "CIE overcast (1 + 2 sin of the elevation)/3: 2199 lx on a free horizontal, 900 cd/m² at the zenith; exact",
        ] {
            assert!(table.contains(part), "no `{part}` in {table}");
        }
        if words.contains("patch") {
            assert!(table.contains("open: 100.0 % of the sight lines end in the sky or under it"), "{table}");
        }
    }
    // A clear sky says how exact it is.
    write(&folder, &DAY.replace("\"cie-overcast\"", "\"cie\"\ntype = 12"));
    let table = text(&fredholm(&folder, "radiosity a.toml --patch-size 1").stdout);
    assert!(table.contains("CIE general sky 12: ") && table.contains("% in any direction"), "{table}");
}

#[test]
fn a_baked_scene_tells_its_lights() {
    let folder = folder("baked_day");
    write(&folder, DAY);
    let report = json(&fredholm(&folder, "bake a.toml --size 64 --json -").stdout);
    assert!(report["sky"]["cells"] == 4 && report["suns"].as_array().unwrap().len() == 1, "{report}");
    assert_eq!(report["dark"], false);
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
