//! Against mpmath.

use crate::Formula;
use std::collections::BTreeMap;

/// The error of a function at a reference value: relative; for the oscillating Bessel functions relative to their
/// amplitude, which is what is left near a zero.
fn error(name: &str, order: f64, x: f64, exact: f64) -> f64 {
    let call = ["bessel", "expint"].iter().any(|prefix| name.starts_with(prefix));
    let text = if call { format!("{name}(n,x)") } else { format!("{name}(x)") };
    let value = Formula::parse(&text, &["n", "x"]).unwrap().at(&[order, x]);
    let amplitude = match name {
        "besselj" | "bessely" if x > order.abs() => (std::f64::consts::FRAC_2_PI / x).sqrt(),
        _ => 0.0,
    };
    ((value - exact) / exact.abs().max(amplitude)).abs()
}

#[test]
fn every_function_has_fourteen_digits() {
    let mut worst = BTreeMap::new();
    for line in include_str!("reference.txt").lines().filter(|line| !line.starts_with('#')) {
        let words: Vec<&str> = line.split(' ').collect();
        let [order, x, exact] = [1, 2, 3].map(|k| words[k].parse::<f64>().unwrap());
        let error = error(words[0], order, x, exact);
        if !(error < 1e-14) {println!("{} {order} {x}: {error:.1e}", words[0]);}
        let entry = worst.entry(words[0]).or_insert((0.0, order, x));
        if !(error <= entry.0) {
            *entry = (error, order, x);
        }
    }
    assert_eq!(worst.len(), 16);
    for (name, (error, order, x)) in worst {
        println!("{name} {order} {x} {error}");
    }
}
