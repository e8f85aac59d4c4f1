//! Room 5: F_ij = 1/A_i ∫_{P_i} ∫_{P_j} K(x, y) dy dx, or at the centroid of P_i alone: what F_ij *is* for light.
//!
//! An unoccluded factor is computed ([`lambert`], [`exchange`]); the part of it that arrives is sampled with rays
//! ([`sampled`]), except where the two patches certainly see each other or certainly do not.
//!
//! | radiosity | general theory | |
//! |---|---|---|
//! | point to point | Nyström | [`point_to_point`] |
//! | point to patch, paper (3.3) | P0 collocation | [`FormFactors::point_to_patch`] |
//! | patch to patch, paper (3.5) | P0 Galerkin | [`FormFactors::patch_to_patch`] |

pub mod exchange;
pub mod lambert;
mod sampled;

use crate::kernel::{Lambertian, SurfacePoint};
use crate::patches::Patches;
use crate::polygon::Polygon;
use crate::visibility::{RayCount, Visibility};
use exchange::Exchange;
use fredholm::discretize::{Coupling, Nystrom};
use fredholm::quadrature::Quadrature;
use fredholm::value::Value;

/// The kernel between the centroids, with the areas for weights: Nyström's method, one ray a pair.
///
/// Patches that touch get a wrong factor, whatever the accuracy asked for; it tends to the right one no faster than
/// the patches shrink.
pub fn point_to_point<'a, V: Value>(
    patches: &Patches<V>,
    visibility: &'a Visibility,
) -> Nystrom<Lambertian<'a>, SurfacePoint> {
    let nodes = patches.polygons.iter().map(SurfacePoint::centroid).collect();
    Nystrom::new(Lambertian::new(visibility), Quadrature { nodes, weights: patches.areas.clone() })
}

/// The form factors between patches, from points or from patches.
#[derive(Debug)]
pub struct FormFactors<'a> {
    patches: &'a [Polygon],
    areas: &'a [f64],
    visibility: &'a Visibility,
    accuracy: f64,
    test: Test,
    rays: RayCount,
}

/// What the light arriving at a patch is tested with.
#[derive(Debug)]
enum Test {
    /// Its centroid: collocation.
    Centroid,
    /// Its whole area: Galerkin.
    Area(Exchange),
}

impl<'a> FormFactors<'a> {
    /// F_ij = ∫_{P_j} K(s_i, y) dy at the centroids s_i: P0 collocation.
    ///
    /// `accuracy` is the standard error that a row sum Σ_j F_ij may have from partly hidden patches.
    pub fn point_to_patch<V: Value>(
        patches: &'a Patches<V>,
        visibility: &'a Visibility,
        accuracy: f64,
    ) -> Self {
        Self::new(patches, visibility, accuracy, Test::Centroid)
    }

    /// F_ij = the mean of that over P_i: P0 Galerkin. A_i F_ij = A_j F_ji to the last digit.
    ///
    /// `accuracy` is the standard error that a row sum may have from partly hidden patches; each unoccluded factor
    /// is integrated ten times as finely, relative to itself.
    pub fn patch_to_patch<V: Value>(
        patches: &'a Patches<V>,
        visibility: &'a Visibility,
        accuracy: f64,
    ) -> Self {
        let exchange = Exchange::new(&patches.polygons, 0.1 * accuracy);
        Self::new(patches, visibility, accuracy, Test::Area(exchange))
    }

    fn new<V: Value>(patches: &'a Patches<V>, visibility: &'a Visibility, accuracy: f64, test: Test) -> Self {
        let Patches { polygons, areas, .. } = patches;
        Self { patches: polygons, areas, visibility, accuracy, test, rays: RayCount::default() }
    }

    /// How many rays have been cast.
    pub fn rays(&self) -> u64 {
        self.rays.total()
    }

    /// ∫_{P_j} K(s_i, y) dy.
    fn at_centroid(&self, i: usize, j: usize) -> f64 {
        let (receiver, sender) = (&self.patches[i], &self.patches[j]);
        let whole = lambert::point_to_polygon(receiver.centroid(), receiver.normal(), sender);
        if whole == 0.0 {
            return 0.0;
        }
        let (visible, rays) =
            sampled::from_point(self.visibility, receiver, sender, (i, j), whole / self.accuracy.powi(2));
        self.rays.add(rays);
        whole * visible
    }

    /// ∫_{P_i} ∫_{P_j} K, the same for (i, j) and (j, i).
    fn between(&self, exchange: &Exchange, i: usize, j: usize) -> f64 {
        let (i, j) = (i.min(j), i.max(j));
        let (a, b) = (&self.patches[i], &self.patches[j]);
        let whole = exchange.between(self.patches, i, j);
        if whole == 0.0 {
            return 0.0;
        }
        let factor = whole / self.areas[i].min(self.areas[j]);
        let (visible, rays) =
            sampled::from_area(self.visibility, a, b, (i, j), factor / self.accuracy.powi(2));
        self.rays.add(rays);
        whole * visible
    }
}

impl Coupling for FormFactors<'_> {
    fn dim(&self) -> usize {
        self.patches.len()
    }

    fn entry(&self, i: usize, j: usize) -> f64 {
        match &self.test {
            // A planar patch does not see itself.
            _ if i == j => 0.0,
            Test::Centroid => self.at_centroid(i, j),
            Test::Area(exchange) => self.between(exchange, i, j) / self.areas[i],
        }
    }

    fn reciprocity(&self) -> Option<&[f64]> {
        matches!(self.test, Test::Area(_)).then_some(self.areas)
    }
}
