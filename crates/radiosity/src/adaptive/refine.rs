//! Which patches are cut: those on which the residual û − E − ρ ∫ K û is large, in the mean square.

use super::Request;
use super::field::Field;
use super::round::{Mesh, variation_of};
use fredholm::value::Value;
use glam::DVec3;
use rayon::prelude::*;

/// Cells more for a patch that is cut: four are cut in four.
pub(super) const NEW: usize = 12;

/// Patches are cut that have this part of the whole (Dörfler's marking): fewer are more rounds, more are finer than needed.
const BULK: f64 = 0.95;

/// Light that varies over a patch is seen wrongly by what is near, even where the field is right on it.
const SOURCE: f64 = 0.005;

/// The part of the accuracy that links may take.
const LINKS: f64 = 0.3;

/// A patch is not interpolated on where that is wrong by so many times the accuracy: of the light on it, for eyes look for
/// steps in the dark too, but not of less than the second part of the mean.
const ROUGH: f64 = 3.0;
const DARK: f64 = 0.05;

/// The sum of the squares of the channels.
pub(super) fn square<V: Value>(value: V) -> f64 {
    value.channels().iter().map(|c| c * c).sum()
}

/// The patches to be cut, the worst first.
pub(super) fn marked<V: Value>(field: &Field<'_, V>, request: &Request) -> Vec<u32> {
    let within = field.bound.discretisation + field.bound.iteration;
    if within <= (1.0 - LINKS) * request.accuracy {
        return Vec::new();
    }
    let error = |patch: u32| {
        let node = field.tree.node(patch);
        let mean = field.radiosity[patch as usize];
        let spread: f64 = node.parts.clone().map(|k| square(field.radiosity[k as usize] - mean)).sum();
        node.area * (square(field.residuals[patch as usize]) + SOURCE * spread / 4.0)
    };
    let mut patches: Vec<(f64, u32)> = field.tree.patches().map(|patch| (error(patch), patch)).collect();
    patches.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let bulk = BULK * patches.iter().map(|(error, _)| error).sum::<f64>();
    let mut sum = 0.0;
    let before = |(error, _): &(f64, u32)| {
        let before = sum < bulk;
        sum += error;
        before
    };
    patches.into_iter().take_while(before).map(|(_, patch)| patch).collect()
}

/// The next mesh.
pub(super) fn refined<V: Value>(field: Field<'_, V>, marked: &[u32], accuracy: f64) -> Mesh {
    let scale = field.scale();
    let Field { mut tree, radiosity: mut values, bound, .. } = field;
    for &patch in marked {
        for cell in tree.node(patch).parts.clone() {
            let parts = tree.quarter(cell);
            values.resize(values.len() + parts.len(), values[cell as usize]);
        }
    }
    let tolerance = if field.tolerance == 0.0 {
        // A first guess, and then what the error that it made asks for.
        0.1 * LINKS * accuracy * scale
    } else {
        field.tolerance * (LINKS * accuracy / bound.form_factors).clamp(0.1, 2.0)
    };
    Mesh { variation: variation_of(&tree, &values), tree, tolerance }
}

/// The residual in the middle of each patch; 0 for other nodes.
pub(super) fn residuals<V: Value>(field: &Field<'_, V>) -> Vec<V> {
    let of_node = |view: &mut _, node: u32| {
        if field.tree.is_patch(node) { field.residual(node, view) } else { V::splat(0.0) }
    };
    (0..field.tree.nodes.len() as u32).into_par_iter().map_init(Default::default, of_node).collect()
}

/// Of each node, whether it is a patch between whose cells the light is not smooth: where something stands on it, say.
pub(super) fn rough<V: Value>(field: &Field<'_, V>, accuracy: f64) -> Vec<bool> {
    let scale = field.scale();
    let is_rough = |node: u32| {
        let light = square(field.radiosity[node as usize]).sqrt().clamp(DARK * scale, scale);
        let tolerance = (ROUGH * accuracy * light).powi(2);
        square(field.residuals[node as usize]) > tolerance || steps(field, node).any(|step| step > tolerance)
    };
    let nodes = 0..field.tree.nodes.len() as u32;
    nodes.into_par_iter().map(|node| field.tree.is_patch(node) && is_rough(node)).collect()
}

/// The squares of the steps of radiosity where the field goes from a patch to its neighbours, at corners and middles of sides.
fn steps<'a, V: Value>(field: &'a Field<'_, V>, patch: u32) -> impl Iterator<Item = f64> + 'a {
    let node = field.tree.node(patch);
    let rho = field.domain.reflectance(node.face);
    let v = node.polygon.vertices();
    let middle = node.polygon.centroid();
    let places = (0..v.len()).flat_map(move |k| [v[k], v[k].midpoint(v[(k + 1) % v.len()])]);
    places.map(move |place: DVec3| {
        let beyond = field.tree.patch_at(node.face, place + (place - middle) * 1e-3);
        square(rho * (field.interpolated(patch, place) - field.interpolated(beyond, place)))
    })
}
