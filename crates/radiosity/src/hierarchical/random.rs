//! Numbers that are hashes of what they are for: they do not depend on who asks first.

use crate::form_factor::sampled::{mix, unit};
use crate::kernel::SurfacePoint;
use crate::polygon::Polygon;

pub(super) struct Random(u64);

impl Random {
    pub fn new(seed: u64, of: u64, number: u64) -> Self {
        Self(mix(mix(mix(seed) ^ of) ^ number))
    }

    /// In [0, 1).
    pub fn next(&mut self) -> f64 {
        self.0 = mix(self.0);
        unit(self.0)
    }

    /// A point of a polygon.
    pub fn point(&mut self, polygon: &Polygon) -> SurfacePoint {
        let [s, t] = [self.next(), self.next()];
        SurfacePoint { position: polygon.point(s, t), normal: polygon.normal() }
    }
}
