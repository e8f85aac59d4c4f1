//! Every scene that is refused is refused at the right line, in words that say what is wrong and what to do.

use radiosity::scene::load;
use std::path::PathBuf;

/// Files, the first of which is loaded; where the error lies; what its message holds.
struct Case {
    files: Vec<(&'static str, String)>,
    place: &'static str,
    words: &'static [&'static str],
}

/// The message of the error, whose paths begin after the case's folder.
fn message(index: usize, group: &str, files: &[(&str, String)]) -> String {
    let folder =
        PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("scene_errors").join(format!("{group}{index}"));
    std::fs::create_dir_all(&folder).unwrap_or_else(|e| panic!("{e}"));
    for (name, text) in files {
        std::fs::write(folder.join(name), text).unwrap_or_else(|e| panic!("{e}"));
    }
    match load(&folder.join(files[0].0)) {
        Ok(_) => panic!("case {group}{index} was accepted: {files:?}"),
        Err(error) => error.to_string().replace(&format!("{}/", folder.display()), ""),
    }
}

fn check(group: &str, cases: &[Case]) {
    for (index, case) in cases.iter().enumerate() {
        let message = message(index, group, &case.files);
        assert!(message.starts_with(&format!("{}: ", case.place)), "not at {}: {message}", case.place);
        for words in case.words {
            assert!(message.contains(words), "no `{words}` in: {message}");
        }
    }
}

const CORNERS: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
const LIT: &str = "newmtl lit\nKe 1 1 1\n";

/// A lit OBJ of which lines 1 to 6 are well, and what follows.
fn obj(rest: &str) -> Vec<(&'static str, String)> {
    vec![("a.obj", format!("mtllib a.mtl\n{CORNERS}usemtl lit\n{rest}\n")), ("a.mtl", LIT.to_owned())]
}

#[test]
fn faces() {
    let face = |rest: &str, place, words| Case { files: obj(rest), place, words };
    check(
        "face",
        &[
            face("f 1 2 3\nf 0 1 2", "a.obj:8", &["vertex 0 does not exist", "4 vertices"]),
            face("f 1 2 5", "a.obj:7", &["vertex 5 does not exist", "4 vertices"]),
            face("f 1 2 -5", "a.obj:7", &["vertex -5 does not exist", "backwards"]),
            face("f 1 2 9223372036854775807", "a.obj:7", &["does not exist"]),
            face("f 1 2 -9223372036854775808", "a.obj:7", &["does not exist"]),
            face("f 1 2 three", "a.obj:7", &["`three` is not a corner", "expected"]),
            face("f 1 2 /3", "a.obj:7", &["`/3` is not a corner"]),
            face("f 1 2", "a.obj:7", &["at least 3 corners", "has 2", "remove"]),
            face("f", "a.obj:7", &["at least 3 corners", "has 0"]),
            face("f 1 2 \\\n3 9", "a.obj:7", &["vertex 9"]),
            face("f 1 2 3 2", "a.obj:7", &["corners 2 and 4", "same point"]),
            face("v 2 0 0\nf 1 2 5", "a.obj:8", &["no area", "3 corners", "remove"]),
            face("f 1 3 2 4", "a.obj:7", &["crosses or touches itself", "corners 1 and 3"]),
            face("v 1 1 1\nf 1 2 5 4", "a.obj:8", &["not planar", "m off the plane", "1e-4", "triangulate"]),
            face("v 1 2", "a.obj:7", &["`v 1 2` is not a vertex", "three coordinates"]),
            face("v 1 2 x", "a.obj:7", &["`x` is not a number"]),
            face("v 1 2 nan", "a.obj:7", &["NaN is not a finite number"]),
            face("v 1 2 -inf", "a.obj:7", &["-inf is not a finite number"]),
            face("v 1 2 1e999", "a.obj:7", &["inf is not a finite number"]),
            face("f 1//x 2 3", "a.obj:7", &["`1//x` is not a corner", "normal"]),
            face("vn 0 1", "a.obj:7", &["`vn 0 1` is not a normal", "three numbers"]),
            face("vn 0 1 up", "a.obj:7", &["`up` is not a number"]),
            face("", "a.obj", &["no faces"]),
        ],
    );
}

