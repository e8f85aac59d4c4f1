//! √sinθ P_n(cosθ) = √(z/z′) J₀(νz), ν = n + ½: Legendre's polynomial is Bessel's function of a stretched angle z(θ).
//!
//! Both functions obey u″ = −(…)u; they do so together when
//! 1 + ε/(4 sin²θ) = z′² + ε z′²/(4z²) + (ε/2) {z, θ}, with ε = ν⁻² and Schwarz's derivative {z, θ} = z‴/z′ − (3/2)(z″/z′)².
//! So z = θ(1 + ε y₁(θ²) + ε² y₂(θ²) + …), and each y_m follows from those before it. With it the roots and weights of
//! Gauss's rule come without iteration, as in I. Bogaert, *Iteration-free computation of Gauss–Legendre quadrature nodes
//! and weights*, 2014, whose tabulated functions are these series.

use std::sync::OnceLock;

/// Powers of ε: at n = 50 the next one is below 1e-17.
const ORDERS: usize = 6;
/// Powers of θ²: the series converge as (θ/π)², so that at π/2 the last is 1e-19 times a power of the order.
const POWERS: usize = 34;

/// Σ_{m, j} c[m][j] ε^m θ^(2j).
#[derive(Clone, Debug)]
struct Series([[f64; POWERS]; ORDERS]);

impl Series {
    fn zero() -> Self {
        Self([[0.0; POWERS]; ORDERS])
    }

    fn one() -> Self {
        let mut one = Self::zero();
        one.0[0][0] = 1.0;
        one
    }

    /// Each coefficient times a factor of its power j.
    fn scaled(&self, factor: impl Fn(f64) -> f64) -> Self {
        let mut out = self.clone();
        for row in &mut out.0 {
            row.iter_mut().enumerate().for_each(|(j, c)| *c *= factor(j as f64));
        }
        out
    }

    /// Multiplied by θ^(2 by), or divided when `by` is −1 (the constant term must then be nought).
    fn shifted(&self, by: i32) -> Self {
        let mut out = Self::zero();
        for (to, from) in out.0.iter_mut().zip(&self.0) {
            match by {
                1 => to[1..].copy_from_slice(&from[..POWERS - 1]),
                _ => to[..POWERS - 1].copy_from_slice(&from[1..]),
            }
        }
        out
    }

    fn plus(&self, other: &Self, factor: f64) -> Self {
        let mut out = self.clone();
        for (to, from) in out.0.iter_mut().zip(&other.0) {
            to.iter_mut().zip(from).for_each(|(to, from)| *to += factor * from);
        }
        out
    }

    fn times(&self, other: &Self) -> Self {
        let mut out = Self::zero();
        for m in 0..ORDERS {
            for i in 0..=m {
                for j in 0..POWERS {
                    out.0[m][j] += (0..=j).map(|k| self.0[i][k] * other.0[m - i][j - k]).sum::<f64>();
                }
            }
        }
        out
    }

    /// 1/self, for a constant term of 1, by Newton's method.
    fn reciprocal(&self) -> Self {
        let mut inverse = Self::one();
        // Each step doubles the number of right terms in m + j, which is at most 39.
        for _ in 0..6 {
            let defect = Self::one().plus(&self.times(&inverse), -1.0);
            inverse = inverse.plus(&inverse.times(&defect), 1.0);
        }
        inverse
    }
}

/// y = z/θ as a series.
fn stretch() -> Series {
    let mut sine = Series::zero();
    let mut term = 1.0;
    for j in 0..POWERS {
        sine.0[0][j] = term;
        term /= -((2 * j + 2) as f64 * (2 * j + 3) as f64);
    }
    let cosecant = sine.reciprocal();
    let cosecant = cosecant.times(&cosecant);
    let mut y = Series::one();
    for m in 1..ORDERS {
        let right = right_hand_side(&y, &cosecant);
        // 1 = z′² + …: what is missing at order m is −2 times the derivative of the new term.
        for j in 0..POWERS {
            y.0[m][j] = -0.5 * right.0[m][j] / (2 * j + 1) as f64;
        }
    }
    y
}

/// z′² + ε (z′² θ²/z² − θ²/sin²θ)/(4θ²) + (ε/2) {z, θ}, with z = θ y.
fn right_hand_side(y: &Series, cosecant: &Series) -> Series {
    let first = y.scaled(|j| 2.0 * j + 1.0);
    // z″ = θ · second, z‴ = third.
    let second = y.scaled(|j| (2.0 * j + 1.0) * 2.0 * j).shifted(-1);
    let third = y.scaled(|j| (2.0 * j + 1.0) * 2.0 * j * (2.0 * j - 1.0)).shifted(-1);
    let over_first = first.reciprocal();
    let bend = second.times(&over_first);
    let schwarz = third.times(&over_first).plus(&bend.times(&bend).shifted(1), -1.5);
    let ratio = first.times(&y.reciprocal());
    let potential = ratio.times(&ratio).plus(cosecant, -1.0).shifted(-1);
    let mut by_epsilon = potential.scaled(|_| 0.25).plus(&schwarz, 0.5);
    by_epsilon.0.rotate_right(1);
    by_epsilon.0[0] = [0.0; POWERS];
    first.times(&first).plus(&by_epsilon, 1.0)
}

/// z(θ) for one n.
#[derive(Clone, Debug)]
pub(super) struct Phase {
    /// z/θ in powers of θ², highest first.
    powers: [f64; POWERS],
}

impl Phase {
    /// For ν = n + ½.
    pub(super) fn new(nu: f64) -> Self {
        static STRETCH: OnceLock<Series> = OnceLock::new();
        let series = STRETCH.get_or_init(stretch);
        let epsilon = 1.0 / (nu * nu);
        let mut powers = [0.0; POWERS];
        for (k, power) in powers.iter_mut().enumerate() {
            *power = (0..ORDERS).rev().fold(0.0, |sum, m| sum * epsilon + series.0[m][POWERS - 1 - k]);
        }
        Self { powers }
    }

    /// (z, z′) at θ in [0, π/2].
    pub(super) fn at(&self, theta: f64) -> (f64, f64) {
        let square = theta * theta;
        let (mut y, mut slope) = (0.0, 0.0);
        for c in self.powers {
            slope = slope * square + y;
            y = y * square + c;
        }
        (theta * y, y + 2.0 * square * slope)
    }

    /// (θ, z′(θ)) where z(θ) = z.
    pub(super) fn inverse(&self, z: f64) -> (f64, f64) {
        // z − θ is below ε/10 and its slope below ε/2: Newton's second step is exact.
        let (value, slope) = self.at(z);
        let theta = z - (value - z) / slope;
        let (value, slope) = self.at(theta);
        (theta - (value - z) / slope, slope)
    }
}
