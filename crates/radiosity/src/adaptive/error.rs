//! û − u = −(I − A)⁻¹ r with the residual r = f + A û − û of the continuous equation, in the mean square over all faces:
//! ‖û − u‖ ≤ ‖r‖ + ‖(I − A)⁻¹ A r‖.
//!
//! ‖r‖ is looked at in points that no cell has for its centre, from which every cell is seen. (I − A)⁻¹ A carries to the cells
//! what r is in the middle of patches, as if it were so all over them. What cells leave unseen of û within themselves is
//! told by what becomes of ∫ K û when patches, four times as large, stand for their cells: a third of the difference, for
//! the error falls with the area; to that, to form factors and to the iteration, ‖(I − A)⁻¹‖ = 1/(1 − λ) is applied, with
//! the λ by which each sweep shrinks the residual: A is self-adjoint in the norm weighted by 1/ρ.

use super::field::Field;
use super::links::{Coarseness, Links, gathered};
use super::refine::square;
use super::round::SWEEPS;
use fredholm::relax::{Relaxation, Report, Stop, SuccessiveApproximation, relax};
use fredholm::system::System;
use fredholm::value::{Value, max_norm};
use glam::DVec3;
use rayon::prelude::*;

/// What the error of a field is made of: in the mean square over all faces, relative to the mean square of the light that
/// they reflect.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bound {
    /// Of the mesh: what is between the cells, and within them.
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

/// Points in which the residual is looked at.
const SAMPLES: usize = 96;

/// The bound of a field, from its residual and from that of its cells' equations, of this operator.
pub(super) fn bound<V: Value>(field: &Field<'_, V>, operator: &Links<'_>, report: &Report) -> Bound {
    let scale = field.scale();
    if scale == 0.0 {
        return Bound::default();
    }
    let patches = of_patches(field);
    let look = |view: &mut _, (face, point): (u32, DVec3)| {
        let rho = field.domain.reflectance(face);
        let links = field.domain.links(&field.tree, Coarseness::CELLS, (face, point), view);
        let direct = links.iter().fold(field.domain.sent_by_points(face, point), |sum, link| {
            sum + field.domain.emission(field.tree.node(link.node).face) * f64::from(link.factor)
        });
        let seen = gathered(&links, &field.radiosity);
        let coarse = field.gathered(face, point, view);
        let unseen = square(rho * (seen - gathered(&links, &patches)));
        let linked = square(rho * (seen + direct - coarse));
        [square(rho * (coarse - field.irradiance_with(face, point, view))), linked, unseen]
    };
    let squares: Vec<[f64; 3]> = points(field).into_par_iter().map_init(Default::default, look).collect();
    let mean = |k: usize| (squares.iter().map(|s| s[k]).sum::<f64>() / squares.len() as f64).sqrt();
    let inverse = 1.0 / (1.0 - contraction(report)) / scale;
    Bound {
        discretisation: (mean(0) + carried(field, operator)) / scale + inverse * mean(2) / 3.0,
        form_factors: inverse * mean(1),
        iteration: inverse * report.residual,
    }
}

/// ‖(I − A)⁻¹ A r‖ for the r of the middle of patches. Rough ones have none: there û is f + A û at each point.
fn carried<V: Value>(field: &Field<'_, V>, operator: &Links<'_>) -> f64 {
    let tree = &field.tree;
    let mut residual = vec![V::splat(0.0); tree.nodes.len()];
    for patch in tree.patches().filter(|&patch| !field.rough[patch as usize]) {
        tree.node(patch)
            .parts
            .clone()
            .for_each(|cell| residual[cell as usize] = field.residuals[patch as usize]);
    }
    let source: Vec<V> = operator.cells.iter().map(|&cell| residual[cell as usize]).collect();
    let faces = operator.cells.iter().map(|&cell| tree.node(cell).face);
    let reflectance: Vec<V> = faces.map(|face| field.domain.reflectance(face)).collect();
    let system = System { source: &source, coefficient: &reflectance, operator };
    let mut relaxation = SuccessiveApproximation::new(system);
    let stop = Stop { residual: CARRIED * max_norm(&source), sweeps: SWEEPS };
    relax(&mut relaxation, stop, |_, _, _| true);
    let carried = relaxation.solution().into_iter().zip(&source).map(|(e, r)| e - *r);
    let of_cells = operator.cells.iter().zip(carried).map(|(&cell, e)| (tree.node(cell).area, square(e)));
    let (sum, area) =
        of_cells.fold((0.0, 0.0), |(sum, all), (area, square)| (sum + area * square, all + area));
    (sum / area).sqrt()
}

/// The residual of that, as part of its largest source.
const CARRIED: f64 = 0.01;

/// The radiosity with that of patches in place of their cells'.
fn of_patches<V: Value>(field: &Field<'_, V>) -> Vec<V> {
    let mut values = field.radiosity.clone();
    for patch in field.tree.patches() {
        for part in field.tree.node(patch).parts.clone() {
            values[part as usize] = field.radiosity[patch as usize];
        }
    }
    values
}

/// By how much the last sweep made the residual smaller.
fn contraction(report: &Report) -> f64 {
    match report.residuals.as_slice() {
        [.., before, last] if *before > 0.0 => (last / before).min(0.9999),
        _ => 0.0,
    }
}

/// Points spread evenly over all faces.
fn points<V: Value>(field: &Field<'_, V>) -> Vec<(u32, DVec3)> {
    let faces = field.domain.faces();
    let area: f64 = faces.iter().map(|face| face.area()).sum();
    let (mut face, mut end) = (0, faces[0].area());
    (0..SAMPLES)
        .map(|k| {
            let k = k as f64 + 0.5;
            while end < k / SAMPLES as f64 * area && face + 1 < faces.len() {
                face += 1;
                end += faces[face].area();
            }
            // Multiples of the powers of the plastic number's inverse.
            let [s, t] = [0.754_877_666_246_693, 0.569_840_290_998_053].map(|step| (k * step).fract());
            (face as u32, faces[face].point(s, t))
        })
        .collect()
}
