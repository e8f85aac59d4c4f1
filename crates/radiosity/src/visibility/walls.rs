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
    fn select(&self, node: &Node) -> u32 {
        let furthest: f32x8 = (0..3)
            .map(|k| {
                let side = if self.normal[k] < 0.0 { k } else { k + 3 };
                node.bounds[side] * f32x8::splat(self.normal[k] as f32)
            })
            .fold(f32x8::ZERO, |sum, term| sum + term);
        // The box is wide enough, but for the rounding of this sum: 6 roundoffs of ½ √3.
        (furthest + f32x8::splat(4.0 * f32::EPSILON)).simd_gt(f32x8::splat(self.offset as f32)).to_bitmask()
    }

    fn visit(&mut self, packet: &Packet) -> ControlFlow<()> {
        let outside = |&v: &DVec3| self.normal.dot(v) > self.offset;
        self.found = packet.distinct().any(|k| self.facets[k as usize].vertices().iter().any(outside));
        if self.found { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    fn backwards(&self, axis: usize) -> bool {
        self.normal[axis] > 0.0
    }
}
