//! The PLY reader: faces with any number of corners, in text or in binary of either byte order; one surface.
//!
//! Read are the properties `x`, `y`, `z` of the element `vertex`, of any type, and the list `vertex_indices` or
//! `vertex_index` of the element `face`; other properties and elements are passed over. The surface is called after
//! the file, and a material can be given to that name. The front is where a face's corners run counter-clockwise.
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
        let corners = found.corners(range).map_err(|problem| problem.at(mesh.place(*spot)))?;
        mesh.push_exported(&corners, *spot)?;
    }
    Ok(mesh.finished())
}

/// What is kept of a file.
#[derive(Default)]
struct Found {
    vertices: Vec<DVec3>,
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
        let axes = ["x", "y", "z"].map(|axis| element.position(|p| p.name == axis && p.length.is_none()));
        let [Some(x), Some(y), Some(z)] = axes else {
            let problem = "the vertices have no numbers `x`, `y` and `z`; export the mesh with its positions";
            return Err((Problem::Malformed(problem.to_owned()), Spot::Line(element.line)));
        };
        body.each(element, |instance, _| {
            let coordinate = |property| text::finite(instance.number(property));
            let point = DVec3::new(coordinate(x)?, coordinate(y)?, coordinate(z)?);
            self.vertices.push(point * metres);
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

    fn corners(&self, range: &Range<usize>) -> Result<Vec<DVec3>, Problem> {
        let corner = |&index: &f64| {
            // Beyond the end saturates, and a negative index or a fraction does not come back the same.
            let position = index as usize;
            let vertex = self.vertices.get(position).filter(|_| position as f64 == index);
            vertex.copied().ok_or_else(|| {
                Problem::Malformed(format!(
                    "vertex {index} does not exist: there are {} vertices, counted from 0",
                    self.vertices.len()
                ))
            })
        };
        self.indices[range.clone()].iter().map(corner).collect()
    }
}
