//! The PLY reader: faces with any number of corners, in text or in binary of either byte order; one surface.
//!
//! Read are the properties `x`, `y`, `z` of the element `vertex`, of any type, with its normal `nx`, `ny`, `nz` if it has
//! one, and the list `vertex_indices` or `vertex_index` of the element `face`; other properties and elements are passed
//! over. The surface is called after the file, and a material can be given to that name. The front is where a face's
//! corners run counter-clockwise.
//!
//! Nothing is allocated because a header counts it: what is kept has been read.

mod body;
mod header;

use super::error::{Error, Place, Problem, Spot};
use super::mesh::Mesh;
use super::text;
use body::Body;
use glam::DVec3;
use header::Element;
use std::ops::Range;
use std::path::Path;

/// A problem, and where in the file it lies.
type Misplaced = (Problem, Spot);

/// The mesh of a file whose unit of length is so many `metres`; `named_at` is where the file's name stands.
pub(super) fn read(file: &Path, metres: f64, named_at: &Place) -> Result<Mesh, Error> {
    let bytes = text::bytes(file, named_at)?;
    let mut mesh = Mesh::new(file);
    let found = find(&bytes, metres).map_err(|(problem, spot)| problem.at(mesh.place(spot)))?;
    if let Some(spot) = found.rest {
        mesh.warn(mesh.place(spot), "what follows the last element of the header is passed over".to_owned());
    }
    mesh.begin(&text::stem(file));
    for (range, spot) in &found.faces {
        let at = |problem: Problem| problem.at(mesh.place(*spot));
        let positions = found.indices[range.clone()].iter().map(|index| found.position(*index));
        let positions = positions.collect::<Result<Vec<_>, _>>().map_err(at)?;
        let corners: Vec<DVec3> = positions.iter().map(|&k| found.vertices[k]).collect();
        let normals: Vec<Option<DVec3>> = positions.iter().map(|&k| found.normals.get(k).copied()).collect();
        mesh.push_exported(&corners, &normals, *spot)?;
    }
    Ok(mesh.finished())
}

/// What is kept of a file.
#[derive(Default)]
struct Found {
    vertices: Vec<DVec3>,
    /// Of each vertex, or none.
    normals: Vec<DVec3>,
    /// The vertices of all faces, face by face.
    indices: Vec<f64>,
    faces: Vec<(Range<usize>, Spot)>,
    /// Where something stands that the header does not speak of.
    rest: Option<Spot>,
}

fn find(bytes: &[u8], metres: f64) -> Result<Found, Misplaced> {
    let header = header::read(bytes)?;
    let mut body = Body::new(bytes, &header);
    let mut found = Found::default();
    for element in &header.elements {
        match element.name.as_str() {
            "vertex" => found.take_vertices(element, &mut body, metres)?,
            "face" => found.take_faces(element, &mut body)?,
            _ => body.each(element, |_, _| Ok(()))?,
        }
    }
    found.rest = body.rest();
    Ok(found)
}

impl Found {
    fn take_vertices(
        &mut self,
        element: &Element,
        body: &mut Body<'_>,
        metres: f64,
    ) -> Result<(), Misplaced> {
        let numbers = |names: [&str; 3]| {
            let [x, y, z] = names.map(|name| element.position(|p| p.name == name && p.length.is_none()));
            Some([x?, y?, z?])
        };
        let Some(position) = numbers(["x", "y", "z"]) else {
            let problem = "the vertices have no numbers `x`, `y` and `z`; export the mesh with its positions";
            return Err((Problem::Malformed(problem.to_owned()), Spot::Line(element.line)));
        };
        let normal = numbers(["nx", "ny", "nz"]);
        body.each(element, |instance, _| {
            let point = DVec3::from(position.map(|property| instance.number(property)));
            point.to_array().into_iter().try_for_each(|c| text::finite(c).map(|_| ()))?;
            self.vertices.push(point * metres);
            self.normals
                .extend(normal.map(|axes| DVec3::from(axes.map(|property| instance.number(property)))));
            Ok(())
        })
    }

    fn take_faces(&mut self, element: &Element, body: &mut Body<'_>) -> Result<(), Misplaced> {
        let is_corners = |name: &str| name == "vertex_indices" || name == "vertex_index";
        let Some(list) = element.position(|p| is_corners(&p.name) && p.length.is_some()) else {
            let problem = "the faces have no list `vertex_indices`; export the mesh with its faces";
            return Err((Problem::Malformed(problem.to_owned()), Spot::Line(element.line)));
        };
        body.each(element, |instance, spot| {
            let first = self.indices.len();
            self.indices.extend(instance.list(list));
            self.faces.push((first..self.indices.len(), spot));
            Ok(())
        })
    }

    /// The vertex of an index as a position in the list of all.
    fn position(&self, index: f64) -> Result<usize, Problem> {
        // Beyond the end saturates, and a negative index or a fraction does not come back the same.
        let position = index as usize;
        if position as f64 == index && position < self.vertices.len() {
            return Ok(position);
        }
        Err(Problem::Malformed(format!(
            "vertex {index} does not exist: there are {} vertices, counted from 0",
            self.vertices.len()
        )))
    }
}
