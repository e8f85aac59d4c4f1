//! The mesh of the domain as a forest: faces, cut into quarters where the solution asks for it, down to patches, on which
//! light is a polynomial; below them three more generations, the last of which, leaves, tell apart what is seen of a patch.

use crate::form_factor::exchange::FromAfar;
use crate::patches::inverse_bilinear;
use crate::polygon::Polygon;
use glam::{DVec2, DVec3};
use std::ops::Range;

/// A part of a face: the face itself, or a quarter of a part.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub polygon: Polygon,
    pub area: f64,
    pub diameter: f64,
    pub from_afar: FromAfar,
    /// The face that it is a part of.
    pub face: u32,
    /// The area that is not under something, in m².
    pub exposed: f64,
    /// Whether light is a polynomial on it.
    pub is_patch: bool,
    /// Its parts, none of a leaf.
    pub parts: Range<u32>,
}

/// How many leaves a patch has.
pub(super) const LEAVES: usize = 64;

/// Faces first, and parts always behind what they are parts of.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    pub nodes: Vec<Node>,
}

impl Tree {
    /// The faces, each in parts that are about as long as wide, and these in patches of some diameter at most.
    pub fn new(faces: &[Polygon], size: f64) -> Self {
        let node = |(polygon, k): (&Polygon, u32)| Node::new(polygon.clone(), k);
        let mut tree = Self { nodes: faces.iter().zip(0..).map(node).collect() };
        for face in 0..faces.len() as u32 {
            let pieces = strips(&faces[face as usize]);
            let parts = if pieces.len() > 1 { tree.divide(face, pieces) } else { face..face + 1 };
            parts.for_each(|part| tree.patch_down_to(part, size));
        }
        tree
    }

    fn patch_down_to(&mut self, node: u32, size: f64) {
        if self.node(node).diameter > size {
            self.quarters(node).for_each(|part| self.patch_down_to(part, size));
        } else {
            self.make_patch(node);
        }
    }

    fn make_patch(&mut self, node: u32) {
        self.nodes[node as usize].is_patch = true;
        for quarter in self.quarters(node) {
            for sixteenth in self.quarters(quarter) {
                self.quarters(sixteenth);
            }
        }
    }

    /// Cuts a patch in four.
    pub fn cut(&mut self, patch: u32) {
        self.nodes[patch as usize].is_patch = false;
        self.quarters(patch).for_each(|part| self.make_patch(part));
    }

    pub fn node(&self, node: u32) -> &Node {
        &self.nodes[node as usize]
    }

    /// The parts of a node, which has four from now on.
    fn quarters(&mut self, node: u32) -> Range<u32> {
        if self.is_leaf(node) {
            self.divide(node, self.node(node).polygon.quarters())
        } else {
            self.node(node).parts.clone()
        }
    }

    fn divide(&mut self, node: u32, pieces: impl IntoIterator<Item = Polygon>) -> Range<u32> {
        let (face, first) = (self.node(node).face, self.nodes.len() as u32);
        self.nodes.extend(pieces.into_iter().map(|piece| Node::new(piece, face)));
        let parts = first..self.nodes.len() as u32;
        self.nodes[node as usize].parts = parts.clone();
        parts
    }

    /// Whether it has no parts.
    pub fn is_leaf(&self, node: u32) -> bool {
        self.node(node).parts.is_empty()
    }

    /// All nodes without parts.
    pub fn leaves(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.nodes.len() as u32).filter(|&node| self.is_leaf(node))
    }

    /// All patches.
    pub fn patches(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.nodes.len() as u32).filter(|&node| self.node(node).is_patch)
    }

    /// The leaves of a patch, quarter by quarter.
    pub fn leaves_of(&self, patch: u32) -> impl Iterator<Item = u32> + '_ {
        let parts = |node: u32| self.node(node).parts.clone();
        parts(patch).flat_map(parts).flat_map(parts)
    }

    /// The patch of a face that a point lies on, the nearest for a point outside.
    pub fn patch_at(&self, face: u32, point: DVec3) -> u32 {
        let mut node = face;
        while !self.node(node).is_patch {
            let nearest = |part: &u32| self.node(*part).polygon.distance_outside(point);
            let parts = self.node(node).parts.clone();
            node = parts.min_by(|a, b| nearest(a).total_cmp(&nearest(b))).unwrap_or(node);
        }
        node
    }
}

impl Node {
    fn new(polygon: Polygon, face: u32) -> Self {
        Self {
            area: polygon.area(),
            exposed: polygon.area(),
            diameter: polygon.diameter(),
            from_afar: FromAfar::new(&polygon),
            polygon,
            face,
            is_patch: false,
            parts: 0..0,
        }
    }

    /// Where a point lies in it: (s, t) of the unit square, or the shares of the second and third corner.
    pub fn local(&self, point: DVec3) -> DVec2 {
        inverse_bilinear(&self.polygon, point)
    }
}

/// A quadrilateral longer than wide in as many pieces side by side as make them square.
fn strips(polygon: &Polygon) -> Vec<Polygon> {
    let &[a, b, c, d] = polygon.vertices() else { return vec![polygon.clone()] };
    let length = 0.5 * (a.distance(b) + c.distance(d));
    let width = 0.5 * (b.distance(c) + d.distance(a));
    let (start, end, count) = if length > width {
        ([a, d], [b, c], (length / width).round() as usize)
    } else {
        ([b, a], [c, d], (width / length).round() as usize)
    };
    let at = |k: usize| [0, 1].map(|side| start[side].lerp(end[side], k as f64 / count as f64));
    let piece = |k: usize| {
        let ([p, s], [q, r]) = (at(k), at(k + 1));
        Polygon::quadrilateral(p, q, r, s)
    };
    (0..count.max(1)).map(piece).collect()
}
