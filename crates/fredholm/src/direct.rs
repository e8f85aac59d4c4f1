//! (I − diag(ρ) F) u = f by LU factorisation: the oracle that the iterative methods are held against.

use crate::operator::Rows;
use crate::system::System;
use crate::value::Value;
use faer::Mat;
use faer::linalg::solvers::Solve;

/// The solution by LU with partial pivoting, one factorisation per channel: O(n³) operations, n² numbers of memory.
///
/// A singular matrix gives values that are not finite; the residual of the answer says how far to trust it.
pub fn solve<V: Value, F: Rows>(system: System<'_, V, F>) -> Vec<V> {
    let n = system.source.len();
    let mut solution = vec![V::splat(0.0); n];
    for channel in 0..V::CHANNELS {
        let lu = channel_matrix(&system, channel).partial_piv_lu();
        let source = Mat::from_fn(n, 1, |i, _| system.source[i].channels()[channel]);
        let u = lu.solve(&source);
        for (i, value) in solution.iter_mut().enumerate() {
            value.channels_mut()[channel] = u[(i, 0)];
        }
    }
    solution
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
