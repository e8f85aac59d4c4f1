//! Points of patches, where rays start and end, from few bytes of memory: rays of a million patches wait for it.

use super::random::Random;
use crate::kernel::SurfacePoint;
use crate::patches::Patches;
use crate::polygon::Polygon;
use fredholm::value::Value;
use glam::{DVec2, DVec3, Vec2};
use prefetch_index::prefetch_index;

/// All patches, in some order, each in the plane of the face that it is a part of.
#[derive(Debug)]
pub(super) struct Spots {
    frames: Vec<Frame>,
    spots: Vec<Spot>,
}

/// The plane of a face: points on it are exactly there, whatever their coordinates are rounded to.
#[derive(Debug)]
struct Frame {
    origin: DVec3,
    along: DVec3,
    across: DVec3,
    normal: DVec3,
}

/// A patch: 36 bytes, where a [`Polygon`] has 168.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    face: u32,
    /// A triangle repeats its last.
    corners: [Vec2; 4],
}

impl Spots {
    /// The patches in an order.
    pub fn new<V: Value>(patches: &Patches<V>, order: &[usize]) -> Self {
        let frames: Vec<Frame> = (0..patches.faces()).map(|face| Frame::new(patches.face(face))).collect();
        let faces = patches.face_of_each();
        let spot = |patch: &usize| {
            let (face, vertices) = (faces[*patch], patches.polygons[*patch].vertices());
            let corner = |k: usize| frames[face as usize].coordinates(vertices[k.min(vertices.len() - 1)]);
            Spot { face, corners: std::array::from_fn(|k| corner(k).as_vec2()) }
        };
        Self { spots: order.iter().map(spot).collect(), frames }
    }

    /// The patch at a place of the order.
    pub fn at(&self, place: usize) -> Spot {
        self.spots[place]
    }

    /// Asks for the lines of memory that a patch is in, so that it is near when it is looked at.
    pub fn fetch(&self, place: usize) {
        prefetch_index(&self.spots, place);
        prefetch_index(&self.spots, place + 1);
    }

    /// A point of a patch.
    pub fn point(&self, Spot { face, corners }: &Spot, random: &mut Random) -> SurfacePoint {
        let [a, b, c, d] = corners.map(Vec2::as_dvec2);
        let [s, t] = [random.next(), random.next()];
        let at: DVec2 = if c == d {
            let root = s.sqrt();
            a * (1.0 - root) + b * (root * (1.0 - t)) + c * (root * t)
        } else {
            a * ((1.0 - s) * (1.0 - t)) + b * (s * (1.0 - t)) + c * (s * t) + d * ((1.0 - s) * t)
        };
        let Frame { origin, along, across, normal } = &self.frames[*face as usize];
        SurfacePoint { position: *origin + *along * at.x + *across * at.y, normal: *normal }
    }
}

impl Frame {
    fn new(face: &Polygon) -> Self {
        let (vertices, normal) = (face.vertices(), face.normal());
        // The mean of the vertices is where [`Visibility`](crate::visibility::Visibility) has the plane, too.
        let origin = vertices.iter().sum::<DVec3>() / vertices.len() as f64;
        // No edge, which two vertices in one place would not have.
        let along = normal.any_orthonormal_vector();
        Self { origin, along, across: normal.cross(along), normal }
    }

    fn coordinates(&self, point: DVec3) -> DVec2 {
        let from = point - self.origin;
        DVec2::new(from.dot(self.along), from.dot(self.across))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Scene, Surface};

    #[test]
    fn points_are_those_of_the_polygons_and_on_their_planes() {
        let at = |x: f64, y: f64| DVec3::new(1.0, 2.0, 3.0) + x * DVec3::X + y * DVec3::new(0.0, 0.6, 0.8);
        let polygons = vec![
            Polygon::quadrilateral(at(0.0, 0.0), at(4.0, 0.5), at(2.5, 3.0), at(-0.5, 2.0)),
            Polygon::triangle(at(5.0, 0.0), at(8.0, 1.0), at(6.0, 4.0)),
            Polygon::quadrilateral(at(9.0, 0.0), at(9.0, 0.0), at(9.5, 0.0), at(9.0, 0.5)),
        ];
        let surface = Surface { name: "s".into(), reflectance: 0.5, emission: 1.0, polygons };
        let scene = Scene { name: "test".into(), surfaces: vec![surface], lights: Vec::new(), camera: None };
        let patches = Patches::new(&scene, 0.3).unwrap();
        let order: Vec<usize> = (0..patches.len()).rev().collect();
        let spots = Spots::new(&patches, &order);
        for (place, patch) in order.iter().enumerate() {
            let [mut one, mut other] = [(); 2].map(|()| Random::new(1, *patch as u64, 0));
            let polygon = &patches.polygons[*patch];
            let (point, exact) = (spots.point(&spots.at(place), &mut one), other.point(polygon));
            assert!(
                point.position.distance(exact.position) < 1e-6 && point.normal.distance(exact.normal) < 1e-12
            );
            assert!(polygon.height_of(point.position).abs() < 1e-14);
        }
    }
}
