//! ‖A‖∞ and ‖(I − A)⁻¹‖∞: what an error is measured with (paper, §1.1.3).
//!
//! Not from the method that is judged, whose matrix may be wrong, but from collocation on panels with integrals to rounding.

use crate::automatic::discrete::Discrete;
use crate::automatic::panels::Panels;
use crate::equation::{EquationError, Scalar};
use crate::product::{COARSE, Product};
use crate::second_kind::SecondKind;

/// Numbers of an operator that do not depend on how an equation with it is solved.
#[derive(Clone, Copy, Debug)]
pub struct Yardstick {
    /// ‖A‖∞, of the discrete operator; [`super::operator_norm`] is the operator's own.
    pub norm: f64,
    /// ‖(I − A)⁻¹‖∞: how much larger an error can be than the residual.
    pub inverse_norm: f64,
}

/// Equal panels of 16 nodes, doubled until ‖(I − A)⁻¹‖ settles: 2 see what is as wide as a fifth of the interval; 32, with
/// 512 unknowns, a hundredth.
const PANELS: [usize; 5] = [2, 4, 8, 16, 32];

/// A change of ‖(I − A)⁻¹‖ by less than this part is as good as none: it multiplies an estimate.
const SETTLED: f64 = 0.1;

impl Yardstick {
    /// The numbers of the equation's operator.
    ///
    /// # Errors
    ///
    /// [`EquationError::KernelNotFinite`].
    pub fn new<T: Scalar>(product: &Product<'_, '_, T>) -> Result<Self, EquationError> {
        let (mut norm, mut inverse_norm) = (0.0, 0.0_f64);
        for count in PANELS {
            let panels = Panels::equal(product.change().range(), count);
            let matrix = Discrete::assemble(product, &panels, &COARSE)?;
            let system = SecondKind::new(matrix.n, &matrix.a);
            let sums = matrix.a.chunks(matrix.n).map(|row| row.iter().map(|entry| entry.modulus()).sum());
            norm = sums.fold(0.0, f64::max);
            let before = std::mem::replace(&mut inverse_norm, system.inverse_norm());
            // A change of a norm beyond 1e10 is that of rounding.
            if (inverse_norm - before).abs() <= SETTLED * inverse_norm || inverse_norm.min(before) > 1e10 {
                break;
            }
        }
        Ok(Self { norm, inverse_norm })
    }

    /// ‖I − A‖∞ ‖(I − A)⁻¹‖∞, from ‖I − A‖ ≤ 1 + ‖A‖.
    pub fn condition(&self) -> f64 {
        (1.0 + self.norm) * self.inverse_norm
    }
}
