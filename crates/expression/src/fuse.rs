//! Two operations in one step: half the way through registers, where the operations are additions and the like.

use crate::graph::{Graph, Kind, Node};
use crate::operation::{Binary, Operation, Unary};

/// The second operation of a step, on the result r of the first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outer {
    /// r + c.
    Add,
    /// r − c.
    Sub,
    /// c − r.
    SubFrom,
    /// r c.
    Mul,
    /// r / c.
    Div,
    /// c / r.
    DivInto,
    /// r².
    Square,
    /// |r|.
    Abs,
    /// −r.
    Neg,
}

/// A node with the one that it swallows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Fusion {
    pub inner: Node,
    pub first: Operation,
    pub second: Outer,
    /// The other argument of the second operation, or any if it has one alone.
    pub other: Node,
}

/// The fusions among `order`, each at the node that swallows another: one that nothing else needs, and that changes
/// with the same columns; otherwise it would be computed more often than alone.
pub(crate) fn fusions(graph: &Graph, order: &[Node]) -> Vec<Option<Fusion>> {
    let size = order.last().map_or(0, |root| root + 1);
    let mut uses = vec![0; size];
    for node in order {
        graph.facts(*node).arguments.iter().for_each(|argument| uses[*argument] += 1);
    }
    let mut fusions = vec![None; size];
    for node in order {
        let free = |inner: Node| uses[inner] == 1 && fusions[inner].is_none();
        let same = |inner: Node| graph.facts(inner).depends == graph.facts(*node).depends;
        fusions[*node] = candidates(graph, *node)
            .into_iter()
            .flatten()
            .find(|fusion: &Fusion| free(fusion.inner) && same(fusion.inner));
    }
    fusions
}

/// What a node could swallow.
fn candidates(graph: &Graph, node: Node) -> [Option<Fusion>; 2] {
    let facts = graph.facts(node);
    let argument = |k: usize| facts.arguments[k];
    let fusion = |inner: Node, second: Outer, other: Node| {
        Some(Fusion { inner, first: quick(graph, inner)?, second, other })
    };
    let alone = |second: Outer| {
        let inner = argument(0);
        [graph.facts(inner).arguments.first().and_then(|any| fusion(inner, second, *any)), None]
    };
    let pair = |left: Outer, right: Outer| {
        [fusion(argument(0), left, argument(1)), fusion(argument(1), right, argument(0))]
    };
    if facts.kind != Kind::Real || facts.arguments.iter().any(|argument| !graph.is_real(*argument)) {
        return [None; 2];
    }
    match facts.operation {
        Operation::Binary(Binary::Add) => pair(Outer::Add, Outer::Add),
        Operation::Binary(Binary::Sub) => pair(Outer::Sub, Outer::SubFrom),
        Operation::Binary(Binary::Mul) => pair(Outer::Mul, Outer::Mul),
        Operation::Binary(Binary::Div) => pair(Outer::Div, Outer::DivInto),
        Operation::Power(2) => alone(Outer::Square),
        Operation::Unary(Unary::Abs) => alone(Outer::Abs),
        Operation::Unary(Unary::Neg) => alone(Outer::Neg),
        _ => [None; 2],
    }
}

/// The operation of a node, if it is one that can come first.
fn quick(graph: &Graph, node: Node) -> Option<Operation> {
    use Binary::{Add, Div, Max, Min, Mul, Sub};
    let facts = graph.facts(node);
    let quick =
        matches!(facts.operation, Operation::Binary(Add | Sub | Mul | Div | Min | Max) | Operation::BySign);
    (quick && facts.arguments.iter().all(|argument| graph.is_real(*argument))).then_some(facts.operation)
}
