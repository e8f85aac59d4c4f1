//! Several unknowns, and complex ones.

use super::special::log_integral;
use super::{Borrowed, Kernel, OfX, Problem};
use fredholm::equation::Class::{Kink, Logarithmic, Smooth};
use fredholm::equation::{ByOffset, Complex64, Equation, Interval};
use std::f64::consts::E;

const UNIT: [f64; 2] = [0.0, 1.0];
const I: Complex64 = Complex64::I;

/// φ_a(x) − Σ_b ∫ K_ab(x, y) φ_b(y) dy = f_a(x) on [0, 1], with its solution.
pub struct System {
    pub id: &'static str,
    /// Row by row.
    pub kernels: Vec<Kernel<f64>>,
    pub sources: Vec<OfX<f64>>,
    pub exact: Vec<OfX<f64>>,
}

impl System {
    /// As a solver takes it.
    pub fn equation(&self) -> Equation<'_, f64> {
        let kernels = self.kernels.iter().map(|kernel| Box::new(Borrowed(&**kernel)) as _).collect();
        let sources = self.sources.iter().map(|source| Box::new(source) as _).collect();
        Equation::system(Interval::new(0.0, 1.0).unwrap(), kernels, sources).unwrap()
    }
}

pub fn systems() -> Vec<System> {
    vec![y01(), y20(), y21(), y22()]
}

fn y01() -> System {
    let sum = || Box::new(|x: f64, y: f64| (x + y) / 3.0);
    let product = || Box::new(|x: f64, y: f64| x * y);
    System {
        id: "Y01",
        kernels: vec![sum(), sum(), product(), product()],
        sources: vec![Box::new(|x| x / 18.0 + 17.0 / 36.0), Box::new(|x| x * x - 19.0 / 12.0 * x + 1.0)],
        exact: vec![Box::new(|x| x + 1.0), Box::new(|x| x * x + 1.0)],
    }
}

/// Four different kernels.
fn y20() -> System {
    System {
        id: "Y20",
        kernels: vec![
            Box::new(|x: f64, y: f64| x * y / 2.0),
            Box::new(|x: f64, y: f64| (x + y) / 2.0),
            Box::new(|x: f64, y: f64| (x - y).exp() / 2.0),
            Box::new(|_: f64, _: f64| -0.5),
        ],
        sources: vec![Box::new(|x| x / 3.0 - 0.25), Box::new(|x| 1.5 - x.exp() * (0.5 - 1.0 / E))],
        exact: vec![Box::new(|x| x), Box::new(|_| 1.0)],
    }
}

/// K_ab = (x + a y + b)/12, φ_b = x^{b − 1}; a, b = 1, 2, 3.
fn y21() -> System {
    let kernel = |(a, b): (i32, i32)| -> Kernel<f64> {
        Box::new(move |x: f64, y: f64| (x + f64::from(a) * y + f64::from(b)) / 12.0)
    };
    let source = |a: i32| -> OfX<f64> {
        let term = move |x: f64, b: f64| ((x + b) / b + f64::from(a) / (b + 1.0)) / 12.0;
        Box::new(move |x| x.powi(a - 1) - (1..=3).map(|b| term(x, f64::from(b))).sum::<f64>())
    };
    System {
        id: "Y21",
        kernels: (1..=3).flat_map(|a| (1..=3).map(move |b| (a, b))).map(kernel).collect(),
        sources: (1..=3).map(source).collect(),
        exact: (1..=3).map(|a| Box::new(move |x: f64| x.powi(a - 1)) as _).collect(),
    }
}

/// A kernel of each class; φ = (1, 1).
fn y22() -> System {
    System {
        id: "Y22",
        kernels: vec![
            Box::new(ByOffset(|_, _, offset: f64| offset.abs().ln() / 2.0)),
            Box::new(|x: f64, y: f64| x * y),
            Box::new(|x: f64, y: f64| (x - y).abs()),
            Box::new(|x: f64, y: f64| (-(x - y).abs()).exp() / 2.0),
        ],
        sources: vec![
            Box::new(|x| 1.0 - log_integral(&[1.0], x, UNIT) / 2.0 - x / 2.0),
            Box::new(|x| ((-x).exp() + (x - 1.0).exp() - x * x - (1.0 - x).powi(2)) / 2.0),
        ],
        exact: vec![Box::new(|_| 1.0), Box::new(|_| 1.0)],
    }
}

pub fn complex() -> Vec<Problem<Complex64>> {
    let wave = |k: f64, x: f64| Complex64::from_polar(1.0, k * x);
    vec![
        Problem::new(
            "S12",
            Smooth,
            UNIT,
            move |x: f64, y: f64| wave(1.0, x - y) * 0.5,
            move |x| wave(1.0, x) * 0.5,
            move |x| wave(1.0, x),
        ),
        Problem::new(
            "C20",
            Smooth,
            UNIT,
            move |x: f64, y: f64| wave(1.0, x * y),
            // (e^{ix} − 1)/(ix) = e^{ix/2} sin(x/2)/(x/2).
            move |x| 1.0 - wave(0.5, x) * super::special::sinc(x / 2.0),
            |_| 1.0.into(),
        ),
        Problem::new(
            "C21",
            Smooth,
            UNIT,
            move |x: f64, y: f64| wave(20.0, x - y) * I * 0.5,
            move |x| (1.0 - 0.5 * I) * wave(20.0, x),
            move |x| wave(20.0, x),
        ),
        // Waves from both sides: Helmholtz's equation, k = 5.
        Problem::new(
            "C22",
            Kink,
            UNIT,
            move |x: f64, y: f64| wave(5.0, (x - y).abs()) * I,
            move |x| 1.0 - (wave(5.0, x) + wave(5.0, 1.0 - x) - 2.0) / 5.0,
            |_| 1.0.into(),
        ),
        Problem::new(
            "C23",
            Logarithmic,
            UNIT,
            ByOffset(|_, _, offset: f64| Complex64::new(0.3, 0.4) * offset.abs().ln()),
            |x| {
                let integral =
                    Complex64::new(log_integral(&[0.0, 1.0], x, UNIT), log_integral(&[1.0], x, UNIT));
                Complex64::new(x, 1.0) - Complex64::new(0.3, 0.4) * integral
            },
            |x| Complex64::new(x, 1.0),
        ),
    ]
}
