//! The STL reader: triangles, in text or in binary; each `solid` is a surface, and a name that a material can be given.
//!
//! A file is binary when its length is what the count in its header asks for, whatever it begins with: many programs
//! begin the header of a binary file with `solid`. A solid without a name, and a binary file, is called after the
//! file. The front is where the corners run counter-clockwise; the normal that stands beside them is only compared.

use super::error::{Error, Place, Problem, Spot};
use super::mesh::Mesh;
use super::text::{self, Statement};
use glam::DVec3;
use std::path::Path;

/// Header and count.
const HEAD: usize = 84;

/// Normal, three corners, two bytes that mean nothing.
const FACET: usize = 50;

/// The mesh of a file whose unit of length is so many `metres`; `named_at` is where the file's name stands.
pub(super) fn read(file: &Path, metres: f64, named_at: &Place) -> Result<Mesh, Error> {
    let bytes = text::bytes(file, named_at)?;
    let mesh = if is_binary(&bytes) { binary(file, &bytes, metres)? } else { ascii(file, bytes, metres)? };
    Ok(mesh.finished())
}

fn is_binary(bytes: &[u8]) -> bool {
    let begins_as_text =
        bytes.trim_ascii_start().get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    // Text has no NUL; a binary file has one in the padding of its header, and in most of its numbers.
    promised_length(bytes) == Some(bytes.len()) || !begins_as_text || bytes.contains(&0)
}

fn promised_length(bytes: &[u8]) -> Option<usize> {
    let count = u32::from_le_bytes(array(bytes.get(HEAD - 4..HEAD)?)?);
    usize::try_from(count).ok()?.checked_mul(FACET)?.checked_add(HEAD)
}

fn array<const N: usize>(bytes: &[u8]) -> Option<[u8; N]> {
    bytes.try_into().ok()
}

fn binary(file: &Path, bytes: &[u8], metres: f64) -> Result<Mesh, Error> {
    let promised = promised_length(bytes);
    if promised != Some(bytes.len()) {
        return Err(wrong_length(bytes.len(), promised).at(Place::file(file)));
    }
    let mut mesh = Mesh::new(file);
    mesh.begin(&text::stem(file));
    let mut normals = Normals::default();
    for (number, facet) in bytes[HEAD..].chunks_exact(FACET).enumerate() {
        let spot = Spot::Byte(HEAD + number * FACET);
        let [normal, corners @ ..] = vectors(facet);
        for value in corners.iter().flat_map(DVec3::to_array) {
            text::finite(value).map_err(|problem| problem.at(mesh.place(spot)))?;
        }
        normals.compare(normal, corners, spot);
        mesh.push_exported(&corners.map(|corner| corner * metres), &[], spot)?;
    }
    normals.tell(&mut mesh);
    Ok(mesh)
}

fn wrong_length(length: usize, promised: Option<usize>) -> Problem {
    Problem::Malformed(match promised {
        Some(promised) => format!(
            "a binary STL with the count in this header, {}, has {promised} bytes, this file has {length}; it was cut \
             off or is no STL file: export it again",
            (promised - HEAD) / FACET
        ),
        None => format!(
            "this is no STL file: it does not begin with `solid`, and its {length} bytes are less than the {HEAD} of \
             a binary header; export it again"
        ),
    })
}

/// Normal and corners of a binary facet.
fn vectors(facet: &[u8]) -> [DVec3; 4] {
    let number = |at: usize| {
        let bytes = facet.get(at..at + 4).and_then(array);
        bytes.map_or(f64::NAN, |bytes| f64::from(f32::from_le_bytes(bytes)))
    };
    std::array::from_fn(|k| DVec3::from_array(std::array::from_fn(|axis| number(12 * k + 4 * axis))))
}

/// How many normals contradict the corners beside them.
#[derive(Default)]
struct Normals {
    opposite: usize,
    first: Option<Spot>,
}

impl Normals {
    fn compare(&mut self, normal: DVec3, [a, b, c]: [DVec3; 3], spot: Spot) {
        // Exporters round normals; more than a right angle away is no rounding. Zero says nothing, nor does NaN.
        if normal.dot((b - a).cross(c - a)) < 0.0 {
            self.opposite += 1;
            self.first.get_or_insert(spot);
        }
    }

    fn tell(&self, mesh: &mut Mesh) {
        if let Some(first) = self.first {
            let message = format!(
                "{} facets have a normal opposite to the order of their corners, the first here; the corners decide \
                 what is the front",
                self.opposite
            );
            mesh.warn(mesh.place(first), message);
        }
    }
}