#[test]
fn files() {
    let alone = |name, text: &str, place, words| Case { files: vec![(name, text.to_owned())], place, words };
    check(
        "file",
        &[
            alone(
                "a.fbx",
                "{}",
                "a.fbx",
                &["`fbx`", ".obj", ".gltf", ".glb", ".stl", ".ply", ".vs3", ".toml"],
            ),
            alone("a", "", "a", &["not read"]),
            alone(
                "a.obj",
                &format!("{CORNERS}\nmtllib no.mtl"),
                "a.obj:6",
                &["cannot read `no.mtl`", "check"],
            ),
            alone("a.obj", &format!("{CORNERS}f 1 2 3"), "a.obj", &["no surface emits", "radiance", "Ke"]),
            alone("a.toml", "unit = 'm'\nmeshes = [\n'no.obj']", "a.toml:3", &["cannot read `no.obj`"]),
            alone("a.toml", "unit = 'm'\nmeshes = ['a.fbx']", "a.toml:2", &["`fbx`", ".obj"]),
        ],
    );
    let missing = load(&PathBuf::from("missing/room.obj")).unwrap_err().to_string();
    assert!(
        missing.starts_with("missing/room.obj: cannot read `missing/room.obj`: No such file"),
        "{missing}"
    );
    let folder = load(&PathBuf::from(env!("CARGO_TARGET_TMPDIR"))).unwrap_err().to_string();
    assert!(folder.contains("not read"), "{folder}");
}

#[test]
fn text_that_is_not_utf8() {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("latin1.obj");
    std::fs::write(&path, b"# plain\n\no K\xfcche\n").unwrap();
    let error = load(&path).unwrap_err();
    assert_eq!(error.place.line, Some(3));
    assert!(error.to_string().contains("save the file as UTF-8"));
}

#[test]
fn materials() {
    let material = |text: &str, place, words| {
        let mut files = obj("f 1 2 3");
        files[1].1 = text.to_owned();
        Case { files, place, words }
    };
    check(
        "material",
        &[
            material(
                "newmtl lit\nKe 1 1 1\nKd 1 1 1",
                "a.mtl:3",
                &["material `lit` is 1 in channel 1", "less than 1"],
            ),
            material("newmtl lit\nKd 0.5 -0.1 0", "a.mtl:2", &["reflectance", "-0.1 in channel 2"]),
            material("newmtl lit\nKd 0.5 0 nan", "a.mtl:2", &["reflectance", "NaN in channel 3"]),
            material("newmtl lit\nKe 1 1 -1", "a.mtl:2", &["emission", "`lit`", "channel 3", "not negative"]),
            material("newmtl lit\nKe inf 1 1", "a.mtl:2", &["emission", "inf", "channel 1"]),
            material("newmtl lit\nKe 1 1", "a.mtl:2", &["`1 1` is not a colour", "three"]),
            material("newmtl lit\n\nKd spectral a.rfl 1", "a.mtl:3", &["`spectral` is not a number"]),
            material("Kd 1 1 1", "a.mtl:1", &["before the first `newmtl`"]),
            material("newmtl", "a.mtl:1", &["without a name"]),
            material(
                "newmtl other",
                "a.obj:6",
                &["no material is called `lit`", "there is only `other`", "[materials]"],
            ),
        ],
    );
}

/// A scene file round the unit square of the material `lit`, whose first three lines are well.
fn toml(rest: &str) -> Vec<(&'static str, String)> {
    let mut files = vec![("a.toml", format!("unit = 'm'\nmeshes = ['a.obj']\n\n{rest}\n"))];
    files.extend(obj("f 1 2 3 4"));
    files
}

