//! What may be between two polygons: single polygons, and convex bodies each as a whole.

use super::bvh::{Bvh, Query};
use super::end::End;
use super::facet::{Facet, Frame};
use super::packet::Packet;
use super::shaft::Shaft;
use super::walls::walls;
use crate::polygon::Polygon;
use glam::DVec3;
use std::ops::ControlFlow;

/// Polygons, some of which are sides of convex bodies.
#[derive(Clone, Debug)]
pub(crate) struct Screens {
    frame: Frame,
    facets: Vec<Facet>,
    /// The vertices of the body that a polygon stands for; none where it stands for itself.
    bodies: Vec<Vec<DVec3>>,
    tree: Bvh,
}

impl Screens {
    /// For these polygons. `body_of` tells of the sides of a convex body which of them stands for all, and
    /// `vertices_of` its vertices; a polygon that is of none stands for itself.
    pub fn new<'a>(
        polygons: &[Polygon],
        stands_for: &[u32],
        vertices_of: impl Fn(u32) -> &'a [DVec3],
    ) -> Self {
        let frame = Frame::around(polygons);
        let facets: Vec<Facet> = polygons.iter().map(|p| Facet::new(p, &frame)).collect();
        let triangles =
            |k: usize, name: u32| polygons[k].triangles().map(move |t| (t.map(|v| frame.point(v)), name));
        let all: Vec<_> = (0..polygons.len()).flat_map(|k| triangles(k, k as u32)).collect();
        let is_wall = walls(&facets, &Bvh::new(&all));
        let hiding = (0..polygons.len()).filter(|&k| !is_wall[k]);
        let triangles: Vec<_> = hiding.flat_map(|k| triangles(k, stands_for[k])).collect();
        let bodies = (0..polygons.len() as u32)
            .map(|k| vertices_of(k).iter().map(|&v| frame.point(v)).collect())
            .collect();
        Self { frame, facets, bodies, tree: Bvh::new(&triangles) }
    }

    /// A polygon, made ready for [`between`](Self::between).
    pub fn end(&self, polygon: &Polygon) -> End {
        End::new(Facet::new(polygon, &self.frame))
    }

    /// What is not proved to miss all segments from a to b, into `found`.
    pub fn between(&self, a: &End, b: &End, found: &mut Vec<u32>) {
        found.clear();
        if self.tree.nodes.first().is_some_and(|root| a.may_meet(b, root)) {
            let shaft = Shaft::new(&self.facets, &a.facet, &b.facet);
            self.tree.walk(&mut Between { shaft, bodies: &self.bodies, found });
        }
    }
}

struct Between<'a> {
    shaft: Shaft<'a>,
    bodies: &'a [Vec<DVec3>],
    found: &'a mut Vec<u32>,
}

impl Between<'_> {
    fn misses(&self, k: u32) -> bool {
        match self.bodies[k as usize].as_slice() {
            [] => self.shaft.misses(k),
            vertices => self.shaft.excludes(vertices),
        }
    }
}

impl Query for Between<'_> {
    #[inline(always)]
    fn select(&self, node: &super::bvh::Node) -> u32 {
        self.shaft.reached(node)
    }

    fn visit(&mut self, packet: &Packet) -> ControlFlow<()> {
        for k in packet.distinct() {
            if !self.found.contains(&k) && !self.misses(k) {
                self.found.push(k);
            }
        }
        ControlFlow::Continue(())
    }
}
