//! Kernels that have many derivatives, gentle and steep.

use super::Problem;
use super::special::{erf, exp_mean, sinc, x_ln};
use fredholm::equation::Class::{Peaked, Smooth};
use std::f64::consts::{E, PI, SQRT_2};

const UNIT: [f64; 2] = [0.0, 1.0];

pub fn all() -> Vec<Problem> {
    [reference(), lorentzians(), gentle(), oscillating(), steep(), rough_solutions()]
        .into_iter()
        .flatten()
        .collect()
}

/// Those of the literature.
fn reference() -> Vec<Problem> {
    vec![
        Problem::new(
            "S01",
            Smooth,
            UNIT,
            |x: f64, y: f64| (x + 1.0) * (-x * y).exp() / 2.0,
            |x| (-x).exp() - 0.5 + (-(x + 1.0)).exp() / 2.0,
            |x| (-x).exp(),
        ),
        Problem::new("S02", Smooth, UNIT, |x: f64, y: f64| x * y * y, |x| x * x - x / 5.0, |x| x * x),
        Problem::new(
            "S03",
            Smooth,
            UNIT,
            |x: f64, y: f64| 1.0 / (1.0 + 2.0 * x + y),
            |x| x - 1.0 + (1.0 + 2.0 * x) * (1.0 / (1.0 + 2.0 * x)).ln_1p(),
            |x| x,
        ),
        Problem::new(
            "S07",
            Smooth,
            UNIT,
            |x: f64, y: f64| (x * y).exp() / 2.0,
            |x| x.exp() - exp_mean(x + 1.0) / 2.0,
            f64::exp,
        ),
        Problem::new(
            "S08",
            Smooth,
            [0.0, PI],
            |x: f64, y: f64| 0.3 * (x - y).cos(),
            |_| 3.0,
            |x| 3.0 + 1.8 * x.sin() / (1.0 - 0.15 * PI),
        ),
        s09(),
        Problem::new(
            "S11",
            Smooth,
            UNIT,
            |x: f64, y: f64| x.powi(3) * y.powi(4),
            |x| x.powf(2.5) - x.powi(3) / 7.5,
            |x| x.powf(2.5),
        ),
    ]
}

fn s09() -> Problem {
    let w = 2.0 * PI;
    // J = ∫ y e^{zy} dy with z = 1 + iw, so that e^z = e.
    let square = (1.0 + w * w).powi(2);
    // (e(z − 1) + 1) z̄² / |z|⁴, z − 1 = iw, z̄² = 1 − w² − 2iw.
    let (re, im) = ((1.0 - w * w) + 2.0 * E * w * w, E * w * (1.0 - w * w) - 2.0 * w);
    Problem::new(
        "S09",
        Smooth,
        UNIT,
        move |x: f64, y: f64| -(w * (x - y)).sin(),
        move |x| x * x.exp() + ((w * x).sin() * re - (w * x).cos() * im) / square,
        |x| x * x.exp(),
    )
}

/// (c/5)/(c² + (x − y)²): the electrostatics of parallel disks.
fn lorentzians() -> Vec<Problem> {
    let s04 = |id, class, c: f64| {
        let exact = |x: f64| 0.06 - 0.8 * x + x * x;
        let source = move |x: f64| {
            let z1 = ((c * c + (1.0 - x).powi(2)) / (c * c + x * x)).ln();
            let z2 = ((1.0 - x) / c).atan() + (x / c).atan();
            exact(x) - (c + c * (x - 0.4) * z1 + (0.06 - c * c - 0.8 * x + x * x) * z2) / 5.0
        };
        let kernel = move |x: f64, y: f64| c / 5.0 / (c * c + (x - y).powi(2));
        Problem::new(id, class, UNIT, kernel, source, exact)
    };
    vec![s04("S04 c=1", Smooth, 1.0), s04("S04 c=.1", Peaked, 0.1), s04("S04 c=.01", Peaked, 0.01)]
}

