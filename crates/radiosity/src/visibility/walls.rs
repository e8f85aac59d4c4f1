//! Which polygons have the whole scene on one side of their plane: these hide nothing.

use super::bvh::{Bvh, Node, Query};
use super::facet::{Facet, ON_PLANE};
use super::packet::Packet;
use glam::DVec3;
use std::collections::HashMap;
use std::ops::ControlFlow;
use wide::f32x8;

/// For each facet of a scene whether it lies in a plane that has the whole scene on one closed side.
///
/// No segment between two points of the scene goes through such a plane.
pub(super) fn walls(facets: &[Facet], all: &Bvh) -> Vec<bool> {
    let mut planes = HashMap::new();
    let is_wall = |facet: &Facet| {
        // A wall may be cut into many polygons: its plane is examined once.
        let known = planes.entry(key(facet)).or_insert_with(|| (facet.clone(), supports(facet, facets, all)));
        let same = facet.vertices().iter().all(|&v| known.0.height_of(v).abs() <= ON_PLANE);
        if same { known.1 } else { supports(facet, facets, all) }
    };
    facets.iter().map(is_wall).collect()
}

/// The plane, coarsely: what differs lies in different planes, or is examined twice.
fn key(facet: &Facet) -> [i32; 4] {
    let DVec3 { x, y, z } = facet.normal;
    [x, y, z, facet.offset].map(|c| (c * 1e6).round() as i32)
}

fn supports(facet: &Facet, facets: &[Facet], all: &Bvh) -> bool {
    let beyond = |normal: DVec3, offset: f64| {
        let mut query = Beyond { facets, normal, offset: offset + ON_PLANE, found: false };
        all.walk(&mut query);
        query.found
    };
    facet.normal != DVec3::ZERO
        && !(beyond(facet.normal, facet.offset) && beyond(-facet.normal, -facet.offset))
}

/// Whether a vertex lies in normal·x > offset.
struct Beyond<'a> {
    facets: &'a [Facet],
    normal: DVec3,
    offset: f64,
    found: bool,
}

impl Query for Beyond<'_> {
    fn select(&mut self, node: &Node) -> u32 {
        let furthest: f32x8 = (0..3)
            .map(|k| {
                let side = if self.normal[k] < 0.0 { k } else { k + 3 };
                node.bounds[side] * f32x8::splat(self.normal[k] as f32)
            })
            .fold(f32x8::ZERO, |sum, term| sum + term);
        // The box is wide enough, but for the rounding of this sum: 6 roundoffs of ½ √3.
        (furthest + f32x8::splat(4.0 * f32::EPSILON)).simd_gt(f32x8::splat(self.offset as f32)).to_bitmask()
    }

    fn visit(&mut self, packet: &Packet, _: (&Node, usize)) -> ControlFlow<()> {
        let outside = |&v: &DVec3| self.normal.dot(v) > self.offset;
        self.found = packet.distinct().any(|k| self.facets[k as usize].vertices().iter().any(outside));
        if self.found { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    fn backwards(&self, axis: usize) -> bool {
        self.normal[axis] > 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::super::Visibility;
    use crate::polygon::Polygon;
    use glam::DVec3;

    /// The cube [0, 1]³, each wall cut into two triangles, turned so that no coordinate is exact.
    fn cube() -> Vec<Polygon> {
        let turn = glam::DQuat::from_euler(glam::EulerRot::XYZ, 0.3, 1.2, -0.8);
        let corner = |k: usize| turn * DVec3::from_array([0, 1, 2].map(|axis| (k >> axis & 1) as f64));
        let faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
        faces
            .iter()
            .map(|face| face.map(corner))
            .flat_map(|[a, b, c, d]| [Polygon::triangle(a, b, c), Polygon::triangle(a, c, d)])
            .collect()
    }

    #[test]
    fn a_convex_room_has_no_occluders() {
        let visibility = Visibility::new(&cube());
        assert!(visibility.occluders.is_empty() && !visibility.walls.is_empty());
    }

    #[test]
    fn a_wall_with_something_behind_it_is_an_occluder() {
        let mut polygons = cube();
        let wall = &polygons[0];
        let behind: Vec<DVec3> =
            wall.vertices().iter().map(|v| v.lerp(wall.centroid(), 0.9) - 1e-6 * wall.normal()).collect();
        polygons.push(Polygon::triangle(behind[0], behind[1], behind[2]));
        let visibility = Visibility::new(&polygons);
        let mut occluders: Vec<u32> =
            visibility.occluders.packets.iter().flat_map(|packet| packet.distinct()).collect();
        occluders.sort_unstable();
        // What is behind the wall hides nothing itself: all else is in front of it.
        assert_eq!(occluders, [0, 1]);
    }
}
