//! One mesh: its links, the equation on them, and the field that it makes.

use super::domain::Domain;
use super::error;
use super::field::Field;
use super::links::{Coarseness, Link, Links, gathered, means};
use super::refine::{residuals, rough};
use super::tree::Tree;
use fredholm::operator::Operator;
use fredholm::relax::{Relaxation, Report, Stop, SuccessiveApproximation, relax};
use fredholm::system::System;
use fredholm::value::{Value, max_norm};
use rayon::prelude::*;

/// A mesh to be solved on.
#[derive(Debug)]
pub(super) struct Mesh {
    pub tree: Tree,
    /// How far the radiosity is believed to be from its mean over each node, in W/m²; unknown at first.
    pub variation: Vec<f64>,
    /// The irradiance that a link may be wrong by, in W/m².
    pub tolerance: f64,
}

/// The first patches are no larger than this part of the scene.
const FIRST: f64 = 0.6;

/// The residual of the cells' equations, as part of the accuracy and of the brightest source.
const ITERATION: f64 = 0.01;

/// Bounces that are followed: 10⁴ are the light between mirrors of .999.
pub(super) const SWEEPS: usize = 10_000;

impl Mesh {
    /// The first one.
    pub fn first<V: Value>(domain: &Domain<'_, V>) -> Self {
        let tree = Tree::new(domain.faces(), FIRST * domain.extent());
        Self { tree, variation: Vec::new(), tolerance: 0.0 }
    }

    /// The field on this mesh, and its error.
    pub fn solved<'a, V: Value>(self, domain: &'a Domain<'a, V>, accuracy: f64) -> Field<'a, V> {
        let Self { tree, variation, tolerance } = self;
        let cells: Vec<u32> = tree.cells().collect();
        let coarseness = Coarseness::new(&variation, tolerance, accuracy);
        let look = |view: &mut _, cell: &u32| {
            let node = tree.node(*cell);
            domain.links(&tree, coarseness, (node.face, domain.node_of(node)), view)
        };
        let links: Vec<Vec<Link>> = cells.par_iter().map_init(Default::default, look).collect();
        let count = links.iter().map(Vec::len).sum();
        let operator = Links { tree: &tree, cells: &cells, links };
        let solved = solved(domain, &operator, accuracy);
        let links = operator.links;
        let radiosity = means(&tree, &cells, &solved.radiosity);
        let mut field = Field {
            domain,
            smooth: means(&tree, &cells, &solved.smooth),
            variation: variation_of(&tree, &radiosity),
            radiosity,
            residuals: Vec::new(),
            rough: Vec::new(),
            tree,
            tolerance,
            accuracy,
            links: count,
            bound: error::Bound::default(),
        };
        field.residuals = residuals(&field);
        field.rough = rough(&field, accuracy);
        let operator = Links { tree: &field.tree, cells: &cells, links };
        field.bound = error::bound(&field, &operator, &solved.report);
        field
    }
}

struct Solved<V> {
    /// The reflected radiosity of each cell.
    radiosity: Vec<V>,
    /// The irradiance of each cell, without that of lamps that are looked at one by one.
    smooth: Vec<V>,
    report: Report,
}

fn solved<V: Value>(domain: &Domain<'_, V>, operator: &Links<'_>, accuracy: f64) -> Solved<V> {
    let Links { tree, cells, .. } = *operator;
    let reflectance: Vec<V> = cells.iter().map(|&cell| domain.reflectance(tree.node(cell).face)).collect();
    // E is the same all over a face, and its links have all of the face together: this is ∫ K E to the last digit.
    let emission: Vec<V> = tree.nodes.iter().map(|node| domain.emission(node.face)).collect();
    let direct: Vec<V> = operator.links.iter().map(|links| gathered(links, &emission)).collect();
    let of_points = cells.par_iter().map(|&cell| {
        let node = tree.node(cell);
        domain.sent_by_points(node.face, domain.node_of(node))
    });
    let of_points: Vec<V> = of_points.collect();
    let lit = direct.iter().zip(&of_points).zip(&reflectance);
    let source: Vec<V> = lit.map(|((lamps, points), rho)| (*lamps + *points) * *rho).collect();
    let system = System { source: &source, coefficient: &reflectance, operator };
    let stop = Stop { residual: ITERATION * accuracy * max_norm(&source), sweeps: SWEEPS };
    let mut relaxation = SuccessiveApproximation::new(system);
    let report = relax(&mut relaxation, stop, |_, _, _| true);
    let radiosity = relaxation.solution();
    let mut smooth = vec![V::splat(0.0); cells.len()];
    operator.apply(&radiosity, &mut smooth);
    if !domain.has_lamps() {
        smooth.iter_mut().zip(&direct).for_each(|(h, direct)| *h += *direct);
    }
    Solved { radiosity, smooth, report }
}

/// How far the values on each node are from their middle, by half of what is between the least and the largest.
pub(super) fn variation_of<V: Value>(tree: &Tree, values: &[V]) -> Vec<f64> {
    let (mut low, mut high) = (values.to_vec(), values.to_vec());
    for (k, node) in tree.nodes.iter().enumerate().rev() {
        for part in node.parts.clone() {
            low[k] = low[k].zip(low[part as usize], f64::min);
            high[k] = high[k].zip(high[part as usize], f64::max);
        }
    }
    low.iter().zip(&high).map(|(low, high)| 0.5 * (*high - *low).magnitude()).collect()
}
