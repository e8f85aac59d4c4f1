//! What can be written with less work or more digits, and has the same value.

use crate::graph::{Graph, Node, NotReal};
use crate::operation::{Binary, Unary};
use std::f64::consts::E;

/// Powers up to this are products: the error grows with the power, to less than that of one rounding each.
const PRODUCTS: f64 = 8.0;

/// A simpler form of an operation on `a`.
pub(crate) fn unary(graph: &mut Graph, operation: Unary, a: Node) -> Option<Node> {
    match operation {
        Unary::Neg => graph.argument_of(Unary::Neg, a),
        Unary::Abs if graph.facts(a).non_negative => Some(a),
        Unary::Abs => {
            let b = graph.argument_of(Unary::Neg, a)?;
            graph.unary(Unary::Abs, b).ok()
        }
        Unary::Real | Unary::Conj if graph.is_real(a) => Some(a),
        Unary::Imag if graph.is_real(a) => Some(graph.real_constant(0.0)),
        _ => None,
    }
}

/// A simpler form of `a` (op) `b`.
pub(crate) fn binary(graph: &mut Graph, operation: Binary, a: Node, b: Node) -> Option<Node> {
    if let Some(exact) = crate::difference::exact(graph, operation, a, b) {
        return Some(exact);
    }
    match operation {
        Binary::Add => sum(graph, a, b),
        Binary::Sub => negated(graph, b).and_then(|c| graph.binary(Binary::Add, a, c).ok()).or_else(|| {
            let zero = graph.real_value(b) == Some(0.0);
            zero.then_some(a)
        }),
        Binary::Mul => product(graph, a, b),
        Binary::Div => quotient(graph, a, b),
        Binary::Pow => power(graph, a, b),
        _ => None,
    }
}

/// c with `a` = −c.
fn negated(graph: &Graph, a: Node) -> Option<Node> {
    graph.argument_of(Unary::Neg, a)
}

fn sum(graph: &mut Graph, a: Node, b: Node) -> Option<Node> {
    match (negated(graph, a), negated(graph, b)) {
        (_, Some(c)) => return graph.binary(Binary::Sub, a, c).ok(),
        (Some(c), None) => return graph.binary(Binary::Sub, b, c).ok(),
        _ => {}
    }
    match (graph.real_value(a), graph.real_value(b)) {
        (Some(0.0), _) => Some(b),
        (_, Some(0.0)) => Some(a),
        _ => None,
    }
}

fn product(graph: &mut Graph, a: Node, b: Node) -> Option<Node> {
    for (factor, other) in [(a, b), (b, a)] {
        match graph.real_value(factor) {
            Some(1.0) => return Some(other),
            Some(-1.0) => return graph.unary(Unary::Neg, other).ok(),
            _ => {}
        }
    }
    (a == b).then(|| graph.power(a, 2))
}

/// Division by a power of two is an exact multiplication, and a quicker one.
fn quotient(graph: &mut Graph, a: Node, b: Node) -> Option<Node> {
    let divisor = graph.real_value(b)?;
    let inverse = 1.0 / divisor;
    let exact = inverse.is_normal() && divisor.to_bits().trailing_zeros() >= 52;
    if !exact {
        return None;
    }
    let inverse = graph.real_constant(inverse);
    graph.binary(Binary::Mul, a, inverse).ok()
}

fn power(graph: &mut Graph, a: Node, b: Node) -> Option<Node> {
    if graph.real_value(a) == Some(E) {
        return graph.unary(Unary::Exp, b).ok();
    }
    let exponent = graph.real_value(b)?;
    if exponent.fract() == 0.0 && exponent.abs() <= PRODUCTS {
        return Some(integer_power(graph, a, exponent as i32));
    }
    half_power(graph, a, exponent).ok().flatten()
}

fn integer_power(graph: &mut Graph, a: Node, n: i32) -> Node {
    match n {
        0 => graph.real_constant(1.0),
        1 => a,
        n => {
            let even =
                negated(graph, a).or_else(|| graph.argument_of(Unary::Abs, a).filter(|b| graph.is_real(*b)));
            match even.filter(|_| n % 2 == 0) {
                Some(b) => graph.power(b, n),
                None => graph.power(a, n),
            }
        }
    }
}

/// a^±½ and a^±1½ by the square root, which is quick and exactly rounded.
fn half_power(graph: &mut Graph, a: Node, exponent: f64) -> Result<Option<Node>, NotReal> {
    if ![0.5, 1.5].contains(&exponent.abs()) {
        return Ok(None);
    }
    let root = graph.unary(Unary::Sqrt, a)?;
    let whole = if exponent.abs() == 0.5 { root } else { graph.binary(Binary::Mul, a, root)? };
    Ok(Some(if exponent < 0.0 { graph.power(whole, -1) } else { whole }))
}
