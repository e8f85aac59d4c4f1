//! A text becomes tokens: numbers, names, operators, parentheses.

use crate::error::{ErrorKind, ParseError};
use std::ops::Range;

/// A word of a formula, with its bytes.
#[derive(Clone, Debug)]
pub(crate) struct Token {
    pub kind: TokenKind,
    pub span: Range<usize>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum TokenKind {
    Number(f64),
    /// A number with the unit `i` behind it.
    Imaginary(f64),
    Name,
    /// An operator, a comma or a parenthesis.
    Symbol(&'static str),
    End,
}

/// The longer ones first: `<=` is not `<`, `=`.
const SYMBOLS: [&str; 18] =
    ["**", "<=", ">=", "==", "!=", "&&", "||", "+", "-", "*", "/", "^", "<", ">", "!", "(", ")", ","];

/// The tokens of `text`, an end behind them. `i` after a number is its unit if `imaginary`.
pub(crate) fn tokens(text: &str, imaginary: bool) -> Result<Vec<Token>, ParseError> {
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(first) = text[at..].chars().next() {
        if first.is_whitespace() {
            at += first.len_utf8();
            continue;
        }
        let (kind, length) = token(text, at, first, imaginary)?;
        tokens.push(Token { kind, span: at..at + length });
        at += length;
    }
    tokens.push(Token { kind: TokenKind::End, span: text.len()..text.len() });
    Ok(tokens)
}

fn token(text: &str, at: usize, first: char, imaginary: bool) -> Result<(TokenKind, usize), ParseError> {
    let rest = &text[at..];
    let digit_follows = rest[first.len_utf8()..].starts_with(|c: char| c.is_ascii_digit());
    if first.is_ascii_digit() || (first == '.' && digit_follows) {
        return number(text, at, imaginary);
    }
    if first.is_alphabetic() || first == '_' {
        let length = rest.find(|c: char| !in_name(c)).unwrap_or(rest.len());
        return Ok((TokenKind::Name, length));
    }
    match SYMBOLS.iter().find(|symbol| rest.starts_with(**symbol)) {
        Some(&"**") => Ok((TokenKind::Symbol("^"), 2)),
        Some(symbol) => Ok((TokenKind::Symbol(symbol), symbol.len())),
        None => {
            let instead = instead_of(first).map(str::to_string);
            let kind = ErrorKind::Character { found: first, instead };
            Err(ParseError::new(kind, at..at + first.len_utf8(), text))
        }
    }
}

/// A number and its length: digits, a point, an exponent, perhaps the imaginary unit.
fn number(text: &str, at: usize, imaginary: bool) -> Result<(TokenKind, usize), ParseError> {
    let rest = &text[at..];
    let mut length = digits(rest);
    if rest[length..].starts_with('.') {
        length += 1 + digits(&rest[length + 1..]);
    }
    length += exponent(&rest[length..]);
    let behind = &rest[length..];
    if behind.starts_with('.') {
        let end =
            at + length + behind.find(|c: char| !(c == '.' || c.is_ascii_digit())).unwrap_or(behind.len());
        return Err(ParseError::new(ErrorKind::Number { text: text[at..end].into() }, at..end, text));
    }
    let value: f64 = rest[..length].parse().unwrap_or(f64::INFINITY);
    if value.is_infinite() {
        let kind = ErrorKind::Overflow { text: rest[..length].into() };
        return Err(ParseError::new(kind, at..at + length, text));
    }
    let unit = behind.strip_prefix('i').filter(|rest| !rest.starts_with(in_name));
    match unit {
        Some(_) if imaginary => Ok((TokenKind::Imaginary(value), length + 1)),
        _ => Ok((TokenKind::Number(value), length)),
    }
}

/// Not `is_alphanumeric`, for which ² is a digit: x² shall be told to be x^2.
fn in_name(c: char) -> bool {
    c.is_alphabetic() || c.is_ascii_digit() || c == '_'
}

fn digits(text: &str) -> usize {
    text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len())
}

/// The length of `e-3` at the start of `text`; 0 where no digits follow, so that `2e` is two values side by side.
fn exponent(text: &str) -> usize {
    let Some(power) = text.strip_prefix(['e', 'E']) else { return 0 };
    let sign = usize::from(power.starts_with(['+', '-']));
    match digits(&power[sign..]) {
        0 => 0,
        count => 1 + sign + count,
    }
}

/// What people type for what is meant.
fn instead_of(found: char) -> Option<&'static str> {
    Some(match found {
        '−' | '–' | '—' => "write `-`",
        '×' | '·' | '∙' | '⋅' => "write `*`",
        '÷' | '∕' => "write `/`",
        '²' => "write `^2`",
        '³' => "write `^3`",
        '√' => "write `sqrt(…)`",
        '≤' => "write `<=`",
        '≠' => "write `!=`",
        '≥' => "write `>=`",
        '=' => "write `==` to compare",
        '&' => "write `&&`",
        '|' => "write `abs(…)` for an absolute value, `||` for or",
        '[' | ']' | '{' | '}' => "write `(` and `)`",
        '.' => "a number has digits beside its point",
        '%' => "write `mod(a,b)` for a remainder",
        ';' => "arguments are separated by `,`",
        '∞' => "infinity is no number of a formula",
        _ => return None,
    })
}
