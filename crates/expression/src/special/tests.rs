//! Against mpmath.

use crate::Formula;
use std::f64::consts::FRAC_2_PI;

/// The error of a function at a reference value: relative; for the oscillating Bessel functions relative to their
/// amplitude, which is what is left near a zero.
fn error(name: &str, order: f64, x: f64, exact: f64) -> f64 {
    let of_order = name.starts_with("bessel") || name == "expint";
    let text = if of_order { format!("{name}(n,x)") } else { format!("{name}(x)") };
    let value = Formula::parse(&text, &["n", "x"]).unwrap().at(&[order, x]);
    let oscillates = matches!(name, "besselj" | "bessely") && x > order.abs();
    let amplitude = if oscillates { (FRAC_2_PI / x).sqrt() } else { 0.0 };
    ((value - exact) / exact.abs().max(amplitude)).abs()
}

#[test]
fn every_function_has_fourteen_digits() {
    for line in include_str!("reference.txt").lines().filter(|line| !line.starts_with('#')) {
        let words: Vec<&str> = line.split(' ').collect();
        let [order, x, exact] = [1, 2, 3].map(|k| words[k].parse::<f64>().unwrap());
        let error = error(words[0], order, x, exact);
        assert!(error < 1e-14, "{} of order {order} at {x}: {error:.1e}", words[0]);
    }
}

/// At the ends of their domains.
#[test]
fn limits_are_limits() {
    let value = |text: &str| Formula::parse(text, &[]).unwrap().at(&[]);
    for (text, expected) in [
        ("ellipk(1)", f64::INFINITY),
        ("ellipe(1)", 1.0),
        ("ellipe(-1)", 1.0),
        ("expint(1,0)", f64::INFINITY),
        ("expint(3,0)", 0.5),
        ("expint(1,800)", 0.0),
        ("ei(0)", f64::NEG_INFINITY),
        ("li2(0)", 0.0),
        ("besselj(0,0)", 1.0),
        ("besselj(0.5,0)", 0.0),
        ("besselj(-0.5,0)", f64::INFINITY),
        ("bessely(0.5,0)", f64::NEG_INFINITY),
        ("bessely(-0.5,0)", 0.0),
        ("besselj(100.5,1e-10)", 0.0),
        ("bessely(100.5,1e-10)", f64::NEG_INFINITY),
        ("besseli(0,0)", 1.0),
        ("besseli(0.5,0)", 0.0),
        ("besseli(1,-1)+besseli(1,1)", 0.0),
        ("besselj(1,-1)+besselj(1,1)", 0.0),
        ("besselk(0,0)", f64::INFINITY),
        ("besselk(100.5,1e-10)", f64::INFINITY),
        ("besselk(0,1000)", 0.0),
        ("erfc(40)", 0.0),
        ("gamma(200)", f64::INFINITY),
    ] {
        assert_eq!(value(text), expected, "{text}");
    }
}