fn ascii(file: &Path, bytes: Vec<u8>, metres: f64) -> Result<Mesh, Error> {
    let text = text::decode(file, bytes)?;
    let mut reader = Reader {
        mesh: Mesh::new(file),
        metres,
        depth: Depth::File,
        facet: Facet::default(),
        normals: Normals::default(),
    };
    let mut last = 1;
    for statement in text::lines(&text) {
        last = statement.line;
        reader.take(&statement)?;
    }
    if !matches!(reader.depth, Depth::File) {
        let inside = reader.depth.name();
        let problem =
            Problem::Malformed(format!("the file ends inside a `{inside}`; it was cut off: export it again"));
        return Err(problem.at(reader.mesh.place(Spot::Line(last))));
    }
    let Reader { mut mesh, normals, .. } = reader;
    normals.tell(&mut mesh);
    Ok(mesh)
}

/// What the statement to come stands in.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Depth {
    File,
    Solid,
    Facet,
    Loop,
    /// Behind `endloop`.
    Closed,
}

impl Depth {
    fn name(self) -> &'static str {
        match self {
            Self::File => "file",
            Self::Solid => "solid",
            Self::Facet | Self::Closed => "facet",
            Self::Loop => "outer loop",
        }
    }

    fn expected(self) -> &'static str {
        match self {
            Self::File => "`solid`",
            Self::Solid => "`facet` or `endsolid`",
            Self::Facet => "`outer loop`",
            Self::Loop => "`vertex` or `endloop`",
            Self::Closed => "`endfacet`",
        }
    }
}

/// The facet that is being read.
#[derive(Default)]
struct Facet {
    normal: DVec3,
    corners: Vec<DVec3>,
    line: usize,
}

struct Reader {
    mesh: Mesh,
    metres: f64,
    depth: Depth,
    facet: Facet,
    normals: Normals,
}

impl Reader {
    fn take(&mut self, statement: &Statement<'_>) -> Result<(), Error> {
        let (keyword, rest) = statement.split();
        if keyword.is_empty() {
            return Ok(());
        }
        let spot = Spot::Line(statement.line);
        self.depth = match (self.depth, keyword.to_ascii_lowercase().as_str()) {
            (Depth::File, "solid") => {
                let name = if rest.is_empty() { text::stem(&self.mesh.file) } else { rest.to_owned() };
                self.mesh.begin(&name);
                Depth::Solid
            }
            (Depth::Solid, "endsolid") => Depth::File,
            (Depth::Solid, "facet") => {
                self.facet = Facet { normal: normal(rest), corners: Vec::new(), line: statement.line };
                Depth::Facet
            }
            (Depth::Facet, "outer") => Depth::Loop,
            (Depth::Loop, "vertex") => {
                self.facet.corners.push(vertex(rest).map_err(|problem| problem.at(self.mesh.place(spot)))?);
                Depth::Loop
            }
            (Depth::Loop, "endloop") => Depth::Closed,
            (Depth::Closed, "endfacet") => {
                self.close()?;
                Depth::Solid
            }
            (depth, _) => {
                let problem = format!("`{keyword}` stands where {} is expected", depth.expected());
                return Err(Problem::Malformed(problem).at(self.mesh.place(spot)));
            }
        };
        Ok(())
    }

    /// Takes the facet that is complete.
    fn close(&mut self) -> Result<(), Error> {
        let spot = Spot::Line(self.facet.line);
        let [a, b, c] = self.facet.corners[..] else {
            let count = self.facet.corners.len();
            let problem =
                format!("a facet has 3 `vertex` lines, this one has {count}; export the mesh again");
            return Err(Problem::Malformed(problem).at(self.mesh.place(spot)));
        };
        self.normals.compare(self.facet.normal, [a, b, c], spot);
        self.mesh.push_exported(&[a, b, c].map(|corner| corner * self.metres), &[], spot)
    }
}

/// The normal behind `facet`; zero where it is none, since it is only compared.
fn normal(rest: &str) -> DVec3 {
    let mut numbers = rest.split_whitespace().skip(1).map(|word| word.parse().unwrap_or(0.0));
    let mut next = || numbers.next().unwrap_or(0.0);
    DVec3::new(next(), next(), next())
}

fn vertex(rest: &str) -> Result<DVec3, Problem> {
    let words: Vec<_> = rest.split_whitespace().collect();
    match words[..] {
        [x, y, z] => Ok(DVec3::new(text::coordinate(x)?, text::coordinate(y)?, text::coordinate(z)?)),
        _ => Err(Problem::Malformed(format!(
            "`vertex {rest}` is not a vertex; expected three coordinates: `vertex 0 1.5 2`"
        ))),
    }
}
