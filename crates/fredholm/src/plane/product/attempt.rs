//! The solution on given elements, judged by its residual between the nodes (paper, §1.1.3).

use super::alternative::{Singular, Verdict, examine};
use super::element::{Element, Elements, NODES};
use super::layout::Layout;
use super::row::{RowBuilder, Rule, Target};
use crate::equation::{Answer, Class, EquationError, Function, Scalar, Status, all_parts, of_all_parts};
use crate::plane::PlaneEquation;
use crate::plane::estimate::largest;
use crate::product::{COARSE, POINTS};
use crate::second_kind::SecondKind;
use rayon::prelude::*;
use std::sync::Arc;

type Point = [f64; 2];

/// Points between the nodes, where A u is found by a finer rule.
pub(super) struct Probes {
    /// Each in its element, with its place from −1 to 1.
    places: Vec<(usize, Point)>,
    targets: Vec<Target>,
}

/// Probes within an element; besides them there is one at each of its corners and sides, where a polynomial through Gauss's nodes errs
/// most.
const PROBES: usize = 6;

/// At a side: as near as this, but not on it.
const RIM: f64 = 0.999;

impl Probes {
    pub(super) fn new(elements: &Elements) -> Self {
        // The plastic number's powers: the most even of sequences in the plane.
        const STEP: [f64; 2] = [0.754_877_666_246_693, 0.569_840_290_998_053];
        let spread = |k: usize| STEP.map(|step| 2.0 * (0.5 + step * k as f64).fract() - 1.0);
        let corners = [[-RIM, -RIM], [-RIM, RIM], [RIM, -RIM], [RIM, RIM]];
        let sides = [[-RIM, 0.31], [RIM, -0.43], [0.57, -RIM], [-0.23, RIM]];
        let of = |element: usize| {
            let inside = (0..PROBES).map(move |k| spread(1 + element * PROBES + k));
            inside.chain(corners).chain(sides).map(move |at| (element, at))
        };
        let places: Vec<_> = (0..elements.all.len()).flat_map(of).collect();
        let target = |(k, at): &(usize, Point)| {
            let element = &elements.all[*k];
            let uv = element.cell.at(*at);
            Target { p: elements.chart(element).point(uv), place: Some((element.chart, uv)) }
        };
        Self { targets: places.iter().map(target).collect(), places }
    }

    /// By function and element, the largest |A u − g| for values u and polynomials g given at the nodes.
    pub(super) fn residuals<T: Scalar>(
        &self,
        layout: &Layout<'_, '_, T>,
        functions: &[(&[T], &[T])],
    ) -> Result<Vec<Vec<f64>>, EquationError> {
        let rule = Rule::finer(layout.exponent);
        let at = |((k, at), target): (&(usize, Point), &Target)| -> Result<Vec<f64>, EquationError> {
            let mut row = vec![T::ZERO; layout.dim()];
            RowBuilder::new(layout.equation, &layout.elements, &rule, *target).row(&mut row)?;
            let residual = |(u, g): &(&[T], &[T])| {
                let image: T = row.iter().zip(*u).map(|(a, u)| *a * *u).sum();
                (image - interpolated(&g[NODES * k..][..NODES], *at)).modulus()
            };
            Ok(functions.iter().map(residual).collect())
        };
        let found: Vec<_> = self.places.par_iter().zip(&self.targets).map(at).collect();
        let mut residuals = vec![vec![0.0; layout.elements.all.len()]; functions.len()];
        for ((k, _), found) in self.places.iter().zip(found) {
            for (of_function, residual) in residuals.iter_mut().zip(found?) {
                of_function[*k] = f64::max(of_function[*k], residual);
            }
        }
        Ok(residuals)
    }

    /// By element, how far f is from its polynomial, beyond rounding.
    fn missed<T: Scalar>(&self, layout: &Layout<'_, '_, T>, f: &[T]) -> Result<Vec<f64>, EquationError> {
        let mut missed = vec![0.0; layout.elements.all.len()];
        for ((k, at), target) in self.places.iter().zip(&self.targets) {
            let own = &f[NODES * k..][..NODES];
            let off = (layout.equation.finite_source(target.p)? - interpolated(own, *at)).modulus();
            missed[*k] = f64::max(missed[*k], off - ROUNDING * largest(own));
        }
        Ok(missed)
    }
}

/// What evaluating a function and its interpolant leaves, as a part of it.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// The polynomial with these values at the nodes of an element.
pub(super) fn interpolated<T: Scalar>(values: &[T], [xi, eta]: Point) -> T {
    let mut along = [T::ZERO; POINTS];
    along
        .iter_mut()
        .zip(values.chunks(POINTS))
        .for_each(|(value, row)| *value = COARSE.interpolate(row, eta));
    COARSE.interpolate(&along, xi)
}

