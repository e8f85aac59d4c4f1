//! Every thermal or photometric scene that is refused is refused at the right line, in words that say what to do.

use radiosity::scene::{Error, Thermal, Units, load, load_in, load_thermal};
use radiosity::thermal::Condition;
use std::path::{Path, PathBuf};

const ROOM: &str = "mtllib a.mtl\nv 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nusemtl hot\nf 1 2 3 4\no back\nusemtl cold\nf 4 3 2 1\n";
const HEAD: &str = "unit = 'm'\nmeshes = ['a.obj']\n";
const COLD: &str = "[materials.cold]\nemissivity = 0.5\nheat_flux = 0\n";

/// A folder of its own with a mesh and this scene file.
fn scene(name: &str, text: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("thermal_scenes").join(name);
    std::fs::create_dir_all(&folder).unwrap_or_else(|e| panic!("{e}"));
    let mtl = "newmtl hot\nKd 0.6 0.5 0.4\nKe 1 1 1\nnewmtl cold\nKd 0.5 0.5 0.5\n";
    for (file, text) in [("a.obj", ROOM), ("a.mtl", mtl), ("a.toml", text)] {
        std::fs::write(folder.join(file), text).unwrap_or_else(|e| panic!("{e}"));
    }
    folder.join("a.toml")
}

fn refused<T: std::fmt::Debug>(file: &Path, loaded: Result<T, Error>, place: &str, words: &[&str]) {
    let folder = file.parent().unwrap_or(file);
    let message = match loaded {
        Ok(loaded) => panic!("accepted: {loaded:?}"),
        Err(error) => error.to_string().replace(&format!("{}/", folder.display()), ""),
    };
    assert!(message.starts_with(&format!("{place}: ")), "not at {place}: {message}");
    for word in words {
        assert!(message.contains(word), "no `{word}` in: {message}");
    }
}

#[test]
fn materials() {
    let hot = |rest: &str| format!("{HEAD}{COLD}[materials.hot]\n{rest}");
    let cases: &[(&str, &str, &[&str])] = &[
        ("emissivity = 1.5\ntemperature = 300", "a.toml:7", &["emissivity of `hot` is 1.5", "[0, 1]"]),
        ("emissivity = -0.1\ntemperature = 300", "a.toml:7", &["-0.1"]),
        ("emissivity = [0.1, 0.2]\ntemperature = 300", "a.toml:7", &["2 emissivities for 1 bands"]),
        ("emissivity = 'black'\ntemperature = 300", "a.toml:7", &["expected a number"]),
        ("emissivity = 0.5\ntemperature = -3", "a.toml:8", &["-3 K", "293.15"]),
        ("emissivity = 0.5\ntemperature = nan", "a.toml:8", &["NaN K"]),
        ("emissivity = 0.5\nemissive_power = -1", "a.toml:6", &["-1 W/m²"]),
        ("emissivity = 0.5\nheat_flux = inf", "a.toml:8", &["finite"]),
        ("emissivity = 0\nheat_flux = 5", "a.toml:8", &["emissivity 0", "5 W/m²"]),
        (
            "emissivity = 0.5\ntemperature = 300\nheat_flux = 0",
            "a.toml:6",
            &["`hot`", "more than one", "give one"],
        ),
        ("emissivity = 0.5\nheat = 3\nheat_flux = 0", "a.toml:6", &["more than one"]),
        ("emissivity = 0.5", "a.toml:6", &["neither", "`temperature` in K", "adiabatic"]),
        ("temperature = 300", "a.toml:6", &["no `emissivity`"]),
        ("emissivity = 0.5\ntemperature = 300\nlinked = 'a'", "a.toml:6", &["`linked`", "leave out"]),
        (
            "emissivity = 0.5\ntemperature = 300\nreflectance = 0.5",
            "a.toml:9",
            &["`reflectance`", "1 − `emissivity`"],
        ),
        ("emissivity = 0.5\ntemperature = 300\nradiance = 5", "a.toml:9", &["`radiance`", "light"]),
        ("emissivity = 0.5\ntemperature = 300\narea = 5", "a.toml:9", &["`area`", "enclosure"]),
        ("emissivity = 0.5\ntemperatur = 300", "a.toml:8", &["unknown field `temperatur`"]),
    ];
    for (k, (rest, place, words)) in cases.iter().enumerate() {
        let file = scene(&format!("material{k}"), &hot(rest));
        refused(&file, load_thermal(&file), place, words);
    }
}

