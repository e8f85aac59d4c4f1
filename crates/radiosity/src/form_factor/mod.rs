//! Room 5: F_ij = 1/A_i ∫_{P_i} ∫_{P_j} K(x, y) dy dx, or at the centroid of P_i alone: what F_ij *is* for light.
//!
//! An unoccluded factor is computed ([`lambert`], [`exchange`], [`contour`]); the part of it that arrives is sampled with rays
//! (`sampled`), except where the two patches certainly see each other or certainly do not. View factors, which are wanted
//! one by one and with an error each, have it clipped instead: [`pairs`].
//!
//! | radiosity | general theory | |
//! |---|---|---|
//! | point to point | Nyström | [`point_to_point`] |
//! | point to patch, paper (3.3) | P0 collocation | [`FormFactors::point_to_patch`] |
//! | patch to patch, paper (3.5) | P0 Galerkin | [`FormFactors::patch_to_patch`] |

mod bundle;
pub mod contour;
pub mod exchange;
mod hider;
mod kinks;
pub mod lambert;
pub(crate) mod outline;
pub(crate) mod outlook;
pub mod pairs;
mod partly;
mod piece;
mod rules;
pub(crate) mod sampled;
mod shadow;
mod sight;
pub(crate) mod view;

use crate::kernel::{Lambertian, SurfacePoint};
use crate::patches::{Patches, Strip};
use crate::polygon::Polygon;
use crate::visibility::{RayCount, Visibility};
use exchange::Unoccluded;
use fredholm::discretize::{Coupling, Nystrom};
use fredholm::quadrature::Quadrature;
use fredholm::value::Value;
use glam::DVec3;
use sampled::Sight;

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
    strips: &'a [Strip],
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
    Area(Unoccluded),
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
        let exchange = Unoccluded::new(&patches.polygons, 0.1 * accuracy);
        Self::new(patches, visibility, accuracy, Test::Area(exchange))
    }

    fn new<V: Value>(patches: &'a Patches<V>, visibility: &'a Visibility, accuracy: f64, test: Test) -> Self {
        let Patches { polygons, areas, strips, .. } = patches;
        Self { patches: polygons, areas, strips, visibility, accuracy, test, rays: RayCount::default() }
    }

    /// How many rays have been cast.
    pub fn rays(&self) -> u64 {
        self.rays.total()
    }

    /// ∫_{P_j} K(s_i, y) dy, where `sight` of P_j from P_i is known or not.
    fn at_centroid(&self, i: usize, j: usize, sight: Sight) -> f64 {
        let (receiver, sender) = (&self.patches[i], &self.patches[j]);
        let (x, n) = (receiver.centroid(), receiver.normal());
        let whole = lambert::point_to_polygon(x, n, sender);
        whole * self.visible_part((i, j), sight, whole, |_, _| (x, 1.0))
    }

    /// ∫_{P_i} ∫_{P_j} K, the same for (i, j) and (j, i).
    fn between(&self, exchange: &Unoccluded, i: usize, j: usize, sight: Sight) -> f64 {
        let (i, j) = (i.min(j), i.max(j));
        let whole = exchange.between(self.patches, i, j).value;
        let factor = whole / self.areas[i].min(self.areas[j]);
        let a = &self.patches[i];
        whole * self.visible_part((i, j), sight, factor, |s, t| (a.point(s, t), a.density(s, t)))
    }

    /// The part of an unoccluded `factor` that arrives.
    fn visible_part(
        &self,
        (i, j): (usize, usize),
        sight: Sight,
        factor: f64,
        start: impl Fn(f64, f64) -> (DVec3, f64),
    ) -> f64 {
        if factor == 0.0 {
            return 0.0;
        }
        let pair = (&self.patches[i], &self.patches[j]);
        let sight = match sight {
            Sight::Unknown => sampled::sight(self.visibility, pair.0, pair.1, &self.rays),
            known => known,
        };
        match sight {
            Sight::Clear => 1.0,
            Sight::Hidden => 0.0,
            Sight::Unknown => {
                let weight = factor / self.accuracy.powi(2);
                sampled::visible_part(self.visibility, pair, (i, j), weight, &self.rays, start)
            }
        }
    }

    /// F_ij, where the sight of P_j from P_i is known or not.
    fn factor(&self, i: usize, j: usize, sight: Sight) -> f64 {
        match &self.test {
            // A planar patch does not see itself.
            _ if i == j => 0.0,
            Test::Centroid => self.at_centroid(i, j, sight),
            Test::Area(exchange) => self.between(exchange, i, j, sight) / self.areas[i],
        }
    }

    /// What patch i sees of a whole strip. A strip of one patch is left to the pair, which asks the same.
    fn sight_of(&self, i: usize, strip: &Strip) -> Sight {
        let (patch, whole) = (&self.patches[i], &strip.polygon);
        match () {
            () if strip.patches.len() == 1 => Sight::Unknown,
            () if !exchange::may_see(patch, whole) => Sight::Hidden,
            () => sampled::sight(self.visibility, patch, whole, &self.rays),
        }
    }
}

impl Coupling for FormFactors<'_> {
    fn dim(&self) -> usize {
        self.patches.len()
    }

    fn entry(&self, i: usize, j: usize) -> f64 {
        self.factor(i, j, Sight::Unknown)
    }

    /// What patch i sees of a strip of patches is asked once for the strip: most of the scene is certainly clear or
    /// certainly hidden, and is told so eight patches at a time. The factors are those of [`Self::entry`].
    fn row(&self, i: usize, from: usize, row: &mut [f64]) {
        let to = from + row.len();
        let first = self.strips.partition_point(|strip| strip.patches.end <= from);
        for strip in self.strips[first..].iter().take_while(|strip| strip.patches.start < to) {
            let sight = self.sight_of(i, strip);
            for j in strip.patches.start.max(from)..strip.patches.end.min(to) {
                row[j - from] = if sight == Sight::Hidden { 0.0 } else { self.factor(i, j, sight) };
            }
        }
    }

    fn reciprocity(&self) -> Option<&[f64]> {
        matches!(self.test, Test::Area(_)).then_some(self.areas)
    }
}
