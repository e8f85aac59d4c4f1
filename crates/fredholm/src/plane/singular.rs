//! ker(I − A) and ker(I − A*) of the discrete equation (paper, §1.1.4, th. 1.5).

use crate::equation::Scalar;
use crate::second_kind::{SecondKind, eigen};

/// What is known of I − A where it is singular or close to it.
#[derive(Clone, Debug)]
pub(super) struct Singular<T> {
    /// The smallest singular values in L², ascending.
    pub(super) values: Vec<f64>,
    /// φ_k at the nodes, orthonormal in L².
    pub(super) null: Vec<Vec<T>>,
    /// ψ_k, those of the adjoint.
    pub(super) adjoint: Vec<Vec<T>>,
    pub(super) distance_to_spectrum: f64,
    /// The φ_k, and after them the functions of the other singular values that are small.
    pub(super) nearly_null: Vec<Vec<T>>,
}

/// Singular values up to this part of the largest are zero: rounding leaves 1e-14, and what is larger than this can still be
/// divided by, with five digits left.
pub(super) const ZERO: f64 = 1e-11;

/// Singular values up to this part of the largest may still become zero with more nodes.
pub(super) const SMALL: f64 = 1e-4;

/// How many singular values besides those that are zero are told.
pub(super) const TOLD: usize = 3;

impl<T: Scalar> Singular<T> {
    /// `None` where a decomposition fails. `a` is A, n × n, row by row.
    pub(super) fn examine(a: &[T], weights: &[f64], system: &SecondKind<T>) -> Option<Self> {
        let n = weights.len();
        let decomposition = system.decompose(weights)?;
        let values: Vec<f64> = decomposition.values().collect();
        let largest = values.last().copied()?;
        let nullity = values.iter().take_while(|value| **value <= ZERO * largest).count();
        let small = values.iter().take_while(|value| **value <= SMALL * largest).count();
        let nearly_null: Vec<_> = (0..small).map(|k| decomposition.right(k)).collect();
        let distances = eigen(n, a)?.into_iter().map(|(value, _)| (value - 1.0).norm());
        Some(Self {
            values: values.into_iter().take(nullity + TOLD).collect(),
            null: nearly_null[..nullity].to_vec(),
            nearly_null,
            adjoint: adjoint_null(a, weights, nullity)?,
            distance_to_spectrum: distances.fold(f64::INFINITY, f64::min),
        })
    }

    pub(super) fn nullity(&self) -> usize {
        self.null.len()
    }
}

/// The null functions of I − A*, where A*_ij = w_j Ā_ji / w_i.
fn adjoint_null<T: Scalar>(a: &[T], weights: &[f64], nullity: usize) -> Option<Vec<Vec<T>>> {
    let n = weights.len();
    let entry = |i: usize, j: usize| a[j * n + i].conjugate() * (weights[j] / weights[i]);
    let adjoint: Vec<T> = (0..n).flat_map(|i| (0..n).map(move |j| entry(i, j))).collect();
    let decomposition = SecondKind::new(n, &adjoint).decompose(weights)?;
    Some((0..nullity).map(|k| decomposition.right(k)).collect())
}
