//! û(x) = E + ρ (D(x) + H(x)): D straight from lamps, at x itself; H between the cells of a patch where it is smooth.

use super::domain::Domain;
use super::error::Bound;
use super::links::{Coarseness, Link, gathered};
use super::refine::square;
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
    /// The mean of H over each node, in W/m².
    pub(super) smooth: Vec<V>,
    /// The mean of the reflected radiosity û − E, and how far it is from that mean.
    pub(super) radiosity: Vec<V>,
    pub(super) variation: Vec<f64>,
    /// The residual E + A û − û in the middle of each patch, in W/m².
    pub(super) residuals: Vec<V>,
    /// Patches on which H is not smooth, and is found at x itself.
    pub(super) rough: Vec<bool>,
    /// The irradiance that a link may be wrong by, in W/m².
    pub(super) tolerance: f64,
    /// What was asked for.
    pub(super) accuracy: f64,
    /// How many links the cells have.
    pub(super) links: usize,
    pub(super) bound: Bound,
}

/// A patch of the mesh that the answer stands on.
#[derive(Clone, Debug)]
pub struct Part<V> {
    /// The patch.
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

    /// How many cells the mesh has, and how many links they have.
    pub fn size(&self) -> [usize; 2] {
        [self.tree.cells().count(), self.links]
    }

    /// The mesh, face by face.
    pub fn parts(&self) -> Vec<Part<V>> {
        let mut patches: Vec<u32> = self.tree.patches().collect();
        patches.sort_by_key(|&patch| self.tree.node(patch).face);
        let mut view = View::default();
        let mut part = |patch: u32| {
            let node = self.tree.node(patch);
            let mut irradiance = V::splat(0.0);
            for cell in node.parts.clone() {
                let whole = self.tree.node(cell);
                let point = self.domain.node_of(whole);
                let share = self.domain.share_in_sight(whole) * whole.area / node.area;
                let direct = self.domain.direct(node.face, point, &mut view);
                irradiance += (direct + self.smooth[cell as usize]) * share;
            }
            let [rho, emission] = [self.domain.reflectance(node.face), self.domain.emission(node.face)];
            let radiosity = emission + rho * irradiance;
            Part { polygon: node.polygon.clone(), face: node.face, radiosity, irradiance }
        };
        patches.into_iter().map(&mut part).collect()
    }

    /// The root of the mean square of the reflected radiosity, in W/m².
    pub(super) fn scale(&self) -> f64 {
        let (mut sum, mut area) = (0.0, 0.0);
        for cell in self.tree.cells() {
            let node = self.tree.node(cell);
            sum += node.area * square(self.radiosity[cell as usize]);
            area += node.area;
        }
        (sum / area).sqrt()
    }

    pub(super) fn irradiance_with(&self, face: u32, point: DVec3, view: &mut View) -> V {
        if self.domain.is_buried(face, point) {
            return V::splat(0.0);
        }
        let patch = self.tree.patch_at(face, point);
        if self.rough[patch as usize] {
            return self.gathered(face, point, view);
        }
        self.domain.direct(face, point, view) + self.interpolated(patch, point)
    }

    /// D + H at the point itself.
    pub(super) fn gathered(&self, face: u32, point: DVec3, view: &mut View) -> V {
        let links = self.links_from(face, point, view);
        let direct = links.iter().fold(self.domain.sent_by_points(face, point), |sum, link| {
            sum + self.domain.emission(self.tree.node(link.node).face) * f64::from(link.factor)
        });
        direct + gathered(&links, &self.radiosity)
    }

    /// The parts of the scene that a point sees.
    pub(super) fn links_from(&self, face: u32, point: DVec3, view: &mut View) -> Vec<Link> {
        let coarseness = Coarseness::new(&self.variation, self.tolerance, self.accuracy);
        self.domain.links(&self.tree, coarseness, (face, point), view)
    }

    /// E + A û − û in the middle of a patch, which is the centre of no cell, in W/m².
    pub(super) fn residual(&self, patch: u32, view: &mut View) -> V {
        let node = self.tree.node(patch);
        let point = node.polygon.point(0.5, 0.5);
        let between = self.domain.direct(node.face, point, view) + self.interpolated(patch, point);
        self.domain.reflectance(node.face) * (self.gathered(node.face, point, view) - between)
    }

    /// H between the centres of a patch's cells: bilinear, or linear on a triangle.
    pub(super) fn interpolated(&self, patch: u32, point: DVec3) -> V {
        let node = self.tree.node(patch);
        let at = node.local(point);
        let first = node.parts.start as usize;
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| self.smooth[first + k]);
        if node.polygon.vertices().len() == 4 {
            // The centres are at ¼ and ¾.
            let (s, t) = (2.0 * at.x - 0.5, 2.0 * at.y - 0.5);
            a * ((1.0 - s) * (1.0 - t)) + b * (s * (1.0 - t)) + c * (s * t) + d * ((1.0 - s) * t)
        } else {
            // Through those at the corners, whose centres have shares of ⅔ and ⅙, and moved to the mean of all four.
            let share = |k: f64| 2.0 * k - 1.0 / 3.0;
            let moved = (d - (a + b + c) * (1.0 / 3.0)) * 0.25;
            a * share(1.0 - at.x - at.y) + b * share(at.x) + c * share(at.y) + moved
        }
    }
}
