//! x = b − h t and x = a + h t, h = (b − a)/2: from [−1, 1] to [a, b], with the nodes' distance t from their end kept.

use super::Quadrature;

/// A node x of [−1, 1], its distance t from the nearer end, and its weight.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub(super) x: f64,
    pub(super) t: f64,
    pub(super) weight: f64,
}

impl Node {
    /// The node 1 − t.
    pub(super) fn from_right(t: f64, weight: f64) -> Self {
        Self { x: 1.0 - t, t, weight }
    }

    /// The node −x.
    pub(super) fn mirrored(self) -> Self {
        Self { x: -self.x, ..self }
    }
}

/// All n nodes of a symmetric rule, ascending, from those between the right end and the middle, that included.
pub(super) fn mirrored(n: usize, mut right: Vec<Node>) -> Vec<Node> {
    if n % 2 == 1
        && let Some(middle) = right.last_mut()
    {
        (middle.x, middle.t) = (0.0, 1.0);
    }
    let left = right.iter().map(|node| node.mirrored());
    let mut all = Vec::with_capacity(n);
    all.extend(left);
    all.extend(right.iter().rev().skip(n % 2));
    all
}

/// The rule on [a, b], for a weight of 1.
pub(super) fn mapped(nodes: &[Node], a: f64, b: f64) -> Quadrature<f64> {
    let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
    // Around 0 the nodes' own digits count, elsewhere those of the distance from an end, which may be at 0.
    let centred = middle.abs() < 0.5 * half.abs();
    let place = |node: &Node| match (centred, node.x < 0.0) {
        (true, _) => middle + half * node.x,
        (false, true) => a + half * node.t,
        (false, false) => b - half * node.t,
    };
    Quadrature {
        nodes: nodes.iter().map(place).collect(),
        weights: nodes.iter().map(|node| half * node.weight).collect(),
    }
}
