//! Kernels of x − y on a circle, or periodic in both: smooth, steep, logarithmic.

use super::Problem;
use fredholm::equation::ByOffset;
use fredholm::equation::Class::{Logarithmic, Periodic};
use std::f64::consts::{PI, TAU};

const CIRCLE: [f64; 2] = [0.0, TAU];

pub fn all() -> Vec<Problem> {
    // .7 (1 − r²)/(1 − 2r cos(x − y) + r²)/2π takes cos nx to .7 r^n cos nx.
    let poisson = |id, r: f64| {
        // The denominator (1 − r)² + 4r sin²((x − y)/2) does not cancel.
        let kernel = move |x: f64, y: f64| {
            let sine = (0.5 * (x - y)).sin();
            0.7 * (1.0 - r * r) / ((1.0 - r).powi(2) + 4.0 * r * sine * sine) / TAU
        };
        let source = move |x: f64| 0.6 + (1.0 - 0.7 * r.powi(3)) * (3.0 * x).cos();
        Problem::new(id, Periodic, CIRCLE, kernel, source, |x| 2.0 + (3.0 * x).cos())
    };
    // −(1/2π) ln(4 sin²((x − y)/2)) takes cos nx to (1/n) cos nx, and 1 to 0.
    let log = |offset: f64| (2.0 * (0.5 * offset).sin().abs()).ln() / -PI;
    vec![
        Problem::new(
            "S06",
            Periodic,
            [-PI, PI],
            |x: f64, y: f64| -0.3 / PI / (1.0 - 0.64 * (0.5 * (x + y)).cos().powi(2)),
            |x| 25.0 - 16.0 * x.sin().powi(2),
            |x| 8.5 + 128.0 / 17.0 * (2.0 * x).cos(),
        ),
        poisson("P20 r=.5", 0.5),
        poisson("P20 r=.95", 0.95),
        Problem::new(
            "L05",
            Logarithmic,
            CIRCLE,
            ByOffset(move |_, _, offset| log(offset)),
            |x| 2.0 / 3.0 * (3.0 * x).cos(),
            |x| (3.0 * x).cos(),
        ),
        Problem::new(
            "P21",
            Logarithmic,
            CIRCLE,
            ByOffset(move |_, _, offset| -2.0 * log(offset)),
            |x| 1.0 + 2.0 * (2.0 * x).sin() + 1.4 * (5.0 * x).cos(),
            |x| 1.0 + (2.0 * x).sin() + (5.0 * x).cos(),
        ),
        Problem::new(
            "P22",
            Logarithmic,
            CIRCLE,
            ByOffset(move |_, _, offset: f64| offset.cos() * log(offset)),
            |x| 0.75 * x.cos() + 0.625 * (3.0 * x).sin(),
            |x| x.cos() + (3.0 * x).sin(),
        ),
    ]
}
