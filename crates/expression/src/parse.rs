//! A text becomes a graph: precedence climbing, each operand with its place for the messages.
//!
//! From loose to tight: `||`, `&&`, comparisons, `+ −`, `* /`, signs and `!`, `^` (from the right).

use crate::error::{ErrorKind, ParseError};
use crate::functions::{Function, Meaning, function};
use crate::graph::{Graph, Node, NotReal};
use crate::names::{Named, Names, nearest_function};
use crate::operation::{Binary, Unary};
use crate::token::{Token, TokenKind, tokens};
use num_complex::Complex;
use std::ops::Range;

/// Bytes that a formula may have: far more than anybody types, few enough for any machine.
const LONGEST: usize = 1 << 16;

/// Levels of nesting: the parser recurses, and a stack of 2 MiB is deep enough for several times as many.
const DEEPEST: usize = 200;

/// The graph of `text`, and its root.
pub(crate) fn parse(text: &str, names: Names<'_>) -> Result<(Graph, Node), ParseError> {
    if text.len() > LONGEST {
        let kind = ErrorKind::TooLong { length: text.len(), limit: LONGEST };
        return Err(ParseError::new(kind, 0..0, text));
    }
    if text.trim().is_empty() {
        return Err(ParseError::new(ErrorKind::Empty, 0..0, text));
    }
    let tokens = tokens(text, names.find("i") == Named::Imaginary)?;
    let imaginary = |token: &Token| match token.kind {
        TokenKind::Imaginary(_) => true,
        TokenKind::Name => names.find(&text[token.span.clone()]) == Named::Imaginary,
        _ => false,
    };
    let graph = Graph::new(tokens.iter().any(imaginary), names.difference);
    let mut parser = Parser { text, tokens, at: 0, depth: 0, names, graph };
    let root = parser.expression(OR)?;
    parser.end()?;
    Ok((parser.graph, root.node))
}

const OR: u8 = 1;
const AND: u8 = 2;
const COMPARISON: u8 = 3;
const SUM: u8 = 4;
const PRODUCT: u8 = 5;

/// A part of the formula, and its bytes.
#[derive(Clone, Debug)]
struct Operand {
    node: Node,
    span: Range<usize>,
}

struct Parser<'a> {
    text: &'a str,
    tokens: Vec<Token>,
    at: usize,
    depth: usize,
    names: Names<'a>,
    graph: Graph,
}

type Parsed<T> = Result<T, ParseError>;

