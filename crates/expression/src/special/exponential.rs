//! E_n(x) = ∫₁^∞ e^{−xt}/tⁿ dt and Ei(x) = −⨍_{−x}^∞ e^{−t}/t dt (DLMF chapters 6 and 8.19).

const EULER: f64 = 0.577_215_664_901_532_9;

/// E_n(x) for n = 0, 1, 2, … and x ≥ 0.
pub(crate) fn expint(n: f64, x: f64) -> f64 {
    if !(n >= 0.0 && n.fract() == 0.0 && n <= super::HIGHEST_ORDER && x >= 0.0) {
        return f64::NAN;
    }
    match x {
        _ if n == 0.0 => (-x).exp() / x,
        0.0 => 1.0 / (n - 1.0), // infinite for n = 1
        x if x > 1.0 => continued_fraction(n, x),
        x => series(n, x),
    }
}

/// e^{−x} (1/(x + n −) 1·n/(x + n + 2 −) 2(n + 1)/(x + n + 4 −) …), DLMF 8.19.17 contracted, by Lentz's method.
fn continued_fraction(n: f64, x: f64) -> f64 {
    let mut b = x + n;
    let mut c = f64::INFINITY;
    let mut d = 1.0 / b;
    let mut h = d;
    // at x = 1 it takes some eighty terms
    for k in 1..500 {
        let k = f64::from(k);
        let a = -k * (n - 1.0 + k);
        b += 2.0;
        d = 1.0 / (a * d + b);
        c = b + a / c;
        let change = c * d;
        h *= change;
        if (change - 1.0).abs() <= f64::EPSILON {
            break;
        }
    }
    h * (-x).exp()
}

/// (−x)^{n−1}/(n−1)! (ψ(n) − ln x) − Σ_{k≠n−1} (−x)^k/(k! (k − n + 1)), DLMF 8.19.8, for x ≤ 1.
fn series(n: f64, x: f64) -> f64 {
    let mut sum = 0.0;
    let mut term = 1.0; // (−x)^k / k!
    for k in 0..30 + n as u32 {
        let k = f64::from(k);
        if k == n - 1.0 {
            sum += term * (digamma(n) - x.ln());
        } else {
            sum -= term / (k - n + 1.0);
        }
        term *= -x / (k + 1.0);
        if term.abs() < 1e-20 * sum.abs() && (k >= n || term.abs() < 1e-30) {
            break;
        }
    }
    sum
}

/// ψ(n) = −γ + 1 + 1/2 + … + 1/(n − 1).
fn digamma(n: f64) -> f64 {
    (1..n as u32).rev().map(|k| 1.0 / f64::from(k)).sum::<f64>() - EULER
}

/// Ei(x), the principal value for x > 0; −E₁(−x) for x < 0.
pub(crate) fn ei(x: f64) -> f64 {
    match x {
        x if x < 0.0 => -expint(1.0, -x),
        0.0 => f64::NEG_INFINITY,
        x if x > 40.0 => asymptotic(x),
        x => EULER + x.ln() + ei_series(x),
    }
}

/// Σ_k x^k/(k k!).
fn ei_series(x: f64) -> f64 {
    let mut sum = 0.0;
    let mut power = 1.0;
    for k in 1..200 {
        power *= x / f64::from(k);
        let term = power / f64::from(k);
        sum += term;
        if term <= 0.1 * f64::EPSILON * sum {
            break;
        }
    }
    sum
}

/// e^x/x Σ_k k!/x^k, to its smallest term: below 10⁻¹⁶ from x = 40 on.
fn asymptotic(x: f64) -> f64 {
    let mut sum = 1.0;
    let mut term = 1.0;
    for k in 1..40 {
        term *= f64::from(k) / x;
        sum += term;
        if term < 0.1 * f64::EPSILON {
            break;
        }
    }
    // in halves: e^x overflows before e^x/x does
    (0.5 * x).exp() / x * (0.5 * x).exp() * sum
}
