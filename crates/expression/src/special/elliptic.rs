//! K(k) = ∫₀^{π/2} dθ/√(1 − k² sin²θ) and E(k) = ∫₀^{π/2} √(1 − k² sin²θ) dθ, of the *modulus* k, by the
//! arithmetic-geometric mean (DLMF §19.8(i)), which doubles the digits with each step.

use std::f64::consts::FRAC_PI_2;

/// K(k) for |k| ≤ 1; infinite at ±1.
pub(crate) fn ellip_k(k: f64) -> f64 {
    let complement = complement(k);
    if complement == 0.0 { f64::INFINITY } else { FRAC_PI_2 / means(complement, |_, _| ()) }
}

/// E(k) for |k| ≤ 1.
pub(crate) fn ellip_e(k: f64) -> f64 {
    let complement = complement(k);
    if complement == 0.0 {
        return 1.0;
    }
    // E/K = (1 + k′²)/2 − Σ 2^{n−1} c_n², with c_{n+1} = (a_n − g_n)/2: (1 + k′²)/2 = 1 − c_0²/2 has no cancellation
    let mut ratio = 0.5 * (1.0 + complement * complement);
    let mut weight = 0.5;
    let mean = means(complement, |a, g| {
        weight *= 2.0;
        ratio -= weight * (0.5 * (a - g)).powi(2);
    });
    FRAC_PI_2 / mean * ratio
}

/// k′ = √(1 − k²), as a product: near ±1, 1 − k² has few digits left. NaN for |k| > 1.
fn complement(k: f64) -> f64 {
    ((1.0 - k) * (1.0 + k)).sqrt()
}

/// The mean of 1 and `g`; `visit` sees each pair (a, g) on the way.
fn means(mut g: f64, mut visit: impl FnMut(f64, f64)) -> f64 {
    let mut a = 1.0;
    // the smallest k′, 10⁻⁸, takes seven steps
    for _ in 0..10 {
        visit(a, g);
        (a, g) = (0.5 * (a + g), (a * g).sqrt());
    }
    a
}