/// What is left out of the series of a function on an element, along either direction.
fn unresolved<T: Scalar>(values: &[T]) -> [f64; 2] {
    let column = |k: usize| values.iter().skip(k).step_by(POINTS).copied().collect::<Vec<T>>();
    let along_u = (0..POINTS).map(|k| COARSE.unresolved(&column(k)));
    let along_v = values.chunks(POINTS).map(|row| COARSE.unresolved(row));
    [along_u.fold(0.0, f64::max), along_v.fold(0.0, f64::max)]
}

/// The largest residual is between the probes: as `estimate::SAFETY`.
const SAFETY: f64 = 2.0;

/// The part of what is allowed that an element's residual may have.
const PART: f64 = 0.4;

/// To cut some elements does not help while others have this part of the worst defect.
const WORTH: f64 = 0.3;

/// Nodes that are nearer to the boundary than this, as a part of a chart, are hardly known from each other.
const NEAREST: f64 = 1e-14;

/// From this condition number on the singular values are looked at, as on a smooth kernel's nodes, on up to so many unknowns.
const SUSPICIOUS: f64 = 1e4;
const DECOMPOSED: usize = 1600;

pub(in crate::plane) struct Attempt<'e, 'a, T: Scalar> {
    layout: Layout<'e, 'a, T>,
    values: Vec<T>,
    /// A u.
    images: Vec<T>,
    pub(super) error: f64,
    scale: f64,
    condition: f64,
    inverse_norm: f64,
    /// What each element leaves unresolved of A u, in its two directions.
    tails: Vec<[f64; 2]>,
    /// What its probes say.
    residuals: Vec<f64>,
    verdict: Option<Verdict<'e, T>>,
    is_in_blocks: bool,
}

/// What was found of the discrete equation.
struct Solved<T> {
    source: Vec<T>,
    /// u.
    values: Vec<T>,
    /// ‖A‖∞, ‖(I − A)⁻¹‖∞ and the condition of I − A.
    norm: f64,
    inverse_norm: f64,
    condition: f64,
}

impl<'e, 'a, T: Scalar> Attempt<'e, 'a, T> {
    /// With A as a matrix.
    pub(in crate::plane) fn dense(layout: Layout<'e, 'a, T>, tolerance: f64) -> Result<Self, EquationError> {
        let (source, n) = (layout.sources()?, layout.dim());
        let a = layout.matrix()?;
        let mut system = SecondKind::new(n, &a);
        let norm = a.chunks(n).map(|row| row.iter().map(|a| a.modulus()).sum()).fold(0.0, f64::max);
        let condition = system.condition();
        let probes = Probes::new(&layout.elements);
        let suspicious = n <= DECOMPOSED && (condition.is_nan() || condition >= SUSPICIOUS);
        let singular = if suspicious { examine(&layout, &a, &probes, &system)? } else { None };
        if let Some(Singular { null, adjoint, .. }) = singular.as_ref().filter(|found| found.is_certain()) {
            system = SecondKind::bordered(&a, &layout.weights, null, adjoint);
        }
        let values = system.solve(&source);
        let inverse_norm = system.inverse_norm();
        let uncertain = singular.as_ref().is_some_and(|found| found.nullity() > 0 && !found.is_certain());
        let verdict = singular.map(|found| found.verdict(&layout, &source, tolerance));
        let mut attempt =
            Self::judged(layout, &probes, Solved { source, values, norm, inverse_norm, condition })?;
        attempt.verdict = verdict;
        if uncertain {
            attempt.error = f64::INFINITY;
        }
        Ok(attempt)
    }

    /// With A in blocks of low rank. Whether I − A is singular is not examined.
    pub(super) fn in_blocks(layout: Layout<'e, 'a, T>, tolerance: f64) -> Result<Self, EquationError> {
        let source = layout.sources()?;
        let blocks = layout.blocks(tolerance)?;
        let values = of_all_parts(&blocks.solve(&all_parts(&source)));
        let (norm, inverse_norm, condition) = (blocks.norm(), blocks.inverse_norm(), blocks.condition());
        let probes = Probes::new(&layout.elements);
        let solved = Solved { source, values, norm, inverse_norm, condition };
        Ok(Self { is_in_blocks: true, ..Self::judged(layout, &probes, solved)? })
    }

    fn judged(layout: Layout<'e, 'a, T>, probes: &Probes, solved: Solved<T>) -> Result<Self, EquationError> {
        let Solved { source, values, norm, inverse_norm, condition } = solved;
        let images: Vec<T> = values.iter().zip(&source).map(|(u, f)| *u - *f).collect();
        let tails: Vec<_> = images.chunks(NODES).map(unresolved).collect();
        let residuals = probes.residuals(&layout, &[(&values, &images)])?.concat();
        let missed = probes.missed(&layout, &source)?;
        let residuals: Vec<f64> =
            residuals.into_iter().zip(missed).map(|(residual, missed)| residual + missed).collect();
        let scale = largest(&values);
        let rounding = 4.0 * f64::EPSILON * (1.0 + norm) + norm * grain(layout.equation, layout.exponent);
        let error = inverse_norm.max(1.0) * (SAFETY * largest(&residuals) + rounding * scale);
        let error = if error.is_nan() { f64::INFINITY } else { error };
        Ok(Self {
            layout,
            values,
            images,
            error,
            scale,
            condition,
            inverse_norm,
            tails,
            residuals,
            verdict: None,
            is_in_blocks: false,
        })
    }

