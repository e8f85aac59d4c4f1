//! min ‖φ_n − Aφ_n − f‖ in L², φ_n = Σ_j α_j u_j (paper, §1.4.3, (1.49)–(1.52)).
//!
//! The normal equations (1.52) would square the condition. The integrals are those of a rule, ∫ g ≈ Σ_q w_q g(x_q), so that
//! the minimum is that of Σ_q w_q |Σ_j α_j û_j(x_q) − f(x_q)|², found by a QR factorisation. It is *not* Galerkin's solution
//! (th. 1.13 says it is): the residual is orthogonal to the û_i, not to the u_i.

use super::discrete::{Coefficients, check_condition};
use super::galerkin::composite_gauss;
use super::integrals::{images, sources};
use super::{Approximation, Integrals};
use crate::equation::{EquationError, Scalar};
use crate::product::Product;
use crate::space::Basis;
use faer::Mat;
use faer::linalg::solvers::{DenseSolveCore, SolveLstsq};
use std::sync::Arc;

/// Least squares in this space. The condition is that of the triangular factor R, in L².
pub fn solve<'e, T: Scalar>(
    product: &Product<'e, '_, T>,
    basis: Arc<dyn Basis>,
) -> Result<Approximation<'e, T>, EquationError> {
    let outer = composite_gauss(basis.breaks());
    let (points, n) = (outer.nodes.len(), basis.dim());
    let mut lines = images(product, &*basis, &outer.nodes, Integrals::Accurate)?;
    let mut u = Vec::with_capacity(n);
    for (index, line) in lines.iter_mut().enumerate() {
        let (a, q) = (index / points, index % points);
        // û_j = u_j − A u_j
        line.iter_mut().for_each(|entry| *entry = -*entry);
        let first = a * n + basis.values(outer.nodes[q], &mut u);
        line[first..].iter_mut().zip(&u).for_each(|(entry, u)| *entry += T::from(*u));
    }
    let f = sources(product.equation(), &outer.nodes)?;
    let root = |index: usize| outer.weights[index % points].sqrt();
    let weighted = Mat::from_fn(lines.len(), lines[0].len(), |i, j| lines[i][j] * root(i));
    let right = Mat::from_fn(lines.len(), 1, |i, _| f[i] * root(i));
    let factors = weighted.qr();
    let condition = condition(factors.thin_R().to_owned());
    check_condition(condition)?;
    let solution = factors.solve_lstsq(&right);
    let values = (0..lines[0].len()).map(|j| solution[(j, 0)]).collect();
    Ok(Approximation::in_space(product.equation().components(), basis, Coefficients { values, condition }))
}

/// ‖R‖∞ ‖R⁻¹‖∞.
fn condition<T: Scalar>(mut r: Mat<T>) -> f64 {
    for j in 0..r.ncols() {
        (j + 1..r.nrows()).for_each(|i| r[(i, j)] = T::ZERO);
    }
    let norm = |m: &Mat<T>| {
        let sums = (0..m.nrows()).map(|i| (0..m.ncols()).map(|j| m[(i, j)].modulus()).sum::<f64>());
        sums.fold(0.0, |largest: f64, sum| if sum > largest || sum.is_nan() { sum } else { largest })
    };
    norm(&r) * norm(&r.partial_piv_lu().inverse())
}
