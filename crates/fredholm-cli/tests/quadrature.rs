//! `fredholm quadrature`: the numbers printed, the exit codes, and what is told of bad input.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the message, in its helpers too")]

mod run;

use run::{folder, fredholm, names, text};
use std::path::PathBuf;
use std::sync::OnceLock;

/// The words after `fredholm quadrature`, and what it writes.
fn quadrature(words: &str) -> (i32, String, String) {
    // One folder for all tests, which leave nothing there.
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    let folder = FOLDER.get_or_init(|| folder("quadrature"));
    let output = fredholm(folder, &format!("quadrature {words}"));
    (output.status.code().unwrap(), text(&output.stdout), text(&output.stderr))
}

/// The value on the first line.
fn value(out: &str) -> f64 {
    out.lines().next().unwrap().parse().unwrap()
}

#[test]
fn a_rule_is_printed_with_its_order_and_error_constant() {
    let (code, out, err) = quadrature("--rule gauss-legendre --n 2 --from 0 --to 2");
    assert_eq!((code, err.as_str()), (0, ""));
    let rows: Vec<Vec<f64>> = out
        .lines()
        .skip(1)
        .take(2)
        .map(|line| line.split_whitespace().map(|word| word.parse().unwrap()).collect())
        .collect();
    assert!((rows[0][0] - (1.0 - 1.0 / 3_f64.sqrt())).abs() < 2e-16);
    assert!((rows[1][1] - 1.0).abs() < 1e-15);
    assert!(out.ends_with("order 3, E(f) = 7.407407e-3 f^(4)(ξ)\n"), "{out}");
}

#[test]
fn every_rule_has_its_order() {
    let orders = [
        ("newton-cotes --n 4", 3),
        ("newton-cotes --n 5", 5),
        ("newton-cotes-open --n 3", 3),
        ("midpoint --panels 7", 1),
        ("trapezoid", 1),
        ("simpson --panels 50", 3),
        ("boole", 5),
        ("gauss-legendre --n 500", 999),
        ("gauss-chebyshev-1 --n 4", 7),
        ("gauss-chebyshev-2 --n 4", 7),
        ("gauss-jacobi --n 4 --alpha -0.5 --beta 2", 7),
        ("gauss-laguerre --n 4 --alpha 0.5", 7),
        ("gauss-hermite --n 4", 7),
        ("gauss-lobatto --n 4", 5),
        ("gauss-radau --n 4", 6),
        ("clenshaw-curtis --n 5", 5),
        ("gauss --weight 1-x --n 4", 7),
        ("gauss --weight exp(-x^4) --n 4 --from -inf --to inf", 7),
    ];
    for (words, order) in orders {
        let (code, out, err) = quadrature(&format!("--rule {words}"));
        assert_eq!((code, err.as_str()), (0, ""), "{words}");
        assert!(out.contains(&format!("\norder {order}, E(f) = ")), "{words}: {out}");
    }
}

#[test]
fn the_error_constant_is_that_of_the_interval_and_the_panels() {
    // −(b − a)⁵/(2880 m⁴).
    let (_, out, _) = quadrature("--rule simpson --panels 2 --from 1 --to 3");
    assert!(out.contains("E(f) = -6.944444e-4 f^(4)"), "{out}");
    let (_, out, _) = quadrature("--rule gauss-hermite --n 1");
    // ∫ x² e^{−x²}/2! = √π/4.
    assert!(out.contains("E(f) = 4.431135e-1 f^(2)"), "{out}");
}

#[test]
fn a_rule_is_written_as_json() {
    let (_, out, _) = quadrature("--rule triangle --degree 8 --json -");
    let json: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert_eq!(json["weights"].as_array().unwrap().len(), 16);
    let sum: f64 = json["weights"].as_array().unwrap().iter().map(|w| w.as_f64().unwrap()).sum();
    assert!((sum - 0.5).abs() < 1e-15);
    let folder = folder("quadrature-json");
    fredholm(&folder, "quadrature --rule simpson --json simpson.json");
    assert_eq!(names(&folder), ["simpson.json"]);
}

#[test]
fn formulas_are_integrated() {
    let integrals = [
        ("exp(x) --from 0 --to 1", std::f64::consts::E - 1.0),
        ("exp(x) --from 0 --to 1 --rule romberg", std::f64::consts::E - 1.0),
        ("exp(x) --from 0 --to 1 --rule gauss-legendre --n 20", std::f64::consts::E - 1.0),
        ("exp(-x)/sqrt(x) --from 0 --to inf", std::f64::consts::PI.sqrt()),
        ("exp(-x^2) --from -inf --to inf", std::f64::consts::PI.sqrt()),
        ("cos(x) --rule gauss-hermite --n 20", std::f64::consts::PI.sqrt() * (-0.25_f64).exp()),
    ];
    for (words, exact) in integrals {
        let (code, out, err) = quadrature(&format!("--integrate {words}"));
        assert_eq!((code, err.as_str()), (0, ""), "{words}");
        assert!((value(&out) / exact - 1.0).abs() < 1e-13, "{words}: {out}");
    }
}

#[test]
fn an_integral_that_does_not_converge_is_told_with_the_best_value() {
    let (code, out, _) = quadrature("--integrate 1/x --from 0 --to 1 --json -");
    assert_eq!(code, 3);
    let json: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert_eq!(json["status"], "tolerance-not-met");
    assert!(json["error_estimate"].as_f64().unwrap() > 1.0);
}

#[test]
fn what_is_wrong_is_told_in_one_message() {
    let wrong = [
        ("", 2, "--rule"),
        ("--rule simpsons", 2, "simpson"),
        ("--rule gauss-legendre --n 0", 1, "--n 0"),
        ("--rule newton-cotes --n 99", 1, "64"),
        ("--rule gauss-jacobi --alpha -1", 1, "−1"),
        ("--rule gauss-hermite --from 0", 1, "own interval"),
        ("--rule gauss-legendre --to inf", 1, "finite"),
        ("--rule gauss-legendre --from x", 2, "inf"),
        ("--rule gauss-jacobi --panels 3 --alpha 1", 1, "--panels"),
        ("--rule gauss", 1, "--weight"),
        ("--rule gauss --weight x", 1, "-"),
        ("--rule romberg", 1, "--integrate"),
        ("--rule triangle --degree 99", 1, "20"),
        ("--rule trapezoid --integrate 1/x --from 0 --to 1", 1, "node"),
        ("--integrate sine(x)", 1, "^^"),
        ("--integrate sqrt(x)", 1, "NaN"),
        ("--integrate x --tolerance 0", 1, "positive"),
        ("--integrate x --json no/such.json", 1, "no/such.json"),
    ];
    for (words, expected, told) in wrong {
        let (code, _, err) = quadrature(words);
        assert!(code == expected && err.contains(told), "{words}: {code}, {err}");
        assert!(!err.contains("panicked"), "{words}: {err}");
    }
}
