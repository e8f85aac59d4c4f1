//! ker(I − A), ker(I − A*), ⟨f, ψ_k⟩: Fredholm's alternative on panels (paper, §1.1.4, th. 1.5).

use super::attempt::largest;
use super::discrete::Discrete;
use super::panels::{Panels, coarsened, refined};
use crate::equation::{EquationError, Scalar};
use crate::product::{COARSE, FINE, Product};
use crate::second_kind::{SecondKind, eigen};

/// What is known of I − A where it is singular, or close to it.
#[derive(Debug)]
pub(crate) struct Singular<T> {
    /// The smallest singular values in L², ascending.
    pub(crate) values: Vec<f64>,
    /// φ_k at the nodes, orthonormal in L².
    pub(crate) null: Vec<Vec<T>>,
    /// ψ_k, those of the adjoint.
    pub(crate) adjoint: Vec<Vec<T>>,
    /// ⟨f, ψ_k⟩.
    pub(crate) defects: Vec<T>,
    pub(crate) distance_to_spectrum: f64,
    /// What each panel leaves to be wished for.
    pub(crate) contributions: Vec<f64>,
    /// What of that is rounding.
    rounding: f64,
}

/// Singular values up to this part of the largest are looked at.
const SMALL: f64 = 1e-4;

/// … and those up to this part are zero, once the panels resolve their functions: rounding leaves 10⁻¹⁴.
const ZERO: f64 = 1e-11;

/// How well the null functions must satisfy their equation.
const RESOLVED: f64 = 1e-11;

/// The functions that I − A all but annuls.
struct Nearly<T> {
    values: Vec<f64>,
    functions: Vec<Vec<T>>,
    /// For each panel, the part of its residual that its singular value does not explain.
    residuals: Vec<f64>,
}

/// Looks at the smallest singular values of I − A and of its adjoint. `None` if a decomposition fails.
pub(crate) fn examine<T: Scalar>(
    product: &Product<'_, '_, T>,
    panels: &Panels,
    coarse: &Discrete<T>,
    fine: &Discrete<T>,
    system: &SecondKind<T>,
) -> Result<Option<Singular<T>>, EquationError> {
    let Some(right) = nearly_annulled(product, panels, coarse, fine, system) else { return Ok(None) };
    let top = right.values.last().copied().unwrap_or(1.0);
    let nullity = right.values.iter().take_while(|value| **value <= ZERO * top).count();
    let mut singular = Singular {
        values: right.values.iter().copied().take(right.functions.len().max(nullity + 1)).collect(),
        null: right.functions.into_iter().take(nullity).collect(),
        adjoint: Vec::new(),
        defects: Vec::new(),
        distance_to_spectrum: f64::NAN,
        contributions: right.residuals,
        rounding: 16.0 * f64::EPSILON * system.norm(),
    };
    if nullity > 0 && singular.resolved() {
        let equation = product.equation().adjoint();
        let transposed = product.adjoint(&equation);
        let coarse = Discrete::assemble(&transposed, panels, &COARSE)?;
        let fine = Discrete::assemble(&transposed, panels, &FINE)?;
        let factors = SecondKind::new(coarse.n, &coarse.a);
        let Some(left) = nearly_annulled(&transposed, panels, &coarse, &fine, &factors) else {
            return Ok(None);
        };
        singular.adjoint = left.functions.into_iter().take(nullity).collect();
        singular.contributions.iter_mut().zip(left.residuals).for_each(|(one, other)| *one = one.max(other));
    }
    if singular.resolved() {
        let Some(eigenvalues) = eigen(coarse.n, &coarse.a) else { return Ok(None) };
        let distances = eigenvalues.iter().map(|(value, _)| (value - 1.0).norm());
        singular.distance_to_spectrum = distances.fold(f64::INFINITY, f64::min);
    }
    Ok(Some(singular))
}

