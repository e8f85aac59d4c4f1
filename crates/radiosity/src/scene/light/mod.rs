//! What shines and is no surface: points, I in W/sr, and suns, H in W/m² across their beams; or cd and lx.

pub(super) mod entry;
mod point;
pub(super) mod sun_entry;

pub use point::{Distribution, PointLight, Spot};

use fredholm::value::Value;
use glam::DVec3;

/// A light that is no surface: nothing hides behind it, and no camera sees it.
#[derive(Clone, Debug, PartialEq)]
pub enum Light<V> {
    /// A point.
    Point(PointLight<V>),
    /// A direction.
    Sun(Sun<V>),
}

/// A light infinitely far away, from one direction: its shadows have hard edges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sun<V> {
    /// The unit vector along which its light goes.
    pub direction: DVec3,
    /// The irradiance of a plane across its beam, in W/m² or lx, by channel.
    pub irradiance: V,
}

impl<V: Value> Light<V> {
    /// What it is measured by: the intensity of a point in W/sr or cd, the irradiance of a sun in W/m² or lx.
    pub fn amount(&self) -> V {
        match self {
            Self::Point(light) => light.intensity,
            Self::Sun(sun) => sun.irradiance,
        }
    }

    /// The same with another amount.
    pub fn with<W>(&self, amount: W) -> Light<W> {
        match self {
            Self::Point(light) => Light::Point(light.with(amount)),
            Self::Sun(sun) => Light::Sun(Sun { direction: sun.direction, irradiance: amount }),
        }
    }

    /// The same, dimmed or brightened.
    pub fn scaled(&self, gain: f64) -> Self {
        self.with(self.amount() * gain)
    }

    /// What it is called among others: `point light`, `spot`, `luminaire`, `sun`.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Point(light) => light.distribution.kind(),
            Self::Sun(_) => "sun",
        }
    }
}

impl<V> From<PointLight<V>> for Light<V> {
    fn from(light: PointLight<V>) -> Self {
        Self::Point(light)
    }
}

impl<V> From<Sun<V>> for Light<V> {
    fn from(sun: Sun<V>) -> Self {
        Self::Sun(sun)
    }
}