#[test]
fn scenes() {
    let hot = "[materials.hot]\nemissivity = 0.5\ntemperature = 300\n";
    let cases: &[(String, &str, &[&str])] = &[
        (format!("{HEAD}{hot}"), "a.obj:9", &["`cold` has no emissivity", "[materials.cold]"]),
        (format!("{HEAD}{hot}{COLD}[materials.warm]\nemissivity = 1"), "a.toml:9", &["no face", "`warm`"]),
        (format!("bands = [3, 2]\n{HEAD}{hot}{COLD}"), "a.toml:1", &["rising"]),
        (format!("surroundings = -1\n{HEAD}{hot}{COLD}"), "a.toml:1", &["-1 K"]),
        (hot.to_owned(), "a.toml", &["`unit` and `meshes`", "[enclosure]"]),
        (format!("{HEAD}[enclosure]\nshape = 'plates'\nsurface = []"), "a.toml:3", &["leave out"]),
        ("[enclosure]\nsurface = []".into(), "a.toml:1", &["either a `shape` or `view_factors`"]),
        ("[enclosure]\nshape = 'torus'\nsurface = []".into(), "a.toml:2", &["`torus`", "plates or nested"]),
        ("[enclosure]\nshape = 'nested'\n[[enclosure.surface]]\nemissivity = 1\ntemperature = 3".into(), "a.toml:3", &["`area`"]),
        ("[enclosure]\nshape = 'plates'\n[[enclosure.surface]]\nemissivity = 1\ntemperature = 3".into(), "a.toml:2", &["in pairs"]),
        (
            "[enclosure]\nview_factors = [[0.5, 0.6]]\nsurface = [{ emissivity = 1, temperature = 3, area = 1 }]".into(),
            "a.toml:2",
            &["1 × 1", "has 2"],
        ),
        (
            "[enclosure]\nview_factors = [[1.5]]\nsurface = [{ emissivity = 1, temperature = 3, area = 1 }]".into(),
            "a.toml:2",
            &["F[1][1] is 1.5"],
        ),
    ];
    for (k, (text, place, words)) in cases.iter().enumerate() {
        let file = scene(&format!("scene{k}"), text);
        refused(&file, load_thermal(&file), place, words);
    }
    let mesh = scene("mesh", "").with_file_name("a.obj");
    refused(&mesh, load_thermal(&mesh), "a.obj", &["no temperatures", ".toml"]);
}

#[test]
fn a_thermal_scene_among_those_of_light_is_told_of_the_flag() {
    let file = scene("light", &format!("{HEAD}[materials.hot]\nemissivity = 1"));
    refused(&file, load(&file), "a.toml:4", &["unknown field `emissivity`", "--thermal"]);
}

#[test]
fn heats_are_spread_over_their_surface() {
    let file = scene(
        "heat",
        &format!("surroundings = 293\n{HEAD}{COLD}[materials.hot]\nemissivity = 0.5\nheat = 30\n"),
    );
    let Thermal::Scene(loaded) = load_thermal(&file).unwrap_or_else(|e| panic!("{e}")) else {
        panic!("no scene")
    };
    assert_eq!(loaded.surroundings, 293.0);
    assert_eq!(loaded.surfaces[0].name, "hot");
    assert_eq!(loaded.surfaces[0].condition, Condition::HeatFlux(15.0));
    assert_eq!((loaded.surfaces[1].name.as_str(), &loaded.surfaces[1].emissivity), ("back", &vec![0.5]));
}

#[test]
fn photometric_scenes() {
    let hot = |rest: &str| format!("units = 'photometric'\n{HEAD}[materials.hot]\nreflectance = 0.5\n{rest}");
    let cases: &[(String, &str, &[&str])] = &[
        (hot("radiance = 5"), "a.toml:6", &["watts", "`luminance` in cd/m²"]),
        (hot("emission = 5"), "a.toml:6", &["watts", "photometric"]),
        (hot("luminance = 5\nluminous_flux = 3"), "a.toml:7", &["give one of them"]),
        (hot("luminance = -5"), "a.toml:6", &["-5", "not negative"]),
        (hot("luminance = 5").replace("= 0.5", "= [0.5, 0.5, 0.4]"), "a.toml:5", &["a colour", "one number"]),
        (hot("luminance = 5").replace("reflectance = 0.5\n", ""), "a.mtl:2", &["a colour", "`hot`"]),
        (hot("luminance = 5").replace("photometric", "lumens"), "a.toml:1", &["lumens", "`photometric`"]),
        (
            hot("luminance = 5").replace("units = 'photometric'\n", ""),
            "a.toml:5",
            &["units = \"photometric\""],
        ),
    ];
    for (k, (text, place, words)) in cases.iter().enumerate() {
        let file = scene(&format!("photometric{k}"), text);
        refused(&file, load(&file), place, words);
    }
    let mesh = scene("coloured", "").with_file_name("a.obj");
    refused(&mesh, load_in(&mesh, Some(Units::Photometric)), "a.mtl:2", &["a colour"]);
}

#[test]
fn luminance_exitance_and_flux_are_one_light() {
    let pi = std::f64::consts::PI;
    for (key, value) in
        [("luminance", 100.0), ("luminous_exitance", 100.0 * pi), ("luminous_flux", 200.0 * pi)]
    {
        let text = format!("{HEAD}[materials.hot]\nreflectance = 0.5\n{key} = {value}\n");
        let loaded = load_in(&scene(key, &text), Some(Units::Photometric)).unwrap_or_else(|e| panic!("{e}"));
        let grey = loaded.grey();
        assert!(
            (grey.surfaces[0].emission - 100.0 * pi).abs() < 1e-10,
            "{key}: {}",
            grey.surfaces[0].emission
        );
        assert_eq!((grey.surfaces[0].reflectance, grey.surfaces[1].emission), (0.5, 0.0));
    }
}
