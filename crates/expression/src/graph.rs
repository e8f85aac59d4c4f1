//! A formula as a graph without repetition: equal sub-expressions are one node, constants are folded.

use crate::difference::{Affine, Difference};
use crate::operation::{Binary, Number, Operation, Unary, power, select};
use crate::{complex, simplify};
use num_complex::Complex;
use std::collections::HashMap;

/// A node by its place; arguments come before the nodes that use them.
pub(crate) type Node = usize;

/// What kind of number a node's value is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Real,
    Complex,
}

/// The argument of this number may be complex, which the operation does not take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct NotReal(pub usize);

/// What is known of a node.
#[derive(Clone, Debug)]
pub(crate) struct Facts {
    pub operation: Operation,
    pub arguments: Vec<Node>,
    pub kind: Kind,
    /// Real, and never negative.
    pub non_negative: bool,
    /// Bit k: the value depends on column k.
    pub depends: u64,
    /// As a combination of the two variables whose difference is known exactly.
    pub affine: Option<Affine>,
}

/// The formula under construction.
#[derive(Debug)]
pub(crate) struct Graph {
    nodes: Vec<Facts>,
    known: HashMap<(Operation, Vec<Node>), Node>,
    /// Whether √−1 is i, and not undefined.
    complex: bool,
    difference: Option<Difference>,
}

impl Graph {
    pub fn new(complex: bool, difference: Option<Difference>) -> Self {
        Graph { nodes: Vec::new(), known: HashMap::new(), complex, difference }
    }

    pub fn facts(&self, node: Node) -> &Facts {
        &self.nodes[node]
    }

    pub fn difference(&self) -> Option<Difference> {
        self.difference
    }

    pub fn is_real(&self, node: Node) -> bool {
        self.nodes[node].kind == Kind::Real
    }

    pub fn real_constant(&mut self, value: f64) -> Node {
        self.constant(Complex::new(value, 0.0))
    }

    /// A constant, real if its imaginary part is zero.
    pub fn constant(&mut self, value: Complex<f64>) -> Node {
        let value = if value.im == 0.0 { Complex::new(value.re, 0.0) } else { value };
        self.node(Operation::Constant(Number::from(value)), Vec::new())
    }

    pub fn variable(&mut self, column: usize) -> Node {
        self.node(Operation::Variable(column), Vec::new())
    }

    /// The value of a constant node.
    pub fn value(&self, node: Node) -> Option<Complex<f64>> {
        match self.nodes[node].operation {
            Operation::Constant(value) => Some(value.into()),
            _ => None,
        }
    }

    /// The value of a constant node that is real.
    pub fn real_value(&self, node: Node) -> Option<f64> {
        self.value(node).filter(|_| self.is_real(node)).map(|z| z.re)
    }

    /// The arguments of a node, if it is made by that operation.
    pub fn argument_of(&self, operation: Unary, node: Node) -> Option<Node> {
        let facts = &self.nodes[node];
        (facts.operation == Operation::Unary(operation)).then(|| facts.arguments[0])
    }

    pub fn unary(&mut self, operation: Unary, a: Node) -> Result<Node, NotReal> {
        if !self.is_real(a) && !operation.takes_complex() {
            return Err(NotReal(0));
        }
        let non_negative = self.nodes[a].non_negative;
        let inside = self.real_value(a).is_some_and(|x| !operation.at(x).is_nan());
        let promote = self.complex && self.is_real(a) && !inside && operation.leaves_reals(non_negative);
        let a = if promote { self.promoted(a) } else { a };
        Ok(match simplify::unary(self, operation, a) {
            Some(simpler) => simpler,
            None => self.node(Operation::Unary(operation), vec![a]),
        })
    }

    pub fn binary(&mut self, operation: Binary, a: Node, b: Node) -> Result<Node, NotReal> {
        if let Some(complex) = [a, b].iter().position(|node| !self.is_real(*node))
            && !operation.takes_complex()
        {
            return Err(NotReal(complex));
        }
        Ok(match simplify::binary(self, operation, a, b) {
            Some(simpler) => simpler,
            None => self.plain_binary(operation, a, b),
        })
    }

    /// a (op) b as it stands, with arguments of the kinds that the operation takes.
    pub fn plain_binary(&mut self, operation: Binary, a: Node, b: Node) -> Node {
        let (mut a, mut b) = if operation.commutes() { (a.min(b), a.max(b)) } else { (a, b) };
        let mixes = matches!(operation, Binary::Add | Binary::Sub | Binary::Mul | Binary::Div);
        let leaves_reals = operation == Binary::Pow && self.power_leaves_reals(a, b);
        if leaves_reals || (!mixes && self.is_real(a) != self.is_real(b)) {
            (a, b) = (self.promoted(a), self.promoted(b));
        }
        self.node(Operation::Binary(operation), vec![a, b])
    }

    /// aⁿ.
    pub fn power(&mut self, a: Node, n: i32) -> Node {
        self.node(Operation::Power(n), vec![a])
    }