#[test]
fn scene_files() {
    let scene = |rest: &str, place, words| Case { files: toml(rest), place, words };
    let whole = |text: &str, place, words| Case { files: vec![("a.toml", text.to_owned())], place, words };
    check(
        "scene",
        &[
            scene("name = ", "a.toml:4", &[]),
            scene("nmae = 'x'", "a.toml:4", &["unknown field `nmae`", "expected", "`name`"]),
            scene(
                "[materials.lit]\nreflectanse = 0.5",
                "a.toml:5",
                &["unknown field `reflectanse`", "`reflectance`"],
            ),
            scene(
                "[materials.lit]\nreflectance = 1.0",
                "a.toml:5",
                &["`lit` is 1 in channel 1", "less than 1"],
            ),
            scene("[materials.lit]\nreflectance = [0, 0.5, 2]", "a.toml:5", &["2 in channel 3"]),
            scene("[materials.lit]\nreflectance = [0, 0.5]", "a.toml:5", &["number or [red, green, blue]"]),
            scene("[materials.lit]\nradiance = -1", "a.toml:5", &["emission", "-3.14"]),
            scene("[materials.lit]\nemission = nan", "a.toml:5", &["emission", "NaN"]),
            scene("[materials.lit]\nradiance = 1\nemission = 1", "a.toml:6", &["give one of them"]),
            scene("[materials.lit]\nradiance = 0", "a.toml", &["no surface emits"]),
            scene(
                "\n[materials.lid]\nradiance = 0",
                "a.toml:5",
                &["no face is of the material `lid`", "only `lit`"],
            ),
            scene("[solve]\npatch_size = 0", "a.toml:5", &["0 is not a positive number"]),
            scene("[solve]\ntolerance = inf", "a.toml:5", &["inf is not a positive number"]),
            scene("[solve]\nmethods = 'x'", "a.toml:5", &["unknown field `methods`", "`method`"]),
            whole("meshes = ['a.obj']", "a.toml:1", &["missing field `unit`"]),
            whole(
                "meshes = ['a.obj']\nunit = 'yard'",
                "a.toml:2",
                &["`yard` is unknown", "mm, cm, m, in, ft"],
            ),
            whole("meshes = ['a.obj']\nunit = -1", "a.toml:2", &["unit of -1 m", "positive"]),
            whole("meshes = ['a.obj']\nunit = []", "a.toml:2", &["expected a unit of length"]),
            whole("unit = 'm'\nmeshes = []", "a.toml:2", &["`meshes` is empty"]),
        ],
    );
}

#[test]
fn cameras() {
    let camera = |rest: &str, words| {
        let text = format!("[camera]\nposition = [1, 1, 1]\n{rest}");
        Case { files: toml(&text), place: "a.toml:4", words }
    };
    check(
        "camera",
        &[
            camera("target = [1, 1, 1]\nvertical_angle = 40", &["looks nowhere", "target"]),
            camera("direction = [0, 0, 0]\nvertical_angle = 40", &["looks nowhere"]),
            camera(
                "direction = [0, 0, 1]\nup = [0, 0, -2]\nvertical_angle = 40",
                &["up is zero or parallel"],
            ),
            camera("direction = [0, nan, 1]\nvertical_angle = 40", &["finite"]),
            camera("target = [0, inf, 1]\nvertical_angle = 40", &["finite"]),
            camera("direction = [0, 1, 0]\nvertical_angle = 0", &["0 degrees", "between 0 and 180"]),
            camera("direction = [0, 1, 0]\nvertical_angle = 180", &["180 degrees"]),
            camera("vertical_angle = 40", &["either a `target` or a `direction`"]),
            camera("target = [0, 0, 0]\ndirection = [1, 0, 0]\nvertical_angle = 40", &["give one of them"]),
        ],
    );
}

