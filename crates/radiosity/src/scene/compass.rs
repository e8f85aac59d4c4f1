//! (azimuth, elevation) → direction: what is up, and where north is.

use super::error::{Error, Problem};
use super::file::Source;
use glam::DVec3;
use toml::Spanned;

/// Three directions at right angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Compass {
    pub up: DVec3,
    pub north: DVec3,
}

impl Compass {
    /// z and y, as plans of buildings have it.
    pub const OF_PLANS: Self = Self { up: DVec3::Z, north: DVec3::Y };

    /// y and −z: glTF says what is up, and that things look along z, which is south here.
    pub const OF_GLTF: Self = Self { up: DVec3::Y, north: DVec3::NEG_Z };

    /// The unit vector at an azimuth, clockwise from north seen from above, and an elevation over the horizon, in degrees.
    pub fn towards(&self, azimuth: f64, elevation: f64) -> DVec3 {
        let (east, (sine, cosine)) = (self.north.cross(self.up), elevation.to_radians().sin_cos());
        let (to_east, to_north) = azimuth.to_radians().sin_cos();
        self.up * sine + (east * to_east + self.north * to_north) * cosine
    }

    /// What is up in a picture seen in a direction: this up, unless it is looked along that, where it is north.
    pub fn up_for(&self, direction: DVec3) -> DVec3 {
        let aside = direction.reject_from(self.up).length();
        if aside > 1e-6 * direction.length() { self.up } else { self.north }
    }
}

impl Source<'_> {
    /// The compass of a scene that may say what is up, and which way north is; what it does not say is as usual.
    pub fn compass(
        &self,
        usual: Compass,
        up: Option<&Spanned<[f64; 3]>>,
        north: Option<&Spanned<[f64; 3]>>,
    ) -> Result<Compass, Error> {
        let unit = |given: &Spanned<[f64; 3]>, name: &str| {
            let what = format!("`{name}` has no direction; give a vector");
            let vector = DVec3::from(*given.get_ref()).try_normalize();
            vector.ok_or_else(|| Problem::Malformed(what).at(self.place(&given.span())))
        };
        let up_is = up.map_or(Ok(usual.up), |up| unit(up, "up"))?;
        let north_is = north.map_or(Ok(usual.north), |north| unit(north, "north"))?;
        let flat = north_is.reject_from(up_is);
        match flat.try_normalize().filter(|_| flat.length() > LEVEL) {
            Some(north) => Ok(Compass { up: up_is, north }),
            None => {
                let DVec3 { x, y, z } = usual.north;
                let what = format!(
                    "`up` and `north` are along one line; give another `north`, which is [{x}, {y}, {z}] where it is not said"
                );
                let span = north.or(up).map_or(0..0, Spanned::span);
                Err(Problem::Malformed(what).at(self.place(&span)))
            }
        }
    }
}

/// The sine of the least angle between what is up and what is north.
const LEVEL: f64 = 1e-6;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn azimuths_go_clockwise_from_north() {
        let compass = Compass::OF_PLANS;
        let near = |a: DVec3, b: DVec3| assert!(a.distance(b) < 1e-15, "{a} {b}");
        near(compass.towards(0.0, 0.0), DVec3::Y);
        near(compass.towards(90.0, 0.0), DVec3::X);
        near(compass.towards(180.0, 0.0), -DVec3::Y);
        near(compass.towards(33.0, 90.0), DVec3::Z);
        // As glTF has it: y is up, and −z north; then east is x.
        let other = Compass::OF_GLTF;
        near(other.towards(90.0, 0.0), DVec3::X);
        near(other.towards(0.0, 30.0), DVec3::new(0.0, 0.5, -(0.75_f64.sqrt())));
    }
}
