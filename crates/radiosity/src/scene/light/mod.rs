//! What shines and is no surface: points, I in W/sr; suns, H in W/m² across their beams; a sky, L in W/(m² sr) at its zenith; or
//! cd, lx and cd/m².

pub(super) mod entry;
mod point;
pub(super) mod sky_entry;
pub(super) mod sun_entry;

pub use point::{Distribution, PointLight, Spot};

use crate::sky::Dome;
use fredholm::value::Value;
use glam::DVec3;
use std::sync::Arc;

/// A light that is no surface: nothing hides behind it, and of all of them a camera sees the sky alone.
#[derive(Clone, Debug, PartialEq)]
pub enum Light<V> {
    /// A point.
    Point(PointLight<V>),
    /// A direction.
    Sun(Sun<V>),
    /// All directions above the horizon.
    Sky(Sky<V>),
}

/// A sky around the scene, which nothing is beyond.
#[derive(Clone, Debug, PartialEq)]
pub struct Sky<V> {
    /// The radiance of the zenith, in W/(m² sr) or cd/m², by channel; of its other directions what the dome says.
    pub zenith: V,
    /// How bright it is from direction to direction.
    pub dome: Arc<Dome>,
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
    /// What it is measured by: the intensity of a point in W/sr or cd, the irradiance of a sun in W/m² or lx, the radiance of a
    /// sky's zenith in W/(m² sr) or cd/m².
    pub fn amount(&self) -> V {
        match self {
            Self::Point(light) => light.intensity,
            Self::Sun(sun) => sun.irradiance,
            Self::Sky(sky) => sky.zenith,
        }
    }

    /// The same with another amount.
    pub fn with<W>(&self, amount: W) -> Light<W> {
        match self {
            Self::Point(light) => Light::Point(light.with(amount)),
            Self::Sun(sun) => Light::Sun(Sun { direction: sun.direction, irradiance: amount }),
            Self::Sky(sky) => Light::Sky(Sky { zenith: amount, dome: Arc::clone(&sky.dome) }),
        }
    }

    /// The same, dimmed or brightened.
    pub fn scaled(&self, gain: f64) -> Self {
        self.with(self.amount() * gain)
    }

    /// What it is called among others: `point light`, `spot`, `luminaire`, `sun`, `sky`.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Point(light) => light.distribution.kind(),
            Self::Sun(_) => "sun",
            Self::Sky(_) => "sky",
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

impl<V> From<Sky<V>> for Light<V> {
    fn from(sky: Sky<V>) -> Self {
        Self::Sky(sky)
    }
}
