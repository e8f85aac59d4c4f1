//! `fredholm compare`: the methods of the paper on one problem.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the message, in its helpers too")]

mod run;

use run::{folder, fredholm_with, json, names, text};
use serde_json::Value;
use std::fs;

const FIRST: [&str; 7] =
    ["compare", "--kernel", "(x+1)*exp(-x*y)/2", "--source", "exp(-x) - 0.5 + exp(-(x+1))/2", "--n", "32"];

fn method<'a>(report: &'a Value, name: &str) -> &'a Value {
    report["methods"].as_array().unwrap().iter().find(|method| method["method"] == name).unwrap()
}

#[test]
fn each_method_has_its_order() {
    let words = [&FIRST[..], &["--exact", "exp(-x)", "--json", "-"]].concat();
    let report = json(&fredholm_with(&folder("compare_orders"), &words).stdout);
    assert_eq!(report["measured"], "error");
    for (name, order) in [
        ("nystrom trapezoid", 2.0),
        ("nystrom simpson", 4.0),
        ("degenerate p1", 2.0),
        ("collocation p1", 2.0),
        ("collocation p2", 3.0),
        ("least-squares p1", 2.0),
        ("galerkin p1", 2.0),
        ("galerkin p2", 3.0),
        ("iterated-galerkin p1", 4.0),
    ] {
        let runs = method(&report, name)["runs"].as_array().unwrap();
        let last = &runs[runs.len() - 1];
        assert_eq!((runs.len(), last["n"].as_u64()), (4, Some(32)), "{name}: {runs:?}");
        let found = last["order"].as_f64().unwrap();
        // Quadratic collocation is of order 4 at the nodes, and its mean slope between 3 and 4.
        assert!(found > order - 0.25 && found < order + 1.1, "{name}: order {found}");
        assert!(
            runs.iter().all(|run| run["error"].as_f64() <= run["error_estimate"].as_f64()),
            "{name}: {runs:?}"
        );
    }
    let trapezoid = method(&report, "nystrom trapezoid")["runs"][3]["error"].as_f64().unwrap();
    assert!((2.0e-4..3.0e-4).contains(&trapezoid), "{trapezoid}");
    let gauss = method(&report, "nystrom gauss-legendre")["runs"][1]["error"].as_f64().unwrap();
    assert!(gauss < 1e-14, "{gauss}");
    assert!(method(&report, "automatic")["runs"][0]["error"].as_f64().unwrap() < 1e-13);
}

#[test]
fn the_table_and_the_files_have_every_method() {
    let folder = folder("compare_files");
    let words = [&FIRST[..], &["--plot", "a.png", "--csv", "a.csv"]].concat();
    let output = fredholm_with(&folder, &words);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let table = text(&output.stdout);
    for part in ["error estimate", "iterated-galerkin p1", "order", "automatic: ", "written: a.csv, a.png"] {
        assert!(table.contains(part), "no `{part}` in: {table}");
    }
    assert_eq!(names(&folder), ["a.csv", "a.png"]);
    assert!(fs::read_to_string(folder.join("a.csv")).unwrap().lines().count() > 40);
    assert!(fs::read(folder.join("a.png")).unwrap().starts_with(b"\x89PNG"));
}

#[test]
fn a_method_that_cannot_says_why() {
    let words = ["compare", "--kernel", "ln(abs(x-y))", "--source", "1", "--n", "8", "--json", "-"];
    let output = fredholm_with(&folder("compare_refused"), &words);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let report = json(&output.stdout);
    let trapezoid = method(&report, "nystrom trapezoid");
    assert!(trapezoid["refused"].as_str().unwrap().contains("kernel is -inf"), "{trapezoid}");
    assert!(text(&output.stderr).contains("nystrom trapezoid: "));
}
