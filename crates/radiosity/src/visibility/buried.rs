//! What is within a body that stands on a surface: from there nothing but backs is seen, and no light comes.

use super::Visibility;
use crate::polygon::Polygon;
use crate::reconstruct::{Rotation, lattice};
use glam::DVec3;
use std::f64::consts::TAU;

/// Directions about the normal, and their angle to it.
const AROUND: u32 = 8;
const TILT: f64 = 1.0;

/// Where a polygon is looked at first, a hundredth within: its corners and its middle; and points where these differ.
const CORNERS: [(f64, f64); 5] = [(0.01, 0.01), (0.99, 0.01), (0.99, 0.99), (0.01, 0.99), (0.5, 0.5)];
const PARTS: usize = 64;

impl Visibility {
    /// Whether a point of a surface with a unit normal is within a body.
    pub fn is_buried(&self, point: DVec3, normal: DVec3) -> bool {
        let from = point + normal * self.lift();
        let (u, v) = normal.any_orthonormal_pair();
        let sees_a_back = |(tilt, turn): (f64, f64)| {
            let direction = normal * tilt.cos() + (u * turn.cos() + v * turn.sin()) * tilt.sin();
            let hit = self.nearest(from, direction);
            hit.is_some_and(|hit| self.facets[hit.polygon as usize].normal.dot(direction) > 0.0)
        };
        let around = (0..AROUND).map(|k| (TILT, f64::from(k) * TAU / f64::from(AROUND)));
        std::iter::once((0.0, 0.0)).chain(around).all(sees_a_back)
    }

    /// The part of a polygon that is not, from 0 to 1; as found in 64 points where it is neither.
    pub fn exposed(&self, polygon: &Polygon) -> f64 {
        if !self.hides_anything() {
            return 1.0;
        }
        let in_sight = |(s, t): &(f64, f64)| !self.is_buried(polygon.point(*s, *t), polygon.normal());
        let seen = CORNERS.iter().filter(|at| in_sight(at)).count();
        if seen == 0 || seen == CORNERS.len() {
            return if seen == 0 { 0.0 } else { 1.0 };
        }
        lattice(PARTS, Rotation::NONE).filter(in_sight).count() as f64 / PARTS as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rectangle(corner: DVec3, u: DVec3, v: DVec3) -> Polygon {
        Polygon::quadrilateral(corner, corner + u, corner + u + v, corner + v)
    }

    /// A cube of side 1 on the plane z = 0, with or without a bottom, and a floor.
    fn cube_on_floor(bottom: bool) -> Vec<Polygon> {
        let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
        let (o, far) = (DVec3::ZERO, DVec3::ONE);
        let mut faces = vec![
            rectangle(o, z, y),
            rectangle(o, x, z),
            rectangle(far, -x, -y),
            rectangle(far, -y, -z),
            rectangle(far, -z, -x),
            rectangle(DVec3::new(-4.0, -4.0, 0.0), 8.0 * x, 8.0 * y),
        ];
        if bottom {
            faces.push(rectangle(o, y, x));
        }
        faces
    }

    #[test]
    fn under_a_cube_the_floor_is_buried_and_nowhere_else() {
        for bottom in [false, true] {
            let visibility = Visibility::new(&cube_on_floor(bottom));
            for (x, y, expected) in [
                (0.5, 0.5, true),
                (0.01, 0.99, true),
                (-0.01, 0.5, false),
                (1.01, 0.5, false),
                (3.0, -3.0, false),
            ] {
                assert_eq!(
                    visibility.is_buried(DVec3::new(x, y, 0.0), DVec3::Z),
                    expected,
                    "{x} {y} {bottom}"
                );
            }
            // A top is a back from below, but there is light beside it.
            assert!(!visibility.is_buried(DVec3::new(0.5, 0.5, 1.0), DVec3::Z));
            let patch = |low: f64, high: f64| {
                rectangle(DVec3::new(low, 0.2, 0.0), DVec3::X * (high - low), DVec3::Y * 0.6)
            };
            assert_eq!([patch(0.1, 0.9), patch(1.1, 1.9)].map(|p| visibility.exposed(&p)), [0.0, 1.0]);
            assert!((visibility.exposed(&patch(0.75, 1.75)) - 0.75).abs() < 0.05);
        }
    }

    #[test]
    fn under_a_sheet_that_shows_its_back_light_may_come_from_the_sides() {
        let sheet = rectangle(DVec3::new(0.0, 0.0, 0.5), DVec3::X, DVec3::Y);
        let floor = rectangle(DVec3::new(-4.0, -4.0, 0.0), 8.0 * DVec3::X, 8.0 * DVec3::Y);
        let visibility = Visibility::new(&[sheet, floor]);
        assert!(!visibility.is_buried(DVec3::new(0.5, 0.5, 0.0), DVec3::Z));
    }
}
