//! A tree of boxes, eight to a node, over packets of eight triangles: one walk for all questions.

use super::build;
use super::facet::Facet;
use super::packet::Packet;
use glam::DVec3;
use std::ops::ControlFlow;
use wide::f32x8;

/// Marks a child as the index of a packet rather than of a node.
pub(super) const LEAF: u32 = 1 << 31;

/// The deepest tree that [`build`] makes, in nodes: the walk keeps one entry for each.
pub(super) const DEPTH: usize = 64;

/// Eight boxes side by side, in order along `axis`.
#[derive(Clone, Debug)]
pub(super) struct Node {
    /// Low x, y, z, then high x, y, z; an unused child has an empty box.
    pub(super) bounds: [f32x8; 6],
    pub(super) children: [u32; 8],
    pub(super) axis: usize,
}

/// What a walk asks of the boxes and does with the packets.
pub(super) trait Query {
    /// A bit for each child that must be visited; empty boxes must give 0.
    fn select(&mut self, node: &Node) -> u32;

    /// Looks at a packet, of which a node has the box in a lane, and may end the walk.
    fn visit(&mut self, packet: &Packet, within: (&Node, usize)) -> ControlFlow<()>;

    /// Whether the children are better visited from high to low along `axis`.
    fn backwards(&self, _axis: usize) -> bool {
        false
    }
}

/// The tree over some triangles, in the scene's unit.
#[derive(Clone, Debug)]
pub(super) struct Bvh {
    pub(super) nodes: Vec<Node>,
    pub(super) packets: Vec<Packet>,
}

impl Bvh {
    /// The tree over triangles with the polygons that they are part of, by their numbers among the facets.
    pub(super) fn new(triangles: &[([DVec3; 3], u32)], facets: &[Facet]) -> Self {
        build::tree(triangles, facets)
    }

    /// Whether there is nothing to meet.
    pub(super) fn is_empty(&self) -> bool {
        self.packets.is_empty()
    }

    /// Visits the packets in all boxes that the query selects, until it ends the walk.
    #[inline(always)]
    pub(super) fn walk(&self, query: &mut impl Query) {
        if self.is_empty() {
            return;
        }
        let mut waiting = [(0_u32, 0_u32); DEPTH];
        let mut depth = 0;
        let mut index = 0;
        let mut node = &self.nodes[0];
        let mut selected = query.select(node);
        loop {
            while selected == 0 {
                if depth == 0 {
                    return;
                }
                depth -= 1;
                (index, selected) = waiting[depth];
                node = &self.nodes[index as usize];
            }
            let last = query.backwards(node.axis);
            let lane = if last { 31 - selected.leading_zeros() } else { selected.trailing_zeros() };
            selected &= !(1 << lane);
            let child = node.children[lane as usize & 7];
            if child & LEAF != 0 {
                let packet = &self.packets[(child ^ LEAF) as usize];
                if query.visit(packet, (node, lane as usize & 7)).is_break() {
                    return;
                }
            } else {
                if selected != 0 {
                    waiting[depth] = (index, selected);
                    depth += 1;
                }
                index = child;
                node = &self.nodes[index as usize];
                selected = query.select(node);
            }
        }
    }
}
