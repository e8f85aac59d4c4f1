//! The header of a PLY file: which elements the body has, how many, and of which properties.

use super::Misplaced;
use crate::scene::error::{Problem, Spot, listed};

/// How the body is written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Format {
    Ascii,
    LittleEndian,
    BigEndian,
}

pub(super) struct Header {
    pub format: Format,
    pub elements: Vec<Element>,
    /// The bytes and the lines of the header.
    pub length: usize,
    pub lines: usize,
}

pub(super) struct Element {
    pub name: String,
    pub count: usize,
    pub properties: Vec<Property>,
    /// Where it is declared.
    pub line: usize,
}

/// A number of each instance of an element, or a list of them.
pub(super) struct Property {
    pub name: String,
    pub kind: Kind,
    /// For a list, of which kind its length is.
    pub length: Option<Kind>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Element {
    pub fn position(&self, which: impl Fn(&Property) -> bool) -> Option<usize> {
        self.properties.iter().position(which)
    }
}

impl Kind {
    fn named(name: &str) -> Result<Self, Problem> {
        Ok(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => {
                let known = ["char", "uchar", "short", "ushort", "int", "uint", "float", "double"];
                let known = listed(known.into_iter());
                return Err(Problem::Malformed(format!("numbers of the type `{name}` are unknown; {known}")));
            }
        })
    }
}

/// The header that a file begins with.
pub(super) fn read(bytes: &[u8]) -> Result<Header, Misplaced> {
    let (mut format, mut elements, mut length) = (None, Vec::new(), 0);
    for (line, number) in bytes.split_inclusive(|&byte| byte == b'\n').zip(1..) {
        length += line.len();
        // Only comments hold what is not ASCII.
        let text = String::from_utf8_lossy(line);
        let words: Vec<_> = text.split_whitespace().collect();
        let at = |problem| (problem, Spot::Line(number));
        match words[..] {
            ["ply"] if number == 1 => {}
            _ if number == 1 => {
                return Err(at(malformed("this is no PLY file: its first line is not `ply`")));
            }
            ["format", name, "1.0"] => format = Some(format_named(name).map_err(at)?),
            ["element", name, count] => elements.push(element(name, count, number).map_err(at)?),
            ["property", ref words @ ..] => add_property(&mut elements, words).map_err(at)?,
            [] | ["comment" | "obj_info", ..] => {}
            ["end_header"] => return end(format, elements, length, number).map_err(at),
            _ => return Err(at(unknown(text.trim()))),
        }
    }
    let lines = bytes.iter().filter(|&&byte| byte == b'\n').count();
    Err((
        malformed("the header has no end; expected `end_header`: export the mesh again"),
        Spot::Line(lines.max(1)),
    ))
}

fn malformed(message: &str) -> Problem {
    Problem::Malformed(message.to_owned())
}

/// A line of the header, short enough to be shown: in a file that is none it may be the whole file.
fn unknown(line: &str) -> Problem {
    let shown: String = line.chars().filter(|c| !c.is_control()).take(60).collect();
    Problem::Malformed(format!(
        "`{shown}` is no line of a PLY header; expected `format … 1.0`, `element NAME COUNT`, `property TYPE NAME`, \
         `property list TYPE TYPE NAME`, `comment` or `end_header`"
    ))
}

fn format_named(name: &str) -> Result<Format, Problem> {
    match name {
        "ascii" => Ok(Format::Ascii),
        "binary_little_endian" => Ok(Format::LittleEndian),
        "binary_big_endian" => Ok(Format::BigEndian),
        _ => Err(Problem::Malformed(format!(
            "the format `{name}` is unknown; there are `ascii`, `binary_little_endian` and `binary_big_endian`"
        ))),
    }
}

fn element(name: &str, count: &str, line: usize) -> Result<Element, Problem> {
    let count = count.parse().map_err(|_| {
        Problem::Malformed(format!(
            "`{count}` is not how many of `{name}` there are; expected a whole number"
        ))
    })?;
    Ok(Element { name: name.to_owned(), count, properties: Vec::new(), line })
}

fn add_property(elements: &mut [Element], words: &[&str]) -> Result<(), Problem> {
    let property = match *words {
        ["list", length, kind, name] => {
            let length = Kind::named(length)?;
            if matches!(length, Kind::F32 | Kind::F64) {
                return Err(malformed("the length of a list is a whole number; declare it `uchar` or `int`"));
            }
            Property { name: name.to_owned(), kind: Kind::named(kind)?, length: Some(length) }
        }
        [kind, name] => Property { name: name.to_owned(), kind: Kind::named(kind)?, length: None },
        _ => return Err(unknown(&format!("property {}", words.join(" ")))),
    };
    let element = elements.last_mut();
    let element =
        element.ok_or_else(|| malformed("a property stands before the first `element`; move it"))?;
    element.properties.push(property);
    Ok(())
}

fn end(
    format: Option<Format>,
    elements: Vec<Element>,
    length: usize,
    lines: usize,
) -> Result<Header, Problem> {
    let format = format.ok_or_else(|| malformed("the header names no format; write `format ascii 1.0`"))?;
    // Instances without a byte to them could be counted to any number.
    match elements.iter().find(|element| element.properties.is_empty() && element.count > 0) {
        Some(Element { name, .. }) => Err(Problem::Malformed(format!(
            "the element `{name}` has no properties; declare them, or remove it"
        ))),
        None => Ok(Header { format, elements, length, lines }),
    }
}
