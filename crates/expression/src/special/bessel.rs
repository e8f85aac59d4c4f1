//! J_ν(x) and Y_ν(x), of any real order: the solutions of x² w″ + x w′ + (x² − ν²) w = 0 (DLMF chapter 10).
//!
//! Integer orders are those of the C library. Others: power series and Temme's series for small x, Hankel's
//! asymptotic expansion for large x, between them Miller's recurrence with Steed's continued fraction.

use super::bessel_modified::leading;
use super::reciprocal_gamma::ReciprocalGamma;
use super::{HIGHEST_ORDER, turn};
use num_complex::Complex;
use std::f64::consts::{FRAC_2_PI, PI};

/// J_ν(x) for x ≥ 0, and for x < 0 where ν is an integer.
pub(crate) fn bessel_j(order: f64, x: f64) -> f64 {
    if order.is_nan() || order.abs() > HIGHEST_ORDER {
        return f64::NAN;
    }
    if order.fract() == 0.0 {
        return libm::jn(order as i32, x);
    }
    match x {
        x if x.is_nan() || x < 0.0 => f64::NAN,
        x if order < 0.0 => {
            let (cos, sin) = turn(order);
            // J_{−ν} = cos νπ J_ν − sin νπ Y_ν, where a zero factor takes away an infinite Y
            weighted(cos, j(-order, x)) + weighted(sin, y(-order, x))
        }
        x => j(order, x),
    }
}

/// Y_ν(x) for x ≥ 0; infinite at 0.
pub(crate) fn bessel_y(order: f64, x: f64) -> f64 {
    if order.is_nan() || order.abs() > HIGHEST_ORDER {
        return f64::NAN;
    }
    if order.fract() == 0.0 {
        return libm::yn(order as i32, x);
    }
    match x {
        x if x.is_nan() || x < 0.0 => f64::NAN,
        x if order < 0.0 => {
            let (cos, sin) = turn(order);
            weighted(cos, y(-order, x)) - weighted(sin, j(-order, x))
        }
        x => y(order, x),
    }
}

fn weighted(weight: f64, value: f64) -> f64 {
    if weight == 0.0 { 0.0 } else { weight * value }
}

/// J_ν(x) for ν > 0, no integer, x ≥ 0.
fn j(order: f64, x: f64) -> f64 {
    match x {
        x if is_far(order, x) => hankel(order, x).re,
        // the terms fall from the first on, so that none is larger than the sum
        x if x < 2.0 || x * x < 2.0 * (order + 1.0) => leading(order, x) * power_series(order, x),
        x => miller(order, x)[0],
    }
}

/// Y_ν(x) for ν > 0, no integer, x ≥ 0.
fn y(order: f64, x: f64) -> f64 {
    if x == 0.0 {
        return f64::NEG_INFINITY;
    }
    if is_far(order, x) {
        return hankel(order, x).im;
    }
    let steps = if x < 2.0 { (order + 0.5).floor() } else { order.floor() };
    let lowest = order - steps;
    let (mut y, mut next) = if x < 2.0 { temme(lowest, x) } else { steed(lowest, x) };
    for step in 1..=steps as u32 {
        (y, next) = (next, 2.0 * (lowest + f64::from(step)) / x * next - y);
        if y.is_infinite() {
            return y; // the next step would make it NaN
        }
    }
    y
}

/// Whether Hankel's expansion has all digits.
fn is_far(order: f64, x: f64) -> bool {
    x > 25.0_f64.max(0.5 * order * order)
}

/// Σ_k (−x²/4)^k/(k! (ν + 1)_k).
fn power_series(order: f64, x: f64) -> f64 {
    let quarter = -0.25 * x * x;
    let (mut sum, mut term) = (1.0_f64, 1.0_f64);
    for k in 1..200 {
        let k = f64::from(k);
        term *= quarter / (k * (order + k));
        sum += term;
        if term.abs() <= 0.1 * f64::EPSILON * sum.abs() {
            break;
        }
    }
    sum
}

/// J_ν + i Y_ν = √(2/πx) e^{i(x − νπ/2 − π/4)} Σ_k i^k a_k(ν)/x^k, DLMF 10.17.5.
fn hankel(order: f64, x: f64) -> Complex<f64> {
    let (mut sum, mut term) = (Complex::ONE, Complex::<f64>::ONE);
    for k in 1..60 {
        let odd = f64::from(2 * k - 1);
        let ratio = (2.0 * order - odd) * (2.0 * order + odd) / (8.0 * x * f64::from(k));
        if ratio.abs() >= 1.0 && odd > 2.0 * order {
            break; // it diverges from here
        }
        term *= Complex::new(0.0, ratio);
        sum += term;
        if term.l1_norm() <= 0.1 * f64::EPSILON {
            break;
        }
    }
    // the phase by its parts: x − νπ/2 − π/4 would round x's last digits away
    let (cos, sin) = turn(0.5 * order + 0.25);
    (FRAC_2_PI / x).sqrt() * Complex::cis(x) * Complex::new(cos, -sin) * sum
}

