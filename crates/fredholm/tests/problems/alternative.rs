//! Equations where 1 is an eigenvalue, or close to one, or where an operator of norm 10 has none; and spectra.

use super::{Kernel, OfX, Problem};
use fredholm::equation::ByOffset;
use fredholm::equation::Class::{self, Kink, Logarithmic, Peaked, Smooth};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

const UNIT: [f64; 2] = [0.0, 1.0];

/// An equation whose homogeneous one has solutions.
pub struct Singular {
    pub id: &'static str,
    pub class: Class,
    pub interval: [f64; 2],
    pub kernel: Kernel<f64>,
    /// A basis of the null space of I − A, and one of its adjoint's.
    pub null: Vec<OfX<f64>>,
    pub adjoint: Vec<OfX<f64>>,
    /// A source f for which there are solutions, and one of them.
    pub solvable: [OfX<f64>; 2],
    /// One for which there are none.
    pub unsolvable: OfX<f64>,
}

pub fn singular() -> Vec<Singular> {
    vec![h01(), h02(), h05(), h20(), h21(), h22()]
}

fn h01() -> Singular {
    Singular {
        id: "H01",
        class: Smooth,
        interval: [0.0, PI],
        kernel: Box::new(|x: f64, y: f64| 2.0 / PI * (x - y).cos()),
        null: vec![Box::new(f64::cos), Box::new(f64::sin)],
        adjoint: vec![Box::new(f64::cos), Box::new(f64::sin)],
        solvable: [Box::new(|x| (3.0 * x).cos()), Box::new(|x| (3.0 * x).cos())],
        unsolvable: Box::new(|_| 3.0),
    }
}

fn h02() -> Singular {
    let f = |x: f64| 1.0 - 5.0 / 3.0 * x * x;
    Singular {
        id: "H02",
        class: Smooth,
        interval: UNIT,
        kernel: Box::new(|x: f64, y: f64| 4.0 * x * y * y),
        null: vec![Box::new(|x| x)],
        adjoint: vec![Box::new(|x| x * x)],
        solvable: [Box::new(f), Box::new(f)],
        unsolvable: Box::new(|_| 1.0),
    }
}

fn h05() -> Singular {
    Singular {
        id: "H05",
        class: Kink,
        interval: UNIT,
        kernel: Box::new(|x: f64, y: f64| PI * PI * x.min(y) * (1.0 - x.max(y))),
        null: vec![Box::new(|x| (PI * x).sin())],
        adjoint: vec![Box::new(|x| (PI * x).sin())],
        solvable: [Box::new(|x| (TAU * x).sin()), Box::new(|x| 4.0 / 3.0 * (TAU * x).sin())],
        unsolvable: Box::new(|x| (PI * x).sin()),
    }
}

/// The mean.
fn h20() -> Singular {
    Singular {
        id: "H20",
        class: Smooth,
        interval: UNIT,
        kernel: Box::new(|_: f64, _: f64| 1.0),
        null: vec![Box::new(|_| 1.0)],
        adjoint: vec![Box::new(|_| 1.0)],
        solvable: [Box::new(|x| (PI * x).cos()), Box::new(|x| (PI * x).cos())],
        unsolvable: Box::new(f64::exp),
    }
}

/// The logarithm on a circle, which takes cos nx to (1/n) cos nx.
fn h21() -> Singular {
    Singular {
        id: "H21",
        class: Logarithmic,
        interval: [0.0, TAU],
        kernel: Box::new(ByOffset(|_, _, offset: f64| (2.0 * (0.5 * offset).sin().abs()).ln() / -PI)),
        null: vec![Box::new(f64::cos), Box::new(f64::sin)],
        adjoint: vec![Box::new(f64::cos), Box::new(f64::sin)],
        solvable: [Box::new(|x| (3.0 * x).cos()), Box::new(|x| 1.5 * (3.0 * x).cos())],
        unsolvable: Box::new(|x| 1.0 + x.sin()),
    }
}

/// Held at 0, free at 1.
fn h22() -> Singular {
    Singular {
        id: "H22",
        class: Kink,
        interval: UNIT,
        kernel: Box::new(|x: f64, y: f64| FRAC_PI_2 * FRAC_PI_2 * x.min(y)),
        null: vec![Box::new(|x| (FRAC_PI_2 * x).sin())],
        adjoint: vec![Box::new(|x| (FRAC_PI_2 * x).sin())],
        solvable: [
            Box::new(|x| (3.0 * FRAC_PI_2 * x).sin()),
            Box::new(|x| 9.0 / 8.0 * (3.0 * FRAC_PI_2 * x).sin()),
        ],
        unsolvable: Box::new(|_| 1.0),
    }
}

/// One solution each, of equations that look as if there were none or many.
pub fn regular() -> Vec<Problem> {
    let e2 = |x: f64| 3.0_f64.sqrt() * (2.0 * x - 1.0);
    // 1 − λ for an eigenvalue λ of K = λ; a power of two, so that K is exact.
    let gap = 2.0_f64.powi(-20);
    vec![
        // Of norm 10 and spectral radius 0: Neumann's series ends after two terms.
        Problem::new("H04", Smooth, UNIT, move |_, y: f64| 10.0 * e2(y), e2, move |x| e2(x) + 10.0),
        Problem::new("H23", Smooth, UNIT, move |_, _| 1.0 - gap, move |_| gap, |_| 1.0),
    ]
}

/// φ − (1/π) ∫ d/(d² + (x − y)²) φ dy = 1/2π on [−1, 1]: bosons on a ring. No closed form; these numbers are known.
pub struct LiebLiniger;

impl LiebLiniger {
    pub const D: f64 = 0.0283;
    pub const CLASS: Class = Peaked;
    /// φ(0).
    pub const MIDDLE: f64 = 5.839_790_336_949_75;
    /// ∫ φ.
    pub const INTEGRAL: f64 = 9.359_477_864_015_18;

    pub fn kernel(x: f64, y: f64) -> f64 {
        Self::D / PI / (Self::D * Self::D + (x - y).powi(2))
    }

    pub fn source(_: f64) -> f64 {
        0.5 / PI
    }
}

/// An operator and its eigenvalues, largest first: the k-th, from k = 1, as often as it is one.
pub struct Spectrum {
    pub id: &'static str,
    pub class: Class,
    pub interval: [f64; 2],
    pub kernel: Kernel<f64>,
    pub eigenvalue: fn(u32) -> f64,
}

pub fn spectra() -> Vec<Spectrum> {
    vec![
        Spectrum {
            id: "H07",
            class: Kink,
            interval: UNIT,
            kernel: Box::new(|x: f64, y: f64| x.min(y)),
            eigenvalue: |k| ((f64::from(k) - 0.5) * PI).powi(-2),
        },
        Spectrum {
            id: "D04",
            class: Kink,
            interval: UNIT,
            kernel: Box::new(|x: f64, y: f64| x.min(y) * (1.0 - x.max(y))),
            eigenvalue: |k| (f64::from(k) * PI).powi(-2),
        },
        // cos nx and sin nx.
        Spectrum {
            id: "L05",
            class: Logarithmic,
            interval: [0.0, TAU],
            kernel: Box::new(ByOffset(|_, _, offset: f64| (2.0 * (0.5 * offset).sin().abs()).ln() / -PI)),
            eigenvalue: |k| 1.0 / f64::from(k.div_ceil(2)),
        },
    ]
}
