//! φ − φ_n = (I − A)⁻¹ r, r = f + Aφ_n − φ_n: the error of an answer from the equation's own residual (paper,
//! §1.1.3).
//!
//! Aφ_n is integrated by a finer rule, with other nodes; r is taken at the nodes and at points that are none.

use super::mesh::Mesh;
use super::nystrom::{Nystrom, integrals, weighted};
use crate::equation::{EquationError, Scalar};
use crate::quadrature::Quadrature;

/// What is known of max |φ − φ_n|.
#[derive(Clone, Copy, Debug)]
pub(super) struct Error {
    /// What the residual says.
    pub(super) correction: f64,
    /// What rounding may have made of it.
    pub(super) floor: f64,
}

/// The finer rule errs too, and the largest error may be where nobody looks: twice the correction, which for a smooth
/// kernel is the error itself to several digits, covers both down to convergence of first order.
const SAFETY: f64 = 2.0;

/// In units of the last place: of sums, of the kernel's values and the source's.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Points besides the nodes at which the residual is taken.
const PROBES: usize = 200;

impl Error {
    /// The estimate of max |φ − φ_n|.
    pub(super) fn estimate(&self) -> f64 {
        SAFETY * self.correction + self.floor
    }

    /// Whether more nodes cannot make it smaller.
    pub(super) fn is_rounding(&self) -> bool {
        SAFETY * self.correction <= self.floor
    }
}

/// The error of a solution: its residual by the mesh's `finer` rule, at the nodes and between them.
pub(super) fn error<T: Scalar>(
    found: &Nystrom<'_, '_, T>,
    finer: &Quadrature<[f64; 2]>,
    mesh: &Mesh,
) -> Result<Error, EquationError> {
    let between = found.interpolate(&finer.nodes)?;
    let integrand = weighted(finer, &between);
    let residuals = |points: &[[f64; 2]], values: &[T]| -> Result<Vec<T>, EquationError> {
        let integral = integrals(found.equation, points, &finer.nodes, &integrand)?;
        let terms = points.iter().zip(values).zip(integral);
        terms.map(|((p, u), integral)| Ok(found.equation.finite_source(*p)? + integral - *u)).collect()
    };
    let correction = found.solve(&residuals(&found.rule.nodes, &found.values)?);

    let probes: Vec<_> = mesh.middles().chain(spread(&mesh.between(), PROBES)).collect();
    let values = found.interpolate(&probes)?;
    let residual = residuals(&probes, &values)?;
    let rest = integrals(found.equation, &probes, &found.rule.nodes, &weighted(&found.rule, &correction))?;
    let at_probes: Vec<T> = residual.iter().zip(rest).map(|(r, rest)| *r + rest).collect();

    let size = largest(&found.values).max(largest(&between));
    let amplified = found.inverse_norm() * (1.0 + found.norm) * size;
    let seen = [&correction, &at_probes, &residual].map(|values| largest(values));
    Ok(Error { correction: seen.into_iter().fold(0.0, f64::max), floor: ROUNDING * amplified })
}

/// What each element's rule falls short by in each direction: the integral over it of K(p, ·) φ_n, seen from a few p.
pub(super) fn defects<T: Scalar>(
    found: &Nystrom<'_, '_, T>,
    mesh: &Mesh,
) -> Result<Vec<[f64; 2]>, EquationError> {
    let mut first = 0;
    let mut all = Vec::with_capacity(mesh.0.len());
    for element in &mesh.0 {
        let own = first..first + element.counts[0] * element.counts[1];
        let nodes = &found.rule.nodes[own.clone()];
        let points: Vec<_> = spread(nodes, 12).chain(spread(&found.rule.nodes, 12)).collect();
        let coarse = integrals(found.equation, &points, nodes, &found.weighted[own.clone()])?;
        let mut defects = [0.0; 2];
        for (direction, defect) in defects.iter_mut().enumerate() {
            let mut counts = element.counts;
            counts[direction] *= 2;
            let rule = element.piece.rule(counts);
            let integrand = weighted(&rule, &found.interpolate(&rule.nodes)?);
            let fine = integrals(found.equation, &points, &rule.nodes, &integrand)?;
            *defect = largest(&fine.iter().zip(&coarse).map(|(a, b)| *a - *b).collect::<Vec<_>>());
        }
        all.push(defects);
        first = own.end;
    }
    Ok(all)
}

/// max |z|; NaN counts as infinite.
pub(super) fn largest<T: Scalar>(values: &[T]) -> f64 {
    let size = |z: &T| if z.finite() { z.modulus() } else { f64::INFINITY };
    values.iter().map(size).fold(0.0, f64::max)
}

/// `count` of the values, spread over them all in no step that a product rule has.
fn spread<P: Copy>(values: &[P], count: usize) -> impl Iterator<Item = P> {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let len = values.len();
    (1..=count.min(len)).map(move |i| values[((i as f64 * GOLDEN).fract() * len as f64) as usize])
}