fn gentle() -> Vec<Problem> {
    let [ln2x, e] = [|x: f64| x_ln(2.0 + x), |x: f64| x_ln(1.0 + x)];
    vec![
        // Of norm 5.
        Problem::new(
            "S20",
            Smooth,
            UNIT,
            |x: f64, y: f64| 5.0 * (x * y).cos(),
            |x| 1.0 - 5.0 * sinc(x),
            |_| 1.0,
        ),
        Problem::new(
            "S21",
            Smooth,
            UNIT,
            |x: f64, y: f64| 3.0 * (x * y).exp(),
            |x| (-x).exp() - 3.0 * exp_mean(x - 1.0),
            |x| (-x).exp(),
        ),
        // Of rank two and three.
        Problem::new(
            "S22",
            Smooth,
            UNIT,
            |x: f64, y: f64| 1.0 + 2.0 * x * y,
            |x| x * x - 1.0 / 3.0 - x / 2.0,
            |x| x * x,
        ),
        Problem::new(
            "S23",
            Smooth,
            UNIT,
            |x: f64, y: f64| x * y - 3.0 * (x * y).powi(2) + (PI * x).cos(),
            |x| x.exp() - x + 3.0 * (E - 2.0) * x * x - (E - 1.0) * (PI * x).cos(),
            f64::exp,
        ),
        Problem::new(
            "S24",
            Smooth,
            UNIT,
            |x: f64, y: f64| (1.0 + x + y).powi(-2),
            |x| 1.0 - 1.0 / ((1.0 + x) * (2.0 + x)),
            |_| 1.0,
        ),
        Problem::new(
            "S25",
            Smooth,
            UNIT,
            |x: f64, y: f64| (1.0 + x + y).ln(),
            move |x| 2.0 - ln2x(x) + e(x),
            |_| 1.0,
        ),
        Problem::new(
            "S26",
            Smooth,
            [-3.0, 4.0],
            |x: f64, y: f64| ((x - y) / 5.0).cosh() / 10.0,
            |x| 1.0 - (((x + 3.0) / 5.0).sinh() + ((4.0 - x) / 5.0).sinh()) / 2.0,
            |_| 1.0,
        ),
    ]
}

fn oscillating() -> Vec<Problem> {
    // ∫ y cos ky and ∫ y sin ky on [0, 1].
    let k = 50.0_f64;
    let (c, s) = (k.sin() / k + (k.cos() - 1.0) / (k * k), -k.cos() / k + k.sin() / (k * k));
    vec![
        Problem::new(
            "S30",
            Smooth,
            UNIT,
            |x: f64, y: f64| (20.0 * x * y).cos(),
            |x| 1.0 + x - 2.0 * sinc(20.0 * x) + sinc(10.0 * x).powi(2) / 2.0,
            |x| 1.0 + x,
        ),
        Problem::new(
            "S31",
            Smooth,
            UNIT,
            move |x: f64, y: f64| (k * (x - y)).sin(),
            move |x| x - (k * x).sin() * c + (k * x).cos() * s,
            |x| x,
        ),
    ]
}

fn steep() -> Vec<Problem> {
    // 3 e^{−(x − y)²/2w²}, φ = 1 + x.
    let gauss = |id, w: f64| {
        let bell = move |t: f64| (-t * t / (2.0 * w * w)).exp();
        let source = move |x: f64| {
            let integral = w * (PI / 2.0).sqrt() * (erf(x / (SQRT_2 * w)) + erf((1.0 - x) / (SQRT_2 * w)));
            (1.0 + x) - 3.0 * ((1.0 + x) * integral + w * w * (bell(x) - bell(1.0 - x)))
        };
        Problem::new(id, Peaked, UNIT, move |x: f64, y: f64| 3.0 * bell(x - y), source, |x| 1.0 + x)
    };
    vec![
        gauss("S40 w=.05", 0.05),
        gauss("S40 w=.01", 0.01),
        // Steep at one y, for all x.
        Problem::new(
            "S41",
            Peaked,
            UNIT,
            |x: f64, y: f64| 0.01 * x.cos() / 5.0 / ((y - 0.3).powi(2) + 1e-4),
            |x| 1.0 - x.cos() / 5.0 * (70.0_f64.atan() + 30.0_f64.atan()),
            |_| 1.0,
        ),
        // The solution is steep, the kernel is not.
        Problem::new(
            "S42",
            Smooth,
            [-1.0, 1.0],
            |x: f64, y: f64| (1.0 + x * y) / 2.0,
            |x| 1.0 / (1.0 + 25.0 * x * x) - 5.0_f64.atan() / 5.0,
            |x| 1.0 / (1.0 + 25.0 * x * x),
        ),
    ]
}

/// Smooth kernels whose solutions are not smooth at the ends, because the source is not.
fn rough_solutions() -> Vec<Problem> {
    let root = |x: f64| x.powf(1.5) * (1.0 - x).sqrt();
    vec![
        Problem::new(
            "S50",
            Smooth,
            UNIT,
            |x: f64, y: f64| x * y,
            move |x| root(x) - x * 5.0 * PI / 128.0,
            root,
        ),
        Problem::new("S51", Smooth, UNIT, |x: f64, y: f64| 1.0 + x * y, |x| x_ln(x) + 0.25 + x / 9.0, x_ln),
        Problem::new(
            "S52",
            Smooth,
            UNIT,
            |x: f64, y: f64| (x + y) / 2.0,
            |x| x.sqrt() - x / 3.0 - 0.2,
            f64::sqrt,
        ),
    ]
}
