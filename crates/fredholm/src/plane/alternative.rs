//! ⟨f, ψ_k⟩ = 0 for all ψ_k of ker(I − A*), or no solution: Fredholm's alternative in the plane (paper, th. 1.5).

use super::PlaneEquation;
use super::estimate::largest;
use super::nystrom::{Nystrom, integral, integrals, sources, weighted};
use crate::equation::{Alternative, EquationError, Function, Scalar, Status};
use crate::quadrature::Quadrature;
use rayon::prelude::*;

/// How closely two rules must agree on A φ for the singular value of φ to be told from zero: as `singular::ZERO`.
const RESOLVED: f64 = 1e-11;

/// f is orthogonal to ψ up to this part of their norms' product; rounding leaves 1e-15 of it.
const ORTHOGONAL: f64 = 1e-12;

/// `NoSolution`, `NotUnique` or nothing said, and the reasons.
type Verdict<'e, T> = (Option<Status>, Alternative<'e, [f64; 2], T>);

/// Whether the nodes resolve the functions that I − A all but annuls: a finer rule has the same A φ.
pub(super) fn is_resolved<T: Scalar>(
    found: &Nystrom<'_, '_, T>,
    finer: &Quadrature<[f64; 2]>,
) -> Result<bool, EquationError> {
    let (equation, rule) = (found.equation, &found.rule);
    for values in found.singular.iter().flat_map(|singular| &singular.nearly_null) {
        // A φ is a function, which φ at the nodes is not, and almost the same.
        let phi = integrals(equation, &rule.nodes, &rule.nodes, &weighted(rule, values))?;
        let between = integrals(equation, &finer.nodes, &rule.nodes, &weighted(rule, values))?;
        let coarse = integrals(equation, &rule.nodes, &rule.nodes, &weighted(rule, &phi))?;
        let fine = integrals(equation, &rule.nodes, &finer.nodes, &weighted(finer, &between))?;
        let difference: Vec<T> = coarse.iter().zip(fine).map(|(a, b)| *a - b).collect();
        if largest(&difference) > RESOLVED * largest(&phi) {
            return Ok(false);
        }
    }
    Ok(true)
}

/// Whether there are solutions, and what there is to tell; the integrals are by the finer rule.
pub(super) fn alternative<'e, T: Scalar>(
    found: &Nystrom<'e, '_, T>,
    finer: &Quadrature<[f64; 2]>,
    tolerance: f64,
) -> Result<Option<Verdict<'e, T>>, EquationError> {
    let Some(singular) = &found.singular else { return Ok(None) };
    let equation = found.equation;
    let functions = |values: &[Vec<T>], extend: &dyn Fn(Vec<T>) -> Function<'e, [f64; 2], T>| {
        values.iter().map(|values| extend(weighted(&found.rule, values))).collect::<Vec<_>>()
    };
    let nodes = &found.rule.nodes;
    let null_functions = functions(&singular.null, &|values| {
        let integral = integral(|p, q, row| equation.kernel.row(p, q, row), nodes, values);
        Function::new(1, move |_, p| integral(p))
    });
    let adjoint_null_functions = functions(&singular.adjoint, &|values| {
        let integral = integral(|p, q, row| adjoint_row(equation, p, q, row), nodes, values);
        Function::new(1, move |_, p| integral(p))
    });

    let source = weighted(finer, &sources(equation, &finer.nodes)?);
    let inner = |psi: &Function<'e, [f64; 2], T>| {
        let values: Vec<T> = finer.nodes.par_iter().map(|p| psi.at(p).conjugate()).collect();
        source.iter().zip(values).map(|(f, psi)| *f * psi).sum::<T>()
    };
    let solvability: Vec<T> = adjoint_null_functions.iter().map(inner).collect();
    // ‖f‖² = Σ |w f|²/w.
    let squares = source.iter().zip(&finer.weights).map(|(f, w)| f.modulus().powi(2) / w);
    let norm = squares.sum::<f64>().sqrt();
    let solvable = largest(&solvability) <= tolerance.max(ORTHOGONAL) * norm;
    let status =
        (singular.nullity() > 0).then_some(if solvable { Status::NotUnique } else { Status::NoSolution });
    let alternative = Alternative {
        null_functions,
        adjoint_null_functions,
        solvability,
        singular_values: singular.values.clone(),
        distance_to_spectrum: singular.distance_to_spectrum,
    };
    Ok(Some((status, alternative)))
}

/// The adjoint's kernel, the conjugate of K(q_j, p), for all j.
fn adjoint_row<T: Scalar>(equation: &PlaneEquation<'_, T>, p: [f64; 2], q: &[[f64; 2]], row: &mut [T]) {
    for (q, entry) in q.iter().zip(row) {
        equation.kernel.row(*q, &[p], std::slice::from_mut(entry));
        *entry = entry.conjugate();
    }
}
