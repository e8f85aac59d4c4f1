//! The body of a PLY file, an instance of an element at a time.

use super::Misplaced;
use super::header::{Element, Format, Header, Kind};
use crate::scene::error::{Problem, Spot};
use crate::scene::text;
use std::ops::Range;

/// The numbers of one instance, property by property.
#[derive(Default)]
pub(super) struct Instance {
    values: Vec<f64>,
    ranges: Vec<Range<usize>>,
}

impl Instance {
    /// The numbers of a list.
    pub fn list(&self, property: usize) -> impl Iterator<Item = f64> {
        let range = self.ranges.get(property).cloned().unwrap_or_default();
        self.values[range].iter().copied()
    }

    pub fn number(&self, property: usize) -> f64 {
        self.list(property).next().unwrap_or(f64::NAN)
    }
}

pub(super) struct Body<'a> {
    bytes: &'a [u8],
    format: Format,
    /// How far it has been read: the byte, and in text the line that ends there.
    at: usize,
    line: usize,
}

impl<'a> Body<'a> {
    pub fn new(bytes: &'a [u8], header: &Header) -> Self {
        Self { bytes, format: header.format, at: header.length, line: header.lines }
    }

    /// Hands on every instance of an element, with its place.
    pub fn each(
        &mut self,
        element: &Element,
        mut take: impl FnMut(&Instance, Spot) -> Result<(), Problem>,
    ) -> Result<(), Misplaced> {
        let mut instance = Instance::default();
        for number in 0..element.count {
            let spot = self.next(element, &mut instance).map_err(|(problem, spot)| match problem {
                Some(problem) => (problem, spot),
                None => (cut_off(element, number), spot),
            })?;
            take(&instance, spot).map_err(|problem| (problem, spot))?;
        }
        Ok(())
    }

    /// What lies behind all elements, if anything.
    pub fn rest(&mut self) -> Option<Spot> {
        if self.format == Format::Ascii {
            return self.next_line().map(|_| Spot::Line(self.line));
        }
        (self.at < self.bytes.len()).then_some(Spot::Byte(self.at))
    }

    /// Reads an instance; the problem is `None` where the file ends.
    fn next(&mut self, element: &Element, instance: &mut Instance) -> Result<Spot, (Option<Problem>, Spot)> {
        instance.values.clear();
        instance.ranges.clear();
        if self.format == Format::Ascii {
            let line = self.next_line();
            let spot = Spot::Line(self.line);
            let line = line.ok_or((None, spot))?;
            words(line, element, instance).map_err(|problem| (Some(problem), spot))?;
            Ok(spot)
        } else {
            let spot = Spot::Byte(self.at);
            self.numbers(element, instance).map_err(|problem| (problem, spot))?;
            Ok(spot)
        }
    }

    /// The next line that is not blank.
    fn next_line(&mut self) -> Option<&'a [u8]> {
        while self.at < self.bytes.len() {
            let rest = &self.bytes[self.at..];
            let length = rest.iter().position(|&byte| byte == b'\n').unwrap_or(rest.len());
            self.at += (length + 1).min(rest.len());
            self.line += 1;
            let line = rest[..length].trim_ascii();
            if !line.is_empty() {
                return Some(line);
            }
        }
        None
    }

    fn numbers(&mut self, element: &Element, instance: &mut Instance) -> Result<(), Option<Problem>> {
        for property in &element.properties {
            let length = match property.length {
                Some(kind) => list_length(self.number(kind).ok_or(None)?)?,
                None => 1,
            };
            let first = instance.values.len();
            for _ in 0..length {
                instance.values.push(self.number(property.kind).ok_or(None)?);
            }
            instance.ranges.push(first..instance.values.len());
        }
        Ok(())
    }

    fn number(&mut self, kind: Kind) -> Option<f64> {
        Some(match kind {
            Kind::I8 => i8::from_le_bytes(self.word()?).into(),
            Kind::U8 => u8::from_le_bytes(self.word()?).into(),
            Kind::I16 => i16::from_le_bytes(self.word()?).into(),
            Kind::U16 => u16::from_le_bytes(self.word()?).into(),
            Kind::I32 => i32::from_le_bytes(self.word()?).into(),
            Kind::U32 => u32::from_le_bytes(self.word()?).into(),
            Kind::F32 => f32::from_le_bytes(self.word()?).into(),
            Kind::F64 => f64::from_le_bytes(self.word()?),
        })
    }

    /// The next bytes, in the order of a little-endian file.
    fn word<const N: usize>(&mut self) -> Option<[u8; N]> {
        let mut word: [u8; N] = self.bytes.get(self.at..self.at.checked_add(N)?)?.try_into().ok()?;
        self.at += N;
        if self.format == Format::BigEndian {
            word.reverse();
        }
        Some(word)
    }
}

fn cut_off(element: &Element, number: usize) -> Problem {
    Problem::Malformed(format!(
        "the file ends here, in the element `{}` number {} of {}; it was cut off: export it again",
        element.name,
        number + 1,
        element.count
    ))
}

fn list_length(value: f64) -> Result<usize, Problem> {
    if value < 0.0 || value.fract() != 0.0 {
        return Err(Problem::Malformed(format!("{value} is no length of a list; export the mesh again")));
    }
    Ok(value as usize)
}

/// Reads an instance from a line of text.
fn words(line: &[u8], element: &Element, instance: &mut Instance) -> Result<(), Problem> {
    let line = std::str::from_utf8(line).map_err(|_| Problem::NotUtf8)?;
    let mut words = line.split_ascii_whitespace();
    let mut next = |what: &str| match words.next() {
        Some(word) => text::number(word),
        None => Err(Problem::Malformed(format!(
            "the line of a `{}` ends before its {what}; export the mesh again",
            element.name
        ))),
    };
    for property in &element.properties {
        let length = match property.length {
            Some(_) => list_length(next(&property.name)?)?,
            None => 1,
        };
        let first = instance.values.len();
        for _ in 0..length {
            instance.values.push(next(&property.name)?);
        }
        instance.ranges.push(first..instance.values.len());
    }
    match words.next() {
        Some(word) => Err(Problem::Malformed(format!(
            "`{word}` follows the last number of a `{}`; the header does not speak of it",
            element.name
        ))),
        None => Ok(()),
    }
}
