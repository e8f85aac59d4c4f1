//! Li₂(x) = −∫₀ˣ ln|1 − t|/t dt, the real part of the dilogarithm where x > 1 (DLMF §25.12(i)).

use std::f64::consts::PI;

/// B_{2k}/(2k + 1)! for k = 1, 2, …
const COEFFICIENTS: [f64; 9] = [
    0.027777777777777776,
    -0.0002777777777777778,
    4.72411186696901e-06,
    -9.185773074661964e-08,
    1.8978869988971e-09,
    -4.0647616451442256e-11,
    8.921691020456452e-13,
    -1.9939295860721074e-14,
    4.518980029619918e-16,
];

/// The argument is carried into [−1, ½], where the series takes nine terms.
pub(crate) fn li2(x: f64) -> f64 {
    const ZETA_2: f64 = PI * PI / 6.0;
    match x {
        x if x.is_nan() => x,
        x if x == f64::INFINITY => f64::NEG_INFINITY,
        x if x > 2.0 => 2.0 * ZETA_2 - 0.5 * x.ln().powi(2) - series(1.0 / x),
        1.0 => ZETA_2,
        x if x > 0.5 => ZETA_2 - x.ln() * (1.0 - x).abs().ln() - series(1.0 - x),
        x if x < -1.0 => -ZETA_2 - 0.5 * (-x).ln().powi(2) - series(1.0 / x),
        x => series(x),
    }
}

/// Li₂(x) = u − u²/4 + Σ_k B_{2k} u^{2k+1}/(2k+1)! with u = −ln(1 − x), for −1 ≤ x ≤ ½.
fn series(x: f64) -> f64 {
    let u = -(-x).ln_1p();
    let square = u * u;
    let sum = COEFFICIENTS.iter().rev().fold(0.0, |sum, coefficient| sum * square + coefficient);
    u - 0.25 * square + u * square * sum
}