/// J_ν(x), and J_μ(x), J_{μ+1}(x) with μ the fraction of ν, by Miller's downward recurrence from where J vanishes,
/// with the norm Σ_k (μ + 2k) Γ(μ + k)/k! J_{μ+2k} = (x/2)^μ (DLMF 10.23.15).
fn miller(order: f64, x: f64) -> [f64; 3] {
    let lowest = order.fract();
    let steps = order.floor() as usize;
    let start = 2 * ((order.max(x) + 12.0 * x.cbrt().max(3.0)) / 2.0) as usize + 20;
    let mut weights = Weights::new(lowest, start / 2);
    let (mut above, mut here) = (0.0_f64, 1e-280_f64);
    let (mut norm, mut wanted, mut second) = (0.0, 0.0, 0.0);
    for k in (0..=start).rev() {
        // here = J_{μ+k} up to a factor
        if k % 2 == 0 {
            norm += weights.previous() * here;
        }
        if k == steps {
            wanted = here;
        }
        if k == 1 {
            second = here;
        }
        if k > 0 {
            (above, here) = (here, 2.0 * (lowest + k as f64) / x * here - above);
        }
        if here.abs() > 1e250 {
            [above, here, norm, wanted].iter_mut().for_each(|value| *value *= 1e-250);
        }
    }
    let scale = (0.5 * x).powf(lowest) / norm;
    [wanted * scale, here * scale, second * scale]
}

/// The weights (μ + 2k) Γ(μ + k)/k!, from a large k down to 0.
struct Weights {
    order: f64,
    k: usize,
    /// Γ(μ + k)/k!
    ratio: f64,
}

impl Weights {
    fn new(order: f64, last: usize) -> Self {
        let ratio =
            (0..last).fold(libm::tgamma(order), |ratio, k| ratio * (order + k as f64) / (k + 1) as f64);
        Weights { order, k: last, ratio }
    }

    fn previous(&mut self) -> f64 {
        let weight = (self.order + 2.0 * self.k as f64) * self.ratio;
        if self.k > 0 {
            self.ratio *= self.k as f64 / (self.order + (self.k - 1) as f64);
            self.k -= 1;
        }
        weight
    }
}

/// Y_μ(x) and Y_{μ+1}(x) for |μ| ≤ ½, x ≤ 2: Temme's series.
fn temme(order: f64, x: f64) -> (f64, f64) {
    let gamma = ReciprocalGamma::new(order);
    let log = -(0.5 * x).ln();
    let e = order * log;
    let sinh_ratio = if e.abs() < f64::EPSILON { 1.0 } else { e.sinh() / e };
    let mut f = FRAC_2_PI * gamma.reflection * (gamma.odd * e.cosh() + gamma.even * sinh_ratio * log);
    let (mut p, mut q) = (e.exp() / (gamma.plus * PI), (-e).exp() / (gamma.minus * PI));
    let half = 0.5 * PI * order;
    let sin_ratio = if half.abs() < f64::EPSILON { 1.0 } else { half.sin() / half };
    let r = PI * half * sin_ratio * sin_ratio;
    let (mut sum, mut next, mut c) = (f + r * q, p, 1.0);
    for k in 1..100 {
        let k = f64::from(k);
        f = (k * f + p + q) / (k * k - order * order);
        c *= -0.25 * x * x / k;
        p /= k - order;
        q /= k + order;
        let term = c * (f + r * q);
        sum += term;
        next += c * p - k * term;
        if term.abs() < 0.1 * f64::EPSILON * (1.0 + sum.abs()) {
            break;
        }
    }
    (-sum, -next * 2.0 / x)
}

/// Y_μ(x) and Y_{μ+1}(x) for 0 < μ < 1, x ≥ 2, from J and (J′ + iY′)/(J + iY) = p + iq, Steed's continued fraction.
fn steed(order: f64, x: f64) -> (f64, f64) {
    let [_, j, j_next] = miller(order, x);
    let ratio = logarithmic_derivative(order, x);
    let j_slope = order / x * j - j_next;
    let y = (ratio.re * j - j_slope) / ratio.im;
    let y_slope = ratio.im * j + ratio.re * y;
    (y, order / x * y - y_slope)
}

/// p + iq = −1/2x + i + (i/x) a₁/(2(x + i) + a₂/(2(x + 2i) + …)), a_k = (k − ½)² − μ², by Lentz's method.
fn logarithmic_derivative(order: f64, x: f64) -> Complex<f64> {
    let partial = |k: f64| ((k - 0.5).powi(2) - order * order, Complex::new(2.0 * x, 2.0 * k));
    let (a, b) = partial(1.0);
    let mut d = b.inv();
    let mut c = Complex::new(1e150, 0.0); // as good as infinite
    let mut fraction = a * d;
    for k in 2..1000 {
        let (a, b) = partial(f64::from(k));
        d = (b + a * d).inv();
        c = b + a / c;
        let change = c * d;
        fraction *= change;
        if (change - 1.0).l1_norm() < f64::EPSILON {
            break;
        }
    }
    Complex::new(-0.5 / x, 1.0) + Complex::new(0.0, 1.0 / x) * fraction
}
