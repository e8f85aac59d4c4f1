//! A tree of boxes, halved where their middles are, to find which of them meet.

use glam::DVec3;
use std::ops::ControlFlow;

/// A box between two corners.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    low: DVec3,
    high: DVec3,
}

impl Bounds {
    pub fn of<'a>(points: impl IntoIterator<Item = &'a DVec3>, margin: f64) -> Self {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for &point in points {
            (low, high) = (low.min(point), high.max(point));
        }
        Self { low: low - margin, high: high + margin }
    }

    fn meets(&self, other: &Self) -> bool {
        self.low.cmple(other.high).all() && other.low.cmple(self.high).all()
    }

    fn union(&self, other: &Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    fn middle(&self) -> DVec3 {
        self.low.midpoint(self.high)
    }
}

/// Boxes in a few to a leaf.
pub(super) struct Boxes {
    bounds: Vec<Bounds>,
    nodes: Vec<Node>,
    /// The numbers of the boxes, leaf by leaf.
    order: Vec<usize>,
}

struct Node {
    bounds: Bounds,
    /// For a leaf the boxes, else nothing.
    leaf: std::ops::Range<usize>,
    /// For an inner node the second child; the first follows the node.
    second: usize,
}

const LEAF: usize = 4;

impl Boxes {
    pub fn new(bounds: Vec<Bounds>) -> Self {
        let mut boxes = Self { order: (0..bounds.len()).collect(), bounds, nodes: Vec::new() };
        if !boxes.order.is_empty() {
            boxes.build(0, boxes.order.len());
        }
        boxes
    }

    /// The halves are equal in number, so that the tree is log₂ n deep whatever the boxes are.
    fn build(&mut self, start: usize, end: usize) {
        let own = self.order[start..end].iter().map(|&k| self.bounds[k]);
        let Some(bounds) = own.reduce(|a, b| a.union(&b)) else { return };
        let node = self.nodes.len();
        self.nodes.push(Node { bounds, leaf: start..end, second: 0 });
        if end - start <= LEAF {
            return;
        }
        let axis = (bounds.high - bounds.low).max_position();
        let middle = (end - start) / 2;
        let at = |k: &usize| self.bounds[*k].middle()[axis];
        self.order[start..end].select_nth_unstable_by(middle, |a, b| at(a).total_cmp(&at(b)));
        self.nodes[node].leaf = 0..0;
        self.build(start, start + middle);
        self.nodes[node].second = self.nodes.len();
        self.build(start + middle, end);
    }

    /// Visits the boxes that meet one, in no order, until told to break.
    pub fn meeting(
        &self,
        bounds: &Bounds,
        mut visit: impl FnMut(usize) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let mut waiting = if self.nodes.is_empty() { Vec::new() } else { vec![0] };
        while let Some(index) = waiting.pop() {
            let node: &Node = &self.nodes[index];
            if !node.bounds.meets(bounds) {
                continue;
            }
            for &k in &self.order[node.leaf.clone()] {
                if self.bounds[k].meets(bounds) {
                    visit(k)?;
                }
            }
            if node.leaf.is_empty() {
                waiting.extend([index + 1, node.second]);
            }
        }
        ControlFlow::Continue(())
    }

    /// Visits the pairs i < j of boxes that meet, by i, until told to break.
    pub fn pairs(&self, mut visit: impl FnMut(usize, usize) -> ControlFlow<()>) -> ControlFlow<()> {
        for (i, bounds) in self.bounds.iter().enumerate() {
            self.meeting(bounds, |j| if j > i { visit(i, j) } else { ControlFlow::Continue(()) })?;
        }
        ControlFlow::Continue(())
    }
}
