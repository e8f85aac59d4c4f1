//! û(x) = E + ρ (D(x) + H(x)): D straight from lamps, at x itself; H the polynomial on a patch, where it is smooth.

use super::domain::Domain;
use super::error::Bound;
use super::links::{Coarseness, Link, Looks, gathered};
use super::round::Iteration;
use super::space::{CHECKS, Space};
use super::tree::Tree;
use crate::form_factor::view::View;
use crate::polygon::Polygon;
use fredholm::value::Value;
use glam::DVec3;

/// The answer: light at any point of any face, with its error.
#[derive(Debug)]
pub struct Field<'a, V> {
    pub(super) domain: &'a Domain<'a, V>,
    pub(super) tree: Tree,
    pub(super) space: Space,
    /// H at the nodes of the space, and its mean over each node of the tree, in W/m².
    pub(super) values: Vec<V>,
    pub(super) smooth: Vec<V>,
    /// D at the points of leaves, in W/m².
    pub(super) direct: Vec<V>,
    /// The mean of the reflected radiosity û − E, the same with the light of lamps that are too many to be looked at one by
    /// one, and how far it is from its mean.
    pub(super) radiosity: Vec<V>,
    pub(super) sent: Vec<V>,
    pub(super) variation: Vec<f64>,
    /// The residual E + A û − û in the checks of each patch, in W/m².
    pub(super) residuals: Vec<[V; CHECKS]>,
    /// Patches on which H is not smooth, and is found at x itself.
    pub(super) rough: Vec<bool>,
    /// The irradiance that a link may be wrong by, in W/m².
    pub(super) tolerance: f64,
    /// What was asked for.
    pub(super) accuracy: f64,
    /// What each patch sees.
    pub(super) looks: Vec<Looks>,
    pub(super) iteration: Iteration,
    pub(super) bound: Bound,
}

/// A leaf of the mesh that the answer stands on: a sixty-fourth of a patch.
#[derive(Clone, Debug)]
pub struct Part<V> {
    /// Where it is.
    pub polygon: Polygon,
    /// Which face it is a part of.
    pub face: u32,
    /// The mean radiosity, in W/m².
    pub radiosity: V,
    /// The mean irradiance, in W/m².
    pub irradiance: V,
}

impl<V: Value> Field<'_, V> {
    /// The radiosity û at a point of a face, in W/m².
    pub fn radiosity(&self, face: u32, point: DVec3) -> V {
        self.domain.emission(face) + self.domain.reflectance(face) * self.irradiance(face, point)
    }

    /// The irradiance D + H at a point of a face, in W/m².
    pub fn irradiance(&self, face: u32, point: DVec3) -> V {
        self.irradiance_with(face, point, &mut View::default())
    }

    /// The radiosity and the irradiance at points of faces, in W/m².
    pub fn light(&self, points: impl Iterator<Item = (u32, DVec3)>) -> Vec<[V; 2]> {
        let mut view = View::default();
        let at = |(face, point): (u32, DVec3)| {
            let irradiance = self.irradiance_with(face, point, &mut view);
            [self.domain.emission(face) + self.domain.reflectance(face) * irradiance, irradiance]
        };
        points.map(at).collect()
    }

    /// The error of the radiosity, as the residual of the equation tells it.
    pub fn bound(&self) -> Bound {
        self.bound
    }

    /// How many patches the mesh has, and how many form factors.
    pub fn size(&self) -> [usize; 2] {
        [self.space.patches.len(), self.looks.iter().flatten().map(Vec::len).sum()]
    }

    /// The patches, each with the number of its face.
    pub fn patches(&self) -> impl Iterator<Item = (u32, &Polygon)> {
        self.space.patches.iter().map(|&patch| (self.tree.node(patch).face, &self.tree.node(patch).polygon))
    }

    /// The mesh, face by face.
    pub fn parts(&self) -> Vec<Part<V>> {
        let mut patches = self.space.patches.clone();
        patches.sort_by_key(|&patch| self.tree.node(patch).face);
        let part = |leaf: u32| {
            let node = self.tree.node(leaf);
            let k = leaf as usize;
            let irradiance = (self.direct[k] + self.smooth[k]) * (node.exposed / node.area);
            let radiosity = self.domain.emission(node.face) + self.domain.reflectance(node.face) * irradiance;
            Part { polygon: node.polygon.clone(), face: node.face, radiosity, irradiance }
        };
        patches.into_iter().flat_map(|patch| self.tree.leaves_of(patch)).map(part).collect()
    }

    /// The root of the mean square of the reflected radiosity, in W/m².
    pub fn scale(&self) -> f64 {
        let (mut sum, mut area) = (0.0, 0.0);
        for leaf in self.tree.leaves() {
            let node = self.tree.node(leaf);
            sum += node.area * self.radiosity[leaf as usize].square();
            area += node.area;
        }
        (sum / area).sqrt()
    }

    pub(super) fn irradiance_with(&self, face: u32, point: DVec3, view: &mut View) -> V {
        if self.domain.is_buried(face, point) {
            return V::splat(0.0);
        }
        self.domain.direct(face, point, view) + self.smooth_at(face, point, view)
    }

    /// H at a point, by the polynomial where that does.
    pub(super) fn smooth_at(&self, face: u32, point: DVec3, view: &mut View) -> V {
        let patch = self.tree.patch_at(face, point);
        if self.rough[patch as usize] { self.gathered(face, point, view) } else { self.between(patch, point) }
    }

    /// H at the point itself.
    pub(super) fn gathered(&self, face: u32, point: DVec3, view: &mut View) -> V {
        gathered(&self.links_from(face, point, view), &self.sent)
    }

    /// The parts of the scene that a point sees.
    pub(super) fn links_from(&self, face: u32, point: DVec3, view: &mut View) -> Vec<Link> {
        let coarseness = Coarseness::new(&self.variation, self.tolerance, self.accuracy);
        self.domain.descent(&self.tree, coarseness, (face, point)).links(view)
    }

    /// H on a patch, as the polynomial has it.
    pub(super) fn between(&self, patch: u32, point: DVec3) -> V {
        let k = self.space.patches.partition_point(|&other| other < patch);
        self.space.at(&self.values, k, self.tree.node(patch), point)
    }

    /// The mean square of the residual of the k-th patch, in (W/m²)².
    pub(super) fn square_residual(&self, k: usize) -> f64 {
        self.residuals[k].iter().map(|r| r.square()).sum::<f64>() / CHECKS as f64
    }
}
