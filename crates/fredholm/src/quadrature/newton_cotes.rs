//! ω_j = ½ ∫_{−1}^{1} L_j: Newton–Cotes, the integral of the polynomial through equidistant points (paper, §4.2, (4.11)).

use super::{Quadrature, QuadratureError, check_size, gauss_legendre};

/// Above this rank the weights, though each is right to thirteen digits, add up to 1e14 times the length in absolute
/// value: no digit would be left of a sum. Up to rank 17 they are right to the last.
const MOST: usize = 64;

/// Newton–Cotes of rank `rank` on [a, b]: rank + 1 equidistant nodes with both ends; exact for degree `rank`, and one more
/// when that is even (theorem 4.2). Trapezoid, Simpson, 3/8, Boole, …; from rank 8 on some weights are negative.
///
/// # Errors
///
/// When the rank is 0 or above 64.
pub fn newton_cotes(rank: usize, a: f64, b: f64) -> Result<Quadrature<f64>, QuadratureError> {
    check_size("Newton–Cotes", rank, 1, MOST)?;
    Ok(equidistant(rank + 1, 0, rank as i128, a, b))
}

/// Open Newton–Cotes with `n` nodes on [a, b]: they divide it into n + 1 parts, the ends left out. n = 1 is the midpoint
/// rule; exact for degree n − 1, and one more when that is even.
///
/// # Errors
///
/// When n is 0 or above 64.
pub fn newton_cotes_open(n: usize, a: f64, b: f64) -> Result<Quadrature<f64>, QuadratureError> {
    check_size("open Newton–Cotes", n, 1, MOST)?;
    Ok(equidistant(n, -1, n as i128, a, b))
}

/// The rule that integrates the polynomial through nodes 0 … n − 1 from `from` to `to`, on [a, b].
fn equidistant(n: usize, from: i128, to: i128, a: f64, b: f64) -> Quadrature<f64> {
    let parts = (to - from) as f64;
    let gauss = gauss_legendre(n.div_ceil(2), from as f64, to as f64);
    let weight = |j: usize| exact(n, j, from, to).unwrap_or_else(|| gauss.integrate(|s| lagrange(n, j, *s)));
    let half: Vec<f64> = (0..n.div_ceil(2)).map(|j| (b - a) / parts * weight(j)).collect();
    let node = |j: usize| a + (b - a) * ((j as f64 - from as f64) / parts);
    Quadrature {
        nodes: (0..n).map(|j| if j as i128 == to { b } else { node(j) }).collect(),
        weights: (0..n).map(|j| half[j.min(n - 1 - j)]).collect(),
    }
}

/// (4.9) as a product: no sum, so in an integral by Gauss's rule nothing cancels but what the integral itself does.
fn lagrange(n: usize, j: usize, s: f64) -> f64 {
    (0..n).filter(|k| *k != j).map(|k| (s - k as f64) / (j as f64 - k as f64)).product()
}

/// ∫ L_j in whole numbers, over the least common denominator; `None` where 128 bits are too few, from 19 nodes or so.
fn exact(n: usize, j: usize, from: i128, to: i128) -> Option<f64> {
    let mut coefficients: Vec<i128> = vec![1];
    let mut below: i128 = 1;
    for k in (0..n).filter(|k| *k != j) {
        let (root, distance) = (k as i128, j as i128 - k as i128);
        below = below.checked_mul(distance)?;
        // Times s − root, lowest power first.
        coefficients.push(0);
        for i in (0..coefficients.len()).rev() {
            let lower = if i == 0 { 0 } else { coefficients[i - 1] };
            coefficients[i] = lower.checked_sub(root.checked_mul(coefficients[i])?)?;
        }
    }
    let common = (1..=n as i128).fold(1, |common, k| common / gcd(common, k) * k);
    let mut sum: i128 = 0;
    for (i, c) in coefficients.iter().enumerate() {
        let power = i as u32 + 1;
        let span = to.checked_pow(power)?.checked_sub(from.checked_pow(power)?)?;
        sum = sum.checked_add(c.checked_mul(span)?.checked_mul(common / i128::from(power))?)?;
    }
    Some(sum as f64 / (below.checked_mul(common)?) as f64)
}

fn gcd(a: i128, b: i128) -> i128 {
    if b == 0 { a } else { gcd(b, a % b) }
}
