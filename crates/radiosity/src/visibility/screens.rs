//! What may be between two polygons: single polygons, and convex bodies each as a whole.

use super::bvh::{Bvh, LEAF, Node, Query};
use super::end::End;
use super::facet::{Facet, Frame};
use super::packet::Packet;
use super::shaft::{ROUNDING, Shaft};
use super::walls::walls;
use crate::polygon::Polygon;
use glam::DVec3;
use smallvec::SmallVec;
use std::cell::OnceCell;
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
        let is_wall = walls(&facets, &Bvh::new(&all, &facets));
        let hiding = (0..polygons.len()).filter(|&k| !is_wall[k]);
        let triangles: Vec<_> = hiding.flat_map(|k| triangles(k, stands_for[k])).collect();
        let bodies = (0..polygons.len() as u32)
            .map(|k| vertices_of(k).iter().map(|&v| frame.point(v)).collect())
            .collect();
        let tree = Bvh::new(&triangles, &facets);
        Self { frame, facets, bodies, tree }
    }

    /// A polygon, made ready for [`between`](Self::between).
    pub fn end(&self, polygon: &Polygon) -> End {
        End::new(Facet::new(polygon, &self.frame))
    }

    /// What may be in the way of some segment from one to the other, into `found`: polygons that are not proved to miss all
    /// of them, and bodies that are near.
    pub fn between(&self, ends: [&End; 2], found: &mut Found) {
        found.clear();
        self.tree.walk(&mut Between { screens: self, ends, shaft: OnceCell::new(), found });
    }

    /// Takes from what was found the bodies that are proved to miss all segments; whether there were any.
    pub fn narrow(&self, [a, b]: [&End; 2], found: &mut Found) -> bool {
        let before = found.len();
        let shaft = Shaft::new(&self.facets, &a.facet, &b.facet);
        found.retain(|k| {
            let vertices = &self.bodies[*k as usize];
            vertices.is_empty() || !shaft.excludes(vertices)
        });
        found.len() < before
    }
}

/// What may be between two polygons: mostly nothing, or a body or two.
pub(crate) type Found = SmallVec<[u32; 8]>;

struct Between<'a> {
    screens: &'a Screens,
    ends: [&'a End; 2],
    /// Made once it is needed: the balls and boxes of the ends tell most pairs in full sight.
    shaft: OnceCell<Shaft<'a>>,
    found: &'a mut Found,
}

impl Between<'_> {
    fn shaft(&self) -> &Shaft<'_> {
        let [a, b] = self.ends;
        self.shaft.get_or_init(|| Shaft::new(&self.screens.facets, &a.facet, &b.facet))
    }

    /// Whether a polygon is proved to miss all segments, or a body is behind one of the ends.
    fn misses(&self, k: u32) -> bool {
        let vertices = &self.screens.bodies[k as usize];
        let behind = |end: &&End| vertices.iter().all(|&v| end.facet.height_of(v) <= ROUNDING);
        if vertices.is_empty() { self.shaft().misses(k) } else { self.ends.iter().any(behind) }
    }
}

impl Query for Between<'_> {
    #[inline(always)]
    fn select(&mut self, node: &Node) -> u32 {
        let met = self.ends[0].met(self.ends[1], node);
        let is_inner = |k: usize| met >> k & 1 == 1 && node.children[k] & LEAF == 0;
        if (0..8).any(is_inner) { met & self.shaft().reached(node) } else { met }
    }

    fn visit(&mut self, packet: &Packet, _: (&Node, usize)) -> ControlFlow<()> {
        for k in packet.distinct() {
            if !self.found.contains(&k) && !self.misses(k) {
                self.found.push(k);
            }
        }
        ControlFlow::Continue(())
    }
}
