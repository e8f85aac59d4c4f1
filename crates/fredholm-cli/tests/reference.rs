//! Equations with known solutions, typed as formulas: the command is right to rounding, and says how right it is.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the message, in its helpers too")]

mod run;

use run::{fredholm_with, json, text};
use serde_json::Value;

/// id, K, f, φ, the ends of the interval, points, the error allowed as a part of max |φ|.
type Row<'a> = (&'a str, &'a str, &'a str, &'a str, [&'a str; 2], &'a str, f64);

const UNIT: [&str; 2] = ["0", "1"];
const WITHIN: &str = "0.01:0.07:0.99";

const PROBLEMS: &[Row<'_>] = &[
    ("S01", "(x+1)*exp(-x*y)/2", "exp(-x) - 1/2 + exp(-(x+1))/2", "exp(-x)", UNIT, "0:0.05:1", 1e-13),
    ("S02", "x*y^2", "x^2 - x/5", "x^2", UNIT, "0:0.05:1", 1e-13),
    ("S03", "1/(1+2*x+y)", "x - 1 + (1+2*x)*ln((2+2*x)/(1+2*x))", "x", UNIT, "0:0.05:1", 1e-13),
    (
        "S06",
        "-(0.3/pi)/(1 - 0.64*cos((x+y)/2)^2)",
        "25 - 16*sin(x)^2",
        "17/2 + 128/17*cos(2*x)",
        ["-pi", "pi"],
        "-3:0.25:3",
        1e-13,
    ),
    ("S07", "exp(x*y)/2", "exp(x) - (exp(x+1)-1)/(2*(x+1))", "exp(x)", UNIT, "0:0.05:1", 1e-13),
    ("S08", "0.3*cos(x-y)", "3", "3 + 1.8*sin(x)/(1 - 0.15*pi)", ["0", "pi"], "0:0.2:3", 1e-13),
    (
        "S09",
        "-sin(2*pi*(x-y))",
        // sin(wx) Re J − cos(wx) Im J is Im(e^{iwx} J*), J = (e^z (z − 1) + 1)/z² and z = 1 + iw
        "x*exp(x) + imag(exp(2*pi*i*x)*conj((exp(1+2*pi*i)*(2*pi*i) + 1)/(1+2*pi*i)^2))",
        "x*exp(x)",
        UNIT,
        "0:0.05:1",
        1e-13,
    ),
    ("S11", "x^3*y^4", "x^2.5 - x^3/7.5", "x^2.5", UNIT, "0:0.05:1", 1e-13),
    ("S12", "0.5*exp(i*(x-y))", "exp(i*x)/2", "exp(i*x)", UNIT, "0:0.05:1", 1e-13),
    (
        "D01",
        "-min(x,y)*(1-max(x,y))",
        "exp(-x)*sin(x) - (x*(1-cos(1)/e) - 1 + cos(x)*exp(-x))/2",
        "exp(-x)*sin(x)",
        UNIT,
        "0:0.05:1",
        1e-12,
    ),
    (
        "D02",
        "-min(x,y)*(5-max(x,y))",
        "exp(-x)*sin(x) - (x*(1-cos(5)*exp(-5)) - 5 + 5*cos(x)*exp(-x))/2",
        "exp(-x)*sin(x)",
        ["0", "5"],
        "0:0.25:5",
        1e-12,
    ),
    ("D03", "abs(x-y)", "-(2*x^3 - 9*x + 2)/6", "x", UNIT, "0:0.05:1", 1e-12),
    ("D04", "min(x,y)*(1-max(x,y))", "(1-1/pi^2)*sin(pi*x)", "sin(pi*x)", UNIT, "0:0.05:1", 1e-12),
    ("D05", "exp(-abs(x-y))/4", "1 - (2 - exp(-x) - exp(-(1-x)))/4", "1", UNIT, "0:0.05:1", 1e-12),
    ("L01", "ln(abs(x-y))", "1 - ((1-x)*ln(1-x) + x*ln(x) - 1)", "1", UNIT, WITHIN, 1e-11),
    (
        "L04",
        "ln(abs(x-y))",
        "x*ln(x) + ln(1-x)/4 + (-1/4 - x + x^2*li2(1/x))/2 - (1/2 + x + x^2*ln((1-x)/x))/4",
        "x*ln(x)",
        UNIT,
        WITHIN,
        1e-11,
    ),
    (
        "A02",
        "abs(x-y)^(-1/3)/10",
        "x^2*(1-x)^2 - 27/30800*(x^(8/3)*(54*x^2-126*x+77) + (1-x)^(8/3)*(54*x^2+18*x+5))",
        "x^2*(1-x)^2",
        UNIT,
        "0:0.05:1",
        1e-11,
    ),
    (
        "A05",
        "abs(x-y)^(-1/2)/5",
        // With u = |x − y|: ∫ (x ∓ u)² u^{−1/2} du on either side.
        "x^2 - (2*x^2*(sqrt(1+x)+sqrt(1-x)) - 4*x/3*((1+x)^1.5-(1-x)^1.5) + 2/5*((1+x)^2.5+(1-x)^2.5))/5",
        "x^2",
        ["-1", "1"],
        "-1:0.1:1",
        1e-11,
    ),
    (
        "I01",
        "1/(1+x^2+y^2)",
        "1/(1+x^2) - pi/2/(sqrt(1+x^2)*(1+sqrt(1+x^2)))",
        "1/(1+x^2)",
        ["0", "inf"],
        "0,0.5,1,2,5,10,100",
        1e-11,
    ),
    (
        "I02",
        "exp(1-y)",
        "1/((x-3)^2+1/2) + 1/((x-9)^2+1/3)",
        "1/((x-3)^2+1/2) + 1/((x-9)^2+1/3) + e*0.348441272859126/(1-e)",
        ["0", "inf"],
        "0,1,2,3,5,9,20",
        1e-11,
    ),
    (
        "I04",
        "exp(-(x-y)^2)/4",
        "exp(-x^2) - sqrt(pi/2)*exp(-x^2/2)/4",
        "exp(-x^2)",
        ["-inf", "inf"],
        "-5:0.5:5",
        1e-11,
    ),
];

