//! U Vᵀ = Σ_l σ_l p_l q_lᵀ with orthonormal p_l and q_l, cut off where the σ_l are small (Bebendorf 2008, §2.5).
//!
//! Crosses are not orthogonal, and more of them are needed than singular values: U = Q R and V = Q′ R′ make of it the singular
//! values of R R′ᵀ, which is small.

use super::cross::Cross;
use faer::{Mat, MatRef};

/// Singular values and vectors of a block, descending; vectors column after column.
#[derive(Clone, Debug, Default)]
pub(super) struct Singular {
    pub(super) values: Vec<f64>,
    pub(super) left: Vec<f64>,
    pub(super) right: Vec<f64>,
}

impl Singular {
    /// Of U Vᵀ with m rows, those that must be kept for the rest to be below `tolerance` ‖U Vᵀ‖_F. `None` where the
    /// decomposition fails, as it does on numbers that are not finite.
    pub(super) fn of(cross: &Cross, m: usize, n: usize, tolerance: f64) -> Option<Self> {
        if cross.rank == 0 {
            return Some(Self::default());
        }
        let u = MatRef::from_column_major_slice(&cross.u, m, cross.rank).qr();
        let v = MatRef::from_column_major_slice(&cross.v, n, cross.rank).qr();
        let middle = (u.thin_R() * v.thin_R().transpose()).svd().ok()?;
        let values: Vec<f64> = (0..cross.rank.min(m).min(n)).map(|l| middle.S()[l]).collect();
        let kept = kept(&values, tolerance);
        let left = u.compute_thin_Q() * middle.U().subcols(0, kept);
        let right = v.compute_thin_Q() * middle.V().subcols(0, kept);
        Some(Self { values: values[..kept].to_vec(), left: columns(&left), right: columns(&right) })
    }
}

/// How many of these descending values must be kept.
fn kept(values: &[f64], tolerance: f64) -> usize {
    let total: f64 = values.iter().map(|value| value * value).sum();
    let mut rest = 0.0;
    let dropped = values.iter().rev().take_while(|value| {
        rest += *value * *value;
        rest <= tolerance * tolerance * total
    });
    values.len() - dropped.count()
}

fn columns(matrix: &Mat<f64>) -> Vec<f64> {
    (0..matrix.ncols()).flat_map(|l| matrix.col(l).iter().copied()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_out_is_as_small_as_was_asked_and_no_smaller() {
        // Σ_l 10^−l u_l v_lᵀ with vectors that are neither orthogonal nor of one length.
        let (m, n, rank) = (40, 30, 12);
        let vector =
            |size: usize, l: usize, a: f64| (0..size).map(move |i| (a * (i * (l + 1)) as f64).sin() + 0.3);
        let u: Vec<f64> =
            (0..rank).flat_map(|l| vector(m, l, 0.7).map(move |x| x * 0.1_f64.powi(l as i32))).collect();
        let v: Vec<f64> = (0..rank).flat_map(|l| vector(n, l, 0.4)).collect();
        let cross = Cross { rank, u, v };
        let entry =
            |i: usize, j: usize| (0..rank).map(|l| cross.u[l * m + i] * cross.v[l * n + j]).sum::<f64>();
        for tolerance in [1e-3, 1e-6, 1e-9] {
            let found = Singular::of(&cross, m, n, tolerance).unwrap();
            let kept = found.values.len();
            let (mut error2, mut norm2) = (0.0, 0.0);
            for (i, j) in (0..m).flat_map(|i| (0..n).map(move |j| (i, j))) {
                let terms =
                    (0..kept).map(|l| found.values[l] * found.left[l * m + i] * found.right[l * n + j]);
                error2 += (entry(i, j) - terms.sum::<f64>()).powi(2);
                norm2 += entry(i, j).powi(2);
            }
            let error = (error2 / norm2).sqrt();
            assert!(error <= tolerance && error > tolerance * 1e-3, "{kept}: {error}");
            // One less would be too few.
            let last = found.values[kept - 1];
            assert!((error2 + last * last).sqrt() > tolerance * norm2.sqrt());
        }
    }

    #[test]
    fn nothing_is_of_rank_0() {
        let zeros = Cross { rank: 2, u: vec![0.0; 10], v: vec![0.0; 8] };
        assert!(Singular::of(&zeros, 5, 4, 1e-6).unwrap().values.is_empty());
        assert!(Singular::of(&Cross::default(), 5, 4, 1e-6).unwrap().values.is_empty());
    }
}
