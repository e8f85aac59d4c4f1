//! Whatever is wrong with an equation is told, with an exit code, without a panic and without files left behind.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the message, in its helpers too")]

mod run;

use run::{Case, folder, fredholm_with, refuse};
use std::fs;

/// Problem files, by name.
fn files() -> Vec<(&'static str, String)> {
    let problem = |rest: &str| format!("kernel = \"x*y\"\nsource = \"x\"\n{rest}");
    vec![
        ("good.toml", problem("")),
        ("unknown.toml", problem("tolerence = 1e-3\n")),
        ("syntax.toml", problem("interval = [0,\n")),
        ("formula.toml", "kernel = \"\"\"\nx +\n  sine(y)\"\"\"\nsource = \"x\"\n".to_owned()),
        ("parameter.toml", problem("[parameters]\na = \"b + 1\"\n")),
        ("interval.toml", problem("interval = [1, 0]\n")),
        ("ends.toml", problem("interval = [0, 1, 2]\n")),
        ("both.toml", problem("interval = [0, 1]\ndomain = \"disk 0 0 1\"\n")),
        ("twice.toml", problem("kernels = [[\"x\"]]\n")),
        ("ragged.toml", "kernels = [[\"x\", \"y\"], [\"1\"]]\nsources = [\"x\", \"x\"]\n".to_owned()),
        ("shape.toml", "kernels = [[\"x\", \"y\"], [\"1\", \"2\"]]\nsources = [\"x\"]\n".to_owned()),
        ("no_source.toml", "kernel = \"x\"\n".to_owned()),
        ("method.toml", problem("method = \"ritz\"\n")),
        ("class.toml", problem("class = \"soft\"\n")),
        ("tolerance.toml", problem("tolerance = 0\n")),
        ("n.toml", problem("method = \"nystrom\"\nn = 0\n")),
        ("points.toml", problem("at = \"0:2\"\n")),
        ("plane.toml", problem("domain = \"disk 0 0 0\"\n")),
    ]
}

const FORMULAS: &[Case] = &[
    ("solve|--kernel|sine(x)*y|--source|1", 1, &["--kernel: unknown function `sine`", "`sin`", "| ^^^^"]),
    ("solve|--kernel|x*y|--source|1+", 1, &["--source: ", "| 1+", "^"]),
    ("solve|--kernel|x*y|--source|y", 1, &["--source: unknown name `y`"]),
    ("solve|--kernel|x*s|--source|x", 1, &["--kernel: unknown name `s`"]),
    ("solve|--kernel|x*y|--source|x|--exact|(x", 1, &["--exact: ", "never closed"]),
    ("solve|--kernel|x*y|--source|0/0", 1, &["the source is NaN at x = "]),
    ("solve|--kernel|ln(-x-y-1)|--source|1", 1, &["the kernel is NaN at x = "]),
    ("solve|--kernel||--source|1", 1, &["--kernel: the formula is empty"]),
    ("solve|--kernel|c*x|--source|1|--set|c=d", 1, &["--set c: unknown name `d`"]),
    ("solve|--kernel|c*x|--source|1|--set|c", 2, &["name=number"]),
    ("solve|--kernel|x|--source|1|--set|x=1", 1, &["`x` is both a variable and a parameter"]),
    ("compare|--kernel|sine(x)*y|--source|1", 1, &["--kernel: unknown function `sine`"]),
    ("spectrum|--kernel|x*z", 1, &["--kernel: unknown name `z`"]),
    ("spectrum", 2, &["--kernel"]),
    ("solve|--kernel|x*y", 2, &["--source"]),
];

const DOMAINS: &[Case] = &[
    ("solve|good.toml|--interval|1|0", 1, &["--interval: ", "from 1 to 0 is empty"]),
    ("solve|good.toml|--interval|1|1", 1, &["is empty"]),
    ("solve|good.toml|--interval|inf|inf", 1, &["is empty"]),
    ("solve|good.toml|--interval|0|zwei", 1, &["--interval: unknown name `zwei`"]),
    ("solve|good.toml|--interval|0|i", 1, &["--interval: `i` is no real number"]),
    ("solve|good.toml|--interval|0|0/0", 1, &["--interval: `0/0` is no real number"]),
    ("solve|good.toml|--interval|0", 2, &["2 values"]),
    ("solve|good.toml|--domain|square 1", 1, &["--domain: ", "square"]),
    ("solve|good.toml|--domain|disk 0 0 -1", 1, &["--domain: ", "disk"]),
    ("solve|good.toml|--interval|0|1|--domain|disk 0 0 1", 2, &["cannot be used with"]),
    ("solve|good.toml|--at|1.5", 1, &["--at: ", "outside of the interval"]),
    ("solve|good.toml|--at|0:1", 1, &["--at: ", "from:step:to"]),
    (
        "solve|--kernel|1/((x-s)^2+(y-t)^2)|--source|1|--domain|rectangle 0 1 0 1",
        1,
        &["|p − q|^-2.00", "cannot be integrated"],
    ),
    ("solve|good.toml|--domain|disk 0 0 1|--at|2,0", 1, &["--at: ", "outside of the disk"]),
    ("compare|good.toml|--domain|disk 0 0 1", 1, &["on intervals"]),
    ("spectrum|good.toml|--domain|disk 0 0 1", 1, &["on intervals"]),
];

