//! Half-lines and the whole line.

use super::Problem;
use fredholm::equation::Class::{Kink, Smooth};
use std::f64::consts::{E, FRAC_PI_2, PI};

const FROM_0: [f64; 2] = [0.0, f64::INFINITY];
const LINE: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

pub fn all() -> Vec<Problem> {
    [half_lines(), half_lines_bent(), lines()].into_iter().flatten().collect()
}

fn half_lines() -> Vec<Problem> {
    let peaks = |x: f64| 1.0 / ((x - 3.0).powi(2) + 0.5) + 1.0 / ((x - 9.0).powi(2) + 1.0 / 3.0);
    vec![
        Problem::new(
            "I01",
            Smooth,
            FROM_0,
            |x: f64, y: f64| 1.0 / (1.0 + x * x + y * y),
            |x| {
                let q = 1.0_f64.hypot(x);
                1.0 / (1.0 + x * x) - FRAC_PI_2 / (q * (1.0 + q))
            },
            |x| 1.0 / (1.0 + x * x),
        ),
        // ∫ e^{−y} f dy, to the digits that doubles have.
        Problem::new(
            "I02",
            Smooth,
            FROM_0,
            |_, y: f64| (1.0 - y).exp(),
            peaks,
            move |x| peaks(x) + E * I02_MEAN / (1.0 - E),
        ),
        Problem::new(
            "I20",
            Smooth,
            FROM_0,
            |x: f64, y: f64| (-x - y).exp(),
            |x| (-x).exp() / 2.0,
            |x| (-x).exp(),
        ),
        Problem::new(
            "I21",
            Smooth,
            FROM_0,
            |x: f64, y: f64| (-(x + 1.0) * y).exp() / 2.0,
            |x| (-x).exp() - 0.5 / (x + 2.0),
            |x| (-x).exp(),
        ),
        Problem::new(
            "I22",
            Smooth,
            [1.0, f64::INFINITY],
            |x: f64, y: f64| (x * y).powi(-2),
            |x| 1.0 / x - 0.5 / (x * x),
            |x| 1.0 / x,
        ),
        Problem::new(
            "I23",
            Smooth,
            [f64::NEG_INFINITY, 0.0],
            |x: f64, y: f64| (x + y).exp() / 2.0,
            |x| 1.0 - x.exp() / 2.0,
            |_| 1.0,
        ),
    ]
}

const I02_MEAN: f64 = 0.348_441_272_859_126;

/// e^{−|x − y|}/4.
fn half_lines_bent() -> Vec<Problem> {
    let kernel = |x: f64, y: f64| (-(x - y).abs()).exp() / 4.0;
    vec![
        Problem::new("I30", Kink, FROM_0, kernel, |x| 0.5 + (-x).exp() / 4.0, |_| 1.0),
        Problem::new("I31", Kink, FROM_0, kernel, |x| (-x).exp() * (0.875 - x / 4.0), |x| (-x).exp()),
    ]
}

fn lines() -> Vec<Problem> {
    let sech = |x: f64| 1.0 / x.cosh();
    vec![
        Problem::new(
            "I04",
            Smooth,
            LINE,
            |x: f64, y: f64| (-(x - y).powi(2)).exp() / 4.0,
            |x| (-x * x).exp() - FRAC_PI_2.sqrt() * (-x * x / 2.0).exp() / 4.0,
            |x| (-x * x).exp(),
        ),
        Problem::new(
            "I40",
            Smooth,
            LINE,
            |x: f64, y: f64| (-(x - y).powi(2)).exp() / 3.0,
            |x| (-x * x / 2.0).exp() - (PI / 1.5).sqrt() * (-x * x / 3.0).exp() / 3.0,
            |x| (-x * x / 2.0).exp(),
        ),
        Problem::new(
            "I41",
            Smooth,
            LINE,
            move |x: f64, y: f64| sech(x - y) / 4.0,
            move |x| sech(x) - 0.5 * if x == 0.0 { 1.0 } else { x / x.sinh() },
            sech,
        ),
        Problem::new(
            "I42",
            Smooth,
            LINE,
            |x: f64, y: f64| 0.25 / (1.0 + (x - y).powi(2)),
            |x| 1.0 / (1.0 + x * x) - FRAC_PI_2 / (4.0 + x * x),
            |x| 1.0 / (1.0 + x * x),
        ),
    ]
}
