//! Which patches are cut: those on which the residual û − E − ρ ∫ K û is large, in the mean square.

use super::Request;
use super::field::Field;
use super::links::{Looks, gathered};
use super::round::Mesh;
use super::space::{CHECKS, Element, Space};
use super::tree::Tree;
use fredholm::value::Value;
use glam::DVec3;
use rayon::prelude::*;

/// Patches more for one that is cut.
pub(super) const NEW: usize = 3;

/// Patches are cut that have this part of the whole (Dörfler's marking): fewer are more rounds, more are finer than needed.
const BULK: f64 = 0.95;

/// Light that varies over a patch is seen wrongly by what is near, even where the field is right on it.
const SOURCE: f64 = 0.005;

/// The part of the accuracy that links may take.
pub(super) const LINKS: f64 = 0.3;

/// A patch is not interpolated on where that is wrong by so many times the accuracy: of the light on it, for eyes look for
/// steps in the dark too, but not of less than the second part of the mean.
const ROUGH: f64 = 3.0;
const DARK: f64 = 0.05;

/// The patches to be cut, the worst first.
pub(super) fn marked<V: Value>(field: &Field<'_, V>, request: &Request) -> Vec<u32> {
    let within = field.bound.discretisation + field.bound.iteration;
    if field.bound.total() > 0.0 && within <= (1.0 - LINKS) * request.accuracy {
        return Vec::new();
    }
    let error = |(k, &patch): (usize, &u32)| {
        let node = field.tree.node(patch);
        let mean = field.radiosity[patch as usize];
        let spread: f64 = node.parts.clone().map(|k| (field.radiosity[k as usize] - mean).square()).sum();
        (node.area * (field.square_residual(k) + SOURCE * spread / 4.0), patch)
    };
    let mut patches: Vec<(f64, u32)> = field.space.patches.iter().enumerate().map(error).collect();
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
pub(super) fn refined<V: Value>(field: Field<'_, V>, marked: &[u32], accuracy: f64) -> Mesh<V> {
    let told = field.bound.form_factors;
    let tolerance = if told > 0.0 {
        field.tolerance * (LINKS * accuracy / told).clamp(0.1, 2.0)
    } else {
        field.tolerance
    };
    let mut tree = field.tree.clone();
    field.domain.cut(&mut tree, marked);
    let space = Space::new(field.domain, &tree);
    let believed = |&patch: &u32| {
        let node = tree.node(patch);
        let before = field.tree.patch_at(node.face, node.polygon.centroid());
        let element = Element::of(&node.polygon);
        let points: Vec<DVec3> = element.points(&node.polygon).take(element.dim()).collect();
        points.into_iter().map(|point| field.between(before, point)).collect::<Vec<V>>()
    };
    let values = space.patches.par_iter().flat_map_iter(believed).collect();
    let looks = kept(field.looks, &tree, marked);
    let direct = field.domain.direct_at_leaves(&tree, field.direct);
    let contraction = field.iteration.contraction;
    Mesh { tree, space, direct, values, looks, unknown: 0.0, tolerance, contraction }
}

/// What is still seen after some patches have been cut.
pub(super) fn kept(mut looks: Vec<Looks>, tree: &Tree, cut: &[u32]) -> Vec<Looks> {
    looks.resize(tree.nodes.len(), Looks::new());
    for &patch in cut {
        let node = tree.node(patch);
        let before = std::mem::take(&mut looks[patch as usize]);
        let checks = before.into_iter().skip(Element::of(&node.polygon).dim());
        for (part, check) in node.parts.clone().zip(checks) {
            looks[part as usize] = Element::of(&node.polygon).around(check);
        }
    }
    looks
}

/// The residual in the checks of each patch.
pub(super) fn residuals<V: Value>(field: &Field<'_, V>) -> Vec<[V; CHECKS]> {
    let of_patch = |k: usize| {
        let patch = field.space.patches[k];
        let node = field.tree.node(patch);
        let rho = field.domain.reflectance(node.face);
        let nodes = field.space.range(k).len();
        let points = Element::of(&node.polygon).points(&node.polygon).skip(nodes);
        let mut checks = points.zip(&field.looks[patch as usize][nodes..]).zip(node.parts.clone());
        let is_holed = field.space.is_holed(patch);
        std::array::from_fn(|_| {
            let Some(((point, links), quarter)) = checks.next() else { return V::splat(0.0) };
            let believed =
                if is_holed { field.smooth[quarter as usize] } else { field.between(patch, point) };
            if is_holed && field.domain.is_buried(node.face, point) {
                return V::splat(0.0);
            }
            rho * (gathered(links, &field.sent) - believed)
        })
    };
    (0..field.space.patches.len()).into_par_iter().map(of_patch).collect()
}

/// Of each node, whether it is a patch on which the light is not smooth: where something stands on it, say.
pub(super) fn rough<V: Value>(field: &Field<'_, V>, accuracy: f64) -> Vec<bool> {
    let scale = field.scale();
    let is_rough = |k: usize, patch: u32| {
        let light = field.radiosity[patch as usize].square().sqrt().clamp(DARK * scale, scale);
        let tolerance = (ROUGH * accuracy * light).powi(2);
        field.space.is_holed(patch)
            || field.residuals[k].iter().any(|r| r.square() > tolerance)
            || steps(field, patch).any(|step| step > tolerance)
    };
    let mut rough = vec![false; field.tree.nodes.len()];
    let patches = &field.space.patches;
    let found: Vec<bool> = patches.par_iter().enumerate().map(|(k, &patch)| is_rough(k, patch)).collect();
    patches.iter().zip(found).for_each(|(&patch, found)| rough[patch as usize] = found);
    rough
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
        (rho * (field.between(patch, place) - field.between(beyond, place))).square()
    })
}
