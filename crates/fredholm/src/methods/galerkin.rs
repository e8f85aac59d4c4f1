//! ⟨φ_n − Aφ_n − f, u_i⟩ = 0, φ_n = Σ_j α_j u_j: orthogonal projection (paper, §1.4.4, (1.53)–(1.56)).

use super::integrals::{images, source};
use super::{Approximation, Discrete, Integrals};
use crate::equation::{EquationError, Scalar};
use crate::product::Product;
use crate::quadrature::{Quadrature, gauss_legendre};
use crate::space::Basis;
use faer::Mat;
use faer::linalg::solvers::Solve;
use std::sync::Arc;

/// F = G⁻¹⟨A u_j, u_i⟩ and s = G⁻¹⟨f, u_i⟩ with G = ⟨u_j, u_i⟩: (1.56), brought to the form φ_n = P_n f + P_n A φ_n of (1.53).
pub fn discrete<T: Scalar>(
    product: &Product<'_, '_, T>,
    basis: &dyn Basis,
) -> Result<Discrete<T>, EquationError> {
    let equation = product.equation();
    let (m, n) = (equation.components(), basis.dim());
    let outer = composite_gauss(basis.breaks());
    let mut mass = Mat::<T>::zeros(n, n);
    // ⟨A u_j, u_i⟩ of component a in rows a n + i, with ⟨f, u_i⟩ in the last column.
    let mut moments = vec![vec![T::ZERO; m * n + 1]; m * n];
    let mut u = Vec::with_capacity(n);
    for (points, weights) in outer.nodes.chunks(POINTS_AT_ONCE).zip(outer.weights.chunks(POINTS_AT_ONCE)) {
        let lines = images(product, basis, points, Integrals::Accurate)?;
        for (q, (x, weight)) in points.iter().zip(weights).enumerate() {
            let first = basis.values(*x, &mut u);
            for (i, u_i) in u.iter().enumerate() {
                for (j, u_j) in u.iter().enumerate() {
                    mass[(first + i, first + j)] += T::from(u_i * u_j * weight);
                }
            }
            for a in 0..m {
                let (line, f) = (&lines[a * points.len() + q], source(equation, a, *x)?);
                for (i, u_i) in u.iter().enumerate() {
                    let moment = &mut moments[a * n + first + i];
                    let image = line.iter().chain([&f]);
                    moment.iter_mut().zip(image).for_each(|(sum, value)| *sum += *value * (u_i * weight));
                }
            }
        }
    }
    Ok(projected(&mass, &moments))
}

/// The integrals of this many points are kept at once.
const POINTS_AT_ONCE: usize = 512;

/// Gauss's rule of 16 nodes on each piece: exact for products of two polynomials of degree 15.
pub(super) fn composite_gauss(breaks: &[f64]) -> Quadrature<f64> {
    let mut rule = Quadrature { nodes: Vec::new(), weights: Vec::new() };
    let reference = gauss_legendre(16, -1.0, 1.0);
    for edge in breaks.windows(2) {
        let (middle, half) = (0.5 * (edge[0] + edge[1]), 0.5 * (edge[1] - edge[0]));
        let piece = reference.map(|t, weight| (middle + half * t, half * weight));
        rule.nodes.extend(piece.nodes);
        rule.weights.extend(piece.weights);
    }
    rule
}

/// G⁻¹ applied to the rows of each component.
fn projected<T: Scalar>(mass: &Mat<T>, moments: &[Vec<T>]) -> Discrete<T> {
    let (n, width) = (mass.nrows(), moments.len() + 1);
    let factors = mass.partial_piv_lu();
    let mut matrix: Vec<Vec<T>> = Vec::with_capacity(moments.len());
    for part in moments.chunks_exact(n) {
        let solved = factors.solve(&Mat::from_fn(n, width, |i, j| part[i][j]));
        matrix.extend((0..n).map(|i| (0..width).map(|j| solved[(i, j)]).collect()));
    }
    let source = matrix.iter_mut().filter_map(Vec::pop).collect();
    Discrete::new(&matrix, source)
}

/// Galerkin's method in this space.
pub fn solve<'e, T: Scalar>(
    product: &Product<'e, '_, T>,
    basis: Arc<dyn Basis>,
) -> Result<Approximation<'e, T>, EquationError> {
    let coefficients = discrete(product, &*basis)?.solve()?;
    Ok(Approximation::in_space(product.equation().components(), basis, coefficients))
}
