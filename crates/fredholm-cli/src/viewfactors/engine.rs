//! The exchange of two polygons, and of two faces made of them.

use super::faces::Face;
use fredholm::discretize::Coupling;
use fredholm::value::{Rgb, Value};
use radiosity::form_factor::FormFactors;
use radiosity::patches::Patches;
use radiosity::polygon::Polygon;
use radiosity::view_factors::Exchange;
use radiosity::visibility::Visibility;
use serde::Serialize;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// What computes the exchanges, and counts what it does.
pub struct Engine<'a> {
    factors: FormFactors<'a>,
    patches: &'a Patches<Rgb>,
    visibility: &'a Visibility,
    accuracy: f64,
    counts: [AtomicU64; 3],
}

/// How many pairs of polygons that face each other are how.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Counts {
    /// In full sight.
    pub clear: u64,
    /// Out of sight.
    pub hidden: u64,
    /// Neither, or not proved to be.
    pub partly: u64,
}

/// What is left of the tolerance for the standard error of a row that is sampled: three of them are a bound.
const SAMPLED: f64 = 1.0 / 3.0;

/// The relative error down to which a pair is sampled: five times the standard error that its rays stop at.
const LEAST: f64 = 5e-3;

impl<'a> Engine<'a> {
    /// For the polygons of these patches, one each.
    pub fn new(patches: &'a Patches<Rgb>, visibility: &'a Visibility, tolerance: f64) -> Self {
        let accuracy = SAMPLED * tolerance;
        let factors = FormFactors::patch_to_patch(patches, visibility, accuracy);
        Self { factors, patches, visibility, accuracy, counts: Default::default() }
    }

    /// The exchange of two polygons.
    pub fn exchange(&self, p: usize, q: usize) -> Exchange {
        let polygons: &[Polygon] = &self.patches.polygons;
        if p == q || !radiosity::form_factor::exchange::may_see(&polygons[p], &polygons[q]) {
            return Exchange::default();
        }
        let value = self.factors.entry(p, q) * self.patches.areas[p];
        let clear = self.visibility.certainly_clear(&polygons[p], &polygons[q]);
        let (kind, error) = match (clear, value == 0.0) {
            (true, _) => (0, 0.1 * self.accuracy * value),
            (false, true) => (1, 0.0),
            (false, false) => (2, (self.accuracy / SAMPLED).max(LEAST) * value),
        };
        self.counts[kind].fetch_add(1, Relaxed);
        Exchange { value, error }
    }

    /// The pairs asked for so far.
    pub fn counts(&self) -> Counts {
        let [clear, hidden, partly] = self.counts.each_ref().map(|count| count.load(Relaxed));
        Counts { clear, hidden, partly }
    }

    /// The rays cast so far.
    pub fn rays(&self) -> u64 {
        self.factors.rays()
    }

    /// The exchange of two faces, or of a face with itself: the sum over their polygons.
    pub fn between(&self, faces: &[Face], i: usize, j: usize) -> Exchange {
        let (a, b) = (&faces[i].polygons, &faces[j].polygons);
        let mut sum = Exchange::default();
        for (k, &p) in a.iter().enumerate() {
            // With itself each pair comes once, and counts in both directions.
            let (others, times) = if i == j { (&b[k + 1..], 2.0) } else { (&b[..], 1.0) };
            for &q in others {
                let exchange = self.exchange(p, q);
                sum.value += times * exchange.value;
                sum.error += times * exchange.error;
            }
        }
        sum
    }
}

/// The polygons of a scene as patches, uncut.
pub fn uncut<V: Value>(
    scene: &radiosity::scene::Scene<V>,
) -> Result<Patches<V>, radiosity::patches::PatchError> {
    let polygons = scene.surfaces.iter().flat_map(|surface| &surface.polygons);
    Patches::new(scene, polygons.map(Polygon::diameter).fold(f64::MIN_POSITIVE, f64::max))
}
