//! ∫ g ≈ Σ_{k ≤ 2n+1} w_k g(x_k), n of whose nodes are Gauss's: Gauss–Kronrod, of order 3n + 1, so that the difference of the
//! two estimates the error.

use super::Quadrature;
use super::orthogonal::Recurrence;

/// The 2n + 1 nodes on [−1, 1], ascending, with Kronrod's weights; every second one is Gauss's. By D. Laurie, *Calculation
/// of Gauss–Kronrod quadrature rules*, 1997: a recurrence of degree 2n + 1 whose Gauss rule it is.
pub(super) fn gauss_kronrod(n: usize) -> Quadrature<f64> {
    let given = Recurrence::legendre(2 * n + 1);
    let mut beside = vec![0.0; 2 * n + 1];
    beside[0] = given.mass;
    let known = (3 * n).div_ceil(2);
    beside[1..=known].copy_from_slice(&given.beside[1..=known]);
    extend(n, &mut beside);
    beside[0] = 0.0;
    Recurrence { diagonal: vec![0.0; 2 * n + 1], beside, mass: given.mass }.gauss()
}

/// Laurie's mixed moments for a symmetric weight, whose λ are nought: fills in μ beyond index ⌈3n/2⌉.
fn extend(n: usize, b: &mut [f64]) {
    let mut s = vec![0.0; n / 2 + 2];
    let mut t = s.clone();
    t[1] = b[n + 1];
    for m in 0..n.saturating_sub(1) {
        let mut sum = 0.0;
        for k in (0..=m.div_ceil(2)).rev() {
            let l = m - k;
            sum += b[k + n + 1] * s[k] - b[l] * s[k + 1];
            s[k + 1] = sum;
        }
        std::mem::swap(&mut s, &mut t);
    }
    for j in (0..=n / 2).rev() {
        s[j + 1] = s[j];
    }
    for m in n - 1..=2 * n - 3 {
        let (mut sum, mut last) = (0.0, 0);
        for k in m + 1 - n..=(m - 1) / 2 {
            let (l, j) = (m - k, n - 1 - (m - k));
            sum += b[l] * s[j + 2] - b[k + n + 1] * s[j + 1];
            s[j + 1] = sum;
            last = j;
        }
        if m % 2 == 1 {
            b[m.div_ceil(2) + n + 1] = s[last + 1] / s[last + 2];
        }
        std::mem::swap(&mut s, &mut t);
    }
}