fn nearly_annulled<T: Scalar>(
    product: &Product<'_, '_, T>,
    panels: &Panels,
    coarse: &Discrete<T>,
    fine: &Discrete<T>,
    system: &SecondKind<T>,
) -> Option<Nearly<T>> {
    let m = product.equation().components();
    let decomposition = system.decompose(&panels.weights(&COARSE, product.change()).repeat(m))?;
    let values: Vec<f64> = decomposition.values().collect();
    let top = values.last().copied().unwrap_or(1.0);
    let small = values.iter().take_while(|value| **value <= SMALL * top).count();
    let mut residuals = vec![0.0; panels.len()];
    let mut functions = Vec::new();
    for (k, value) in values.iter().enumerate().take(small) {
        // φ = A φ; where weights are tiny, A has it more exactly than the decomposition.
        let function = coarse.apply(&decomposition.right(k));
        let phi = refined(&function);
        let transported = fine.apply(&phi);
        let size = largest(&phi);
        for (j, (old, new)) in phi.chunks(FINE.len()).zip(transported.chunks(FINE.len())).enumerate() {
            let residual: Vec<T> = old.iter().zip(new).map(|(old, new)| *old - *new).collect();
            let excess = (largest(&residual) / size - 2.0 * value).max(0.0);
            let panel = j % panels.len();
            residuals[panel] = f64::max(residuals[panel], excess);
        }
        functions.push(function);
    }
    Some(Nearly { values, functions, residuals })
}

impl<T: Scalar> Singular<T> {
    pub(crate) fn nullity(&self) -> usize {
        self.null.len()
    }

    /// Whether the panels are fine enough to tell zero from small.
    pub(crate) fn resolved(&self) -> bool {
        self.contributions.iter().all(|size| *size <= RESOLVED.max(self.rounding))
    }

    /// I − A bordered by the null functions.
    pub(crate) fn bordered(&self, a: &[T], weights: &[f64]) -> SecondKind<T> {
        SecondKind::bordered(a, weights, &self.null, &self.adjoint)
    }

    /// Whether f, given at the fine nodes with their weights, is orthogonal to the adjoint's null functions; `None` where
    /// the panels are too long for f.
    pub(crate) fn test(&mut self, source: &[T], weights: &[f64], tolerance: f64) -> Option<bool> {
        let inner = |f: &[T], psi: &[T]| {
            f.iter().zip(psi).zip(weights).map(|((f, psi), w)| *f * psi.conjugate() * *w).sum::<T>()
        };
        let defects =
            |f: &[T]| -> Vec<T> { self.adjoint.iter().map(|psi| inner(f, &refined(psi))).collect() };
        // Of squares of very large or small numbers nothing would be left.
        let unit = largest(source).max(f64::MIN_POSITIVE);
        let scaled: Vec<T> = source.iter().map(|f| *f * (1.0 / unit)).collect();
        let source = scaled.as_slice();
        let exact = defects(source);
        let smoothed = defects(&refined(&coarsened(source)));
        let allowed = tolerance.max(1e-12) * inner(source, source).modulus().sqrt();
        let change =
            exact.iter().zip(smoothed).map(|(one, other)| (*one - other).modulus()).fold(0.0, f64::max);
        // What the panels do not show of f could be orthogonal to ψ or not.
        let parts = source.chunks(FINE.len()).zip(weights.chunks(FINE.len()));
        let unseen: f64 = parts.map(|(f, w)| FINE.unresolved(f) * w.iter().sum::<f64>()).sum();
        let size = self.adjoint.iter().map(|psi| largest(psi)).fold(0.0, f64::max);
        let doubt = change + unseen * size;
        let defect = largest(&exact);
        self.defects = exact.into_iter().map(|defect| defect * unit).collect();
        if defect <= allowed {
            Some(true)
        } else if defect > 10.0 * doubt {
            Some(false)
        } else {
            None
        }
    }
}
