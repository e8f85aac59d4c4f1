//! The reader of View3D's input (`.vs3`): vertices and surfaces, in metres; each surface is a face with its own name.
//!
//! Read are the title `T`, the control line `C` (see [`Control`]), the geometries `F 3` and `F 3a`, vertices `V` under
//! any numbers and in any place, surfaces `S`, obstructions `O`, masking surfaces `M`, null surfaces `N`, comments and the end `E` or `*`.
//! Lengths have no unit in the format and are metres unless a scene file says otherwise.
//!
//! - A surface with emittance ε is grey, of reflectance 1 − ε, and a material can be given to its name.
//! - A *subsurface* (its `base` is not 0) is cut out of its base, so that no point belongs to two faces; a null surface
//!   as well, and then only blocks.
//! - A surface *combined* with another (`cmb`) makes one row with it: [`Face::combined_with`](super::Face).
//! - A masking surface lies upon a part of its base, front to front: the two see each other there and nothing else,
//!   [`Face::masks`](super::Face). The base keeps that part in its area. Only view factors know of it.
//! - An obstruction blocks and is black: [`Face::is_obstruction`](super::Face).

mod control;
mod entry;
mod hole;
mod link;

pub use control::Control;

use super::error::{Error, Place, Problem, Spot};
use super::mesh::Mesh;
use super::text;
use entry::{Entry, Kind, malformed, whole};
use glam::DVec3;
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::Path;

/// The vertices by number, in metres.
type Vertices = BTreeMap<i64, DVec3>;

/// The mesh of a file whose unit of length is so many `metres`; `named_at` is where the file's name stands.
pub(super) fn read(file: &Path, metres: f64, named_at: &Place) -> Result<Mesh, Error> {
    let text = text::read(file, named_at)?;
    let (is_in_planes, vertices, entries, control) = Default::default();
    let mesh = Mesh::new(file);
    let mut reader = Reader { mesh, metres, is_in_planes, vertices, entries, control };
    for (line, number) in text.lines().zip(1..) {
        let flow = reader.take(line, number);
        if flow.map_err(|problem| problem.at(reader.mesh.place(Spot::Line(number))))?.is_break() {
            break;
        }
    }
    reader.finished()
}

struct Reader {
    mesh: Mesh,
    metres: f64,
    /// Whether the geometry is `F 3a`.
    is_in_planes: bool,
    vertices: Vertices,
    entries: Vec<Entry>,
    control: Control,
}

impl Reader {
    /// Takes a line; breaks at the end of the data.
    fn take(&mut self, line: &str, number: usize) -> Result<ControlFlow<()>, Problem> {
        let data = line.split('!').next().unwrap_or_default();
        let words: Vec<_> =
            data.split(|c: char| c == ',' || c.is_whitespace()).filter(|word| !word.is_empty()).collect();
        let Some((&first, rest)) = words.split_first() else { return Ok(ControlFlow::Continue(())) };
        if self.take_numbers(&words)? {
            return Ok(ControlFlow::Continue(()));
        }
        // As to View3D the first letter alone counts: `End of data`.
        match first.chars().next().map(|letter| letter.to_ascii_uppercase()) {
            Some('/') => {}
            Some('*' | 'E') => return Ok(ControlFlow::Break(())),
            Some('T') => self.mesh.title = title(line),
            Some('C') => self.take_control(data, number)?,
            Some('F') => self.is_in_planes = is_in_planes(rest)?,
            Some('V') => self.take_vertex(rest)?,
            Some('S') => self.take_surface(Kind::Radiating, number, rest)?,
            Some('N') => self.take_surface(Kind::Null, number, rest)?,
            Some('O') => self.take_surface(Kind::Obstruction, number, rest)?,
            Some('M') => self.take_surface(Kind::Mask, number, rest)?,
            _ => {
                let place = self.mesh.place(Spot::Line(number));
                self.mesh.warn(place, format!("`{first}` begins no line that is known; it is passed over"));
            }
        }
        Ok(ControlFlow::Continue(()))
    }

