//! û − u = −(I − A)⁻¹ r with the residual r = f + A û − û of the continuous equation, in the mean square over all faces:
//! ‖û − u‖ ≤ ‖r‖ + ‖(I − A)⁻¹ A r‖.
//!
//! ‖r‖ is looked at in points that are no nodes. (I − A)⁻¹ A carries to the nodes what r is in the middle of the quarters of
//! patches, as if it were so all over them. What leaves do not tell of û within themselves is told by what becomes of ∫ K û
//! when four leaves stand for one: a third of the difference, for the error falls with
//! the area. What links are wrong by is told by finer ones. To that, and to the iteration, ‖(I − A)⁻¹‖ = 1/(1 − λ) is applied, with
//! the λ by which each sweep shrinks the residual: A is self-adjoint in the norm weighted by 1/ρ.

use super::field::Field;
use super::links::{Coarseness, Links, gathered};
use super::round::SWEEPS;
use super::space::{CHECKS, average};
use super::tree::LEAVES;
use crate::reconstruct::scattered;
use fredholm::relax::{Relaxation, Stop, SuccessiveApproximation, relax};
use fredholm::system::System;
use fredholm::value::{Value, max_norm};
use glam::DVec3;
use rayon::prelude::*;

/// What the error of a field is made of: in the mean square over all faces, relative to the mean square of the light that
/// they reflect.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bound {
    /// Of the mesh: what is between the nodes, and within the leaves.
    pub discretisation: f64,
    /// Of the form factors: parts of the scene that are seen as one.
    pub form_factors: f64,
    /// Of the iteration, which was stopped.
    pub iteration: f64,
}

impl Bound {
    /// All of it.
    pub fn total(&self) -> f64 {
        self.discretisation + self.form_factors + self.iteration
    }
}

/// The part of their error that finer links have by which links are judged.
const FINER: f64 = 0.1;

/// Points in which the residual is looked at.
const SAMPLES: usize = 96;

/// The mean square of the residual in the checks of patches, relative to the light: less than the error, and known at once.
pub(super) fn residual<V: Value>(field: &Field<'_, V>) -> f64 {
    let patches = field.space.patches.iter().enumerate().filter(|(_, patch)| !field.rough[**patch as usize]);
    let of_patch = |(k, patch): (usize, &u32)| field.tree.node(*patch).area * field.square_residual(k);
    let area: f64 = field.domain.faces().iter().map(|face| face.area()).sum();
    let scale = field.scale();
    if scale > 0.0 { (patches.map(of_patch).sum::<f64>() / area).sqrt() / scale } else { 0.0 }
}

/// The bound of a field, from its residual and from that of its nodes' equations.
pub(super) fn bound<V: Value>(field: &Field<'_, V>) -> Bound {
    let scale = field.scale();
    if scale == 0.0 {
        return Bound::default();
    }
    let fours = of_fours(field);
    let finer = Coarseness::new(&field.variation, FINER * field.tolerance, FINER * field.accuracy);
    let look = |view: &mut _, (face, point): (u32, DVec3)| {
        if field.domain.is_buried(face, point) {
            return [0.0; 3];
        }
        let links = field.domain.descent(&field.tree, finer, (face, point)).links(view);
        let seen = gathered(&links, &field.sent);
        let coarse = field.gathered(face, point, view);
        let differences =
            [coarse - field.smooth_at(face, point, view), seen - coarse, seen - gathered(&links, &fours)];
        differences.map(|difference| (field.domain.reflectance(face) * difference).square())
    };
    let squares: Vec<[f64; 3]> = points(field).into_par_iter().map_init(Default::default, look).collect();
    let mean = |k: usize| (squares.iter().map(|s| s[k]).sum::<f64>() / squares.len() as f64).sqrt();
    let inverse = 1.0 / (1.0 - field.iteration.contraction) / scale;
    Bound {
        discretisation: (mean(0) + carried(field)) / scale + inverse * mean(2) / 3.0,
        form_factors: inverse * mean(1) / (1.0 - FINER),
        iteration: inverse * field.iteration.residual,
    }
}

/// ‖(I − A)⁻¹ A r‖ for the r of the checks, each for its quarter. Where û is f + A û, on rough
/// patches, A still has the polynomial.
fn carried<V: Value>(field: &Field<'_, V>) -> f64 {
    let Field { tree, space, looks, .. } = field;
    let mut residual = vec![V::splat(0.0); tree.nodes.len()];
    for (&patch, checks) in space.patches.iter().zip(&field.residuals) {
        let of_quarter = LEAVES / CHECKS;
        for (k, leaf) in tree.leaves_of(patch).enumerate() {
            residual[leaf as usize] = checks[k / of_quarter];
        }
    }
    average(tree, &mut residual);
    let operator = Links { tree, space, looks };
    let reflectance = field.domain.reflectances(tree, space);
    let source: Vec<V> =
        operator.gathered(&residual).into_iter().zip(&reflectance).map(|(h, rho)| h * *rho).collect();
    let system = System { source: &source, coefficient: &reflectance, operator: &operator };
    let mut relaxation = SuccessiveApproximation::new(system);
    let stop = Stop { residual: CARRIED * max_norm(&source), sweeps: SWEEPS };
    relax(&mut relaxation, stop, |_, _, _| true);
    let carried = space.means(tree, &relaxation.solution());
    let of_leaf = |leaf: u32| [tree.node(leaf).area * carried[leaf as usize].square(), tree.node(leaf).area];
    let [sum, area] = tree.leaves().map(of_leaf).fold([0.0; 2], |[a, b], [c, d]| [a + c, b + d]);
    (sum / area).sqrt()
}

/// The residual of that, as part of its largest source.
const CARRIED: f64 = 0.01;

/// The radiosity with what four leaves have together in place of theirs.
fn of_fours<V: Value>(field: &Field<'_, V>) -> Vec<V> {
    let mut values = field.sent.clone();
    for (k, node) in field.tree.nodes.iter().enumerate() {
        node.parts.clone().filter(|&part| field.tree.is_leaf(part)).for_each(|leaf| {
            values[leaf as usize] = field.sent[k];
        });
    }
    values
}

/// Points spread evenly over all faces.
fn points<V: Value>(field: &Field<'_, V>) -> Vec<(u32, DVec3)> {
    let faces = field.domain.faces();
    let area: f64 = faces.iter().map(|face| face.area()).sum();
    let (mut face, mut end) = (0, faces[0].area());
    (0..SAMPLES)
        .map(|k| {
            while end < (k as f64 + 0.5) / SAMPLES as f64 * area && face + 1 < faces.len() {
                face += 1;
                end += faces[face].area();
            }
            let (s, t) = scattered(k);
            (face as u32, faces[face].point(s, t))
        })
        .collect()
}
