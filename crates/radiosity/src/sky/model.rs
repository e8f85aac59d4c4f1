//! L/L_z = f(χ) φ(Z) / (f(Z_s) φ(0)): the general skies of the CIE, with φ(Z) = 1 + a exp(b/cos Z) and
//! f(χ) = 1 + c (exp(d χ) − exp(d π/2)) + e cos²χ.
//!
//! Z is the angle from the zenith, χ that from the sun, Z_s that between sun and zenith. The numbers are those of ISO 15469:2004
//! (CIE S 011/E:2003), table 1.

use glam::DVec3;
use std::f64::consts::FRAC_PI_2;

/// How bright a sky is from direction to direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Alike.
    Uniform,
    /// (1 + 2 cos Z)/3, three times as bright at the zenith as at the horizon: the overcast sky of Moon and Spencer (1942), the
    /// CIE's before 2003 and its sixteenth sky since.
    Overcast,
    /// One of the fifteen general skies of the CIE, by its number.
    General(usize),
}

/// A sky of a kind, with what is up and where the sun is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Model {
    kind: Kind,
    up: DVec3,
    sun: DVec3,
}

/// a, b, c, d, e.
const GENERAL: [[f64; 5]; 15] = [
    [4.0, -0.70, 0.0, -1.0, 0.0],
    [4.0, -0.70, 2.0, -1.5, 0.15],
    [1.1, -0.8, 0.0, -1.0, 0.0],
    [1.1, -0.8, 2.0, -1.5, 0.15],
    [0.0, -1.0, 0.0, -1.0, 0.0],
    [0.0, -1.0, 2.0, -1.5, 0.15],
    [0.0, -1.0, 5.0, -2.5, 0.30],
    [0.0, -1.0, 10.0, -3.0, 0.45],
    [-1.0, -0.55, 2.0, -1.5, 0.15],
    [-1.0, -0.55, 5.0, -2.5, 0.30],
    [-1.0, -0.55, 10.0, -3.0, 0.45],
    [-1.0, -0.32, 10.0, -3.0, 0.45],
    [-1.0, -0.32, 16.0, -3.0, 0.30],
    [-1.0, -0.15, 16.0, -3.0, 0.30],
    [-1.0, -0.15, 24.0, -2.8, 0.15],
];

impl Kind {
    /// The general sky of a number from 1 to 15.
    pub fn general(number: usize) -> Option<Self> {
        (1..=GENERAL.len()).contains(&number).then_some(Self::General(number))
    }

    /// Whether it matters where the sun is.
    pub fn needs_sun(self) -> bool {
        self.numbers().is_some_and(|[_, _, c, _, e]| c != 0.0 || e != 0.0)
    }

    /// a, b, c, d and e of a general sky.
    pub fn numbers(self) -> Option<[f64; 5]> {
        match self {
            Self::General(number) => GENERAL.get(number.wrapping_sub(1)).copied(),
            Self::Uniform | Self::Overcast => None,
        }
    }
}

impl Model {
    /// A sky above which is `up`, with the sun in a direction, both unit vectors; where the sun does not matter any will do.
    pub fn new(kind: Kind, up: DVec3, towards_sun: DVec3) -> Self {
        Self { kind, up, sun: towards_sun }
    }

    /// The kind.
    pub fn kind(&self) -> Kind {
        self.kind
    }

    /// What is up.
    pub fn up(&self) -> DVec3 {
        self.up
    }

    /// Where the sun is, a unit vector; it says nothing where the sun does not matter.
    pub fn towards_sun(&self) -> DVec3 {
        self.sun
    }

    /// The radiance from a direction, a unit vector towards the sky, as a part of that of the zenith; nothing below the horizon.
    pub fn relative(&self, direction: DVec3) -> f64 {
        let height = direction.dot(self.up);
        if height < -LEVEL { 0.0 } else { self.above(direction, height.max(0.0)) }
    }

    fn above(&self, direction: DVec3, height: f64) -> f64 {
        match (self.kind, self.kind.numbers()) {
            (Kind::Overcast, _) => (1.0 + 2.0 * height) / 3.0,
            (_, Some([a, b, c, d, e])) => {
                let gradation = |height: f64| 1.0 + a * (b / height).exp();
                let indicatrix = |from: DVec3| {
                    let chi = from.angle_between(self.sun);
                    1.0 + c * ((d * chi).exp() - (d * FRAC_PI_2).exp()) + e * chi.cos().powi(2)
                };
                indicatrix(direction) * gradation(height) / (indicatrix(self.up) * gradation(1.0))
            }
            (_, None) => 1.0,
        }
    }
}

/// The sine of an angle below the horizon that is rounding.
const LEVEL: f64 = 1e-12;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_zenith_is_one_and_below_the_horizon_is_nothing() {
        let sun = DVec3::new(0.0, 0.6, 0.8);
        let kinds = (1..=15).map(Kind::General).chain([Kind::Uniform, Kind::Overcast]);
        for model in kinds.map(|kind| Model::new(kind, DVec3::Z, sun)) {
            assert!((model.relative(DVec3::Z) - 1.0).abs() < 1e-15);
            assert_eq!(model.relative(-DVec3::Z), 0.0);
            assert!(model.relative(DVec3::X) > 0.0 && model.relative(sun) > 0.0);
        }
        assert_eq!([Kind::general(0), Kind::general(16)], [None, None]);
    }

    #[test]
    fn some_skies_are_known_by_other_names() {
        let of = |kind, direction: DVec3| Model::new(kind, DVec3::Z, DVec3::X).relative(direction);
        for height in [0.0_f64, 0.1, 0.5, 0.9] {
            let direction = DVec3::new((1.0 - height * height).sqrt(), 0.0, height);
            assert!((of(Kind::General(5), direction) - 1.0).abs() < 1e-15, "the fifth is uniform");
        }
        // The first is the steep overcast sky: its horizon is 1/(1 + 4 exp(−0.7)) of its zenith.
        let horizon = of(Kind::General(1), DVec3::Y);
        assert!((horizon - 1.0 / (1.0 + 4.0 * (-0.7_f64).exp())).abs() < 1e-15);
        assert!(!Kind::General(1).needs_sun() && Kind::General(2).needs_sun() && !Kind::Overcast.needs_sun());
        // A clear one is brightest about the sun, and darkest across from it.
        let sun = DVec3::new(0.0, 0.6, 0.8);
        let clear = Model::new(Kind::General(12), DVec3::Z, sun);
        assert!(clear.relative(sun) > 3.0 * clear.relative(DVec3::new(0.0, -0.6, 0.8)));
    }
}
