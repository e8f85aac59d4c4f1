//! `fredholm solve` from formulas to numbers, files and pictures.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the message, in its helpers too")]

mod run;

use run::{folder, fredholm_with, json, names, text};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// The first problem of the paper, whose solution is e^{−x}.
const FIRST: [&str; 4] = ["--kernel", "(x+1)*exp(-x*y)/2", "--source", "exp(-x) - 0.5 + exp(-(x+1))/2"];

fn solve(folder: &Path, words: &[&str]) -> std::process::Output {
    fredholm_with(folder, &[&["solve"], words].concat())
}

/// The JSON of a run, and its exit code.
fn report(folder: &Path, words: &[&str]) -> (Value, i32) {
    let output = solve(folder, &[words, &["--json", "-"]].concat());
    assert!(!output.stdout.is_empty(), "{words:?}: {}", text(&output.stderr));
    (json(&output.stdout), output.status.code().unwrap())
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

/// max |φ − exact| at the points of the report.
fn error(report: &Value, exact: impl Fn(f64) -> f64) -> f64 {
    let (x, phi) = (numbers(&report["x"]), numbers(&report["phi"]));
    assert_eq!(x.len(), phi.len());
    x.iter().zip(phi).map(|(x, phi)| (phi - exact(*x)).abs()).fold(0.0, f64::max)
}

#[test]
fn the_first_problem_has_its_solution_and_the_json_its_keys() {
    let words = [&FIRST[..], &["--interval", "0", "1", "--tolerance", "1e-12", "--at", "0:0.1:1"]].concat();
    let (report, code) = report(&folder("solve_first"), &words);
    assert_eq!((code, report["status"].as_str()), (0, Some("converged")));
    assert!(error(&report, |x| (-x).exp()) < 1e-12, "{report}");
    assert_eq!(numbers(&report["x"])[3], 0.3);
    let estimate = report["error_estimate"].as_f64().unwrap();
    assert!(estimate < 1e-12 && error(&report, |x| (-x).exp()) <= estimate, "{report}");
    assert!(report["method"].is_string() && report["n"].is_u64());
    assert!(report["condition"].as_f64().unwrap() >= 1.0 && report["seconds"].is_number());
    assert_eq!((&report["nullity"], report["solvability"].as_array()), (&Value::from(0), Some(&vec![])));
}

#[test]
fn people_read_a_table_of_what_is_known() {
    let folder = folder("solve_table");
    let output = solve(&folder, &[&FIRST[..], &["--exact", "exp(-x)", "--at", "0.07,1/4"]].concat());
    let table = text(&output.stdout);
    for part in ["converged", "in truth", "condition", "φ(x)", "0.07   0.93239", "0.25   0.77880"] {
        assert!(table.contains(part), "no `{part}` in: {table}");
    }
    assert!(names(&folder).is_empty(), "files that nobody asked for");
}

#[test]
fn infinite_intervals_and_singular_kernels_are_taken() {
    let folder = folder("solve_classes");
    for (words, exact) in [
        (
            ["ln(abs(x-y))", "1 - (if(x<1,(1-x)*ln(1-x),0) + if(x>0,x*ln(x),0) - 1)", "0", "1"],
            (|_| 1.0) as fn(f64) -> f64,
        ),
        (["exp(-(x-y)^2)/4", "exp(-x^2) - sqrt(pi/2)*exp(-x^2/2)/4", "-inf", "inf"], |x| (-x * x).exp()),
        (
            ["-min(x,y)*(1-max(x,y))", "exp(-x)*sin(x) - (x*(1-cos(1)/e) - 1 + cos(x)*exp(-x))/2", "0", "1"],
            |x| (-x).exp() * x.sin(),
        ),
    ] {
        let [kernel, source, a, b] = words;
        let words = ["--kernel", kernel, "--source", source, "--interval", a, b];
        let (report, code) = report(&folder, &words);
        assert_eq!(code, 0, "{report}");
        assert!(error(&report, exact) < 1e-10, "{report}");
    }
}

#[test]
fn a_file_states_systems_with_parameters_and_complex_equations() {
    let folder = folder("solve_files");
    let system = r#"
kernels = [["(x+y)/a", "(x+y)/a"], ["x*y", "x*y"]]
sources = ["x/18+17/36", "x^2-19*x/12+1"]
exact = ["x+1", "x^2+1"]
parameters = { a = 3 }
at = "0,1/2,1"
"#;
    fs::write(folder.join("system.toml"), system).unwrap();
    let (answer, code) = report(&folder, &["system.toml"]);
    assert_eq!(code, 0, "{answer}");
    assert!(answer["true_error"].as_f64().unwrap() < 1e-10);
    let phi = answer["phi"].as_array().unwrap();
    assert_eq!((phi.len(), phi[1].as_array().unwrap().len()), (2, 3));
    assert!((phi[1][2].as_f64().unwrap() - 2.0).abs() < 1e-10);

    fs::write(folder.join("complex.toml"), "kernel = \"exp(i*(x-y))/2\"\nsource = \"exp(i*x)/2\"\n").unwrap();
    let (answer, _) = report(&folder, &["complex.toml", "--at", "0,1", "--exact", "exp(i*x)"]);
    assert!(answer["true_error"].as_f64().unwrap() < 1e-10, "{answer}");
    let at_one = numbers(&answer["phi"][1]);
    assert!((at_one[0] - 1f64.cos()).abs() < 1e-10 && (at_one[1] - 1f64.sin()).abs() < 1e-10);
}

#[test]
fn the_command_line_goes_before_the_file_and_that_before_the_defaults() {
    let folder = folder("solve_settings");
    let file = "kernel = \"c*x*y\"\nsource = \"1\"\ninterval = [0, \"d\"]\nparameters = { c = 0.5, d = \"2*c\" }\ntolerance = 1e-8\n";
    fs::write(folder.join("p.toml"), file).unwrap();
    let last = |words: &[&str]| {
        let (report, _) = report(&folder, &[&["p.toml"], words].concat());
        (*numbers(&report["x"]).last().unwrap(), report["tolerance"].as_f64().unwrap())
    };
    assert_eq!(last(&[]), (1.0, 1e-8));
    assert_eq!(last(&["--set", "c=1"]), (2.0, 1e-8));
    assert_eq!(last(&["--set", "d=e*c", "--set", "e=3", "--set", "d=3*c"]), (1.5, 1e-8));
    assert_eq!(last(&["--interval", "-1", "3", "--tolerance", "1e-6"]), (3.0, 1e-6));
    let (plane, code) = report(&folder, &["p.toml", "--domain", "disk 0 0 1"]);
    assert_eq!((code, plane["x"][0].as_array().unwrap().len()), (0, 2));
}

#[test]
fn domains_of_the_plane_are_solved() {
    let folder = folder("solve_plane");
    let words = [
        "--kernel",
        "(x*s+y*t)/pi",
        "--source",
        "1+3*x/4",
        "--domain",
        "disk 0 0 1",
        "--at",
        "0.3,-0.4; 0,1",
    ];
    let (report, code) = report(&folder, &[&words[..], &["--exact", "1+x"]].concat());
    assert_eq!((code, report["x"][0][1].as_f64()), (0, Some(-0.4)));
    assert!(
        report["true_error"].as_f64().unwrap() < 1e-12 && (numbers(&report["phi"])[0] - 1.3).abs() < 1e-12
    );
}

#[test]
fn methods_are_called_by_name() {
    let folder = folder("solve_methods");
    for (words, least, most) in [
        ("nystrom --rule trapezoid --n 16", 1e-4, 2e-3),
        ("nystrom --n 8", 0.0, 1e-14),
        ("collocation --space p1 --n 16", 1e-4, 2e-3),
        ("iterated-galerkin --space p1 --n 8", 1e-8, 1e-6),
        ("least-squares --space p2 --n 8", 1e-7, 1e-4),
        ("degenerate", 0.0, 1e-10),
        ("neumann", 0.0, 1e-10),
        ("successive --n 3", 1e-4, 1.0),
    ] {
        let method: Vec<&str> = std::iter::once("--method").chain(words.split_whitespace()).collect();
        let (report, _) = report(&folder, &[&FIRST[..], &method].concat());
        let error = error(&report, |x| (-x).exp());
        assert!((least..=most).contains(&error), "{words}: {error} in {report}");
        assert!(error <= report["error_estimate"].as_f64().unwrap(), "{words}: {report}");
    }
}

#[test]
fn what_cannot_be_met_is_told() {
    let folder = folder("solve_not_met");
    let words = [&FIRST[..], &["--method", "nystrom", "--rule", "trapezoid", "--n", "4"]].concat();
    let output = solve(&folder, &words);
    assert_eq!(output.status.code(), Some(3));
    assert!(text(&output.stdout).contains("TOLERANCE NOT MET"), "{}", text(&output.stdout));
    assert_eq!(report(&folder, &words).0["status"], "tolerance-not-met");
}

#[test]
fn what_takes_more_unknowns_than_are_allowed_is_told() {
    let folder = folder("solve_unknowns");
    let words = ["--kernel", "cos(100*x*y)", "--source", "cos(30*x)"];
    let few = [&words[..], &["--unknowns", "64"]].concat();
    let output = solve(&folder, &few);
    assert_eq!(output.status.code(), Some(3));
    assert!(text(&output.stdout).contains("allow more than 64 --unknowns"), "{}", text(&output.stdout));
    assert!(report(&folder, &few).0["n"].as_u64().unwrap() <= 64);
    std::fs::write(
        folder.join("enough.toml"),
        "kernel = \"cos(100*x*y)\"\nsource = \"cos(30*x)\"\nunknowns = 500\n",
    )
    .unwrap();
    let (enough, _) = report(&folder, &["enough.toml"]);
    assert_eq!(enough["status"], "converged", "{enough}");
    assert!(enough["n"].as_u64().unwrap() > 64, "{enough}");
    let output = solve(&folder, &[&few[..], &["--method", "nystrom", "--n", "4"]].concat());
    assert_eq!(output.status.code(), Some(1));
}

#[test]
fn more_unknowns_than_a_matrix_is_made_for_are_kept_in_blocks() {
    let folder = folder("solve_large");
    for (file, z) in [("waves.toml", "1"), ("complex.toml", "(0.3+0.8*i)")] {
        let problem = format!(
            "kernel = \"{z}*exp(-abs(x-y))/2\"\n\
             source = \"sin(w*x) - {z}*(sin(w*x) + w*exp(-x)/2 - (w*cos(w)+sin(w))*exp(x-1)/2)/(1+w^2)\"\n\
             exact = \"sin(w*x)\"\nparameters = {{ w = 6000 }}\ntolerance = 1e-8\nunknowns = 40000\n"
        );
        std::fs::write(folder.join(file), problem).unwrap();
        let (answer, code) = report(&folder, &[file]);
        assert_eq!((code, answer["status"].as_str()), (0, Some("converged")), "{answer}");
        assert!(answer["method"].as_str().unwrap().contains("blocks of low rank"), "{answer}");
        assert!(answer["n"].as_u64().unwrap() > 3000, "{answer}");
        let [told, off] = ["error_estimate", "true_error"].map(|key| answer[key].as_f64().unwrap());
        assert!(off <= told && told <= 1e-8, "{answer}");
    }
    let output = solve(&folder, &["waves.toml", "--unknowns", "5000"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stderr).contains("the source alone takes more than"), "{}", text(&output.stderr));
}

#[test]
fn fredholms_alternative_is_told() {
    let folder = folder("solve_alternative");
    let kernel = ["--kernel", "4*x*y^2", "--at", "0,0.5,1"];
    let one_of_many = [&kernel[..], &["--source", "1-5*x^2/3"]].concat();
    let (answer, code) = report(&folder, &one_of_many);
    assert_eq!(
        (code, answer["status"].as_str(), answer["nullity"].as_u64()),
        (4, Some("not-unique"), Some(1))
    );
    assert_eq!(report(&folder, &[&one_of_many[..], &["--general"]].concat()).1, 0);
    // The null functions are multiples of x, of norm 1 in L².
    let null = numbers(&answer["null_space"][0]);
    assert!(null[0].abs() < 1e-10 && (null[2].abs() - 3f64.sqrt()).abs() < 1e-10, "{answer}");
    // φ = f + a x for some a.
    let phi = numbers(&answer["phi"]);
    let a = phi[2] + 2.0 / 3.0;
    assert!((phi[0] - 1.0).abs() < 1e-9 && (phi[1] - (1.0 - 5.0 / 12.0) - 0.5 * a).abs() < 1e-9, "{answer}");

    let none = [&kernel[..], &["--source", "1", "--general"]].concat();
    let (answer, code) = report(&folder, &none);
    assert_eq!((code, answer["status"].as_str()), (4, Some("no-solution")));
    // ⟨1, x²⟩ = 1/3 with ψ = √5 x².
    assert!((numbers(&answer["solvability"])[0].abs() - 5f64.sqrt() / 3.0).abs() < 1e-9, "{answer}");
    assert!(answer["phi"][0].is_null(), "a φ that is no solution: {answer}");
    let table = text(&solve(&folder, &none).stdout);
    assert!(
        table.contains("NO SOLUTION") && table.contains("⟨f, ψ₁⟩ = ") && !table.contains("φ(x)"),
        "{table}"
    );
}

#[test]
fn all_files_are_written_and_read_back() {
    let folder = folder("solve_outputs");
    for picture in ["a.svg", "b.png"] {
        let files = ["--csv", "a.csv", "--json", "a.json", "--plot", picture];
        let output = solve(&folder, &[&FIRST[..], &files, &["--at", "0.1,0.7"]].concat());
        assert!(output.status.success(), "{}", text(&output.stderr));
    }
    assert_eq!(names(&folder), ["a.csv", "a.json", "a.svg", "b.png"]);
    let json = json(&fs::read(folder.join("a.json")).unwrap());
    assert_eq!(json["files"], serde_json::json!(["a.csv", "b.png", "a.json"]));
    let csv = fs::read_to_string(folder.join("a.csv")).unwrap();
    let cells: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!((cells.len(), &cells[0][..]), (3, &["x", "phi"][..]));
    assert_eq!(cells[2][1].parse::<f64>().unwrap(), numbers(&json["phi"])[1], "all digits are there");
    let svg = fs::read_to_string(folder.join("a.svg")).unwrap();
    assert!(svg.starts_with("<svg") && svg.ends_with("</svg>") && svg.contains("φ(x)"), "{svg:.200}");
    let png = image::load_from_memory(&fs::read(folder.join("b.png")).unwrap()).unwrap().to_rgb8();
    let ink = png.pixels().filter(|pixel| pixel.0 == [0x1f, 0x77, 0xb4]).count();
    assert!(
        png.width() > 1000 && ink > 1000,
        "{} × {}, {ink} pixels of the curve",
        png.width(),
        png.height()
    );
}

#[test]
fn complex_answers_systems_and_maps_are_drawn() {
    let folder = folder("solve_pictures");
    let drawn = |words: &[&str]| {
        let output = solve(&folder, &[words, &["--plot", "a.svg"]].concat());
        assert!(output.status.success(), "{}", text(&output.stderr));
        fs::read_to_string(folder.join("a.svg")).unwrap()
    };
    let svg = drawn(&["--kernel", "exp(i*(x-y))/2", "--source", "exp(i*x)/2"]);
    assert!(svg.contains("Re φ") && svg.contains("Im φ"));
    let svg = drawn(&["--kernel", "x*y*(s+t)", "--source", "1", "--domain", "triangle 0 0 1 0 0 1"]);
    assert!(svg.matches("<rect").count() > 1000, "the squares of a map");
}

#[test]
fn a_kernel_that_is_0_over_0_has_its_limit_there() {
    let words = ["--kernel", "sin(x-1/2)/(x-1/2)/2", "--source", "1", "--at", "0.5, 0.50001"];
    let (report, code) = report(&folder("solve_limit"), &words);
    assert_eq!((code, report["status"].as_str()), (0, Some("converged")));
    let phi = numbers(&report["phi"]);
    assert!((phi[0] - phi[1]).abs() < 1e-9, "{report}");
}

#[test]
fn where_there_is_no_number_nothing_has_converged() {
    let folder = folder("solve_lost");
    for kernel in ["1/(x-1/2)", "ln(abs(x-1/2))"] {
        let words = ["--kernel", kernel, "--source", "1", "--tolerance", "0.01"];
        let output = solve(&folder, &words);
        let table = text(&output.stdout);
        assert_eq!(output.status.code(), Some(3), "{table}");
        for part in ["TOLERANCE NOT MET", "φ at x = 0.5, where K or f is not"] {
            assert!(table.contains(part), "no `{part}` in: {table}");
        }
        let (report, code) = report(&folder, &words);
        assert_eq!((code, report["status"].as_str()), (3, Some("tolerance-not-met")));
        assert_eq!(report["phi"].as_array().unwrap()[5], Value::Null);
    }
}
