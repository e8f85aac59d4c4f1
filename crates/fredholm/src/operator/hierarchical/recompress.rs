//! U Vᵀ = Σ_l σ_l p_l q_lᵀ with orthonormal p_l and q_l, cut off where the σ_l are small (Bebendorf 2008, §2.5).
//!
//! Crosses are not orthogonal, and more of them are needed than singular values: U = Q R and V = Q′ R′ make of it the singular
//! values of R R′ᵀ, which is small.

use super::cross::Cross;
use faer::linalg::triangular_solve::solve_upper_triangular_in_place;
use faer::{Mat, MatRef, Par};
use wide::f64x4;

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
        let (u, v) = (Triangle::of(&cross.u, m, tolerance), Triangle::of(&cross.v, n, tolerance));
        let middle = (&u.r * v.r.transpose()).svd().ok()?;
        let values: Vec<f64> = (0..cross.rank.min(m).min(n)).map(|l| middle.S()[l]).collect();
        let kept = kept(&values, tolerance);
        let left = u.orthonormal(middle.U().subcols(0, kept));
        let right = v.orthonormal(middle.V().subcols(0, kept));
        Some(Self { values: values[..kept].to_vec(), left: columns(&left), right: columns(&right) })
    }
}

/// U = Q R.
struct Triangle<'a> {
    u: MatRef<'a, f64>,
    r: Mat<f64>,
    /// `None` where it is U R⁻¹.
    q: Option<Mat<f64>>,
}

/// How much less than the tolerance may be lost by R from UᵀU.
const CAREFUL: f64 = 0.01;

impl<'a> Triangle<'a> {
    /// By Cholesky of UᵀU, columns brought to length 1, where that is as good as Householder's reflections, which take four
    /// times as long: what it loses is ε_machine ‖R⁻¹‖², and columns of crosses are far from dependent.
    fn of(columns: &'a [f64], m: usize, tolerance: f64) -> Self {
        let u = MatRef::from_column_major_slice(columns, m, columns.len() / m);
        match cholesky(columns, m) {
            Some((r, least)) if f64::EPSILON <= CAREFUL * tolerance * least * least => Self { u, r, q: None },
            _ => {
                let factors = u.qr();
                Self { u, r: factors.thin_R().to_owned(), q: Some(factors.compute_thin_Q()) }
            }
        }
    }

    /// Q times a matrix.
    fn orthonormal(&self, matrix: MatRef<'_, f64>) -> Mat<f64> {
        match &self.q {
            Some(q) => q * matrix,
            None => {
                let mut solved = matrix.to_owned();
                solve_upper_triangular_in_place(self.r.as_ref(), solved.as_mut(), Par::Seq);
                self.u * solved
            }
        }
    }
}

/// R with RᵀR = UᵀU, and the least diagonal entry that it has for columns of length 1; `None` where a column is zero or depends
/// on others.
fn cholesky(columns: &[f64], m: usize) -> Option<(Mat<f64>, f64)> {
    let columns: Vec<&[f64]> = columns.chunks_exact(m).collect();
    let k = columns.len();
    let (mut r, mut least) = (Mat::<f64>::zeros(k, k), 1.0_f64);
    for j in 0..k {
        let length2 = dot(columns[j], columns[j]);
        let mut rest = length2;
        for i in 0..j {
            let known: f64 = (0..i).map(|l| r[(l, i)] * r[(l, j)]).sum();
            r[(i, j)] = (dot(columns[i], columns[j]) - known) / r[(i, i)];
            rest -= r[(i, j)] * r[(i, j)];
        }
        if rest.is_nan() || rest <= 0.0 {
            return None;
        }
        r[(j, j)] = rest.sqrt();
        least = least.min((rest / length2).sqrt());
    }
    Some((r, least))
}

/// Eight sums in vector registers.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let ((a, rest_a), (b, rest_b)) = (a.as_chunks::<8>(), b.as_chunks::<8>());
    let mut sums = [f64x4::ZERO; 2];
    let half = |numbers: &[f64; 8], first: usize| {
        f64x4::new([numbers[first], numbers[first + 1], numbers[first + 2], numbers[first + 3]])
    };
    for (a, b) in a.iter().zip(b) {
        sums[0] += half(a, 0) * half(b, 0);
        sums[1] += half(a, 4) * half(b, 4);
    }
    let rest: f64 = rest_a.iter().zip(rest_b).map(|(a, b)| a * b).sum();
    (sums[0] + sums[1]).reduce_add() + rest
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
