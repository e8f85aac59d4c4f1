//! ‖u − B‖ from the residual f + ρ F u − u, F being asked anew where it is looked at: with an eighth of what a link may bring, and
//! other rays.

use super::build::{Light, Plan};
use super::cut::{Found, Hidden};
use super::factor::{Column, Link};
use crate::polygon::Polygon;
use fredholm::operator::hierarchical::Cluster;
use fredholm::value::Value;
use rayon::prelude::*;

/// How far a solution is from the light itself, in the L² norm relative to the solution's.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Judged {
    /// In all.
    pub error: f64,
    /// What the patches leave out: light is not the same all over a patch.
    pub patches: f64,
    /// What links get wrong: light that is not the same all over a cluster, form factors, visibility; and what iteration left.
    pub links: f64,
    /// ‖B − E‖ / ‖B‖: what surfaces reflect, as a part of all that they send. These errors are that much larger as parts of it.
    pub reflected: f64,
}

/// Patches that are looked at.
const LOOKS: usize = 512;

/// How many times finer the cuts are that judge.
const FINER: f64 = 8.0;

/// The cosine of an angle between patches from which on light varies from one to the other as it does within them.
const ALIKE: f64 = 0.99;

/// Another seed than any that links are made with.
const SEED: u64 = 0x5eed_0f0e_1707;

impl<V: Value> Plan<'_, V> {
    /// Judges u, the radiosity of each patch, which was made with links that may bring a `part`.
    pub fn judge(&self, source: &[V], u: &[V], light: &Light, part: f64) -> Judged {
        let (areas, rho) = (&self.patches.areas, &self.patches.reflectance);
        let total: f64 = areas.iter().sum();
        let mean = |squares: &mut dyn Iterator<Item = f64>| {
            (areas.iter().zip(squares).map(|(area, square)| area * square).sum::<f64>() / total).sqrt()
        };
        let norm = mean(&mut u.iter().map(V::square));
        if norm == 0.0 {
            return Judged::default();
        }
        let looked: Vec<(Cluster, Polygon)> = self
            .spread()
            .into_iter()
            .map(|leaf| (leaf, self.patches.polygons[self.patch(leaf)].clone()))
            .collect();
        let residual = |((leaf, _), arriving): (&(Cluster, Polygon), V)| {
            let patch = self.patch(*leaf);
            source[patch] + rho[patch] * arriving - u[patch]
        };
        let arriving = self.arriving(u, light, part, &looked);
        let residuals: Vec<V> = looked.iter().zip(arriving).map(residual).collect();
        let links = told(&residuals, self.patches.mean_reflectance()) / norm;
        let patches = self.variation(u).sqrt() / norm;
        let reflected =
            mean(&mut u.iter().zip(&self.patches.emission).map(|(u, e)| (*u - *e).square())) / norm;
        Judged { error: (links * links + patches * patches).sqrt(), patches, links, reflected }
    }

    /// F u on parts of patches, asked anew: with an eighth of what a link may bring, and other rays.
    pub(crate) fn arriving(&self, u: &[V], light: &Light, part: f64, at: &[(Cluster, Polygon)]) -> Vec<V> {
        let part = part / FINER;
        let means = self.means(light);
        let radiosity = self.clusters.means(u);
        let (cuts, factors) = (self.cuts(&means, part, None), self.factors(&means, SEED, true));
        let on = |(found, column): &mut (Vec<_>, Column), (leaf, place): &(Cluster, Polygon)| {
            cuts.of(*leaf, &mut Hidden::from(*leaf), found);
            let first = self.clusters.tree.range(*leaf).start;
            let receivers = factors.receivers(std::slice::from_ref(place), first);
            let most = part * cuts.arriving[leaf.index()];
            let numbered = (0_u64..).zip(found.iter());
            numbered.fold(V::splat(0.0), |sum, (number, &Found { cluster: sender, weight, clear })| {
                let worth = most / cuts.brightness[sender.index()];
                let link = Link { sender, weight, number, clear, worth };
                factors.column(&receivers, &link, column);
                sum + radiosity[sender.index()] * column.factors[0]
            })
        };
        at.par_iter().map_init(Default::default, on).collect()
    }

    /// The patch that a leaf of the tree is.
    pub(crate) fn patch(&self, leaf: Cluster) -> usize {
        self.clusters.tree.members(leaf)[0]
    }

    /// Leaves of the tree, one for each equal part of the area.
    pub(crate) fn spread(&self) -> Vec<Cluster> {
        let areas = &self.patches.areas;
        let total: f64 = areas.iter().sum();
        let step = total / LOOKS as f64;
        let (mut passed, mut next, mut found) = (0.0, 0.5 * step, Vec::new());
        for leaf in self.clusters.tree.leaves() {
            passed += areas[self.patch(leaf)];
            while passed > next {
                found.push(leaf);
                next += step;
            }
        }
        found
    }

    /// The mean square of what light varies by within patches: between two that are neighbours in a plane it differs by as much as
    /// across one, and a twelfth of the square of that is the variance along one of two axes.
    fn variation(&self, u: &[V]) -> f64 {
        let tree = &self.clusters.tree;
        let areas = &self.patches.areas;
        let (mut sum, mut seen) = (0.0, 0.0);
        for cluster in tree.top_down() {
            let Some([a, b]) = tree.children(cluster) else { continue };
            let (Some(a), Some(b)) = (self.clusters.patch(a), self.clusters.patch(b)) else { continue };
            let [n, m] = [a, b].map(|patch| self.patches.polygons[patch].normal());
            if self.patches.surface[a] != self.patches.surface[b] || n.dot(m) < ALIKE {
                continue;
            }
            let step = u[a] - u[b];
            let area = areas[a] + areas[b];
            sum += area * step.square();
            seen += area;
        }
        if seen > 0.0 { sum / seen / 6.0 } else { 0.0 }
    }
}

/// ‖û − u‖ as residuals tell it that were looked at here and there, where so much of all light is reflected.
pub(crate) fn told<V: Value>(residuals: &[V], reflected: f64) -> f64 {
    let count = residuals.len().max(1) as f64;
    let squares = || residuals.iter().map(V::square);
    let mean_square = squares().sum::<f64>() / count;
    // A few patches may have most of the error, and there are more of these than are seen, or fewer: two standard errors more.
    let spread = squares().map(|s| (s - mean_square).powi(2)).sum::<f64>() / count;
    let mean_square = mean_square + 2.0 * (spread / count).sqrt();
    let mean = residuals.iter().fold(V::splat(0.0), |sum, r| sum + *r) * count.recip();
    // Noise is lost in the next bounce, in which hundreds of links add up; what all have in common is not, and is as large as
    // it is seen to be, or could be without being seen.
    let common = mean.square().max(mean_square / count).sqrt();
    let carried = common / (1.0 - reflected).max(f64::EPSILON);
    (mean_square - mean.square() + carried * carried).sqrt()
}
