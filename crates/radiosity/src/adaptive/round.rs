//! One mesh: its links, the equation on them, and the field that it makes. What was found for the mesh before is kept.

use super::domain::Domain;
use super::error::Bound;
use super::field::Field;
use super::links::{Coarseness, Links, Looks};
use super::refine::{LINKS, residuals, rough};
use super::space::{Space, average};
use super::tree::{Node, Tree};
use fredholm::relax::{Relaxation, Stop, SuccessiveApproximation, relax};
use fredholm::system::System;
use fredholm::value::Value;

/// A mesh to be solved on.
#[derive(Debug)]
pub(super) struct Mesh<V> {
    pub tree: Tree,
    pub space: Space,
    /// D at the points of nodes, as far as it is known, in W/m².
    pub direct: Vec<V>,
    /// H at the nodes of the space as it is believed to be, in W/m².
    pub values: Vec<V>,
    /// What is seen of the mesh before, where it is known.
    pub looks: Vec<Looks>,
    /// How much the radiosity is believed to vary over the whole scene beside that, in W/m².
    pub unknown: f64,
    /// The irradiance that a link may be wrong by, in W/m².
    pub tolerance: f64,
    /// By how much sweeps on the meshes before made their residual smaller at the least.
    pub contraction: f64,
}

/// The first patches are no larger than this part of the scene.
const FIRST: f64 = 0.6;

/// The residual of the nodes' equations, as part of the accuracy and of the brightest source.
const ITERATION: f64 = 0.01;

/// Bounces that are followed: 10⁴ are the light between mirrors of .999.
pub(super) const SWEEPS: usize = 10_000;

/// Bounces of the light that is believed to be everywhere before any is computed.
const AMBIENT: usize = 16;

/// Part of it by which light is believed to vary over the scene.
const VARIES: f64 = 0.5;

impl<V: Value> Mesh<V> {
    /// The first one: light from lamps, and the ambient term that goes with it.
    pub fn first(domain: &Domain<'_, V>, accuracy: f64) -> Self {
        let tree = domain.tree(FIRST * domain.extent());
        let direct = domain.direct_at_leaves(&tree, Vec::new());
        let area: f64 = tree.leaves().map(|leaf| tree.node(leaf).area).sum();
        let mean = |value: &dyn Fn(&Node, u32) -> V| {
            let sum = tree.leaves().map(|leaf| (tree.node(leaf), leaf));
            sum.fold(V::splat(0.0), |sum, (node, leaf)| sum + value(node, leaf) * (node.area / area))
        };
        let rho = mean(&|node, _| domain.reflectance(node.face));
        let sent = mean(&|node, leaf| {
            let lamps = if domain.has_lamps() { V::splat(0.0) } else { domain.emission(node.face) };
            direct[leaf as usize] + lamps
        });
        let ambient = (0..AMBIENT).fold(V::splat(0.0), |ambient, _| rho * (sent + ambient));
        let scale = mean(&|node, leaf| {
            let lit = domain.reflectance(node.face) * (direct[leaf as usize] + ambient);
            lit.map(|c| c * c)
        });
        let space = Space::new(domain, &tree);
        Self {
            values: vec![ambient; space.dim()],
            looks: vec![Looks::new(); tree.nodes.len()],
            unknown: VARIES * (rho * ambient).magnitude(),
            tolerance: first_tolerance(accuracy, scale.channels().iter().sum::<f64>().sqrt()),
            contraction: 0.0,
            tree,
            space,
            direct,
        }
    }

    /// The field on this mesh.
    pub fn solved<'a>(self, domain: &'a Domain<'a, V>, accuracy: f64) -> Field<'a, V> {
        let variation = self.variation(domain);
        let Self { tree, space, direct, values: guess, looks: known, tolerance, contraction, .. } = self;
        let coarseness = Coarseness::new(&variation, tolerance, accuracy);
        let looks = domain.looks(&tree, coarseness, known);
        let operator = Links { tree: &tree, space: &space, looks: &looks };
        let Solved { values, mut iteration } = solved(domain, operator, &direct, &guess, accuracy);
        // From a good start all but the quick part of the error is gone.
        iteration.contraction = iteration.contraction.max(contraction);
        let smooth = space.means(&tree, &values);
        let radiosity = reflected(domain, &tree, &direct, &smooth);
        let mut field = Field {
            variation: variation_of(&tree, &radiosity),
            sent: with_emission(domain, &tree, radiosity.clone()),
            domain,
            tree,
            space,
            direct,
            values,
            smooth,
            radiosity,
            looks,
            residuals: Vec::new(),
            rough: Vec::new(),
            tolerance,
            accuracy,
            iteration,
            bound: Bound::default(),
        };
        field.residuals = residuals(&field);
        field.rough = rough(&field, accuracy);
        field
    }

