//! The OBJ reader: faces with any number of corners, of groups and materials, each error with its line.
//!
//! Read are `v`, `vn`, `f` (`v`, `v/vt`, `v//vn`, `v/vt/vn`; negative indices count backwards), `o`, `g`, `usemtl`,
//! `mtllib`, comments and lines continued by `\`; the rest (`vt`, `s`, `l`, `p`, …) is passed over. A face is
//! one-sided: its front is where its corners run counter-clockwise, whatever its normals say.

use super::cut::cut;
use super::error::{Error, Place, Problem, Spot};
use super::mesh::{Group, MaterialName, Mesh};
use super::mtl;
use super::text::{self, Statement};
use glam::DVec3;
use std::collections::BTreeMap;
use std::path::Path;

/// The mesh of a file whose unit of length is so many `metres`; `named_at` is where the file's name stands.
pub(super) fn read(file: &Path, metres: f64, named_at: &Place) -> Result<Mesh, Error> {
    parse(file, &text::read(file, named_at)?, metres)
}

fn parse(file: &Path, text: &str, metres: f64) -> Result<Mesh, Error> {
    let (vertices, normals, current, known) = Default::default();
    let mut reader = Reader { file, metres, vertices, normals, current, known, mesh: Mesh::new(file) };
    text::statements(text).try_for_each(|statement| reader.take(&statement))?;
    Ok(reader.mesh.finished())
}

struct Reader<'a> {
    file: &'a Path,
    metres: f64,
    vertices: Vec<DVec3>,
    normals: Vec<DVec3>,
    current: State,
    /// The group of each name and material so far.
    known: BTreeMap<(Option<String>, Option<String>), usize>,
    mesh: Mesh,
}

/// What holds for the faces to come.
#[derive(Default)]
struct State {
    name: Option<String>,
    material: Option<MaterialName>,
    /// Their group, once one of them came.
    group: Option<usize>,
}

impl Reader<'_> {
    fn take(&mut self, statement: &Statement<'_>) -> Result<(), Error> {
        let place = || Place::line(self.file, statement.line);
        let at = |problem: Problem| problem.at(place());
        match statement.split() {
            ("v", rest) => self.vertices.push(vertex(rest).map_err(at)? * self.metres),
            ("vn", rest) => self.normals.push(normal(rest).map_err(at)?),
            ("f", rest) => {
                let corners = rest.split_whitespace().map(|word| self.corner(word));
                let corners = corners.collect::<Result<Vec<_>, _>>().map_err(at)?;
                let (corners, normals): (Vec<_>, Vec<_>) = corners.into_iter().unzip();
                let polygons = cut(&corners).map_err(at)?;
                let group = self.group();
                self.mesh.push(group, polygons, (&corners, &normals), Spot::Line(statement.line));
            }
            ("o" | "g", rest) => {
                let name = (!rest.is_empty()).then(|| rest.to_owned());
                self.current = State { name, material: self.current.material.take(), group: None };
            }
            ("usemtl", rest) => {
                let material = Some(MaterialName { name: rest.to_owned(), place: place() });
                self.current = State { name: self.current.name.take(), material, group: None };
            }
            ("mtllib", rest) => self.libraries(rest, &place())?,
            _ => {}
        }
        Ok(())
    }

    /// The vertex of a corner `v`, `v/vt`, `v//vn` or `v/vt/vn`, and its normal if there is one of that number.
    fn corner(&self, word: &str) -> Result<(DVec3, Option<DVec3>), Problem> {
        let mut numbers = word.split('/');
        let index = |number: &str| {
            number.parse::<i64>().map_err(|_| {
                Problem::Malformed(format!(
                    "`{word}` is not a corner of a face; expected the numbers of a vertex and perhaps of its texture and \
                     normal: `7`, `7/1`, `7//1` or `7/1/1`"
                ))
            })
        };
        let vertex = index(numbers.next().unwrap_or(word))?;
        let count = self.vertices.len();
        let position = numbered(&self.vertices, vertex).ok_or(Problem::Index { index: vertex, count })?;
        let normal = numbers.nth(1).filter(|number| !number.is_empty()).map(index).transpose()?;
        Ok((position, normal.and_then(|index| numbered(&self.normals, index))))
    }

    /// The number of the group that the next face belongs to.
    fn group(&mut self) -> usize {
        let State { name, material, group } = &mut self.current;
        let groups = &mut self.mesh.groups;
        *group.get_or_insert_with(|| {
            let key = (name.clone(), material.as_ref().map(|material| material.name.clone()));
            *self.known.entry(key).or_insert_with(|| {
                groups.push(Group::new(name.clone(), material.clone()));
                groups.len() - 1
            })
        })
    }

    /// One file whose name may hold spaces, as most programs write it, or several, as the format has it.
    fn libraries(&mut self, names: &str, place: &Place) -> Result<(), Error> {
        let beside = |name: &str| self.file.with_file_name(name);
        let files = if beside(names).exists() {
            vec![beside(names)]
        } else {
            names.split_whitespace().map(beside).collect()
        };
        files.iter().try_for_each(|file| mtl::read(file, place, &mut self.mesh.materials))
    }
}