impl Parser<'_> {
    fn expression(&mut self, loosest: u8) -> Parsed<Operand> {
        let mut left = self.signed()?;
        while let Some((symbol, level)) = self.infix().filter(|(_, level)| *level >= loosest) {
            self.at += 1;
            let right = self.expression(level + 1)?;
            if level == COMPARISON && self.infix().is_some_and(|(_, next)| next == COMPARISON) {
                return Err(self.error_here(ErrorKind::ChainedComparison));
            }
            left = self.combine(symbol, left, right)?;
        }
        Ok(left)
    }

    /// The infix operator at the cursor and how tight it binds.
    fn infix(&self) -> Option<(&'static str, u8)> {
        let TokenKind::Symbol(symbol) = self.tokens[self.at].kind else { return None };
        let level = match symbol {
            "||" => OR,
            "&&" => AND,
            "<" | "<=" | ">" | ">=" | "==" | "!=" => COMPARISON,
            "+" | "-" => SUM,
            "*" | "/" => PRODUCT,
            _ => return None,
        };
        Some((symbol, level))
    }

    fn combine(&mut self, symbol: &'static str, left: Operand, right: Operand) -> Parsed<Operand> {
        let (operation, turned) = match symbol {
            "||" => (Binary::Or, false),
            "&&" => (Binary::And, false),
            "<" => (Binary::Less, false),
            "<=" => (Binary::LessEqual, false),
            ">" => (Binary::Less, true),
            ">=" => (Binary::LessEqual, true),
            "==" => (Binary::Equal, false),
            "!=" => (Binary::NotEqual, false),
            "+" => (Binary::Add, false),
            "-" => (Binary::Sub, false),
            "*" => (Binary::Mul, false),
            "/" => (Binary::Div, false),
            _ => (Binary::Pow, false),
        };
        let span = left.span.start..right.span.end;
        let pair = if turned { [right, left] } else { [left, right] };
        let made = self.graph.binary(operation, pair[0].node, pair[1].node);
        let node = made.map_err(|NotReal(k)| self.not_real(symbol, &pair[k]))?;
        Ok(Operand { node, span })
    }

    /// Signs, then a power: −x² is −(x²).
    fn signed(&mut self) -> Parsed<Operand> {
        let Token { kind, span } = self.tokens[self.at].clone();
        let TokenKind::Symbol(symbol @ ("-" | "+" | "!")) = kind else { return self.power() };
        self.at += 1;
        let operand = self.deeper(&span, Self::signed)?;
        let span = span.start..operand.span.end;
        let operation = match symbol {
            "-" => Unary::Neg,
            "!" => Unary::Not,
            _ => return Ok(Operand { span, ..operand }),
        };
        let node = self.graph.unary(operation, operand.node).map_err(|_| self.not_real(symbol, &operand))?;
        Ok(Operand { node, span })
    }

    /// a ^ b ^ c = a ^ (b ^ c), with signs in the exponents.
    fn power(&mut self) -> Parsed<Operand> {
        let base = self.primary()?;
        let Token { kind: TokenKind::Symbol("^"), span } = self.tokens[self.at].clone() else {
            return Ok(base);
        };
        self.at += 1;
        let exponent = self.deeper(&span, Self::signed)?;
        self.combine("^", base, exponent)
    }

    fn primary(&mut self) -> Parsed<Operand> {
        let Token { kind, span } = self.tokens[self.at].clone();
        let node = match kind {
            TokenKind::Number(value) => self.graph.real_constant(value),
            TokenKind::Imaginary(value) => self.graph.constant(Complex::new(0.0, value)),
            TokenKind::Name => return self.named(span),
            TokenKind::Symbol("(") => return self.parenthesis(span),
            TokenKind::Symbol(")") if self.open() == 0 => return Err(self.error_here(ErrorKind::Unopened)),
            _ => return Err(self.error_here(ErrorKind::MissingValue { found: self.found() })),
        };
        self.at += 1;
        self.followed_by_operator(Operand { node, span })
    }

    fn parenthesis(&mut self, opening: Range<usize>) -> Parsed<Operand> {
        self.at += 1;
        let inner = self.deeper(&opening, |parser| parser.expression(OR))?;
        let end = self.closing(&opening)?;
        self.followed_by_operator(Operand { node: inner.node, span: opening.start..end })
    }

    /// Steps over the `)` of the parenthesis that opened at `opening`; its end.
    fn closing(&mut self, opening: &Range<usize>) -> Parsed<usize> {
        let Token { kind, span } = self.tokens[self.at].clone();
        match kind {
            TokenKind::Symbol(")") => {
                self.at += 1;
                Ok(span.end)
            }
            TokenKind::End => Err(self.error(ErrorKind::Unclosed, opening)),
            _ => Err(self.unexpected()),
        }
    }

    /// A variable, a parameter, a constant or a call.
    fn named(&mut self, span: Range<usize>) -> Parsed<Operand> {
        let name = &self.text[span.clone()];
        self.at += 1;
        if self.tokens[self.at].kind == TokenKind::Symbol("(") {
            return match function(name) {
                Some(function) => self.call(function, span),
                None => Err(self.error(self.no_function(name), &span)),
            };
        }
        let node = match self.names.find(name) {
            Named::Variable(column) => self.graph.variable(column),
            Named::Number(value) => self.graph.real_constant(value),
            Named::Imaginary => self.graph.constant(Complex::I),
            Named::Both => return Err(self.error(ErrorKind::Ambiguous { name: name.into() }, &span)),
            Named::Nothing => return Err(self.error(self.no_value(name), &span)),
        };
        self.followed_by_operator(Operand { node, span })
    }

    fn no_function(&self, name: &str) -> ErrorKind {
        match self.names.find(name) {
            Named::Nothing => {
                ErrorKind::UnknownFunction { name: name.into(), nearest: nearest_function(name) }
            }
            _ => ErrorKind::NotAFunction { name: name.into() },
        }
    }

    fn no_value(&self, name: &str) -> ErrorKind {
        match function(name) {
            Some(function) => {
                ErrorKind::NotCalled { name: name.into(), signature: function.signature.into() }
            }
            None => ErrorKind::UnknownName {
                name: name.into(),
                nearest: self.names.nearest(name),
                known: self.names.listed(),
            },
        }
    }

    /// A call, the cursor at its parenthesis.
    fn call(&mut self, function: &Function, name: Range<usize>) -> Parsed<Operand> {
        let opening = self.tokens[self.at].span.clone();
        self.at += 1;
        let arguments = self.deeper(&opening, Self::arguments)?;
        let end = self.closing(&opening)?;
        let (expected, right) = function.arity(arguments.len());
        if !right {
            let (signature, expected) = (function.signature.into(), expected.into());
            let kind = ErrorKind::Arity { signature, expected, found: arguments.len() };
            return Err(self.error(kind, &(name.start..end)));
        }
        let node = self.apply(function, &arguments)?;
        self.followed_by_operator(Operand { node, span: name.start..end })
    }

    fn arguments(&mut self) -> Parsed<Vec<Operand>> {
        let mut arguments = Vec::new();
        if self.tokens[self.at].kind == TokenKind::Symbol(")") {
            return Ok(arguments);
        }
        loop {
            arguments.push(self.expression(OR)?);
            if self.tokens[self.at].kind != TokenKind::Symbol(",") {
                return Ok(arguments);
            }
            self.at += 1;
        }
    }

    fn apply(&mut self, function: &Function, arguments: &[Operand]) -> Parsed<Node> {
        let node = |k: usize| arguments[k].node;
        let order = arguments.first().and_then(|order| self.graph.real_value(order.node));
        if matches!(function.meaning, Meaning::Binary(Binary::ExpInt))
            && order.is_some_and(|n| n < 0.0 || n.fract() != 0.0)
        {
            return Err(self.error(ErrorKind::Order { name: function.name().into() }, &arguments[0].span));
        }
        let made = match function.meaning {
            Meaning::Unary(operation) => self.graph.unary(operation, node(0)),
            Meaning::Binary(operation) => self.graph.binary(operation, node(0), node(1)),
            Meaning::If => self.graph.select(node(0), node(1), node(2)),
            Meaning::Fold(operation) => (1..arguments.len()).try_fold(node(0), |folded, k| {
                let made = self.graph.binary(operation, folded, node(k));
                made.map_err(|NotReal(side)| NotReal(if side == 0 { 0 } else { k }))
            }),
        };
        made.map_err(|NotReal(k)| self.not_real(function.name(), &arguments[k]))
    }

    /// Two values side by side are not multiplied: `2x` may be a slip for `2*x`, or for `x2`.
    fn followed_by_operator(&self, operand: Operand) -> Parsed<Operand> {
        let Token { kind, span } = &self.tokens[self.at];
        let value_follows = matches!(
            kind,
            TokenKind::Number(_) | TokenKind::Imaginary(_) | TokenKind::Name | TokenKind::Symbol("(")
        );
        if !value_follows {
            return Ok(operand);
        }
        let left = shown(&self.text[operand.span.clone()]);
        let right = match kind {
            TokenKind::Symbol(_) => "(…)".to_string(),
            _ => shown(&self.text[span.clone()]),
        };
        Err(self.error(ErrorKind::SideBySide { left, right }, &(operand.span.start..span.end)))
    }

    /// One level down; told at `span` if that is too deep.
    fn deeper<T>(&mut self, span: &Range<usize>, parse: impl FnOnce(&mut Self) -> Parsed<T>) -> Parsed<T> {
        if self.depth == DEEPEST {
            return Err(self.error(ErrorKind::TooDeep { limit: DEEPEST }, span));
        }
        self.depth += 1;
        let parsed = parse(self);
        self.depth -= 1;
        parsed
    }

    fn end(&self) -> Parsed<()> {
        match self.tokens[self.at].kind {
            TokenKind::End => Ok(()),
            TokenKind::Symbol(")") => Err(self.error_here(ErrorKind::Unopened)),
            _ => Err(self.unexpected()),
        }
    }

    /// Parentheses open before the cursor.
    fn open(&self) -> usize {
        self.tokens[..self.at].iter().fold(0, |open: usize, token| match token.kind {
            TokenKind::Symbol("(") => open + 1,
            TokenKind::Symbol(")") => open.saturating_sub(1),
            _ => open,
        })
    }

    fn unexpected(&self) -> ParseError {
        let instead = match self.tokens[self.at].kind {
            TokenKind::Symbol(",") => {
                Some("arguments belong in a function's parentheses, and decimals behind a `.`")
            }
            TokenKind::Symbol("!") => Some("for a factorial, write `gamma(n+1)`"),
            _ => None,
        };
        let kind = ErrorKind::Unexpected { found: self.found(), instead: instead.map(str::to_string) };
        self.error_here(kind)
    }

    /// What stands at the cursor, for a message.
    fn found(&self) -> String {
        let Token { kind, span } = &self.tokens[self.at];
        match kind {
            TokenKind::End => "the end of the formula".into(),
            _ => format!("`{}`", &self.text[span.clone()]),
        }
    }

    fn not_real(&self, name: &str, argument: &Operand) -> ParseError {
        self.error(ErrorKind::NotReal { name: name.into() }, &argument.span)
    }

    fn error_here(&self, kind: ErrorKind) -> ParseError {
        self.error(kind, &self.tokens[self.at].span)
    }

    fn error(&self, kind: ErrorKind, span: &Range<usize>) -> ParseError {
        ParseError::new(kind, span.clone(), self.text)
    }
}

/// A text short enough for a message.
fn shown(text: &str) -> String {
    const LONGEST: usize = 24;
    match text.char_indices().nth(LONGEST) {
        None => text.to_string(),
        Some(_) => "(…)".to_string(),
    }
}
