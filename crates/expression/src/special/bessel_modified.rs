//! I_ν(x) and K_ν(x), of any real order: the decaying and the growing solutions of x² w″ + x w′ − (x² + ν²) w = 0
//! (DLMF chapter 10; K by N. M. Temme, J. Comput. Phys. 19 (1975)).

use super::reciprocal_gamma::ReciprocalGamma;
use super::{HIGHEST_ORDER, turn};
use std::f64::consts::{FRAC_2_PI, PI};

/// I_ν(x) for x ≥ 0, and for x < 0 where ν is an integer.
pub(crate) fn bessel_i(order: f64, x: f64) -> f64 {
    if x.is_nan() || order.is_nan() || order.abs() > HIGHEST_ORDER {
        return f64::NAN;
    }
    if order.fract() == 0.0 {
        let odd = order.rem_euclid(2.0) == 1.0;
        let size = growing(order.abs(), x.abs());
        return if odd && x < 0.0 { -size } else { size };
    }
    match x {
        x if x < 0.0 => f64::NAN,
        x if order < 0.0 => growing(-order, x) - FRAC_2_PI * turn(order).1 * bessel_k(order, x),
        x => growing(order, x),
    }
}

/// I_ν(x) for ν, x ≥ 0.
fn growing(order: f64, x: f64) -> f64 {
    if x > 30.0_f64.max(0.5 * order * order) {
        return asymptotic(order, x);
    }
    // (x/2)^ν/Γ(ν+1) Σ (x²/4)^k/(k! (ν+1)_k): all terms are positive
    let quarter = 0.25 * x * x;
    let (mut sum, mut term) = (1.0, 1.0);
    for k in 1..100_000 {
        let k = f64::from(k);
        term *= quarter / (k * (order + k));
        sum += term;
        if term <= 0.1 * f64::EPSILON * sum {
            break;
        }
    }
    leading(order, x) * sum
}

/// (x/2)^ν/Γ(ν + 1).
pub(super) fn leading(order: f64, x: f64) -> f64 {
    let direct = (0.5 * x).powf(order) / libm::tgamma(order + 1.0);
    if order < 170.0 && direct.is_normal() {
        return direct;
    }
    if x == 0.0 {
        return if order == 0.0 { 1.0 } else { 0.0 };
    }
    (order * (0.5 * x).ln() - libm::lgamma(order + 1.0)).exp()
}

/// e^x/√(2πx) Σ_k (−1)^k a_k(ν)/x^k, DLMF 10.40.1.
fn asymptotic(order: f64, x: f64) -> f64 {
    let (mut sum, mut term) = (1.0, 1.0);
    for k in 1..60 {
        let odd = f64::from(2 * k - 1);
        let ratio = -(2.0 * order - odd) * (2.0 * order + odd) / (8.0 * x * f64::from(k));
        if ratio.abs() >= 1.0 && odd > 2.0 * order {
            break; // it diverges from here
        }
        term *= ratio;
        sum += term;
        if term.abs() <= 0.1 * f64::EPSILON * sum.abs() {
            break;
        }
    }
    // in halves: e^x overflows before I does
    (0.5 * x).exp() / (2.0 * PI * x).sqrt() * (0.5 * x).exp() * sum
}

/// K_ν(x) for x > 0, even in ν; infinite at 0.
pub(crate) fn bessel_k(order: f64, x: f64) -> f64 {
    if x.is_nan() || x < 0.0 || order.is_nan() || order.abs() > HIGHEST_ORDER {
        return f64::NAN;
    }
    if x == 0.0 {
        return f64::INFINITY;
    }
    let order = order.abs();
    let steps = (order + 0.5).floor();
    let lowest = order - steps;
    let (mut k, mut next) = if x <= 2.0 { series(lowest, x) } else { continued_fraction(lowest, x) };
    for step in 1..=steps as u32 {
        (k, next) = (next, k + 2.0 * (lowest + f64::from(step)) / x * next);
        if k.is_infinite() {
            return k; // the next step would make it NaN
        }
    }
    k
}

/// K_μ(x) and K_{μ+1}(x) for |μ| ≤ ½, x ≤ 2: Temme's series.
fn series(order: f64, x: f64) -> (f64, f64) {
    let gamma = ReciprocalGamma::new(order);
    let log = -(0.5 * x).ln();
    let e = order * log;
    let scale = gamma.reflection;
    let sinh_ratio = if e.abs() < f64::EPSILON { 1.0 } else { e.sinh() / e };
    let mut f = scale * (gamma.odd * e.cosh() + gamma.even * sinh_ratio * log);
    let (mut p, mut q) = (0.5 * e.exp() / gamma.plus, 0.5 * (-e).exp() / gamma.minus);
    let (mut sum, mut next, mut c) = (f, p, 1.0);
    for k in 1..100 {
        let k = f64::from(k);
        f = (k * f + p + q) / (k * k - order * order);
        c *= 0.25 * x * x / k;
        p /= k - order;
        q /= k + order;
        sum += c * f;
        next += c * (p - k * f);
        if (c * f).abs() < 0.1 * f64::EPSILON * sum.abs() {
            break;
        }
    }
    (sum, next * 2.0 / x)
}

/// K_μ(x) and K_{μ+1}(x) for |μ| ≤ ½, x > 2: Steed's continued fraction with Temme's sum.
fn continued_fraction(order: f64, x: f64) -> (f64, f64) {
    let first = 0.25 - order * order;
    let mut b = 2.0 * (1.0 + x);
    let mut d = 1.0 / b;
    let (mut h, mut change) = (d, d);
    let (mut before, mut now) = (0.0, 1.0);
    let (mut q, mut c, mut a) = (first, first, -first);
    let mut sum = 1.0 + q * change;
    for k in 2..500 {
        let k = f64::from(k);
        a -= 2.0 * (k - 1.0);
        c = -a * c / k;
        (before, now) = (now, (before - b * now) / a);
        q += c * now;
        b += 2.0;
        d = 1.0 / (b + a * d);
        change *= b * d - 1.0;
        h += change;
        sum += q * change;
        if (q * change / sum).abs() < 0.1 * f64::EPSILON {
            break;
        }
    }
    let k = (PI / (2.0 * x)).sqrt() * (-x).exp() / sum;
    (k, k * (order + x + 0.5 - first * h) / x)
}
