//! ‖B⁻¹‖∞ from the factors of B, in a few solves: the method of Hager (1984), with Higham's safeguard (1988).

use crate::equation::Scalar;
use faer::Mat;
use faer::linalg::solvers::{PartialPivLu, Solve};

/// Hager's iteration ends after two or three steps; five bound it.
const STEPS: usize = 5;

/// ‖B⁻¹‖∞ of an n × n matrix, almost always exact and never too large; infinite where B is singular.
pub(super) fn inverse_norm<T: Scalar>(factors: &PartialPivLu<T>, n: usize) -> f64 {
    // ‖B⁻¹‖∞ = ‖C‖₁ with C = B⁻ᴴ; the largest column of C is climbed to along the gradient of ‖C x‖₁.
    let column = |x: &dyn Fn(usize) -> T| Mat::from_fn(n, 1, |i, _| x(i));
    let sum = |y: &Mat<T>| (0..n).map(|i| y[(i, 0)].modulus()).sum::<f64>();
    let alternating = |i: usize| {
        let size = 1.0 + i as f64 / (n.max(2) - 1) as f64;
        T::from(if i % 2 == 0 { size } else { -size })
    };
    let safeguard = 2.0 * sum(&factors.solve_adjoint(column(&alternating))) / (3.0 * n as f64);
    let mut y = factors.solve_adjoint(column(&|_| T::from(1.0 / n as f64)));
    let mut norm = sum(&y);
    let mut last = n;
    for _ in 0..STEPS {
        let gradient = factors.solve(column(&|i| sign(y[(i, 0)])));
        let size = |i: usize| gradient[(i, 0)].modulus();
        let largest = (0..n).max_by(|i, j| size(*i).total_cmp(&size(*j))).unwrap_or(0);
        if largest == last {
            break;
        }
        last = largest;
        y = factors.solve_adjoint(column(&|i| if i == largest { T::ONE } else { T::ZERO }));
        norm = norm.max(sum(&y));
    }
    let norm = norm.max(safeguard);
    if norm.is_finite() { norm } else { f64::INFINITY }
}

/// z/|z|, and 1 for 0.
fn sign<T: Scalar>(z: T) -> T {
    let size = z.modulus();
    if size > 0.0 { z * (1.0 / size) } else { T::ONE }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_complex::Complex64;

    #[test]
    fn the_norm_is_that_of_the_inverse() {
        let entry = |i: usize, j: usize| {
            let noise = |k: usize| ((k * 7919 % 101) as f64 / 101.0 - 0.5) * 1.5;
            Complex64::new(noise(1 + i * 13 + j * 5), noise(3 + i * 3 + j * 17)) + f64::from(u8::from(i == j))
        };
        let factors = Mat::from_fn(9, 9, entry).partial_piv_lu();
        let inverse = factors.solve(Mat::<Complex64>::identity(9, 9));
        let row = |i: usize| (0..9).map(|j| inverse[(i, j)].norm()).sum::<f64>();
        let exact = (0..9).map(row).fold(0.0, f64::max);
        let norm = inverse_norm(&factors, 9);
        assert!(norm <= exact * (1.0 + 1e-12) && norm > 0.9 * exact, "{norm} for {exact}");
    }

    #[test]
    fn a_singular_matrix_has_an_infinite_or_huge_one() {
        let factors = Mat::<f64>::from_fn(4, 4, |i, j| (i + j) as f64).partial_piv_lu();
        assert!(inverse_norm(&factors, 4) > 1e14);
    }
}
