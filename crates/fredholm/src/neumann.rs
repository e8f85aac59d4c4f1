//! u = Σ_k (ρF)^k f: the Neumann series, whose k-th term is the k-th bounce of light (paper, §1.2.1).

use crate::value::Value;

/// The estimated sum of the terms of the Neumann series that follow a residual r, if F were the weighted mean:
/// r̄ / (1 − ρ̄), a value per channel. Added as ρ_i times that, it is the *ambient term* of progressive radiosity.
///
/// `weights` are the measures of the elements. Where the mean of ρ is 1 or more there is no estimate, and the answer is 0.
pub fn estimated_rest<V: Value>(residual: &[V], coefficient: &[V], weights: &[f64]) -> V {
    let mean = |values: &[V]| {
        let total: f64 = weights.iter().sum();
        values.iter().zip(weights).fold(V::splat(0.0), |sum, (v, w)| sum + *v * (w / total))
    };
    let one_minus_rho = (V::splat(1.0) - mean(coefficient)).map(|x| if x > 0.0 { x } else { f64::INFINITY });
    mean(residual) / one_minus_rho
}
