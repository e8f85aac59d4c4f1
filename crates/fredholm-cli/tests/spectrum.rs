//! `fredholm spectrum`: eigenvalues and eigenfunctions.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the message, in its helpers too")]

mod run;

use run::{folder, fredholm_with, json, names, text};
use std::f64::consts::PI;
use std::fs;

#[test]
fn the_brownian_kernel_has_its_eigenvalues_and_eigenfunctions() {
    let folder = folder("spectrum_brownian");
    let words = ["spectrum", "--kernel", "min(x,y)", "--count", "5", "--at", "0,0.5,1", "--json", "-"];
    let output = fredholm_with(&folder, &words);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let report = json(&output.stdout);
    assert_eq!(report["eigenvalues"].as_array().unwrap().len(), 5);
    for k in 0..5 {
        let frequency = (k as f64 + 0.5) * PI;
        let value = report["eigenvalues"][k][0].as_f64().unwrap();
        let estimate = report["error_estimates"][k].as_f64().unwrap();
        let error = (value - frequency.powi(-2)).abs();
        assert!(error < 1e-11 && error <= estimate, "{k}: {value}, wrong by {error}, estimated {estimate}");
        // sin ωx, up to a factor.
        let modulus = |j: usize| {
            let [re, im] = [0, 1].map(|part| report["eigenfunctions"][k][j][part].as_f64().unwrap());
            re.hypot(im)
        };
        let ratio = modulus(1) / modulus(2);
        assert!((ratio - (frequency / 2.0).sin().abs()).abs() < 1e-8 && modulus(0) < 1e-8, "{k}: {ratio}");
    }
    let distance = report["distance_to_spectrum"].as_f64().unwrap();
    assert!((distance - (1.0 - 4.0 / (PI * PI))).abs() < 1e-10, "{distance}");
}

#[test]
fn table_and_files() {
    let folder = folder("spectrum_files");
    let words = ["spectrum", "--kernel", "min(x,y)", "--count", "3", "--csv", "a.csv", "--plot", "a.svg"];
    let output = fredholm_with(&folder, &words);
    let table = text(&output.stdout);
    assert!(table.contains("0.40528473") && table.contains("error estimate"), "{table}");
    assert_eq!(names(&folder), ["a.csv", "a.svg"]);
    assert!(fs::read_to_string(folder.join("a.csv")).unwrap().starts_with("x,phi1_re,phi1_im,phi2_re"));
    assert!(fs::read_to_string(folder.join("a.svg")).unwrap().contains("φ3"));
}