/// `x y z`; a weight or a colour behind them is passed over.
fn vertex(rest: &str) -> Result<DVec3, Problem> {
    let mut words = rest.split_whitespace();
    let mut coordinate = || match words.next().map(text::coordinate) {
        Some(coordinate) => coordinate,
        None => Err(Problem::Malformed(format!(
            "`v {rest}` is not a vertex; expected three coordinates: `v 0 1.5 2`"
        ))),
    };
    Ok(DVec3::new(coordinate()?, coordinate()?, coordinate()?))
}

/// `x y z`, of any length; what has no direction is told of the faces that it is used for.
fn normal(rest: &str) -> Result<DVec3, Problem> {
    let words: Vec<_> = rest.split_whitespace().collect();
    match words[..] {
        [x, y, z] => Ok(DVec3::new(text::number(x)?, text::number(y)?, text::number(z)?)),
        _ => Err(Problem::Malformed(format!(
            "`vn {rest}` is not a normal; expected three numbers: `vn 0 0 1`"
        ))),
    }
}

/// What an index names, counted from 1, or backwards from −1.
fn numbered(list: &[DVec3], index: i64) -> Option<DVec3> {
    let number = usize::try_from(index.unsigned_abs()).ok()?;
    let position = if index < 0 { list.len().checked_sub(number)? } else { number.checked_sub(1)? };
    list.get(position).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh(text: &str, metres: f64) -> Mesh {
        parse(Path::new("none.obj"), text, metres).unwrap()
    }

    const SQUARE: &str = "v 0 0 0 1\nv 1 0 0\nv 1 1 0 .5 .5 .5\nv 0 1 0\n";

    #[test]
    fn corners_are_written_in_many_ways() {
        let ways =
            ["1 2 3 4", "1/9 2/9 3/9 4/9", "1//9 2//9 3//9 4//9", "1/9/9 2/9/9 3/9/9 4/9/9", "-4 -3 -2 -1"];
        for corners in ways {
            let mesh = mesh(&format!("{SQUARE}vn 0 0 1\nvt 0 0\ns off\nf {corners}\nv 9 9 9\n"), 1.0);
            assert_eq!(
                mesh.groups[0].polygons[0].vertices(),
                [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y]
            );
            assert_eq!(mesh.groups[0].polygons[0].normal(), DVec3::Z, "front is counter-clockwise");
        }
    }

    #[test]
    fn lengths_are_multiplied_by_the_unit() {
        let mesh = mesh(&format!("{SQUARE}f 1 2 3 4"), 1e-3);
        assert!((mesh.groups[0].polygons[0].area() - 1e-6).abs() < 1e-18);
    }

    #[test]
    fn faces_of_one_name_and_material_come_together() {
        let faces =
            "usemtl a\nf 1 2 3\no box\nf 1 2 3\nusemtl b\nf 1 2 3\nusemtl a\nf 1 2 3\no lid\no box\nf 1 2 3";
        let mesh = mesh(&format!("{SQUARE}{faces}"), 1.0);
        let groups: Vec<_> = mesh
            .groups
            .iter()
            .map(|group| {
                (
                    group.name.as_deref(),
                    group.material.as_ref().map(|m| m.name.as_str()),
                    group.polygons.len(),
                )
            })
            .collect();
        assert_eq!(groups, [(None, Some("a"), 1), (Some("box"), Some("a"), 3), (Some("box"), Some("b"), 1)]);
    }
}
