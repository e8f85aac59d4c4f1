//! Room 3: V(s, t), whether two points see each other: every polygon is tried, in order.

use crate::polygon::Polygon;
use glam::DVec3;

/// What may stand between two points.
#[derive(Clone, Debug)]
pub struct Visibility {
    blockers: Vec<Polygon>,
}

/// Where a ray ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The number of the polygon, counted over all surfaces.
    pub polygon: u32,
    /// How far from the origin, in m.
    pub distance: f64,
}

/// A ray that starts or ends on a polygon does not meet it: distances below this, in m, are rounding.
const CONTACT: f64 = 1e-7;

impl Visibility {
    /// The structure for these polygons.
    pub fn new(polygons: &[Polygon]) -> Self {
        Self { blockers: polygons.to_vec() }
    }

    /// Whether nothing stands between s and t.
    pub fn unoccluded(&self, s: DVec3, t: DVec3) -> bool {
        let length = s.distance(t);
        let direction = (t - s) / length;
        !self.blockers.iter().any(|p| meet(p, s, direction).is_some_and(|d| d < length - CONTACT))
    }

    /// The first polygon that a ray meets; `direction` is a unit vector, and both sides stop it.
    pub fn nearest(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        let met = self.blockers.iter().zip(0..);
        met.filter_map(|(p, polygon)| meet(p, origin, direction).map(|distance| Hit { polygon, distance }))
            .min_by(|a, b| a.distance.total_cmp(&b.distance))
    }
}

fn meet(polygon: &Polygon, origin: DVec3, direction: DVec3) -> Option<f64> {
    let slope = direction.dot(polygon.normal());
    let distance = -polygon.height_of(origin) / slope;
    let inside = |point: DVec3| {
        let v = polygon.vertices();
        (0..v.len())
            .all(|i| (v[(i + 1) % v.len()] - v[i]).cross(point - v[i]).dot(polygon.normal()) >= -1e-12)
    };
    (slope != 0.0 && distance > CONTACT && inside(origin + distance * direction)).then_some(distance)
}
