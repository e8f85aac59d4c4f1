//! The rays of a pinhole camera through the pixels of a picture.

use crate::polygon::Polygon;
use crate::scene::Camera;
use crate::visibility::{Hit, Visibility};
use glam::DVec3;

/// What a picture is of, and how well it is to be drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Where the scene is looked at from.
    pub camera: Camera,
    /// Pixels across.
    pub width: usize,
    /// Pixels down.
    pub height: usize,
    /// Rays per pixel that find the edges; 9 make them smooth.
    pub samples: usize,
    /// Rays per pixel that gather indirect light; 64 leave no noise that shows.
    pub gather: usize,
}

/// The rays of a camera. Pixel coordinates run right and down from the upper left corner of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rays {
    origin: DVec3,
    corner: DVec3,
    right: DVec3,
    down: DVec3,
}

impl Rays {
    /// The rays of a camera for a picture of this many square pixels.
    pub fn new(camera: &Camera, width: usize, height: usize) -> Self {
        let forward = (camera.target - camera.position).normalize();
        let right = forward.cross(camera.up).normalize();
        let down = forward.cross(right);
        let pixel = 2.0 * (0.5 * camera.vertical_angle).tan() / height as f64;
        let (right, down) = (right * pixel, down * pixel);
        let corner = forward - right * (0.5 * width as f64) - down * (0.5 * height as f64);
        Self { origin: camera.position, corner, right, down }
    }

    /// The pinhole.
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// The unit direction through the point (x, y) of the picture, in pixels.
    pub fn direction(&self, x: f64, y: f64) -> DVec3 {
        (self.corner + self.right * x + self.down * y).normalize()
    }
}

/// A step past a back, relative to the way so far: more than rounding, less than any thickness.
const PAST: f64 = 1e-9;

/// The first front that a ray of the camera meets. Backs are cut away, as in a dolls' house: a closed room can
/// be looked into from outside.
pub(crate) fn first_front(
    polygons: &[Polygon],
    visibility: &Visibility,
    origin: DVec3,
    direction: DVec3,
) -> Option<Hit> {
    let mut travelled = 0.0;
    // A straight ray meets a convex polygon once.
    for _ in 0..polygons.len() {
        let hit = visibility.nearest(origin + direction * travelled, direction)?;
        let distance = travelled + hit.distance;
        if direction.dot(polygons[hit.polygon as usize].normal()) < 0.0 {
            return Some(Hit { polygon: hit.polygon, distance });
        }
        travelled = distance * (1.0 + PAST);
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    const CAMERA: Camera = Camera {
        position: DVec3::new(1.0, 2.0, 3.0),
        target: DVec3::new(1.0, 2.0, -3.0),
        up: DVec3::Y,
        vertical_angle: 1.0,
    };

    #[test]
    fn the_middle_of_the_picture_is_the_target() {
        let rays = Rays::new(&CAMERA, 7, 5);
        assert!(rays.direction(3.5, 2.5).distance(-DVec3::Z) < 1e-15);
        assert_eq!(rays.origin(), CAMERA.position);
    }

    #[test]
    fn up_is_up_right_is_right_and_the_angle_is_the_height() {
        let rays = Rays::new(&CAMERA, 8, 4);
        let (top, bottom) = (rays.direction(4.0, 0.0), rays.direction(4.0, 4.0));
        assert!((top.angle_between(bottom) - 1.0).abs() < 1e-12 && top.y > 0.0);
        assert!(rays.direction(8.0, 2.0).x > 0.0);
    }

    #[test]
    fn backs_are_looked_through() {
        let wall = |z: f64| {
            Polygon::triangle(DVec3::new(-9.0, -9.0, z), DVec3::new(9.0, -9.0, z), DVec3::new(0.0, 9.0, z))
        };
        let back = {
            let v = wall(1.0);
            let v = v.vertices();
            Polygon::triangle(v[0], v[2], v[1])
        };
        let polygons = [back, wall(-1.0)];
        let seen = first_front(&polygons, &Visibility::new(&polygons), CAMERA.position, -DVec3::Z);
        let hit = seen.unwrap();
        assert!(hit.polygon == 1 && (hit.distance - 4.0).abs() < 1e-6, "{hit:?}");
    }
}
