//! A pinhole camera.

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
