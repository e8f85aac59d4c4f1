//! Point lights: I(ω) in W/sr, and so H = I cosθ/r² at a surface.

use crate::scene::luminaire::Aimed;
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// A light that is a point.
#[derive(Clone, Debug, PartialEq)]
pub struct PointLight<V> {
    /// Where it is, in metres.
    pub position: DVec3,
    /// The largest radiant intensity in W/sr, or luminous intensity in cd, by channel.
    pub intensity: V,
    /// Which part of that goes in which direction.
    pub distribution: Distribution,
}

/// How much of a point light's largest intensity goes in a direction.
#[derive(Clone, Debug, PartialEq)]
pub enum Distribution {
    /// All, in all directions.
    Uniform,
    /// cosθ of a diffuse lamp without a size, about this unit vector; nothing behind it.
    Diffuse(DVec3),
    /// The beam of a spot.
    Spot(Spot),
    /// What was measured of a luminaire.
    Measured(Aimed),
}

/// A beam with a soft edge: all of the intensity up to an inner angle from its axis, nothing from an outer one on, and between
/// them the square of what is linear in the cosine, as glTF 2.0 has it (`KHR_lights_punctual`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// The unit vector along the axis.
    pub direction: DVec3,
    /// The angle up to which the beam is whole, in radians.
    pub inner: f64,
    /// The angle from which on there is no light, in radians: larger, and at most π/2.
    pub outer: f64,
}

/// What the format has in place of a smaller difference of the cosines.
const SHARPEST: f64 = 1e-3;

impl Spot {
    /// The part of the intensity at an angle of this cosine from the axis.
    fn part(&self, cosine: f64) -> f64 {
        let [outer, edge] = self.edge();
        ((cosine - outer) / edge).clamp(0.0, 1.0).powi(2)
    }

    /// The cosine of the outer angle, and by how much that of the inner one is larger.
    fn edge(&self) -> [f64; 2] {
        let outer = self.outer.cos();
        [outer, (self.inner.cos() - outer).max(SHARPEST)]
    }

    /// 2π ∫ of the part over the cosine, in sr.
    fn flux_of_unit(&self) -> f64 {
        let [outer, edge] = self.edge();
        let soft = edge.min(1.0 - outer);
        TAU * (soft.powi(3) / (3.0 * edge * edge) + (1.0 - outer - soft))
    }
}

impl Distribution {
    /// The part of the largest intensity in a direction, a unit vector away from the light.
    pub fn part(&self, direction: DVec3) -> f64 {
        match self {
            Self::Uniform => 1.0,
            Self::Diffuse(normal) => direction.dot(*normal).max(0.0),
            Self::Spot(spot) => spot.part(direction.dot(spot.direction)),
            Self::Measured(aimed) => aimed.part(direction),
        }
    }

    /// The flux where the largest intensity is 1, in sr: 4π, or π of a diffuse light.
    pub fn flux_of_unit(&self) -> f64 {
        match self {
            Self::Uniform => 2.0 * TAU,
            Self::Diffuse(_) => PI,
            Self::Spot(spot) => spot.flux_of_unit(),
            Self::Measured(aimed) => aimed.web.flux() / aimed.web.largest(),
        }
    }

    /// An angle in which it changes little, in radians: what is seen under a larger one is not to be judged by one direction.
    pub(crate) fn resolution(&self) -> f64 {
        match self {
            Self::Uniform | Self::Diffuse(_) => PI,
            Self::Spot(spot) => spot.outer / 4.0,
            Self::Measured(aimed) => aimed.web.resolution(),
        }
    }

    pub(super) fn kind(&self) -> &'static str {
        match self {
            Self::Uniform | Self::Diffuse(_) => "point light",
            Self::Spot(_) => "spot",
            Self::Measured(_) => "luminaire",
        }
    }
}

impl<V> PointLight<V> {
    /// One that shines alike in all directions.
    pub fn uniform(position: DVec3, intensity: V) -> Self {
        Self { position, intensity, distribution: Distribution::Uniform }
    }

    /// A diffuse one, with its largest intensity along a unit vector.
    pub fn diffuse(position: DVec3, intensity: V, direction: DVec3) -> Self {
        Self { position, intensity, distribution: Distribution::Diffuse(direction) }
    }

    /// The intensity towards a point, as a part of [`intensity`](Self::intensity).
    pub fn part_towards(&self, point: DVec3) -> f64 {
        self.distribution.part((point - self.position).normalize_or_zero())
    }

    /// The same with another intensity.
    pub fn with<W>(&self, intensity: W) -> PointLight<W> {
        PointLight { position: self.position, intensity, distribution: self.distribution.clone() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫ of the part over all directions about z, by a midpoint rule in the cosine.
    fn flux(distribution: &Distribution) -> f64 {
        const CELLS: u32 = 1_000_000;
        let least = if let Distribution::Spot(spot) = distribution { spot.outer.cos() } else { -1.0 };
        let cell = (1.0 - least) / f64::from(CELLS);
        let part = |k: u32| {
            let cosine = least + cell * (f64::from(k) + 0.5);
            distribution.part(DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine))
        };
        TAU * cell * (0..CELLS).map(part).sum::<f64>()
    }

    fn spot(inner: f64, outer: f64) -> Distribution {
        let [inner, outer] = [inner, outer].map(f64::to_radians);
        Distribution::Spot(Spot { direction: DVec3::Z, inner, outer })
    }

    #[test]
    fn the_flux_is_the_integral_of_the_intensity() {
        // The last two have edges sharper than the format knows, the last one more so than its beam is wide.
        let spots = [spot(0.0, 90.0), spot(20.0, 35.0), spot(30.0, 30.01), spot(0.5, 1.0)];
        for light in [Distribution::Uniform, Distribution::Diffuse(DVec3::Z)].iter().chain(&spots) {
            let (told, found) = (light.flux_of_unit(), flux(light));
            assert!((told / found - 1.0).abs() < 1e-5, "{light:?}: {told}, {found}");
        }
    }

    #[test]
    fn a_spot_is_whole_within_and_nothing_without() {
        let Distribution::Spot(spot) = spot(20.0, 35.0) else { unreachable!() };
        let at = |degrees: f64| spot.part(degrees.to_radians().cos());
        assert_eq!([at(0.0), at(19.99), at(35.01), at(120.0)], [1.0, 1.0, 0.0, 0.0]);
        // Half of the way in the cosine is a quarter of the light.
        let half = (20_f64.to_radians().cos() + 35_f64.to_radians().cos()) / 2.0;
        assert!((spot.part(half) - 0.25).abs() < 1e-12);
    }
}
