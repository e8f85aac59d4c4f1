//! d = u − v, known exactly: where a formula subtracts the variables u and v, it gets d, which has all its digits.
//!
//! A kernel such as |x − y|^(−1/2) is wanted for y within 10⁻³⁰ of x, where the doubles x and y are equal. So a node
//! that is a u + b v + c, with numbers a, b, c, is kept as such, and if a = −b it is written a d + c.

use crate::graph::{Facts, Graph, Node};
use crate::operation::{Binary, Operation, Unary};
use num_complex::Complex;

/// The columns of u, v and d = u − v.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Difference {
    pub minuend: usize,
    pub subtrahend: usize,
    pub column: usize,
}

/// a u + b v + c, as [a, b, c].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Affine([f64; 3]);

impl Affine {
    /// The form of a node, if it has one.
    pub fn of(difference: Difference, graph: &Graph, facts: &Facts) -> Option<Affine> {
        let form = |k: usize| graph.facts(facts.arguments[k]).affine;
        let number = |k: usize| graph.real_value(facts.arguments[k]);
        let Difference { minuend, subtrahend, column } = difference;
        match facts.operation {
            Operation::Variable(k) if k == minuend => Some(Affine([1.0, 0.0, 0.0])),
            Operation::Variable(k) if k == subtrahend => Some(Affine([0.0, 1.0, 0.0])),
            Operation::Variable(k) if k == column => Some(Affine([1.0, -1.0, 0.0])),
            Operation::Constant(value) => {
                let value = Complex::from(value);
                (value.im == 0.0 && value.re.is_finite()).then_some(Affine([0.0, 0.0, value.re]))
            }
            Operation::Unary(Unary::Neg) => Some(form(0)?.map(|a| -a)),
            Operation::Binary(Binary::Add) => Some(form(0)?.combined(form(1)?, 1.0)),
            Operation::Binary(Binary::Sub) => Some(form(0)?.combined(form(1)?, -1.0)),
            Operation::Binary(Binary::Mul) => match (number(0), number(1)) {
                (Some(factor), _) => Some(form(1)?.map(|a| factor * a)),
                (_, Some(factor)) => Some(form(0)?.map(|a| a * factor)),
                _ => None,
            },
            Operation::Binary(Binary::Div) => {
                let divisor = number(1)?;
                Some(form(0)?.map(|a| a / divisor))
            }
            _ => None,
        }
    }

    fn map(self, change: impl Fn(f64) -> f64) -> Affine {
        Affine(self.0.map(change))
    }

    fn combined(self, other: Affine, sign: f64) -> Affine {
        Affine(std::array::from_fn(|k| self.0[k] + sign * other.0[k]))
    }

    /// (k, c) if the form is k (u − v) + c, with k ≠ 0.
    fn multiple(self) -> Option<(f64, f64)> {
        let [a, b, c] = self.0;
        (a == -b && a != 0.0 && self.0.iter().all(|a| a.is_finite())).then_some((a, c))
    }
}

/// `a` (op) `b` with the exact difference in it, if it is a sum, a comparison or a choice that depends on u − v alone.
pub(crate) fn exact(graph: &mut Graph, operation: Binary, a: Node, b: Node) -> Option<Node> {
    let column = graph.difference()?.column;
    let (left, right) = (graph.facts(a).affine?, graph.facts(b).affine?);
    if graph.real_value(a).is_some() || graph.real_value(b).is_some() {
        return None; // what is added to a number has the difference already
    }
    let sign = if operation == Binary::Add { 1.0 } else { -1.0 };
    let (factor, rest) = left.combined(right, sign).multiple()?;
    match operation {
        Binary::Add | Binary::Sub => written(graph, column, factor, rest),
        Binary::Less | Binary::LessEqual | Binary::Equal | Binary::NotEqual if rest == 0.0 => {
            let gap = written(graph, column, factor, 0.0)?;
            let zero = graph.real_constant(0.0);
            Some(graph.plain_binary(operation, gap, zero))
        }
        Binary::Min | Binary::Max if rest == 0.0 => {
            // the step asks for a − b < 0, or with a factor that is negative for b − a < 0, which takes the other
            let (small, large) = if operation == Binary::Min { (a, b) } else { (b, a) };
            let (small, large) = if factor < 0.0 { (large, small) } else { (small, large) };
            let gap = written(graph, column, factor.abs(), 0.0)?;
            Some(graph.by_sign(gap, small, large))
        }
        _ => None,
    }
}

/// factor · d + rest.
fn written(graph: &mut Graph, column: usize, factor: f64, rest: f64) -> Option<Node> {
    let difference = graph.variable(column);
    let factor = graph.real_constant(factor);
    let scaled = graph.binary(Binary::Mul, difference, factor).ok()?;
    let rest = graph.real_constant(rest);
    graph.binary(Binary::Add, scaled, rest).ok()
}
