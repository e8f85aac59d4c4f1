//! Point lights: I in W/sr, and so H = I cosθ/r² at a surface.

use glam::DVec3;
use std::f64::consts::PI;

/// A light that is a point, and no surface: nothing hides behind it, and no camera sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLight<V> {
    /// Where it is, in metres.
    pub position: DVec3,
    /// The radiant intensity in W/sr, or the luminous intensity in cd, by channel: in all directions, or in that of
    /// [`direction`](Self::direction).
    pub intensity: V,
    /// None if it shines alike in all directions; else it is a diffuse lamp without a size, whose intensity falls with the
    /// cosine of the angle to this unit vector and is nothing behind it.
    pub direction: Option<DVec3>,
}

impl<V> PointLight<V> {
    /// The flux of intensity 1, in sr: 4π, or π of a diffuse one.
    pub fn flux_of_unit(&self) -> f64 {
        if self.direction.is_some() { PI } else { 4.0 * PI }
    }

    /// The intensity towards a point, as a part of [`intensity`](Self::intensity).
    pub fn part_towards(&self, point: DVec3) -> f64 {
        let cosine = |direction: DVec3| (point - self.position).normalize_or_zero().dot(direction).max(0.0);
        self.direction.map_or(1.0, cosine)
    }

    /// The same with another value.
    pub fn map<W>(self, intensity: impl FnOnce(V) -> W) -> PointLight<W> {
        PointLight {
            position: self.position,
            intensity: intensity(self.intensity),
            direction: self.direction,
        }
    }
}