const METHODS: &[Case] = &[
    ("solve|--kernel|ln(abs(x-y))|--source|1|--method|nystrom|--n|4", 1, &["the kernel is -inf at x = "]),
    ("solve|good.toml|--method|ritz", 2, &["no method is called `ritz`", "galerkin"]),
    ("solve|good.toml|--method|galerkin|--space|p99", 2, &["no space is called `p99`"]),
    ("solve|good.toml|--method|nystrom|--rule|boole", 2, &["no rule is called `boole`"]),
    ("solve|good.toml|--method|nystrom|--n|0", 2, &["1 or more"]),
    ("solve|good.toml|--method|nystrom|--space|p1", 1, &["nystrom has no space"]),
    ("solve|good.toml|--method|galerkin|--rule|simpson", 1, &["galerkin has no rule"]),
    ("solve|good.toml|--method|nystrom|--rule|simpson|--n|3", 1, &["n = 3"]),
    ("solve|good.toml|--method|nystrom|--interval|0|inf", 1, &["finite interval"]),
    ("solve|good.toml|--method|galerkin|--domain|disk 0 0 1", 1, &["for intervals"]),
    ("solve|good.toml|--n|5", 1, &["--method"]),
    ("solve|good.toml|--unknowns|0", 2, &["1 or more"]),
    ("solve|good.toml|--method|galerkin|--unknowns|50", 1, &["galerkin has --n"]),
    ("solve|--kernel|i*x*y|--source|sin(10^17*x)|--unknowns|5000", 1, &["the source alone", "4992 unknowns"]),
    ("solve|good.toml|--source|sin(10^17*x)|--unknowns|5000", 1, &["the source alone", "4992 unknowns"]),
    ("solve|good.toml|--kernel|1|--source|sin(3000*x)|--unknowns|40000", 1, &["singular operator"]),
    ("solve|good.toml|--class|soft", 2, &["smooth, periodic"]),
    ("solve|good.toml|--class|algebraic:-2", 2, &["above -1"]),
    ("solve|good.toml|--tolerance|0", 2, &["positive finite number"]),
    ("solve|good.toml|--tolerance|nan", 2, &["positive finite number"]),
    ("compare|good.toml|--n|0", 2, &["1 or more"]),
    ("spectrum|good.toml|--count|0", 2, &["1 to 1000"]),
];

const FILES: &[Case] = &[
    ("solve|missing.toml", 1, &["cannot read missing.toml", "No such file"]),
    ("solve|.", 1, &["cannot read ."]),
    ("solve|unknown.toml", 1, &["unknown.toml:3: ", "`tolerence`"]),
    ("solve|syntax.toml", 1, &["syntax.toml:"]),
    ("solve|formula.toml", 1, &["formula.toml:1: kernel: unknown function `sine`", "2 |   sine(y)", "^^^^"]),
    ("solve|parameter.toml", 1, &["parameter.toml:4: a: unknown name `b`"]),
    ("solve|interval.toml", 1, &["interval.toml:3: interval: ", "from 1 to 0 is empty"]),
    ("solve|ends.toml", 1, &["ends.toml:3: "]),
    ("solve|both.toml", 1, &["both.toml:3: ", "`domain`"]),
    ("solve|twice.toml", 1, &["twice.toml:3: ", "`kernels`"]),
    ("solve|ragged.toml", 1, &["ragged.toml:1: ", "m lists of m"]),
    ("solve|shape.toml", 1, &["4 kernels for 1 sources"]),
    ("solve|no_source.toml", 1, &["no `source`"]),
    ("solve|method.toml", 1, &["method.toml:3: method: no method is called `ritz`"]),
    ("solve|class.toml", 1, &["class.toml:3: class: write smooth"]),
    ("solve|tolerance.toml", 1, &["tolerance.toml:3: tolerance: 0 is not a positive"]),
    ("solve|n.toml", 1, &["n.toml:4: n: "]),
    ("solve|points.toml", 1, &["points.toml:3: at: "]),
    ("solve|plane.toml", 1, &["plane.toml:3: domain: "]),
];

const OUTPUTS: &[Case] = &[
    ("solve|good.toml|--csv|no/such.csv", 1, &["cannot write no/such.csv", "folder no"]),
    ("solve|good.toml|--plot|no/such.svg|--csv|a.csv", 1, &["cannot write no/such.svg"]),
    ("solve|good.toml|--json|.", 1, &["it is a folder"]),
    ("solve|good.toml|--json|a.csv|--csv|a.csv", 1, &["two outputs", "a.csv"]),
    ("solve|good.toml|--plot|a.pdf", 2, &["a.pdf", ".svg or .png"]),
    ("solve|good.toml|--csv|a.txt", 2, &["a.txt", ".csv"]),
    ("compare|good.toml|--plot|no/such.png", 1, &["cannot write no/such.png"]),
    ("spectrum|good.toml|--csv|no/such.csv", 1, &["cannot write no/such.csv"]),
];

fn check(name: &str, cases: &[Case]) {
    let folder = folder(name);
    for (file, text) in files() {
        fs::write(folder.join(file), text).unwrap();
    }
    refuse(&folder, cases, |words| fredholm_with(&folder, &words.split('|').collect::<Vec<_>>()));
}

#[test]
fn formulas() {
    check("bad_formulas", FORMULAS);
}

#[test]
fn domains() {
    check("bad_domains", DOMAINS);
}

#[test]
fn methods() {
    check("bad_methods", METHODS);
}

#[test]
fn problem_files() {
    check("bad_files", FILES);
}

#[test]
fn outputs() {
    check("bad_equation_outputs", OUTPUTS);
}
