//! The eigenvalues of a symmetric tridiagonal matrix: the roots of the polynomial that (4.14) makes of its entries.

/// The eigenvalues, ascending, of the matrix with `diagonal` and the squares `squared` of what stands beside it
/// (one fewer), by the root-free QL method of Pal, Walker and Kahan. The error is some rounding of the largest.
pub(super) fn eigenvalues(diagonal: &[f64], squared: &[f64]) -> Vec<f64> {
    let mut d = diagonal.to_vec();
    let mut e2 = squared.to_vec();
    e2.push(0.0);
    let size = d.iter().map(|d| d.abs()).fold(0.0, f64::max)
        + 2.0 * e2.iter().fold(0.0, |m: f64, e| m.max(*e)).sqrt();
    let negligible = (f64::EPSILON * size).powi(2);
    for l in 0..d.len() {
        // QL takes 1.7 steps an eigenvalue; fifty have never been seen.
        for _ in 0..50 {
            let m = (l..d.len()).find(|m| e2[*m] <= negligible).unwrap_or(d.len() - 1);
            if m == l {
                break;
            }
            sweep(&mut d, &mut e2, l, m);
        }
    }
    d.sort_unstable_by(f64::total_cmp);
    d
}

/// One QL step with Wilkinson's shift on rows l to m.
fn sweep(d: &mut [f64], e2: &mut [f64], l: usize, m: usize) {
    let below = e2[l].sqrt();
    let half = (d[l + 1] - d[l]) / (2.0 * below);
    let shift = d[l] - below / (half + half.hypot(1.0).copysign(half));
    let (mut c, mut s) = (1.0, 0.0);
    let mut gamma = d[m] - shift;
    let mut p = gamma * gamma;
    for i in (l..m).rev() {
        let r = p + e2[i];
        if i + 1 != m {
            e2[i + 1] = s * r;
        }
        let (old_c, old_gamma) = (c, gamma);
        c = p / r;
        s = e2[i] / r;
        gamma = c * (d[i] - shift) - s * old_gamma;
        d[i + 1] = old_gamma + (d[i] - gamma);
        p = if c == 0.0 { old_c * e2[i] } else { gamma * gamma / c };
    }
    e2[l] = s * p;
    d[l] = shift + gamma;
}