    /// Whether the line has numbers that a surface waits for.
    fn take_numbers(&mut self, words: &[&str]) -> Result<bool, Problem> {
        let Some(entry) = self.entries.last_mut() else { return Ok(false) };
        let Some(all) = entry.missing() else { return Ok(false) };
        let begins_number = words[0].starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
        if !begins_number {
            let (number, first) = (entry.number, words[0]);
            return malformed(format!("`{first}` stands where surface {number} needs numbers, {all} in all"));
        }
        entry.add_numbers(words)?;
        Ok(true)
    }

    fn take_control(&mut self, data: &str, number: usize) -> Result<(), Problem> {
        let place = self.mesh.place(Spot::Line(number));
        self.control.line = Some(number);
        let words = data.trim_start().split_once(char::is_whitespace).map_or("", |(_, words)| words);
        let mesh = &mut self.mesh;
        self.control.take(words, |word| {
            mesh.warn(place.clone(), format!("the control word `{word}` is unknown; it is passed over"));
        })
    }

    fn take_vertex(&mut self, words: &[&str]) -> Result<(), Problem> {
        let [number, x, y, z] = words else {
            return malformed(format!("a vertex has {} numbers here; expected `V # x y z`", words.len()));
        };
        let (number, point) = (whole(number)?, [x, y, z].map(|word| text::coordinate(word)));
        let [x, y, z] = point;
        if number < 1 {
            return malformed(format!("a vertex is numbered {number}; numbers begin with 1"));
        }
        if self.vertices.insert(number, DVec3::new(x?, y?, z?) * self.metres).is_some() {
            return malformed(format!("there is a vertex {number} above; give this one another number"));
        }
        Ok(())
    }

    fn take_surface(&mut self, kind: Kind, line: usize, words: &[&str]) -> Result<(), Problem> {
        let read = if self.is_in_planes { Entry::in_plane } else { Entry::by_vertices };
        let entry = read(kind, line, words)?;
        if entry.number < 1 {
            return malformed(format!("a surface is numbered {}; numbers begin with 1", entry.number));
        }
        self.entries.push(entry);
        Ok(())
    }

    fn finished(mut self) -> Result<Mesh, Error> {
        if let Some(entry) = self.entries.last().filter(|entry| entry.missing().is_some()) {
            let problem = format!("the file ends before all numbers of surface {}", entry.number);
            return Err(Problem::Malformed(problem).at(self.mesh.place(Spot::Line(entry.line))));
        }
        self.entries.sort_by_key(|entry| entry.number);
        let radiates = |entry: &&Entry| matches!(entry.kind, Kind::Radiating | Kind::Mask);
        let radiating = self.entries.iter().filter(radiates).count();
        for (word, asked) in [("row", self.control.row), ("col", self.control.column)] {
            if let Some(asked) = asked.filter(|&asked| asked > radiating) {
                let problem =
                    format!("`{word}={asked}` asks for a surface that is not there: {radiating} radiate");
                let line = self.control.line.unwrap_or_default();
                return Err(Problem::Malformed(problem).at(self.mesh.place(Spot::Line(line))));
            }
        }
        link::link(&self.entries, &self.vertices, self.metres, &mut self.mesh)?;
        self.mesh.control = Some(self.control);
        Ok(self.mesh.finished())
    }
}

/// The rest of the line behind `T`.
fn title(line: &str) -> Option<String> {
    let (_, title) = line.trim().split_once(char::is_whitespace)?;
    Some(title.trim().to_owned())
}

fn is_in_planes(words: &[&str]) -> Result<bool, Problem> {
    let geometry = words.first().copied().unwrap_or_default();
    match geometry.to_ascii_lowercase().as_str() {
        "3" => Ok(false),
        "3a" => Ok(true),
        _ => malformed(format!(
            "the geometry `F {geometry}` is not read, only those in three dimensions, `F 3` and `F 3a`"
        )),
    }
}