    fn meets(&self, tolerance: f64) -> bool {
        self.error <= tolerance * self.scale
    }

    pub(super) fn is_final(&self, tolerance: f64) -> bool {
        self.meets(tolerance) || self.status() == Some(Status::NoSolution)
    }

    fn status(&self) -> Option<Status> {
        self.verdict.as_ref().and_then(|verdict| verdict.status)
    }

    /// The elements cut where A u is not resolved, the worst first, as far as the unknowns allow; none where that does not help.
    pub(super) fn finer(&self, tolerance: f64, unknowns: usize) -> Option<Elements> {
        let elements = &self.layout.elements;
        let allowed = PART * tolerance * self.scale / self.inverse_norm.max(1.0);
        // The residual says how much is missing, the series in which direction.
        let defect = |k: usize, d: usize| match self.has_room(k, d) {
            true => self.residuals[k] * self.tails[k][d] / largest(&self.tails[k]),
            false => 0.0,
        };
        let mut worst: Vec<_> =
            (0..elements.all.len()).flat_map(|k| [0, 1].map(|d| (defect(k, d), k, d))).collect();
        worst.retain(|(defect, ..)| *defect > allowed);
        worst.sort_by(|one, other| other.0.total_cmp(&one.0));
        let least = WORTH * worst.first()?.0;
        let mut along = vec![[false; 2]; elements.all.len()];
        let mut count = elements.all.len();
        for (defect, k, d) in worst {
            let parts = if along[k][1 - d] { 2 } else { 1 };
            if (count + parts) * NODES <= unknowns {
                along[k][d] = true;
                count += parts;
            } else if defect >= least {
                return None;
            }
        }
        Some(elements.cut(|k| along[k]))
    }

    /// Whether nodes do not come so near to the boundary by a cut that rounding moves them.
    fn has_room(&self, k: usize, direction: usize) -> bool {
        let elements = &self.layout.elements;
        let Element { cell, .. } = elements.all[k];
        let [low, high] = [cell.u, cell.v][direction];
        let nearest = low + 0.25 * (high - low) * (1.0 + COARSE.nodes[0]);
        elements.chart(&elements.all[k]).depth(direction, nearest) >= NEAREST
    }

    pub(super) fn answer(self, class: Class, tolerance: f64) -> Answer<'e, [f64; 2], T> {
        let met = if self.meets(tolerance) { Status::Converged } else { Status::ToleranceNotMet };
        let status = self.status().unwrap_or(met);
        let equation = self.layout.equation;
        let elements = self.layout.elements.clone();
        let phi = Phi {
            equation,
            elements,
            values: self.values,
            images: self.images,
            rule: Rule::new(self.layout.exponent),
        };
        Answer {
            status,
            method: format!(
                "collocation, product rule on {} elements of the {}{}",
                self.layout.elements.all.len(),
                equation.domain,
                if self.is_in_blocks { ", in blocks of low rank" } else { "" }
            ),
            class: Some(class),
            unknowns: self.layout.dim(),
            error_estimate: if status == Status::NoSolution { f64::INFINITY } else { self.error },
            condition: self.condition,
            solution: Function::new(1, move |_, p| phi.at(*p)),
            alternative: self.verdict.map(|verdict| verdict.alternative),
        }
    }
}

/// What a singular kernel has of the rounding of q near p, as a part of ∫ |K|: |q − p| is known to the last digits of p and q, and where
/// it is smaller than those nothing is known.
fn grain<T>(equation: &PlaneEquation<'_, T>, exponent: f64) -> f64 {
    let (size, offset) = equation.domain.extent();
    (4.0 * f64::EPSILON * (1.0 + offset / size)).powf((2.0 + exponent).min(1.0))
}

/// φ_n = f + the polynomials with the values A u; outside of the domain f + A u.
struct Phi<'e, 'a, T> {
    equation: &'e PlaneEquation<'a, T>,
    elements: Arc<Elements>,
    values: Vec<T>,
    images: Vec<T>,
    rule: Rule,
}

impl<T: Scalar> Phi<'_, '_, T> {
    fn at(&self, p: Point) -> T {
        let image = match self.elements.locate(p) {
            Some((k, uv)) => {
                interpolated(&self.images[NODES * k..][..NODES], self.elements.all[k].cell.local(uv))
            }
            None => {
                let mut row = vec![T::ZERO; self.values.len()];
                let target = Target { p, place: None };
                match RowBuilder::new(self.equation, &self.elements, &self.rule, target).row(&mut row) {
                    Ok(()) => row.iter().zip(&self.values).map(|(a, u)| *a * *u).sum(),
                    Err(_) => T::from(f64::NAN),
                }
            }
        };
        (self.equation.source)(p) + image
    }
}
