//! Whatever is wrong is told in one message, with an exit code, without a panic and without files left behind.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the message, in its helpers too")]

mod run;

use run::{Case, folder, fredholm, refuse};
use std::fs;

/// A lit triangle; what is wrong comes after.
const LIT: &str = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl lit\nf 1 2 3\n";

const MATERIALS: &str =
    "newmtl lit\nKe 1 1 1\nKd 0.5 0.5 0.5\nnewmtl white\nKd 1.5 1.5 1.5\nnewmtl grey\nKd 0.5 0.5 0.5\n";

/// Files that scenes are made of, by name.
fn files() -> Vec<(&'static str, String)> {
    let scene = |rest: &str| format!("unit = \"m\"\nmeshes = [\"good.obj\"]\n{rest}");
    vec![
        ("m.mtl", MATERIALS.into()),
        ("good.obj", LIT.into()),
        ("syntax.obj", format!("{LIT}f 1 2 three\n")),
        ("degenerate.obj", format!("{LIT}v 2 0 0\nf 1 2 5\n")),
        ("bent.obj", format!("{LIT}v 1 1 1\nf 1 2 5 4\n")),
        ("nan.obj", format!("{LIT}v nan 0 0\n")),
        ("bright.obj", format!("{LIT}usemtl white\nf 1 3 4\n")),
        ("dark.obj", LIT.replace("lit", "grey")),
        ("empty.obj", String::new()),
        ("syntax.toml", scene("[solve]\npatch_size = = 1\n")),
        ("method.toml", scene("[solve]\nmethod = \"ritz\"\n")),
        ("solver.toml", scene("[solve]\nsolver = \"gauss\"\n")),
    ]
}

const SCENES: &[Case] = &[
    ("missing.obj", 1, &["missing.obj", "cannot read"]),
    ("missing.toml", 1, &["missing.toml", "cannot read"]),
    (".", 1, &["kind"]),
    ("syntax.obj", 1, &["syntax.obj:8", "`three`"]),
    ("syntax.toml", 1, &["syntax.toml:4"]),
    ("degenerate.obj", 1, &["degenerate.obj:9", "no area"]),
    ("bent.obj", 1, &["bent.obj:9", "not planar"]),
    ("nan.obj", 1, &["nan.obj:8", "not a finite number"]),
    ("bright.obj", 1, &["m.mtl:5", "reflectance", "less than 1"]),
    ("dark.obj", 1, &["no surface emits light"]),
    ("empty.obj", 1, &["no faces"]),
    ("method.toml", 1, &["method.toml", "ritz", "galerkin, collocation, nystrom"]),
    ("solver.toml", 1, &["solver.toml", "\"gauss\"", "gauss-seidel, southwell"]),
    ("good.obj --bands spectral", 1, &["good.obj", "--bands spectral", "Cornell"]),
];

const OUTPUTS: &[Case] = &[
    ("-o no/such.png", 1, &["cannot write no/such.png", "folder no"]),
    ("-o a.jpg", 2, &["a.jpg", ".png"]),
    ("-o m.mtl/a.png", 1, &["cannot write m.mtl/a.png"]),
    ("--json no/such.json", 1, &["cannot write no/such.json"]),
    ("--json .", 1, &["it is a folder"]),
    ("--patches no/such.csv", 1, &["cannot write no/such.csv"]),
    ("--patches a.txt", 2, &["a.txt", ".csv or .npz"]),
    ("--json a.png -o a.png", 1, &["two outputs", "a.png"]),
    ("--frames m.mtl", 1, &["m.mtl"]),
    ("--json a.json --patches no/such.npz", 1, &["cannot write no/such.npz"]),
];

const NUMBERS: &[Case] = &[
    ("--patch-size nan", 2, &["positive finite number"]),
    ("--patch-size 0", 2, &["positive finite number"]),
    ("--patch-size 1e-9 --frames f", 1, &["patches", "take larger ones"]),
    ("--patch-size 0.002 --operator dense --frames f", 1, &["MB are free", "hierarchical"]),
    ("--patch-size 1 --patch-count 5", 2, &["cannot be used with"]),
    ("--patch-count 0", 2, &["1 or more"]),
    ("--accuracy -1", 2, &["--accuracy"]),
    ("--accuracy 100%", 2, &["--accuracy", "such as 1%"]),
    ("--accuracy 1% --patch-size 1", 2, &["--accuracy", "--patch-size"]),
    ("--factor-accuracy -1", 2, &["--factor-accuracy"]),
    ("--tolerance inf", 2, &["positive finite number"]),
    ("--iterations 0", 2, &["1 or more"]),
    ("--threads 0", 2, &["1 to 1024"]),
    ("--size 0x0", 2, &["640x480"]),
    ("--size 640", 2, &["640x480"]),
    ("--samples 0", 2, &["--samples"]),
    ("--gather 0", 2, &["--gather"]),
    ("--every 0 --frames f", 2, &["1 or more"]),
    ("--every 5", 2, &["--frames"]),
    ("--ambient --frames f", 1, &["--ambient", "southwell"]),
    ("--solver gauss", 2, &["gauss-seidel", "southwell"]),
    ("--method ritz", 2, &["galerkin", "collocation", "nystrom"]),
    ("--solver jacobi --method nystrom --patch-count 200 --wrong", 2, &["--wrong"]),
];

fn check(name: &str, cases: &[Case]) {
    let folder = folder(name);
    for (file, text) in files() {
        fs::write(folder.join(file), text).unwrap();
    }
    let messages = refuse(&folder, cases, |words| fredholm(&folder, &format!("radiosity {words}")));
    for (message, (words, code, _)) in messages.iter().zip(cases) {
        assert!(*code == 2 || message.lines().count() == 1, "`{words}`: {message}");
    }
}

#[test]
fn scenes() {
    check("bad_scenes", SCENES);
}

#[test]
fn outputs() {
    check("bad_outputs", OUTPUTS);
}

#[test]
fn numbers() {
    check("bad_numbers", NUMBERS);
}