/// The JSON of `fredholm solve`, and its exit code.
fn solve(folder: &str, words: &[&str]) -> (Value, i32) {
    let output = fredholm_with(&run::folder(folder), &[&["solve", "--json", "-"], words].concat());
    assert!(!output.stdout.is_empty(), "{words:?}: {}", text(&output.stderr));
    (json(&output.stdout), output.status.code().unwrap())
}

fn check(id: &str, bound: f64, words: &[&str]) {
    let tolerance = format!("{bound:e}");
    let (report, code) = solve(&format!("reference {id}"), &[words, &["--tolerance", &tolerance]].concat());
    let number = |key: &str| report[key].as_f64().unwrap_or_else(|| panic!("{id}: no {key} in {report}"));
    let (error, estimate) = (number("true_error"), number("error_estimate"));
    let parts = |value: &Value| match value {
        Value::Array(parts) => parts.iter().map(|part| part.as_f64().unwrap().abs()).fold(0.0, f64::max),
        number => number.as_f64().unwrap().abs(),
    };
    let scale = report["phi"].as_array().unwrap().iter().map(parts).fold(0.0, f64::max);
    assert_eq!((code, report["status"].as_str()), (0, Some("converged")), "{id}: {report}");
    assert!(error <= bound * scale, "{id}: error {error:e}");
    assert!(error <= estimate, "{id}: error {error:e}, said to be {estimate:e}");
}

#[test]
fn typed_problems_are_solved_and_their_errors_are_known() {
    for (id, kernel, source, exact, [a, b], at, bound) in PROBLEMS {
        let words =
            ["--kernel", kernel, "--source", source, "--exact", exact, "--interval", a, b, "--at", at];
        check(id, *bound, &words);
    }
}

#[test]
fn peaks_of_any_steepness_are_solved() {
    let source = "0.06 - 0.8*x + x^2 - (c + c*(x-0.4)*ln((c^2+(1-x)^2)/(c^2+x^2)) \
                  + (0.06 - c^2 - 0.8*x + x^2)*(atan((1-x)/c) + atan(x/c)))/5";
    for (c, bound) in [("c=1", 1e-13), ("c=0.1", 1e-13), ("c=0.01", 1e-12)] {
        let exact = "0.06 - 0.8*x + x^2";
        let kernel = "c/5/(c^2+(x-y)^2)";
        let words =
            ["--kernel", kernel, "--source", source, "--exact", exact, "--set", c, "--at", "0:0.05:1"];
        check(c, bound, &words);
    }
}

#[test]
fn domains_of_the_plane_are_solved_to_rounding() {
    let rows = [
        (
            "rectangle 0 1 0 1",
            "exp(-(x*s+y*t))/2",
            "exp(-(x+y)) - (1-exp(-(x+1)))/(x+1)*(1-exp(-(y+1)))/(y+1)/2",
            "exp(-(x+y))",
        ),
        ("triangle 0 0 1 0 0 1", "x*y*(s+t)", "1 + x*y - x*y*(1/3+1/30)", "1+x*y"),
        ("disk 0 0 1", "(x*s+y*t)/pi", "1+3*x/4", "1+x"),
    ];
    for (domain, kernel, source, exact) in rows {
        let at = "0.1,0.2; 0.3,0.4; 0.05,0.9; 0.7,0.1; 0.33,0.33";
        let words =
            ["--domain", domain, "--kernel", kernel, "--source", source, "--exact", exact, "--at", at];
        check(domain, 1e-13, &words);
    }
}

/// −(1/2π) ln(4 sin²((x − y)/2)) takes cos x and sin x to themselves: what cos 3x solves, cos 3x + a cos x + b sin x does too.
#[test]
fn the_logarithm_on_a_circle_has_two_null_functions() {
    let words = [
        "--kernel",
        "-ln(4*sin((x-y)/2)^2)/(2*pi)",
        "--source",
        "2/3*cos(3*x)",
        "--interval",
        "0",
        "2*pi",
        "--at",
        "0.5:0.5:6",
        "--tolerance",
        "1e-11",
    ];
    let (report, code) = solve("circle", &words);
    assert_eq!(
        (code, report["status"].as_str(), report["nullity"].as_u64()),
        (4, Some("not-unique"), Some(2))
    );
    let phi = report["phi"].as_array().unwrap().iter().map(|phi| phi.as_f64().unwrap());
    for (x, phi) in report["x"].as_array().unwrap().iter().zip(phi) {
        assert!((phi - (3.0 * x.as_f64().unwrap()).cos()).abs() < 1e-10, "{report}");
    }
}

#[test]
fn a_weak_singularity_of_the_solution_is_no_obstacle() {
    // φ has the slope of √x at 0 and of √(1 − x) at 1.
    let words = ["--kernel", "abs(x-y)^(-1/2)/5", "--source", "1+x", "--tolerance", "1e-11"];
    let (report, code) = solve("weak", &words);
    assert_eq!((code, report["status"].as_str()), (0, Some("converged")), "{report}");
}
