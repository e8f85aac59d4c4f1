//! Equations whose solutions are known.

use fredholm::equation::{Answer, Complex64, Equation, Interval, LineKernel, Source};
use std::f64::consts::PI;

/// An equation on an interval, and its solution.
pub struct Problem {
    pub name: &'static str,
    pub equation: Equation<'static, f64>,
    pub exact: Box<dyn Fn(f64) -> f64>,
}

impl Problem {
    /// max |φ_n − φ| at 401 points.
    pub fn error(&self, answer: &Answer<'_, f64, f64>) -> f64 {
        let (a, b) = (self.equation.interval().a(), self.equation.interval().b());
        let at = |k: usize| a + (b - a) * k as f64 / 400.0;
        (0..=400).map(at).map(|x| (answer.at(&x) - (self.exact)(x)).abs()).fold(0.0, f64::max)
    }
}

pub fn on(a: f64, b: f64) -> Interval {
    Interval::new(a, b).unwrap()
}

fn problem(
    name: &'static str,
    (a, b): (f64, f64),
    kernel: impl LineKernel<f64> + 'static,
    exact: impl Fn(f64) -> f64 + 'static,
    source: impl Source<f64> + 'static,
) -> Problem {
    Problem { name, equation: Equation::new(on(a, b), kernel, source), exact: Box::new(exact) }
}

pub fn s01() -> Problem {
    let source = |x: f64| (-x).exp() - 0.5 + (-(x + 1.0)).exp() / 2.0;
    problem("S01", (0.0, 1.0), |x: f64, y: f64| (x + 1.0) * (-x * y).exp() / 2.0, |x| (-x).exp(), source)
}

/// Periodic.
pub fn s06() -> Problem {
    let kernel = |x: f64, y: f64| -0.3 / PI / (1.0 - 0.64 * (0.5 * (x + y)).cos().powi(2));
    let exact = |x: f64| 8.5 + 128.0 / 17.0 * (2.0 * x).cos();
    problem("S06", (-PI, PI), kernel, exact, |x: f64| 25.0 - 16.0 * x.sin().powi(2))
}

/// A system: K = ((x + y)/3 ; xy)(φ_1 + φ_2), φ = (x + 1, x² + 1).
pub fn y01() -> Equation<'static, f64> {
    let first = || -> Box<dyn LineKernel<f64>> { Box::new(|x: f64, y: f64| (x + y) / 3.0) };
    let second = || -> Box<dyn LineKernel<f64>> { Box::new(|x: f64, y: f64| x * y) };
    let sources: Vec<Box<dyn Source<f64>>> =
        vec![Box::new(|x| x / 18.0 + 17.0 / 36.0), Box::new(|x| x * x - 19.0 * x / 12.0 + 1.0)];
    Equation::system(on(0.0, 1.0), vec![first(), first(), second(), second()], sources).unwrap()
}

fn s04(c: f64) -> Problem {
    let exact = |x: f64| 0.06 - 0.8 * x + x * x;
    let source = move |x: f64| {
        let z1 = ((c * c + (1.0 - x).powi(2)) / (c * c + x * x)).ln();
        let z2 = ((1.0 - x) / c).atan() + (x / c).atan();
        exact(x) - 0.2 * (c + c * (x - 0.4) * z1 + (0.06 - c * c - 0.8 * x + x * x) * z2)
    };
    problem("S04", (0.0, 1.0), move |x: f64, y: f64| c / 5.0 / (c * c + (x - y).powi(2)), exact, source)
}

fn s09() -> Problem {
    let w = 2.0 * PI;
    let z = Complex64::new(1.0, w);
    let j = (z.exp() * (z - 1.0) + 1.0) / (z * z);
    let exact = |x: f64| x * x.exp();
    let source = move |x: f64| exact(x) + (w * x).sin() * j.re - (w * x).cos() * j.im;
    problem("S09", (0.0, 1.0), move |x: f64, y: f64| -(w * (x - y)).sin(), exact, source)
}

/// The smooth ones and those that bend on the diagonal.
pub fn all() -> Vec<Problem> {
    let unit = (0.0, 1.0);
    vec![
        s01(),
        problem("S02", unit, |x: f64, y: f64| x * y * y, |x| x * x, |x: f64| x * x - x / 5.0),
        problem(
            "S03",
            unit,
            |x: f64, y: f64| 1.0 / (1.0 + 2.0 * x + y),
            |x| x,
            |x: f64| x - 1.0 + (1.0 + 2.0 * x) * ((2.0 + 2.0 * x) / (1.0 + 2.0 * x)).ln(),
        ),
        s04(1.0),
        s04(0.1),
        s06(),
        problem(
            "S07",
            unit,
            |x: f64, y: f64| (x * y).exp() / 2.0,
            f64::exp,
            // (e^{x+1} − 1)/(x + 1) needs no care: x + 1 ≥ 1.
            |x: f64| x.exp() - ((x + 1.0).exp() - 1.0) / (2.0 * (x + 1.0)),
        ),
        s09(),
        problem(
            "S11",
            unit,
            |x: f64, y: f64| x.powi(3) * y.powi(4),
            |x| x.powf(2.5),
            |x: f64| x.powf(2.5) - x.powi(3) / 7.5,
        ),
        problem(
            "D01",
            unit,
            |x: f64, y: f64| -x.min(y) * (1.0 - x.max(y)),
            |x| (-x).exp() * x.sin(),
            |x: f64| {
                let e = 1_f64.exp();
                (-x).exp() * x.sin() - (x * (1.0 - 1_f64.cos() / e) - 1.0 + x.cos() * (-x).exp()) / 2.0
            },
        ),
        problem(
            "D03",
            unit,
            |x: f64, y: f64| (x - y).abs(),
            |x| x,
            |x: f64| -(2.0 * x.powi(3) - 9.0 * x + 2.0) / 6.0,
        ),
        problem(
            "D05",
            unit,
            |x: f64, y: f64| (-(x - y).abs()).exp() / 4.0,
            |_| 1.0,
            |x: f64| 1.0 - (2.0 - (-x).exp() - (x - 1.0).exp()) / 4.0,
        ),
    ]
}
