//! Builds the tree: a binary one by the surface area heuristic, then eight subtrees to a node.

use super::bvh::{Bvh, DEPTH, LEAF, Node};
use super::facet::Facet;
use super::packet::Packet;
use glam::{DVec3, Vec3A};
use std::ops::Range;
use wide::f32x8;

/// How many slices of a box are tried as places to split it; more change the cost by less than a hundredth.
const BINS: usize = 16;

/// From this depth on ranges are halved, so that 2^24 triangles stay within [`DEPTH`].
const DEEPEST_CHOICE: usize = DEPTH - 24;

/// Subtrees with fewer triangles than this are built by the thread that met them.
const PARALLEL: usize = 4096;

/// How many triangles are not worth a box of their own.
const SMALLEST: usize = 4;

#[derive(Clone, Copy)]
struct Bounds {
    low: Vec3A,
    high: Vec3A,
}

impl Bounds {
    const EMPTY: Self = Self { low: Vec3A::INFINITY, high: Vec3A::NEG_INFINITY };

    fn union(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Half the surface; 0 when empty.
    fn area(self) -> f32 {
        let side = (self.high - self.low).max(Vec3A::ZERO);
        side.x * side.y + side.y * side.z + side.z * side.x
    }
}

/// A triangle to be sorted: its box, its place in the input.
#[derive(Clone, Copy)]
struct Item {
    bounds: Bounds,
    triangle: u32,
}

impl Item {
    fn new(corners: &[DVec3; 3], triangle: u32) -> Self {
        let [a, b, c] = corners.map(|v| Vec3A::from(v.as_vec3()));
        // Coordinates are at most ½ in size: twice what their rounding can be.
        let widening = Vec3A::splat(f32::EPSILON * 0.5);
        let bounds = Bounds { low: a.min(b).min(c) - widening, high: a.max(b).max(c) + widening };
        Self { bounds, triangle }
    }

    /// Twice the centre of the box: only the order matters.
    fn centre(&self) -> Vec3A {
        self.bounds.low + self.bounds.high
    }
}

/// The binary tree over a range of the sorted items.
struct Tree {
    bounds: Bounds,
    range: Range<usize>,
    halves: Option<Box<[Tree; 2]>>,
}

impl Tree {
    fn new(items: &mut [Item], start: usize, depth: usize) -> Self {
        let bounds = items.iter().fold(Bounds::EMPTY, |b, item| b.union(item.bounds));
        let range = start..start + items.len();
        if items.len() <= SMALLEST {
            return Self { bounds, range, halves: None };
        }
        let middle = if depth < DEEPEST_CHOICE { split(items) } else { halve(items) };
        let parallel = items.len() >= PARALLEL;
        let (left, right) = items.split_at_mut(middle);
        let mut first = || Self::new(left, start, depth + 1);
        let mut second = || Self::new(right, start + middle, depth + 1);
        let (first, second) = if parallel { rayon::join(first, second) } else { (first(), second()) };
        Self { bounds, range, halves: Some(Box::new([first, second])) }
    }
}

/// Splits items where Σ area × count of the two sides is least; returns how many lie on the first side.
fn split(items: &mut [Item]) -> usize {
    let (low, high) = items.iter().fold((Vec3A::INFINITY, Vec3A::NEG_INFINITY), |(low, high), item| {
        (low.min(item.centre()), high.max(item.centre()))
    });
    let bin_of = |item: &Item, axis: usize| {
        let place = (item.centre()[axis] - low[axis]) / (high[axis] - low[axis]);
        ((place * BINS as f32) as usize).min(BINS - 1)
    };
    let cheapest = (0..3)
        .filter(|&axis| high[axis] > low[axis])
        .map(|axis| (axis, cheapest_cut(items, |item| bin_of(item, axis))))
        .min_by(|(_, a), (_, b)| a.1.total_cmp(&b.1));
    match cheapest {
        Some((axis, (cut, _))) => partition(items, |item| bin_of(item, axis) < cut),
        None => items.len() / 2,
    }
}

/// The first bin of the second side, and the cost.
fn cheapest_cut(items: &[Item], bin_of: impl Fn(&Item) -> usize) -> (usize, f32) {
    let mut bins = [(Bounds::EMPTY, 0_usize); BINS];
    for item in items {
        let (bounds, count) = &mut bins[bin_of(item)];
        (*bounds, *count) = (bounds.union(item.bounds), *count + 1);
    }
    let mut above = [0.0; BINS];
    let (mut bounds, mut count) = (Bounds::EMPTY, 0);
    for k in (1..BINS).rev() {
        (bounds, count) = (bounds.union(bins[k].0), count + bins[k].1);
        above[k] = bounds.area() * count as f32;
    }
    let mut best = (BINS / 2, f32::INFINITY);
    (bounds, count) = (Bounds::EMPTY, 0);
    for k in 1..BINS {
        (bounds, count) = (bounds.union(bins[k - 1].0), count + bins[k - 1].1);
        let cost = bounds.area() * count as f32 + above[k];
        if count > 0 && count < items.len() && cost < best.1 {
            best = (k, cost);
        }
    }
    best
}

/// Moves what belongs first to the front; returns how much that is.
fn partition(items: &mut [Item], first: impl Fn(&Item) -> bool) -> usize {
    let mut middle = 0;
    for k in 0..items.len() {
        if first(&items[k]) {
            items.swap(k, middle);
            middle += 1;
        }
    }
    middle
}

/// Halves items at their median along the longest side.
fn halve(items: &mut [Item]) -> usize {
    let bounds = items.iter().fold(Bounds::EMPTY, |b, item| b.union(item.bounds));
    let axis = longest_axis(bounds);
    let middle = items.len() / 2;
    items.select_nth_unstable_by(middle, |a, b| a.centre()[axis].total_cmp(&b.centre()[axis]));
    middle
}

fn longest_axis(bounds: Bounds) -> usize {
    let side = bounds.high - bounds.low;
    (0..3).max_by(|&i, &j| side[i].total_cmp(&side[j])).unwrap_or(0)
}

/// The tree over triangles with the polygons that they are part of; no node at all over nothing.
pub(super) fn tree(triangles: &[([DVec3; 3], u32)], facets: &[Facet]) -> Bvh {
    let mut items: Vec<Item> =
        triangles.iter().zip(0..).map(|((corners, _), k)| Item::new(corners, k)).collect();
    let mut bvh = Bvh { nodes: Vec::new(), packets: Vec::new() };
    if !items.is_empty() {
        let root = Tree::new(&mut items, 0, 0);
        Collapse { triangles, facets, items: &items, bvh: &mut bvh }.node(&root);
    }
    bvh
}

/// Turns the binary tree into nodes of eight.
struct Collapse<'a> {
    triangles: &'a [([DVec3; 3], u32)],
    facets: &'a [Facet],
    items: &'a [Item],
    bvh: &'a mut Bvh,
}

