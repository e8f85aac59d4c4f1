//! (I − A) u = f for a dense A of nodal values: solved, with its norms, and taken apart where it is singular.

mod blocks;

pub(crate) use blocks::Blocks;

use crate::equation::{Complex64, Scalar};
use faer::linalg::solvers::{PartialPivLu, Solve};
use faer::{Mat, MatRef};

/// I − A, factored.
#[derive(Debug)]
pub(crate) struct SecondKind<T: Scalar> {
    matrix: Mat<T>,
    factors: PartialPivLu<T>,
    norm: f64,
    inverse_norm: f64,
}

/// Up to this size the inverse is computed, which takes three times as long as factoring; above, its norm is estimated.
const INVERTED: usize = 64;

impl<T: Scalar> SecondKind<T> {
    /// From A, n × n, row by row.
    pub(crate) fn new(n: usize, a: &[T]) -> Self {
        let identity = |i: usize, j: usize| if i == j { T::ONE } else { T::ZERO };
        let matrix = Mat::from_fn(n, n, |i, j| identity(i, j) - a[i * n + j]);
        let factors = matrix.partial_piv_lu();
        let norm = row_sum_norm(matrix.as_ref());
        let inverse_norm = if n <= INVERTED {
            row_sum_norm(factors.solve(Mat::from_fn(n, n, identity)).as_ref())
        } else {
            inverse_norm_estimate(&factors, n)
        };
        // Where it is singular, LU divides by zero.
        let inverse_norm = if inverse_norm.is_finite() { inverse_norm } else { f64::INFINITY };
        Self { matrix, factors, norm, inverse_norm }
    }

    /// n.
    pub(crate) fn len(&self) -> usize {
        self.matrix.nrows()
    }

    /// A bordered by the null functions φ_k of I − A and those ψ_k of its adjoint, which makes it regular: its solution
    /// u, c with (I − A) u + Σ c_k ψ_k = f is orthogonal to the φ_k for the product Σ weights u v̄, and c = 0 where
    /// (I − A) u = f can be solved.
    pub(crate) fn bordered(a: &[T], weights: &[f64], null: &[Vec<T>], adjoint: &[Vec<T>]) -> Self {
        let n = weights.len();
        let size = n + null.len();
        let mut border = vec![T::ZERO; size * size];
        for i in 0..n {
            border[i * size..][..n].copy_from_slice(&a[i * n..][..n]);
        }
        for (k, (phi, psi)) in null.iter().zip(adjoint).enumerate() {
            for i in 0..n {
                border[i * size + n + k] = -psi[i];
                border[(n + k) * size + i] = -(phi[i].conjugate() * weights[i]);
            }
            border[(n + k) * size + n + k] = T::ONE;
        }
        Self::new(size, &border)
    }

    /// u with (I − A) u = f. With a border f is without its zeros, and u without the multipliers c.
    pub(crate) fn solve(&self, f: &[T]) -> Vec<T> {
        let mut u = Mat::from_fn(self.len(), 1, |i, _| f.get(i).copied().unwrap_or(T::ZERO));
        self.factors.solve_in_place(u.as_mut());
        (0..f.len()).map(|i| u[(i, 0)]).collect()
    }

    /// ‖(I − A)⁻¹‖∞, or an estimate from below that is rarely off by more than a factor of 3 (Hager 1984, Higham 1988).
    pub(crate) fn inverse_norm(&self) -> f64 {
        self.inverse_norm
    }

    /// ‖I − A‖∞.
    pub(crate) fn norm(&self) -> f64 {
        self.norm
    }

    /// ‖I − A‖∞ ‖(I − A)⁻¹‖∞.
    pub(crate) fn condition(&self) -> f64 {
        self.norm * self.inverse_norm
    }

    /// Singular values and functions in L², where Σ weights |u_i|² is ∫ |u|².
    pub(crate) fn decompose(&self, weights: &[f64]) -> Option<Decomposition<T>> {
        let root: Vec<f64> = weights.iter().map(|w| w.sqrt()).collect();
        let n = root.len();
        let weighted = Mat::from_fn(n, n, |i, j| self.matrix[(i, j)] * (root[i] / root[j]));
        let svd = weighted.svd().ok()?;
        let values = (0..n).map(|k| svd.S()[k].modulus()).collect();
        Some(Decomposition { values, right: svd.V().to_owned(), root })
    }
}

/// The singular values of I − A in L², and its right singular functions.
#[derive(Debug)]
pub(crate) struct Decomposition<T: Scalar> {
    /// Descending.
    values: Vec<f64>,
    right: Mat<T>,
    /// √w_i.
    root: Vec<f64>,
}

impl<T: Scalar> Decomposition<T> {
    /// The singular values, ascending.
    pub(crate) fn values(&self) -> impl Iterator<Item = f64> + '_ {
        self.values.iter().rev().copied()
    }

    /// The function whose image is smallest but for k others; its L² norm is 1.
    pub(crate) fn right(&self, k: usize) -> Vec<T> {
        let column = self.values.len() - 1 - k;
        self.root.iter().enumerate().map(|(i, root)| self.right[(i, column)] * (1.0 / root)).collect()
    }
}

