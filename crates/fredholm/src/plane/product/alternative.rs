//! ker(I − A), ker(I − A*) and ⟨f, ψ_k⟩ on elements: Fredholm's alternative (paper, th. 1.5).

use super::attempt::{Probes, interpolated};
use super::element::{Elements, NODES};
use super::layout::Layout;
use crate::equation::{Alternative, EquationError, Function, Scalar, Status};
use crate::plane::PlaneEquation;
use crate::plane::estimate::largest;
use crate::plane::singular::{SMALL, TOLD, ZERO};
use crate::second_kind::{SecondKind, eigen};
use std::sync::Arc;

/// How well the functions of small singular values must satisfy their equation for these to be told from zero: values err less than
/// functions do.
const RESOLVED: f64 = 1e-8;

/// f is orthogonal to ψ up to this part of their norms' product.
const ORTHOGONAL: f64 = 1e-11;

/// What is known of I − A where it is singular or close to it.
pub(super) struct Singular<T> {
    /// The smallest singular values in L², ascending.
    values: Vec<f64>,
    /// φ_k at the nodes, orthonormal in L².
    pub(super) null: Vec<Vec<T>>,
    /// ψ_k, those of the adjoint.
    pub(super) adjoint: Vec<Vec<T>>,
    distance_to_spectrum: f64,
    /// Whether the elements tell zero from small.
    resolved: bool,
}

/// Whether there are solutions, and the reasons.
pub(super) struct Verdict<'e, T> {
    pub(super) status: Option<Status>,
    pub(super) alternative: Alternative<'e, [f64; 2], T>,
}

/// The functions that I − A all but annuls.
struct Nearly<T> {
    values: Vec<f64>,
    functions: Vec<Vec<T>>,
    resolved: bool,
}

/// Looks at the smallest singular values of I − A and of its adjoint; `None` where a decomposition fails.
pub(super) fn examine<T: Scalar>(
    layout: &Layout<'_, '_, T>,
    a: &[T],
    probes: &Probes,
    system: &SecondKind<T>,
) -> Result<Option<Singular<T>>, EquationError> {
    let Some(right) = nearly_annulled(layout, probes, system)? else { return Ok(None) };
    let top = right.values.last().copied().unwrap_or(1.0);
    let nullity = right.values.iter().take_while(|value| **value <= ZERO * top).count();
    let mut singular = Singular {
        values: right.values.into_iter().take(nullity + TOLD).collect(),
        null: right.functions.into_iter().take(nullity).collect(),
        adjoint: Vec::new(),
        distance_to_spectrum: f64::NAN,
        resolved: right.resolved,
    };
    if nullity > 0 && singular.resolved {
        let equation = layout.equation;
        let kernel = |p: [f64; 2], q: [f64; 2]| {
            let mut value = [T::ZERO];
            equation.kernel.row(q, &[p], &mut value);
            value[0].conjugate()
        };
        let transposed = PlaneEquation::new(equation.domain, kernel, |_| T::ZERO);
        let adjoint = layout.of(&transposed);
        let system = SecondKind::new(adjoint.dim(), &adjoint.matrix()?);
        let Some(left) = nearly_annulled(&adjoint, probes, &system)? else {
            return Ok(None);
        };
        singular.adjoint = left.functions.into_iter().take(nullity).collect();
        singular.resolved = left.resolved && singular.adjoint.len() == nullity;
    }
    let Some(eigenvalues) = eigen(layout.dim(), a) else { return Ok(None) };
    let distances = eigenvalues.into_iter().map(|(value, _)| (value - 1.0).norm());
    singular.distance_to_spectrum = distances.fold(f64::INFINITY, f64::min);
    Ok(Some(singular))
}

fn nearly_annulled<T: Scalar>(
    layout: &Layout<'_, '_, T>,
    probes: &Probes,
    system: &SecondKind<T>,
) -> Result<Option<Nearly<T>>, EquationError> {
    let Some(decomposition) = system.decompose(&layout.weights) else { return Ok(None) };
    let values: Vec<f64> = decomposition.values().collect();
    let top = values.last().copied().unwrap_or(1.0);
    let small: Vec<f64> = values.iter().copied().take_while(|value| *value <= SMALL * top).collect();
    let functions: Vec<Vec<T>> = (0..small.len()).map(|k| decomposition.right(k)).collect();
    let pairs: Vec<_> = functions.iter().map(|phi| (phi.as_slice(), phi.as_slice())).collect();
    let residuals = probes.residuals(layout, &pairs)?;
    // What a singular value explains of φ − A φ is no fault of the elements.
    let is_resolved = |((phi, value), residuals): ((&Vec<T>, &f64), &Vec<f64>)| {
        largest(residuals) <= (RESOLVED + 2.0 * value) * largest(phi)
    };
    let resolved = functions.iter().zip(&small).zip(&residuals).all(is_resolved);
    Ok(Some(Nearly { values, functions, resolved }))
}

impl<T: Scalar> Singular<T> {
    pub(super) fn nullity(&self) -> usize {
        self.null.len()
    }

    /// Whether there are null functions, surely.
    pub(super) fn is_certain(&self) -> bool {
        self.resolved && self.nullity() > 0
    }

    /// Whether there are solutions, and what there is to tell.
    pub(super) fn verdict<'e>(
        self,
        layout: &Layout<'_, '_, T>,
        source: &[T],
        tolerance: f64,
    ) -> Verdict<'e, T> {
        let inner = |one: &[T], other: &[T]| {
            let terms = one.iter().zip(other).zip(&layout.weights);
            terms.map(|((f, psi), w)| *f * psi.conjugate() * *w).sum::<T>()
        };
        let solvability: Vec<T> = self.adjoint.iter().map(|psi| inner(source, psi)).collect();
        let norm = inner(source, source).modulus().sqrt();
        let solvable = largest(&solvability) <= tolerance.max(ORTHOGONAL) * norm;
        let status =
            self.is_certain().then_some(if solvable { Status::NotUnique } else { Status::NoSolution });
        let functions =
            |all: Vec<Vec<T>>| all.into_iter().map(|values| function(&layout.elements, values)).collect();
        let alternative = Alternative {
            null_functions: functions(self.null),
            adjoint_null_functions: functions(self.adjoint),
            solvability,
            singular_values: self.values,
            distance_to_spectrum: self.distance_to_spectrum,
        };
        Verdict { status, alternative }
    }
}

/// The piecewise polynomial with these values at the nodes; NaN outside of the domain.
fn function<'e, T: Scalar>(elements: &Arc<Elements>, values: Vec<T>) -> Function<'e, [f64; 2], T> {
    let elements = elements.clone();
    Function::new(1, move |_, p: &[f64; 2]| match elements.locate(*p) {
        Some((k, uv)) => interpolated(&values[NODES * k..][..NODES], elements.all[k].cell.local(uv)),
        None => T::from(f64::NAN),
    })
}
