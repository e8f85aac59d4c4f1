//! What is wrong with a formula, and where: an error that points at the character.

use std::fmt;
use std::ops::Range;
use thiserror::Error;

/// Why a text is no formula, with the place. Displayed, it shows the line and points:
///
/// ```
/// let error = expression::Formula::parse("sine(x)*y", &["x", "y"]).unwrap_err();
/// assert_eq!(
///     error.to_string(),
///     "unknown function `sine`; did you mean `sin`?\n  1 | sine(x)*y\n    | ^^^^"
/// );
/// assert_eq!(error.span(), 0..4);
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub struct ParseError(Box<Details>);

/// Behind a pointer, since a result is as large as its error.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Details {
    kind: ErrorKind,
    span: Range<usize>,
    excerpt: Excerpt,
}

/// What is wrong with a formula.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the fields are what the messages name")]
pub enum ErrorKind {
    /// Nothing but blanks.
    #[error("the formula is empty")]
    Empty,
    /// More bytes than a formula may have.
    #[error("the formula has {length} bytes, more than the {limit} that are read")]
    TooLong { length: usize, limit: usize },
    /// Parentheses, signs or powers nested too deep.
    #[error("nested deeper than {limit} levels")]
    TooDeep { limit: usize },
    /// A character that no formula has.
    #[error("unexpected character `{found}`{}", hint(.instead.as_deref()))]
    Character { found: char, instead: Option<String> },
    /// Digits that make no number.
    #[error("malformed number `{text}`")]
    Number { text: String },
    /// A number beyond the range of double precision.
    #[error("the number `{text}` is too large for double precision")]
    Overflow { text: String },
    /// A function that does not exist.
    #[error("unknown function `{name}`{}", did_you_mean(.nearest.as_deref()))]
    UnknownFunction { name: String, nearest: Option<String> },
    /// A name that is no variable, parameter or constant.
    #[error("unknown name `{name}`{}", names_known(.nearest.as_deref(), .known))]
    UnknownName { name: String, nearest: Option<String>, known: String },
    /// A parameter with the name of a variable.
    #[error("`{name}` is both a variable and a parameter; rename the parameter")]
    Ambiguous { name: String },
    /// A function without its parentheses.
    #[error("the function `{name}` needs its arguments in parentheses: `{signature}`")]
    NotCalled { name: String, signature: String },
    /// A variable or a number followed by a parenthesis.
    #[error("`{name}` is no function; to multiply, write `{name}*(`")]
    NotAFunction { name: String },
    /// The wrong number of arguments.
    #[error("`{signature}` takes {expected}, not {found}")]
    Arity { signature: String, expected: String, found: usize },
    /// An order for which a function is not defined here.
    #[error("the order of `{name}` is 0, 1, 2, …")]
    Order { name: String },
    /// Two values side by side.
    #[error("an operator is missing; to multiply, write `{left}*{right}`")]
    SideBySide { left: String, right: String },
    /// An operator, or the formula, without its operand.
    #[error("a value is missing before {found}")]
    MissingValue { found: String },
    /// A parenthesis without its partner.
    #[error("this parenthesis is never closed")]
    Unclosed,
    /// A closing parenthesis without its partner.
    #[error("this parenthesis was never opened")]
    Unopened,
    /// Something after the end of the formula, or in the place of an operator.
    #[error("unexpected {found}{}", hint(.instead.as_deref()))]
    Unexpected { found: String, instead: Option<String> },
    /// `a < b < c`.
    #[error("comparisons do not chain; write `a < b && b < c`")]
    ChainedComparison,
    /// A complex argument where only real ones have a meaning or a method.
    #[error("`{name}` takes real arguments, and this one may be complex; `real(…)` takes its real part")]
    NotReal { name: String },
}

fn hint(instead: Option<&str>) -> String {
    instead.map(|text| format!("; {text}")).unwrap_or_default()
}

fn did_you_mean(nearest: Option<&str>) -> String {
    nearest.map(|name| format!("; did you mean `{name}`?")).unwrap_or_default()
}

fn names_known(nearest: Option<&str>, known: &str) -> String {
    match nearest {
        Some(_) => did_you_mean(nearest),
        None => format!("; known are {known}"),
    }
}

impl ParseError {
    /// The error at `span`, a range of bytes of `text`.
    pub(crate) fn new(kind: ErrorKind, span: Range<usize>, text: &str) -> Self {
        let excerpt = Excerpt::new(text, &span);
        ParseError(Box::new(Details { kind, span, excerpt }))
    }

    /// What is wrong.
    pub fn kind(&self) -> &ErrorKind {
        &self.0.kind
    }

    /// Where: bytes of the formula's text.
    pub fn span(&self) -> Range<usize> {
        self.0.span.clone()
    }
}

impl fmt::Display for ParseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Excerpt { number, line, before, width } = &self.0.excerpt;
        let gutter = " ".repeat(number.to_string().len());
        writeln!(f, "{}", self.0.kind)?;
        writeln!(f, "  {number} | {line}")?;
        write!(f, "  {gutter} | {}{}", " ".repeat(*before), "^".repeat(*width))
    }
}

/// The line that an error points at, cut to what fits a terminal.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Excerpt {
    /// The number of the line, from 1.
    number: usize,
    line: String,
    /// Characters of `line` before those pointed at, and how many are pointed at.
    before: usize,
    width: usize,
}

/// Characters shown on either side of the place, when the line is longer.
const CONTEXT: usize = 40;

impl Excerpt {
    fn new(text: &str, span: &Range<usize>) -> Self {
        let start = text[..span.start].rfind('\n').map_or(0, |at| at + 1);
        let end = text[span.start..].find('\n').map_or(text.len(), |at| span.start + at);
        let before = text[start..span.start].chars().count();
        let width = text[span.start..span.end.clamp(span.start, end)].chars().count().clamp(1, CONTEXT);
        let skipped = if before > 2 * CONTEXT { before - CONTEXT } else { 0 };
        let shown = before - skipped + width + CONTEXT;
        let rest = || text[start..end].chars().skip(skipped);
        let line: String = rest().take(shown).map(|c| if c.is_control() { ' ' } else { c }).collect();
        let (left, right) =
            (if skipped > 0 { "…" } else { "" }, if rest().nth(shown).is_some() { "…" } else { "" });
        Excerpt {
            number: text[..start].matches('\n').count() + 1,
            line: format!("{left}{line}{right}"),
            before: before - skipped + left.chars().count(),
            width,
        }
    }
}