    pub fn select(&mut self, condition: Node, a: Node, b: Node) -> Result<Node, NotReal> {
        if !self.is_real(condition) {
            return Err(NotReal(0));
        }
        let (mut a, mut b) = (a, b);
        if self.is_real(a) != self.is_real(b) {
            (a, b) = (self.promoted(a), self.promoted(b));
        }
        Ok(match self.real_value(condition) {
            Some(c) if c.is_nan() => self.real_constant(f64::NAN),
            Some(c) => select(c, a, b, b),
            None => self.node(Operation::Select, vec![condition, a, b]),
        })
    }

    /// `a` where `gap` is negative, else `b`, all of them real.
    pub fn by_sign(&mut self, gap: Node, a: Node, b: Node) -> Node {
        self.node(Operation::BySign, vec![gap, a, b])
    }

    /// A negative number to a power that is not an integer is no real number.
    fn power_leaves_reals(&self, a: Node, b: Node) -> bool {
        let integer = self.real_value(b).is_some_and(|n| n.fract() == 0.0);
        self.complex && !self.nodes[a].non_negative && !integer
    }

    fn promoted(&mut self, a: Node) -> Node {
        if self.is_real(a) { self.node(Operation::Promote, vec![a]) } else { a }
    }

    /// The node of that operation: a constant if the arguments are, the one already there if there is one.
    fn node(&mut self, operation: Operation, arguments: Vec<Node>) -> Node {
        // a promoted constant stays a node: as a constant it would be real again
        if operation != Operation::Promote
            && let Some(value) = self.folded(operation, &arguments)
        {
            return self.constant(value);
        }
        let key = (operation, arguments);
        if let Some(node) = self.known.get(&key) {
            return *node;
        }
        let facts = self.deduce(key.0, key.1.clone());
        self.nodes.push(facts);
        self.known.insert(key, self.nodes.len() - 1);
        self.nodes.len() - 1
    }

    fn deduce(&self, operation: Operation, arguments: Vec<Node>) -> Facts {
        let depends = match operation {
            Operation::Variable(column) => 1 << column,
            _ => arguments.iter().fold(0, |mask, a| mask | self.nodes[*a].depends),
        };
        let kind = self.kind(operation, &arguments);
        let non_negative = kind == Kind::Real && self.is_non_negative(operation, &arguments);
        let mut facts = Facts { operation, arguments, kind, non_negative, depends, affine: None };
        facts.affine = self.difference.and_then(|difference| Affine::of(difference, self, &facts));
        facts
    }

    fn kind(&self, operation: Operation, arguments: &[Node]) -> Kind {
        let real = match operation {
            Operation::Constant(value) => Complex::from(value).im == 0.0,
            Operation::Variable(_) | Operation::BySign => true,
            Operation::Promote => false,
            Operation::Unary(operation) => operation.yields_real() || self.is_real(arguments[0]),
            Operation::Binary(Binary::Equal | Binary::NotEqual) => true,
            Operation::Select => self.is_real(arguments[1]),
            Operation::Binary(_) | Operation::Power(_) => arguments.iter().all(|a| self.is_real(*a)),
        };
        if real { Kind::Real } else { Kind::Complex }
    }

    fn is_non_negative(&self, operation: Operation, arguments: &[Node]) -> bool {
        let known = |k: usize| self.nodes[arguments[k]].non_negative;
        match operation {
            Operation::Constant(value) => Complex::from(value).re >= 0.0,
            Operation::Variable(_) | Operation::Promote => false,
            Operation::Unary(Unary::Tanh | Unary::Atan | Unary::Asinh | Unary::Sinh | Unary::Real) => {
                known(0)
            }
            Operation::Unary(operation) => operation.is_non_negative(),
            Operation::Binary(Binary::Add | Binary::Mul | Binary::Div | Binary::Min) => known(0) && known(1),
            Operation::Binary(Binary::Max) => known(0) || known(1),
            Operation::Binary(Binary::Pow) => known(0),
            Operation::Binary(operation) => operation.is_condition(),
            Operation::Power(n) => n % 2 == 0 || known(0),
            Operation::Select | Operation::BySign => known(1) && known(2),
        }
    }

    /// The value of an operation on constants.
    fn folded(&self, operation: Operation, arguments: &[Node]) -> Option<Complex<f64>> {
        let promoted = |node: Node| match self.nodes[node].operation {
            Operation::Promote => self.value(self.nodes[node].arguments[0]),
            _ => self.value(node),
        };
        let values: Vec<_> = arguments.iter().map(|node| promoted(*node)).collect::<Option<_>>()?;
        let real = arguments.iter().all(|a| self.is_real(*a));
        let from_real = |x: f64| Complex::new(x, 0.0);
        Some(match (operation, values.as_slice()) {
            (Operation::Unary(unary), [z]) if real => from_real(unary.at(z.re)),
            (Operation::Unary(unary), [z]) if unary.yields_real() => {
                from_real(complex::real_unary(unary, *z))
            }
            (Operation::Unary(unary), [z]) => complex::unary(unary, *z),
            (Operation::Power(n), [z]) if real => from_real(power(z.re, n)),
            (Operation::Power(n), [z]) => z.powi(n),
            (Operation::Binary(binary), [a, b]) if real => from_real(binary.at(a.re, b.re)),
            (Operation::Binary(binary), [a, b]) => complex::binary(binary, *a, *b),
            _ => return None,
        })
    }
}
