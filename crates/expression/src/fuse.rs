//! Operations that are one step together: half the way through registers, where they are additions and the like.

use crate::graph::{Graph, Kind, Node};
use crate::operation::{Binary, Operation, Unary};
use crate::program::Action;

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

/// A node with those that it swallows, as one step.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Fusion {
    pub swallowed: Vec<Node>,
    pub action: Action,
    pub arguments: Vec<Node>,
}

/// A node with one that it could swallow.
#[derive(Clone, Copy, Debug)]
struct Pair {
    inner: Node,
    first: Operation,
    second: Outer,
    /// The other argument of the second operation, or any if it has one alone.
    other: Node,
}

/// The fusions among `order`, each at the node that swallows others: those that nothing else needs, and that change
/// with the same columns; otherwise they would be computed more often than alone.
pub(crate) fn fusions(graph: &Graph, order: &[Node]) -> Vec<Option<Fusion>> {
    let size = order.last().map_or(0, |root| root + 1);
    let mut uses = vec![0; size];
    for node in order {
        graph.facts(*node).arguments.iter().for_each(|argument| uses[*argument] += 1);
    }
    let mut fusions: Vec<Option<Fusion>> = vec![None; size];
    for node in order {
        let free = |inner: Node| uses[inner] == 1 && graph.facts(inner).depends == graph.facts(*node).depends;
        let pair = pairs(graph, *node)
            .into_iter()
            .flatten()
            .find(|pair| free(pair.inner) && fusions[pair.inner].is_none());
        fusions[*node] = pair.map(|pair| {
            let left = fusions[pair.other].as_ref().filter(|_| free(pair.other));
            left.and_then(|left| chosen_and_left(graph, pair, left)).unwrap_or_else(|| alone(graph, pair))
        });
    }
    fusions
}

/// The pair as a step.
fn alone(graph: &Graph, pair: Pair) -> Fusion {
    let arguments = [graph.facts(pair.inner).arguments.as_slice(), &[pair.other]].concat();
    Fusion { swallowed: vec![pair.inner], action: Action::Two(pair.first, pair.second), arguments }
}

/// The pair with the step that its other argument is, as one: if it multiplies a choice of two with something of what
/// the choice leaves. Green's functions are such products, u(min(x, y)) v(max(x, y)).
fn chosen_and_left(graph: &Graph, pair: Pair, left: &Fusion) -> Option<Fusion> {
    let Action::Two(first, second) = left.action else { return None };
    let chosen = graph.facts(pair.inner).arguments.as_slice();
    let opposite = match (pair.first, first, chosen) {
        (Operation::Binary(Binary::Min), Operation::Binary(Binary::Max), _)
        | (Operation::Binary(Binary::Max), Operation::Binary(Binary::Min), _) => {
            left.arguments.starts_with(chosen)
        }
        (Operation::BySign, Operation::BySign, [gap, a, b]) => left.arguments.starts_with(&[*gap, *b, *a]),
        _ => false,
    };
    (opposite && pair.second == Outer::Mul).then(|| Fusion {
        swallowed: [left.swallowed.as_slice(), &[pair.inner, pair.other]].concat(),
        action: Action::ChosenAndLeft(pair.first, second),
        arguments: [chosen, &left.arguments[chosen.len()..]].concat(),
    })
}

/// What a node could swallow.
fn pairs(graph: &Graph, node: Node) -> [Option<Pair>; 2] {
    let facts = graph.facts(node);
    let argument = |k: usize| facts.arguments[k];
    let pair_of = |inner: Node, second: Outer, other: Node| {
        Some(Pair { inner, first: quick(graph, inner)?, second, other })
    };
    let alone = |second: Outer| {
        let inner = argument(0);
        [graph.facts(inner).arguments.first().and_then(|any| pair_of(inner, second, *any)), None]
    };
    let pair = |left: Outer, right: Outer| {
        [pair_of(argument(0), left, argument(1)), pair_of(argument(1), right, argument(0))]
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