/// A face is judged by its shape alone: what is refused in metres is refused in any unit, and as much accepted.
#[test]
fn the_unit_changes_nothing() {
    for unit in ["1e-6", "'mm'", "1e6"] {
        let loaded = |mesh: &str| {
            let mut files = toml("");
            files[0].1 = files[0].1.replace("'m'", unit);
            files[1].1.push_str(mesh);
            let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("scene_units");
            std::fs::create_dir_all(&folder).unwrap();
            files.iter().for_each(|(name, text)| std::fs::write(folder.join(name), text).unwrap());
            load(&folder.join("a.toml")).map_err(|error| error.to_string())
        };
        assert!(loaded("v 1 1 0.0001\nf 1 2 5 4").is_ok());
        assert!(loaded("v 1 1 0.001\nf 1 2 5 4").unwrap_err().contains("not planar"));
        assert!(loaded("v 2 1e-5 0\nf 1 2 5").is_ok());
        assert!(loaded("v 2 1e-7 0\nf 1 2 5").unwrap_err().contains("no area"));
    }
}

#[test]
fn lights() {
    let light = |rest: &str, place, words| {
        let mut files = obj("f 1 2 3 4");
        files.insert(
            0,
            ("a.toml", format!("unit = 'm'\nmeshes = ['a.obj']\n[[light]]\nposition = [0, 0, 1]\n{rest}\n")),
        );
        Case { files, place, words }
    };
    check(
        "light",
        &[
            light("intensity = -1", "a.toml:5", &["light 1", "intensity is -1", "not negative"]),
            light("intensity = [1, nan, 1]", "a.toml:5", &["intensity is NaN in channel 2"]),
            light("flux = inf", "a.toml:5", &["flux is inf", "finite"]),
            light("", "a.toml:4", &["light 1", "either an `intensity` or a `flux`"]),
            light("intensity = 1\nflux = 1", "a.toml:6", &["either", "give one"]),
            light("intensity = 'bright'", "a.toml:5", &["expected a number or [red, green, blue]"]),
            light("intensity = 1\ndirection = [0, 0, 0]", "a.toml:6", &["direction has no length"]),
            light("intensity = 1\ndirection = [0, nan, 0]", "a.toml:6", &["direction"]),
            light("intensity = 1\ncone = [10, 20]", "a.toml:6", &["a `cone` and no `direction`"]),
            light(
                "intensity = 1\ndirection = [0, 0, -1]\ncone = [30, 20]",
                "a.toml:7",
                &["light 1", "whole up to 30", "ends at 20", "less than the second"],
            ),
            light("intensity = 1\ndirection = [0, 0, -1]\ncone = [30, 91]", "a.toml:7", &["at most 90"]),
            light("intensity = 1\ndirection = [0, 0, -1]\ncone = [nan, 20]", "a.toml:7", &["beam"]),
            light("intensity = 1\ndirection = [0, 0, -1]\ncone = 20", "a.toml:7", &["array"]),
            light("intensity = 1\ncolour = 1", "a.toml:6", &["unknown field `colour`"]),
            light(
                "intensity = 1\n[[light]]\nposition = [inf, 0, 0]\nflux = 1",
                "a.toml:7",
                &["light 2", "position"],
            ),
            light("flux = 1\n[[light]]\nflux = 1", "a.toml:6", &["missing field `position`"]),
        ],
    );
    let sun = |rest: &str, place, words| {
        let mut files = obj("f 1 2 3 4");
        files.insert(0, ("a.toml", format!("unit = 'm'\nmeshes = ['a.obj']\n{rest}\n")));
        Case { files, place, words }
    };
    check(
        "sun",
        &[
            sun("[sun]", "a.toml:3", &["either an `azimuth` and an `elevation`", "or a `direction`"]),
            sun("[sun]\nazimuth = 9\nelevation = 9\ndirection = [0, 0, -1]", "a.toml:3", &["either"]),
            sun("[sun]\ndirection = [0, 0, 0]", "a.toml:4", &["no length"]),
            sun("[sun]\nazimuth = inf\nelevation = 9", "a.toml:4", &["azimuth", "finite"]),
            sun("[sun]\nazimuth = 9\nelevation = 91", "a.toml:5", &["elevation", "-90 to 90"]),
            sun("[sun]\nazimuth = 9\nelevation = 9", "a.toml:3", &["in watts", "`normal_irradiance`"]),
            sun(
                "[sun]\nazimuth = 9\nelevation = 9\nnormal_illuminance = 9",
                "a.toml:6",
                &["in watts", "`normal_irradiance`"],
            ),
            sun(
                "[sun]\nazimuth = 9\nelevation = 9\nnormal_irradiance = [1, -2, 1]",
                "a.toml:6",
                &["normal_irradiance is -2 in channel 2", "not negative"],
            ),
            sun("[sun]\nazimut = 9", "a.toml:4", &["unknown field `azimut`"]),
            sun("up = [0, 0, 0]", "a.toml:3", &["`up` has no direction"]),
            sun("up = [0, 2, 0]", "a.toml:3", &["along one line", "another `north`"]),
            sun("north = [0, 0, 1]", "a.toml:3", &["along one line"]),
        ],
    );
    let sky = |rest: &str, place, words| sun(&format!("[sky]\n{rest}"), place, words);
    check(
        "sky",
        &[
            sky("", "a.toml:3", &["missing field `kind`"]),
            sky("kind = 'blue'", "a.toml:4", &["no sky of the kind \"blue\"", "\"cie-overcast\""]),
            sky("kind = 'cie'", "a.toml:4", &["needs a `type` from 1 to 15"]),
            sky("kind = 'cie'\ntype = 16", "a.toml:5", &["no CIE sky of type 16"]),
            sky("kind = 'cie'\ntype = -1", "a.toml:5", &["no CIE sky of type -1"]),
            sky("kind = 'uniform'\ntype = 5", "a.toml:5", &["has no types"]),
            sky("kind = 'cie'\ntype = 12", "a.toml:4", &["depends on where the sun is", "[sun]"]),
            sky("kind = 'cie'\ntype = 12\nazimuth = 3\nelevation = -3", "a.toml:4", &["below the horizon"]),
            sky("kind = 'cie'\ntype = 12\nazimuth = 3", "a.toml:3", &["an `azimuth` and an `elevation`"]),
            sky("kind = 'uniform'", "a.toml:3", &["`zenith_radiance` or a `horizontal_irradiance`"]),
            sky(
                "kind = 'uniform'\nzenith_radiance = 1\nhorizontal_irradiance = 1",
                "a.toml:3",
                &["give one of them"],
            ),
            sky("kind = 'uniform'\nzenith_luminance = 1", "a.toml:5", &["in watts", "`zenith_radiance`"]),
            sky("kind = 'uniform'\nzenith_radiance = -1", "a.toml:5", &["zenith_radiance is -1"]),
            sky("kind = 'uniform'\nhorizontal_irradiance = inf", "a.toml:5", &["is inf", "finite"]),
            sky("kind = 'uniform'\nground = 1", "a.toml:5", &["unknown field `ground`"]),
        ],
    );
    let mut photometric =
        sky("kind = 'uniform'\nzenith_radiance = 1", "a.toml:6", &["is photometric", "`zenith_luminance`"]);
    photometric.files[0].1.insert_str(0, "units = 'photometric'\n");
    check("photometric sky", &[photometric]);
    let mut photometric = sun(
        "[sun]\nazimuth = 9\nelevation = 9\nnormal_irradiance = 9",
        "a.toml:7",
        &["is photometric", "`normal_illuminance`"],
    );
    photometric.files[0].1.insert_str(0, "units = 'photometric'\n");
    check("photometric sun", &[photometric]);
    let mut photometric = light("flux = [1, 1, 1]", "a.toml:6", &["one channel", "lm"]);
    photometric.files[0].1.insert_str(0, "units = 'photometric'\n");
    check("photometric light", &[photometric]);
}