impl Collapse<'_> {
    /// Appends the node over a tree, and all below it; returns its index.
    fn node(&mut self, tree: &Tree) -> u32 {
        let axis = longest_axis(tree.bounds);
        let mut children = eight_subtrees(tree);
        children.sort_by(|a, b| {
            let centre = |t: &Tree| t.bounds.low[axis] + t.bounds.high[axis];
            centre(a).total_cmp(&centre(b))
        });
        let index = self.bvh.nodes.len();
        let bounds = std::array::from_fn(|side| {
            f32x8::new(std::array::from_fn(|k| {
                let Bounds { low, high } = children.get(k).map_or(Bounds::EMPTY, |t| t.bounds);
                if side < 3 { low[side] } else { high[side - 3] }
            }))
        });
        self.bvh.nodes.push(Node { bounds, children: [0; 8], axis });
        for (k, child) in children.into_iter().enumerate() {
            let place = if child.range.len() > 8 { self.node(child) } else { self.packet(child) | LEAF };
            self.bvh.nodes[index].children[k] = place;
        }
        index as u32
    }

    /// Appends the packet of a tree's triangles; returns its index.
    fn packet(&mut self, tree: &Tree) -> u32 {
        let mut members: Vec<_> =
            self.items[tree.range.clone()].iter().map(|i| self.triangles[i.triangle as usize]).collect();
        members.sort_by_key(|&(_, polygon)| polygon);
        self.bvh.packets.push(Packet::new(&members, self.facets));
        (self.bvh.packets.len() - 1) as u32
    }
}

/// Opens the subtree whose halves gain the most, until there are eight.
fn eight_subtrees(tree: &Tree) -> Vec<&Tree> {
    let mut open = vec![tree];
    while open.len() < 8 {
        let widest = (0..open.len())
            .filter(|&k| worth_opening(open[k]))
            .max_by(|&i, &j| gain(open[i]).total_cmp(&gain(open[j])));
        let Some((k, [first, second])) = widest.and_then(|k| Some((k, open[k].halves.as_deref()?))) else {
            break;
        };
        open[k] = first;
        open.push(second);
    }
    open
}

/// What fits one packet is opened only where its halves leave much of the box empty.
fn worth_opening(tree: &Tree) -> bool {
    tree.halves.as_deref().is_some_and(|[first, second]| {
        tree.range.len() > 8 || first.bounds.area() + second.bounds.area() < 0.65 * tree.bounds.area()
    })
}

/// How often rays meet the box; what needs more nodes below goes before what fits one packet.
fn gain(tree: &Tree) -> f32 {
    tree.bounds.area() * if tree.range.len() > 8 { 4.0 } else { 1.0 }
}
