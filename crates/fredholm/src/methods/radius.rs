//! r(A) = max_k |λ_k|: successive approximations converge for every f when it is below 1 (paper, §1.2.2, th. 1.6).

use crate::equation::{Equation, EquationError, Scalar};
use crate::spectrum::spectrum;

/// What a spectral radius is known to, as a part of itself; whoever comes closer to 1 has millions of terms to sum.
pub(super) const TOLERANCE: f64 = 1e-6;

/// The spectral radius of A; 0 where no eigenvalue can be told from 0.
///
/// # Errors
///
/// Those of [`spectrum`].
pub fn spectral_radius<T: Scalar>(equation: &Equation<'_, T>) -> Result<f64, EquationError> {
    let spectrum = spectrum(equation, 1, TOLERANCE)?;
    Ok(spectrum.eigenpairs.first().map_or(0.0, |pair| pair.value.norm()))
}
