//! A pinhole camera.

use super::error::Problem;
use glam::DVec3;

/// A pinhole camera: where it is, where it looks, how much it sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The pinhole, in metres.
    pub position: DVec3,
    /// A point it looks at, in metres: the middle of the picture.
    pub target: DVec3,
    /// The direction that is up in the picture; not parallel to the line of sight.
    pub up: DVec3,
    /// The whole vertical angle of view, in radians, between 0 and π.
    pub vertical_angle: f64,
}

impl Camera {
    /// Checks that there is a picture to be seen.
    ///
    /// # Errors
    ///
    /// When the target is the position, `up` is parallel to the line of sight, or the angle lies outside (0, π).
    pub fn check(&self) -> Result<(), Problem> {
        // A sine of 10⁻⁶ leaves ten digits to the picture's horizontal axis.
        const PARALLEL: f64 = 1e-6;
        if !(self.position.is_finite() && self.target.is_finite() && self.up.is_finite()) {
            return Err(Problem::CameraNotFinite);
        }
        let Some(forward) = (self.target - self.position).try_normalize() else {
            return Err(Problem::CameraDirection);
        };
        if forward.cross(self.up.normalize_or_zero()).length() < PARALLEL {
            return Err(Problem::CameraUp);
        }
        if !(self.vertical_angle > 0.0 && self.vertical_angle < std::f64::consts::PI) {
            return Err(Problem::CameraAngle(self.vertical_angle.to_degrees()));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: Camera =
        Camera { position: DVec3::ONE, target: DVec3::ZERO, up: DVec3::Z, vertical_angle: 0.7 };

    #[test]
    fn a_camera_that_sees_nothing_is_refused() {
        assert!(GOOD.check().is_ok());
        assert!(matches!(Camera { target: DVec3::ONE, ..GOOD }.check(), Err(Problem::CameraDirection)));
        assert!(matches!(Camera { target: DVec3::NAN, ..GOOD }.check(), Err(Problem::CameraNotFinite)));
        assert!(matches!(Camera { up: DVec3::ZERO, ..GOOD }.check(), Err(Problem::CameraUp)));
        assert!(matches!(Camera { up: DVec3::splat(1e9), ..GOOD }.check(), Err(Problem::CameraUp)));
        for bad in [0.0, std::f64::consts::PI, f64::NAN] {
            assert!(matches!(Camera { vertical_angle: bad, ..GOOD }.check(), Err(Problem::CameraAngle(_))));
        }
    }
}
