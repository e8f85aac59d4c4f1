//! A tree of boxes, eight to a node, over packets of eight triangles: one walk for all questions.

use super::build;
use super::facet::Facet;
use super::packet::{Packet, Triangles};
use super::ray::bits;
use glam::DVec3;
use prefetch_index::prefetch_index;
use std::ops::ControlFlow;
use wide::f32x8;

/// Marks a child as the index of a packet rather than of a node.
pub(super) const LEAF: u32 = 1 << 31;

/// The deepest tree that [`build`] makes, in nodes: the walk keeps one entry for each.
pub(super) const DEPTH: usize = 64;

/// So many packets, a megabyte, are near a core by themselves: to ask for them would take a tenth longer.
const NEAR: usize = 2048;

/// How many walks are made by turns.
const ABREAST: usize = 8;

/// Eight boxes side by side, in order along `axis`: four lines of memory.
#[derive(Clone, Debug)]
#[repr(align(64))]
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
        let (mut walk, mut waiting) = (Walk::START, NONE_WAIT);
        let far = self.packets.len() > NEAR;
        while !self.is_empty() && self.step((&mut walk, &mut waiting), query, far) {}
    }

    /// The same of many queries by turns, which are given back in any order: while one waits for memory the others go on. Alone each is as
    /// fast where memory is near, and only a little more than half as fast in a million triangles.
    pub(super) fn walk_each<T, Q: Query>(
        &self,
        mut queries: impl Iterator<Item = (T, Q)>,
        mut done: impl FnMut(T, Q),
    ) {
        if self.is_empty() {
            return queries.for_each(|(name, query)| done(name, query));
        }
        let start = |query| (Walk::START, NONE_WAIT, query);
        let mut walks: Vec<_> = queries.by_ref().take(ABREAST).map(start).collect();
        while !walks.is_empty() {
            let mut k = 0;
            while let Some((walk, waiting, (_, query))) = walks.get_mut(k) {
                if self.step((walk, waiting), query, false) {
                    self.fetch(walk.child);
                    k += 1;
                } else {
                    let (name, query) = match queries.next() {
                        Some(next) => {
                            *walk = Walk::START;
                            std::mem::replace(&mut walks[k].2, next)
                        }
                        None => walks.swap_remove(k).2,
                    };
                    done(name, query);
                }
            }
        }
    }

    /// Looks at a node or at a packet, and finds which is next; false at the end. With `all` it asks for all children of a node that it
    /// will visit, so that it waits for the first only.
    #[inline(always)]
    fn step(&self, (walk, waiting): (&mut Walk, &mut Waiting), query: &mut impl Query, all: bool) -> bool {
        if walk.child & LEAF == 0 {
            if walk.selected != 0 {
                waiting[walk.depth] = (walk.node, walk.selected);
                walk.depth += 1;
            }
            walk.node = walk.child;
            let node = &self.nodes[walk.node as usize];
            walk.selected = query.select(node);
            if all {
                bits(walk.selected.into()).for_each(|lane| self.fetch(node.children[lane]));
            }
        } else {
            let packet = &self.packets[(walk.child ^ LEAF) as usize];
            let within = (&self.nodes[walk.node as usize], walk.lane);
            if query.visit(packet, within).is_break() {
                return false;
            }
        }
        while walk.selected == 0 {
            if walk.depth == 0 {
                return false;
            }
            walk.depth -= 1;
            (walk.node, walk.selected) = waiting[walk.depth];
        }
        let node = &self.nodes[walk.node as usize];
        let last = query.backwards(node.axis);
        let lane = if last { 31 - walk.selected.leading_zeros() } else { walk.selected.trailing_zeros() };
        walk.selected &= !(1 << lane);
        walk.lane = lane as usize & 7;
        walk.child = node.children[walk.lane];
        true
    }

    /// Asks for each line of a node or packet that a step needs, so that it is near by then.
    #[inline(always)]
    fn fetch(&self, child: u32) {
        if child & LEAF == 0 {
            let Node { bounds, children, .. } = &self.nodes[child as usize];
            for k in [0, 2, 4] {
                prefetch_index(bounds, k);
            }
            prefetch_index(children, 0);
        } else {
            let Packet { triangles: Triangles { corner, edges: [e, f] }, planes, .. } =
                &self.packets[(child ^ LEAF) as usize];
            for (lanes, k) in [(corner, 0), (corner, 2), (e, 1), (f, 0), (f, 2)] {
                prefetch_index(lanes, k);
            }
            for k in [1, 3, 5, 7] {
                prefetch_index(planes, k);
            }
        }
    }
}

/// A walk between two of its steps, apart from what waits: so all of it is in registers.
struct Walk {
    /// How many nodes wait.
    depth: usize,
    /// The node that it is at, with the children that are still to be visited.
    node: u32,
    selected: u32,
    /// What is next: of that node, the child in this lane.
    child: u32,
    lane: usize,
}

/// Nodes with the children that are still to be visited.
type Waiting = [(u32, u32); DEPTH];

const NONE_WAIT: Waiting = [(0, 0); DEPTH];

impl Walk {
    const START: Self = Self { depth: 0, node: 0, selected: 0, child: 0, lane: 0 };
}