/// The eigenvalues of A, n × n, row by row, with their vectors: (λ_k, column k).
pub(crate) fn eigen<T: Scalar>(n: usize, a: &[T]) -> Option<Vec<(Complex64, Vec<Complex64>)>> {
    let (values, vectors) = T::eigen(MatRef::from_row_major_slice(a, n, n))?;
    Some(
        values
            .into_iter()
            .enumerate()
            .map(|(k, value)| (value, (0..n).map(|i| vectors[(i, k)]).collect()))
            .collect(),
    )
}

/// The largest Σ_j |M_ij|.
fn row_sum_norm<T: Scalar>(matrix: MatRef<'_, T>) -> f64 {
    let mut sums = vec![0.0; matrix.nrows()];
    for j in 0..matrix.ncols() {
        sums.iter_mut().enumerate().for_each(|(i, sum)| *sum += matrix[(i, j)].modulus());
    }
    sums.into_iter().fold(0.0, |m: f64, x| if x > m || x.is_nan() { x } else { m })
}

fn inverse_norm_estimate<T: Scalar>(factors: &PartialPivLu<T>, n: usize) -> f64 {
    let column = |x: &[T]| Mat::from_fn(n, 1, |i, _| x[i]);
    let values = |y: Mat<T>| (0..n).map(|i| y[(i, 0)]).collect();
    let adjoint = |x: &[T]| values(factors.solve_adjoint(column(x)));
    norm_estimate(n, adjoint, |x| values(factors.solve(column(x))))
}

/// ‖B‖∞ = ‖B*‖₁ of an n × n matrix by Hager's ascent, from u ↦ B* u and u ↦ B u: from the corner of the unit ball that the last
/// step points at. Not above the norm, and rarely below a third of it (Hager 1984, Higham 1988).
fn norm_estimate<T: Scalar>(
    n: usize,
    adjoint: impl Fn(&[T]) -> Vec<T>,
    forward: impl Fn(&[T]) -> Vec<T>,
) -> f64 {
    let mut x = vec![T::from(1.0 / n as f64); n];
    let mut norm = 0.0;
    // It seldom takes more than three steps.
    for _ in 0..5 {
        let y = adjoint(&x);
        let length: f64 = y.iter().map(|y| y.modulus()).sum();
        if length.is_nan() || length <= norm {
            return if length.is_nan() { length } else { norm };
        }
        norm = length;
        let sign = |y: &T| if *y == T::ZERO { T::ONE } else { *y * (1.0 / y.modulus()) };
        let z = forward(&y.iter().map(sign).collect::<Vec<T>>());
        let steepest = (0..n).max_by(|i, j| z[*i].modulus().total_cmp(&z[*j].modulus())).unwrap_or(0);
        x.fill(T::ZERO);
        x[steepest] = T::ONE;
    }
    norm
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A with I − A = Q diag(1, 1, …, 0) R for n = 100, and its norm far from that of a diagonal.
    fn a(n: usize) -> Vec<f64> {
        (0..n * n)
            .map(|k| {
                ((k * k + 3 * k) % 17) as f64 / (20.0 * n as f64) - if k % (n + 1) == 0 { 0.3 } else { 0.0 }
            })
            .collect()
    }

    #[test]
    fn the_estimated_norm_of_the_inverse_is_that_of_the_inverse() {
        let n = INVERTED + 20;
        let system = SecondKind::new(n, &a(n));
        let inverse = system.factors.solve(Mat::<f64>::identity(n, n));
        let norm = row_sum_norm(inverse.as_ref());
        assert!(system.inverse_norm() <= norm * (1.0 + 1e-12) && system.inverse_norm() > norm / 3.0);
    }

    #[test]
    fn what_is_annulled_is_found() {
        // A = 1 ⊗ w for weights w of sum 1: A 1 = 1.
        let weights = [0.1, 0.2, 0.3, 0.4];
        let a: Vec<f64> = (0..16).map(|k| weights[k % 4]).collect();
        let decomposition = SecondKind::new(4, &a).decompose(&weights).unwrap();
        let values: Vec<f64> = decomposition.values().collect();
        assert!(values[0] < 1e-15 && values[1] > 0.9);
        let null = decomposition.right(0);
        assert!(null.iter().all(|v| (v.abs() - 1.0).abs() < 1e-14), "{null:?}");
    }

    #[test]
    fn what_is_solved_for_is_found() {
        for n in [7, 90] {
            let system = SecondKind::new(n, &a(n));
            let f: Vec<f64> = (0..n).map(|i| (i as f64).cos()).collect();
            let u = system.solve(&f);
            for i in 0..n {
                let image: f64 = u[i] - (0..n).map(|j| a(n)[i * n + j] * u[j]).sum::<f64>();
                assert!((image - f[i]).abs() < 1e-13);
            }
        }
    }
}
