//! Kernels with a bend or a jump on the diagonal: Green's functions, Volterra's.

use super::Problem;
use fredholm::equation::Class::{Jump, Kink};
use std::f64::consts::{E, PI};

const UNIT: [f64; 2] = [0.0, 1.0];

pub fn all() -> Vec<Problem> {
    [reference(), greens_functions(), exponentials(), powers(), jumps()].into_iter().flatten().collect()
}

/// Those of the literature.
fn reference() -> Vec<Problem> {
    // −min(x, y)(b − max(x, y)) on [0, b].
    let damped = |id, b: f64| {
        let exact = |x: f64| (-x).exp() * x.sin();
        let source =
            move |x: f64| exact(x) - (x * (1.0 - b.cos() * (-b).exp()) - b + b * x.cos() * (-x).exp()) / 2.0;
        Problem::new(id, Kink, [0.0, b], move |x: f64, y: f64| -x.min(y) * (b - x.max(y)), source, exact)
    };
    vec![
        damped("D01", 1.0),
        damped("D02", 5.0),
        Problem::new(
            "D03",
            Kink,
            UNIT,
            |x: f64, y: f64| (x - y).abs(),
            |x| -(2.0 * x.powi(3) - 9.0 * x + 2.0) / 6.0,
            |x| x,
        ),
        Problem::new(
            "D04",
            Kink,
            UNIT,
            |x: f64, y: f64| x.min(y) * (1.0 - x.max(y)),
            |x| (1.0 - 1.0 / (PI * PI)) * (PI * x).sin(),
            |x| (PI * x).sin(),
        ),
        Problem::new(
            "D05",
            Kink,
            UNIT,
            |x: f64, y: f64| (-(x - y).abs()).exp() / 4.0,
            |x| 1.0 - (2.0 - (-x).exp() - (x - 1.0).exp()) / 4.0,
            |_| 1.0,
        ),
    ]
}

fn greens_functions() -> Vec<Problem> {
    let k = 5.0_f64;
    vec![
        // Free at the left end, held at the right one; and the other way round.
        Problem::new(
            "D20",
            Kink,
            UNIT,
            |x: f64, y: f64| x.max(y) / 2.0,
            |x| x - x.powi(3) / 12.0 - 1.0 / 6.0,
            |x| x,
        ),
        Problem::new(
            "D21",
            Kink,
            UNIT,
            |x: f64, y: f64| -2.0 * x.min(y),
            |x| 2.0 - x.exp() + 2.0 * E * x,
            f64::exp,
        ),
        // −u″ − k²u, held at both ends.
        Problem::new(
            "D22",
            Kink,
            UNIT,
            move |x: f64, y: f64| 2.0 * (k * x.min(y)).sin() * (k * (1.0 - x.max(y))).sin() / (k * k.sin()),
            move |x| (1.0 - 2.0 / (PI * PI - k * k)) * (PI * x).sin(),
            |x| (PI * x).sin(),
        ),
    ]
}

fn exponentials() -> Vec<Problem> {
    // s e^{−k|x − y|}, φ = 1.
    let flat = |id, s: f64, k: f64| {
        let source = move |x: f64| 1.0 - s / k * (2.0 - (-k * x).exp() - (k * (x - 1.0)).exp());
        Problem::new(id, Kink, UNIT, move |x: f64, y: f64| s * (-k * (x - y).abs()).exp(), source, |_| 1.0)
    };
    vec![
        flat("D30 k=10", 3.0, 10.0),
        flat("D30 k=100", 20.0, 100.0),
        Problem::new(
            "D31",
            Kink,
            UNIT,
            |x: f64, y: f64| 2.0 * (-10.0 * (x - y).abs()).exp(),
            |x| {
                let left = (x.exp() - (-10.0 * x).exp()) / 11.0;
                let right = (x.exp() - (10.0 * x - 9.0).exp()) / 9.0;
                x.exp() - 2.0 * (left + right)
            },
            f64::exp,
        ),
    ]
}

fn powers() -> Vec<Problem> {
    let [a, b] = [-1.0_f64, 2.0_f64];
    vec![
        Problem::new(
            "D40",
            Kink,
            UNIT,
            |x: f64, y: f64| (x - y).abs().powi(3),
            |x| {
                let z = 1.0 - x;
                1.0 + x - (1.0 + x) * (x.powi(4) + z.powi(4)) / 4.0 - (z.powi(5) - x.powi(5)) / 5.0
            },
            |x| 1.0 + x,
        ),
        Problem::new(
            "D41",
            Kink,
            [a, b],
            |x: f64, y: f64| -(x - y).abs() / 2.0,
            move |x| (a.cos() + b.cos() - (x - a) * a.sin() + (b - x) * b.sin()) / 2.0,
            f64::cos,
        ),
    ]
}

fn jumps() -> Vec<Problem> {
    vec![
        Problem::new(
            "J20",
            Jump,
            UNIT,
            |x: f64, y: f64| if y < x { 1.0 } else { -1.0 },
            |x| x - x * x + 0.5,
            |x| x,
        ),
        Problem::new("J21", Jump, UNIT, |x: f64, y: f64| if y < x { 1.0 } else { 0.0 }, |_| 1.0, f64::exp),
        Problem::new(
            "J22",
            Jump,
            UNIT,
            |x: f64, y: f64| if y < x { (x - y).cos() } else { 2.0 * x * y },
            |x| 1.0 - x.sin() - x + x.powi(3),
            |_| 1.0,
        ),
        Problem::new(
            "J23",
            Jump,
            UNIT,
            |x: f64, y: f64| if y < x { (x - y).exp() } else { -1.0 },
            |x| 2.0 * x - x.exp_m1() + (1.0 - x * x) / 2.0,
            |x| x,
        ),
    ]
}
