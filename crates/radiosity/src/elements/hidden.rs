//! ∫ φ_a ∫ V K φ_b ≈ Σ V w − v̄ (Σ w − ∫ φ_a ∫ K φ_b): what arrives of a block, from rays.
//!
//! Σ w is the same sum with V = 1, whose integral is known: the control takes away that part of the sampling error. v̄ is
//! the visible part of the whole, so that the block adds up to v̄ times the exchange: what the ratio of P0 says. Its error
//! is that of P0, a standard error of the accuracy in a row sum; entry by entry it is of the order of accuracy × √(F_ij) in
//! the coefficients. Rays do not know where a shadow's edge is, and no polynomial has one: the order of the space does not
//! hold on elements across a shadow's edge, whatever the number of rays.

use super::adaptive::{Block, combined};
use super::degree::{Local, MOST};
use super::space::Space;
use crate::form_factor::sampled::{Sighting, visible_part_seen};
use crate::kernel::SurfacePoint;
use crate::visibility::{RayCount, Visibility};
use glam::DVec3;

/// The sampling of what is hidden.
pub(super) struct Hidden<'a> {
    pub space: &'a Space<'a>,
    pub visibility: &'a Visibility,
    pub rays: &'a RayCount,
    pub accuracy: f64,
}

impl Hidden<'_> {
    /// The moments ∫ V K φ_jb from x, given those with V = 1; `sample` sets points of one element apart.
    pub fn at_point(&self, x: &SurfacePoint, (i, j): (usize, usize), sample: usize, whole: Local) -> Local {
        let mut block = [[0.0; MOST]; MOST];
        block[0] = whole;
        let factor: f64 = whole.iter().sum();
        let pair = (i + (sample << 24), j);
        let start = |_, _| (x.position, 1.0);
        let mut tests = [0.0; MOST];
        tests[0] = 1.0;
        self.sampled((i, j), pair, factor, block, start, |_| tests)[0]
    }

    /// ∫ φ_ia ∫ V K φ_jb, given the same with V = 1.
    pub fn between(&self, (i, j): (usize, usize), whole: Block) -> Block {
        let area = |k: usize| self.space.areas[k];
        let exchange: f64 = whole.iter().flatten().sum();
        // The variance of a mean over φ_a is that over the patch, times A/m_a.
        let least = |k: usize| {
            let weights = &self.space.weights()[self.space.range(k)];
            weights.iter().fold(f64::INFINITY, |least, m| least.min(m / area(k)))
        };
        let factor = exchange / area(i).min(area(j)) / least(i).min(least(j));
        let polygon = &self.space.polygons()[i];
        let start = |s, t| (polygon.point(s, t), polygon.density(s, t));
        self.sampled((i, j), (i, j), factor, whole, start, |x| self.space.values(i, x))
    }

    fn sampled(
        &self,
        (i, j): (usize, usize),
        pair: (usize, usize),
        factor: f64,
        whole: Block,
        start: impl Fn(f64, f64) -> (DVec3, f64),
        tests: impl Fn(DVec3) -> Local,
    ) -> Block {
        let polygons = self.space.polygons();
        let (mut all, mut clear, mut total) = ([[0.0; MOST]; MOST], [[0.0; MOST]; MOST], 0.0);
        let seen = |ray: &Sighting| {
            let (tests, values) = (tests(ray.ends[0]), self.space.values(j, ray.ends[1]));
            total += ray.weight;
            for a in 0..MOST {
                for b in 0..MOST {
                    let term = ray.weight * tests[a] * values[b];
                    all[a][b] += term;
                    clear[a][b] += if ray.clear { term } else { 0.0 };
                }
            }
        };
        let weight = factor / self.accuracy.powi(2);
        let patches = (&polygons[i], &polygons[j]);
        let part = visible_part_seen(self.visibility, patches, pair, weight, self.rays, start, seen);
        if total == 0.0 {
            return [[0.0; MOST]; MOST];
        }
        // Rays add up to the exchange, too.
        let scale = whole.iter().flatten().sum::<f64>() / total;
        let shape = combined(&clear, &all, -part);
        std::array::from_fn(|a| std::array::from_fn(|b| scale * shape[a][b] + part * whole[a][b]))
    }
}
