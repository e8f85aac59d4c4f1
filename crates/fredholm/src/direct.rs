//! (I − diag(ρ) F) u = f by LU factorisation: the oracle that the iterative methods are held against.

use crate::operator::Rows;
use crate::relax::Relaxation;
use crate::system::System;
use crate::value::{Value, max_norm};
use faer::Mat;
use faer::linalg::solvers::Solve;
use rayon::prelude::*;

/// The solution by LU with partial pivoting, one factorisation per channel: O(n³) operations, and 16 n² bytes for each
/// channel in work. The channels are shared among the cores; within one the order is fixed, and so are the digits.
///
/// A singular matrix gives values that are not finite; the residual of the answer says how far to trust it.
pub fn solve<V: Value, F: Rows>(system: System<'_, V, F>) -> Vec<V> {
    let n = system.source.len();
    let channels: Vec<Mat<f64>> =
        (0..V::CHANNELS).into_par_iter().map(|k| solve_channel(&system, k)).collect();
    let at = |i: usize| {
        let mut value = V::splat(0.0);
        value.channels_mut().iter_mut().zip(&channels).for_each(|(number, u)| *number = u[(i, 0)]);
        value
    };
    (0..n).map(at).collect()
}

fn solve_channel<V: Value, F: Rows>(system: &System<'_, V, F>, channel: usize) -> Mat<f64> {
    let source = Mat::from_fn(system.source.len(), 1, |i, _| system.source[i].channels()[channel]);
    channel_matrix(system, channel).partial_piv_lu().solve(&source)
}

/// I − diag(ρ) F for one channel of ρ.
fn channel_matrix<V: Value, F: Rows>(system: &System<'_, V, F>, channel: usize) -> Mat<f64> {
    let n = system.source.len();
    let mut matrix = Mat::identity(n, n);
    let mut buffer = Vec::new();
    for i in 0..n {
        let rho = system.coefficient[i].channels()[channel];
        for (j, entry) in system.operator.row(i, &mut buffer).iter().enumerate() {
            matrix[(i, j)] -= rho * entry;
        }
    }
    matrix
}

/// N = (I − diag(ρ) F)⁻¹, the whole of it: what all bounces make of what each unknown sends.
#[derive(Debug)]
pub struct Resolvent(Mat<f64>);

/// A matrix that a [`Resolvent`] has made.
#[derive(Debug)]
pub struct Product(Mat<f64>);

impl Resolvent {
    /// From ρ and the entries F_ij of a square matrix: O(n³) operations, and 24 n² bytes in work.
    ///
    /// A singular matrix gives entries that are not finite.
    pub fn new(coefficient: &[f64], entry: impl Fn(usize, usize) -> f64) -> Self {
        let n = coefficient.len();
        let identity = |i: usize, j: usize| if i == j { 1.0 } else { 0.0 };
        let matrix = Mat::from_fn(n, n, |i, j| identity(i, j) - coefficient[i] * entry(i, j));
        Self(matrix.partial_piv_lu().solve(Mat::from_fn(n, n, identity)))
    }

    /// L N, for a matrix L of these entries.
    pub fn after(&self, left: impl Fn(usize, usize) -> f64) -> Product {
        let n = self.0.nrows();
        Product(Mat::from_fn(n, n, left) * &self.0)
    }

    /// Nᵀ D N, for a matrix D of these entries.
    pub fn between(&self, middle: impl Fn(usize, usize) -> f64) -> Product {
        Product(self.0.transpose() * self.after(middle).0)
    }
}

impl Product {
    /// The entry in row i and column j.
    pub fn at(&self, i: usize, j: usize) -> f64 {
        self.0[(i, j)]
    }
}

/// The direct solver in the clothes of an iterative one: a single sweep from u = 0 finds the solution.
#[derive(Debug)]
pub struct Direct<'a, V, F> {
    system: System<'a, V, F>,
    solution: Vec<V>,
}

impl<'a, V: Value, F: Rows> Direct<'a, V, F> {
    /// Nothing is computed before the first sweep.
    pub fn new(system: System<'a, V, F>) -> Self {
        Self { system, solution: vec![V::splat(0.0); system.dim()] }
    }
}

impl<V: Value, F: Rows> Relaxation<V> for Direct<'_, V, F> {
    fn sweep(&mut self) -> f64 {
        self.solution = solve(self.system);
        max_norm(&self.residual())
    }

    fn solution(&self) -> Vec<V> {
        self.solution.clone()
    }

    fn residual(&self) -> Vec<V> {
        self.system.residual(&self.solution)
    }
}
