//! Kernels that are infinite on the diagonal, or have no second derivative there: ln|x − y|, |x − y|^α, Abel's.

use super::Problem;
use super::special::{li2, log_integral, power_integral, x_ln};
use fredholm::equation::ByOffset;
use fredholm::equation::Class::{Algebraic, Logarithmic};
use std::f64::consts::PI;

const UNIT: [f64; 2] = [0.0, 1.0];

pub fn all() -> Vec<Problem> {
    [logarithms(), logarithms_and_more(), powers(), powers_and_more(), abel()].into_iter().flatten().collect()
}

/// s ln|x − y| with a polynomial for φ, of the coefficients c.
fn log_of(id: &'static str, interval: [f64; 2], s: f64, c: &'static [f64]) -> Problem {
    Problem::new(
        id,
        Logarithmic,
        interval,
        ByOffset(move |_, _, offset: f64| s * offset.abs().ln()),
        move |x| polynomial(c, x) - s * log_integral(c, x, interval),
        |x| polynomial(c, x),
    )
}

/// s |x − y|^α with a polynomial for φ, of the coefficients c.
fn power_of(id: &'static str, interval: [f64; 2], s: f64, alpha: f64, c: &'static [f64]) -> Problem {
    Problem::new(
        id,
        Algebraic { exponent: alpha },
        interval,
        ByOffset(move |_, _, offset: f64| s * offset.abs().powf(alpha)),
        move |x| polynomial(c, x) - s * power_integral(alpha, c, x, interval),
        |x| polynomial(c, x),
    )
}

fn polynomial(c: &[f64], x: f64) -> f64 {
    c.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

fn logarithms() -> Vec<Problem> {
    vec![
        log_of("L01", UNIT, 1.0, &[1.0]),
        log_of("L20", UNIT, 1.0, &[0.0, 1.0]),
        log_of("L21", [2.0, 5.0], -0.5, &[1.0, 0.0, 1.0]),
        // All of it on a thousandth of a unit.
        log_of("L22", [0.0, 1e-3], 100.0, &[1.0, 1000.0]),
    ]
}

fn logarithms_and_more() -> Vec<Problem> {
    vec![
        Problem::new(
            "L04",
            Logarithmic,
            UNIT,
            ByOffset(|_, _, offset: f64| offset.abs().ln()),
            |x| x_ln(x) - log_of_x_ln(x),
            x_ln,
        ),
        Problem::new(
            "L23",
            Logarithmic,
            UNIT,
            ByOffset(|_, _, offset: f64| offset.abs().ln() / 2.0),
            |x| x.sqrt() - log_of_root(x) / 2.0,
            f64::sqrt,
        ),
        // Smooth factors and terms.
        Problem::new(
            "L24",
            Logarithmic,
            UNIT,
            ByOffset(|x: f64, y, offset: f64| ((1.0 + x * y) * offset.abs().ln() + x.exp() * y) / 2.0),
            |x| 1.0 - (log_integral(&[1.0, x], x, UNIT) + x.exp() / 2.0) / 2.0,
            |_| 1.0,
        ),
        Problem::new(
            "L25",
            Logarithmic,
            [-1.0, 1.0],
            ByOffset(|_, y: f64, offset: f64| -(2.0 + y) * offset.abs().ln() / 4.0),
            |x| x * x + log_integral(&[0.0, 0.0, 2.0, 1.0], x, [-1.0, 1.0]) / 4.0,
            |x| x * x,
        ),
    ]
}

/// ∫₀¹ ln|x − y| y ln y dy.
fn log_of_x_ln(x: f64) -> f64 {
    if x == 0.0 {
        return 0.25;
    }
    // Re Li₂(1/x) = π²/3 − ½ ln² x − Li₂(x).
    let p = -0.25 - x + x * x * (PI * PI / 3.0 - x.ln().powi(2) / 2.0 - li2(x));
    // (1 − x²) ln(1 − x) is 0 at 1.
    -(1.0 + x) * x_ln(1.0 - x) / 4.0 - p / 2.0 + (0.5 + x - x * x_ln(x)) / 4.0
}

/// ∫₀¹ ln|x − y| √y dy.
fn log_of_root(x: f64) -> f64 {
    let root = x.sqrt();
    // 1 − √x = (1 − x)/(1 + √x), and 1 − x√x = (1 − √x)(1 + √x + x).
    let left = (1.0 + root + x) * x_ln((1.0 - x) / (1.0 + root));
    2.0 / 3.0 * (left + (1.0 + x * root) * root.ln_1p()) - 4.0 / 9.0 - 4.0 / 3.0 * x
}

fn powers() -> Vec<Problem> {
    vec![
        power_of("A02", UNIT, 0.1, -1.0 / 3.0, &[0.0, 0.0, 1.0, -2.0, 1.0]),
        power_of("A05", [-1.0, 1.0], 0.2, -0.5, &[0.0, 0.0, 1.0]),
        power_of("A20", UNIT, 0.25, -0.5, &[1.0]),
        power_of("A21", UNIT, 0.3, -0.25, &[0.0, 0.0, 1.0]),
        power_of("A22", UNIT, 0.02, -0.8, &[1.0, 1.0]),
        power_of("A23", UNIT, 1.0, 0.5, &[0.0, 1.0, -1.0]),
        power_of("A24", [-2.0, 3.0], -0.3, 1.5, &[1.0, 0.5]),
    ]
}

fn powers_and_more() -> Vec<Problem> {
    vec![
        Problem::new(
            "A30",
            Algebraic { exponent: -0.5 },
            UNIT,
            ByOffset(|x: f64, y: f64, offset: f64| 0.2 * (1.0 + x * y) / offset.abs().sqrt() - y),
            |x| x - 0.2 * power_integral(-0.5, &[0.0, 1.0, x], x, UNIT) + 1.0 / 3.0,
            |x| x,
        ),
        Problem::new(
            "A31",
            Algebraic { exponent: -0.5 },
            UNIT,
            ByOffset(|_, _, offset: f64| 0.2 / offset.abs().sqrt()),
            |x| x.sqrt() - 0.2 * inverse_root_of_root(x),
            f64::sqrt,
        ),
    ]
}

/// ∫₀¹ |x − y|^{−1/2} √y dy.
fn inverse_root_of_root(x: f64) -> f64 {
    let rest = (1.0 - x).sqrt();
    let logarithm = if x == 0.0 { 0.0 } else { x * ((1.0 + rest).ln() - x.ln() / 2.0) };
    PI / 2.0 * x + rest + logarithm
}

/// s (x − y)^{−1/2} for y < x, and 0 for y > x.
fn abel() -> Vec<Problem> {
    let kernel =
        |s: f64| ByOffset(move |_, _, offset: f64| if offset < 0.0 { s / (-offset).sqrt() } else { 0.0 });
    let class = Algebraic { exponent: -0.5 };
    vec![
        Problem::new("B20", class, UNIT, kernel(0.5), |x| 1.0 - x.sqrt(), |_| 1.0),
        Problem::new("B21", class, UNIT, kernel(1.0), |x| x - 4.0 / 3.0 * x * x.sqrt(), |x| x),
        Problem::new("B22", class, UNIT, kernel(1.0), |x| x.sqrt() - PI / 2.0 * x, f64::sqrt),
    ]
}