    /// How far the radiosity is believed to be from its mean over each node, in W/m².
    fn variation(&self, domain: &Domain<'_, V>) -> Vec<f64> {
        let Self { tree, space, direct, values, unknown, .. } = self;
        let smooth = space.means(tree, values);
        let mut variation = variation_of(tree, &reflected(domain, tree, direct, &smooth));
        let unknown = unknown / domain.extent();
        variation.iter_mut().zip(&tree.nodes).for_each(|(v, node)| *v += unknown * node.diameter);
        variation
    }
}

/// The mean of the reflected radiosity over each node, of the irradiance D + H of the leaves.
fn reflected<V: Value>(domain: &Domain<'_, V>, tree: &Tree, direct: &[V], smooth: &[V]) -> Vec<V> {
    let mut radiosity = vec![V::splat(0.0); tree.nodes.len()];
    for leaf in tree.leaves() {
        let k = leaf as usize;
        radiosity[k] = domain.reflectance(tree.node(leaf).face) * (direct[k] + smooth[k]);
    }
    average(tree, &mut radiosity);
    radiosity
}

/// The radiosity that H is made of: of lamps that are looked at one by one, only what they reflect.
fn with_emission<V: Value>(domain: &Domain<'_, V>, tree: &Tree, mut radiosity: Vec<V>) -> Vec<V> {
    if !domain.has_lamps() {
        radiosity.iter_mut().zip(&tree.nodes).for_each(|(b, node)| *b += domain.emission(node.face));
    }
    radiosity
}

struct Solved<V> {
    /// H at the nodes of the space.
    values: Vec<V>,
    iteration: Iteration,
}

/// How the equations of the nodes were solved.
#[derive(Clone, Copy, Debug)]
pub(super) struct Iteration {
    /// What is left of their residual, in W/m².
    pub residual: f64,
    /// By how much the last sweep made it smaller.
    pub contraction: f64,
}

/// H = F (E + ρ D) + F w, where w = ρ H satisfies w = ρ F (E + ρ D) + ρ F w; the unknown is what is wrong with a guess of w.
fn solved<V: Value>(
    domain: &Domain<'_, V>,
    operator: Links<'_>,
    direct: &[V],
    guess: &[V],
    accuracy: f64,
) -> Solved<V> {
    let Links { tree, space, .. } = operator;
    let nothing = vec![V::splat(0.0); tree.nodes.len()];
    let first = operator.gathered(&with_emission(domain, tree, reflected(domain, tree, direct, &nothing)));
    let reflectance = domain.reflectances(tree, space);
    let mut w: Vec<V> = guess.iter().zip(&reflectance).map(|(h, rho)| *h * *rho).collect();
    let arrives = |w: &[V]| -> Vec<V> {
        let again = operator.gathered(&space.means(tree, w));
        again.into_iter().zip(&first).map(|(again, first)| again + *first).collect()
    };
    let wrong = |((h, rho), w): ((V, &V), &V)| h * *rho - *w;
    let source: Vec<V> = arrives(&w).into_iter().zip(&reflectance).zip(&w).map(wrong).collect();
    let system = System { source: &source, coefficient: &reflectance, operator: &operator };
    let brightest =
        first.iter().zip(&reflectance).map(|(h, rho)| (*h * *rho).magnitude()).fold(0.0, f64::max);
    let stop = Stop { residual: ITERATION * accuracy * brightest, sweeps: SWEEPS };
    let mut relaxation = SuccessiveApproximation::new(system);
    let report = relax(&mut relaxation, stop, |_, _, _| true);
    w.iter_mut().zip(relaxation.solution()).for_each(|(w, wrong)| *w += wrong);
    let values = arrives(&w);
    let contraction = match report.residuals.as_slice() {
        [.., before, last] if *before > 0.0 => (last / before).min(0.9999),
        _ => 0.0,
    };
    Solved { values, iteration: Iteration { residual: report.residual, contraction } }
}

/// What links may be wrong by before it is known what their errors add up to.
fn first_tolerance(accuracy: f64, scale: f64) -> f64 {
    0.1 * LINKS * accuracy * scale
}

/// How far the values on each node are from their middle, by half of what is between the least and the largest.
pub(super) fn variation_of<V: Value>(tree: &Tree, values: &[V]) -> Vec<f64> {
    let (mut low, mut high) = (values.to_vec(), values.to_vec());
    for (k, node) in tree.nodes.iter().enumerate().rev() {
        for part in node.parts.clone().filter(|&part| tree.node(part).exposed > 0.0) {
            low[k] = low[k].zip(low[part as usize], f64::min);
            high[k] = high[k].zip(high[part as usize], f64::max);
        }
    }
    low.iter().zip(&high).map(|(low, high)| 0.5 * (*high - *low).magnitude()).collect()
}
