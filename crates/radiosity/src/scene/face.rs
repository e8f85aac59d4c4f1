//! A face is what a file calls one: Σ areas of its polygons = its area.

use super::error::{Error, Place, Problem};
use super::{Loaded, Scene};
use std::ops::Range;

/// A face of a file, and the polygons that it was cut in.
///
/// A convex triangle or quadrilateral is one polygon, all else is several; so view factors *by face* are sums over
/// [`Self::polygons`], and *by group* sums over the faces of one [`Self::surface`]. What a View3D file says beyond
/// that stands here as well, and [`Loaded::rows`] applies it.
#[derive(Clone, Debug, PartialEq)]
pub struct Face {
    /// The surface's name; where that has several faces, with the face's number in it: `floor#3`.
    pub name: String,
    /// Which of [`Scene::surfaces`] it is of.
    pub surface: usize,
    /// Its polygons, by their numbers in [`Scene::polygons`].
    pub polygons: Range<usize>,
    /// Where it stands; `None` for a scene that no file was read for.
    pub place: Option<Place>,
    /// Whether it only blocks: such a face is an occluder, and no row of a matrix unless it masks another.
    pub is_obstruction: bool,
    /// The face, by its number, part of which it lies upon, front to front: it sees nothing else, and nothing else sees that
    /// part.
    pub masks: Option<usize>,
    /// The face, by its number, that this one makes one row with.
    pub combined_with: Option<usize>,
}

impl Face {
    /// The name and, in parentheses, the place.
    pub(super) fn label(&self) -> String {
        match &self.place {
            Some(place) => format!("`{}` ({place})", self.name),
            None => format!("`{}`", self.name),
        }
    }

    /// The faces of a scene that was built by hand: each polygon is one.
    pub fn of_polygons<V>(scene: &Scene<V>) -> Vec<Self> {
        let in_order = scene.surfaces.iter().enumerate().flat_map(|(index, surface)| {
            let count = surface.polygons.len();
            (0..count).map(move |number| (index, numbered(&surface.name, number, count)))
        });
        let face = |(polygon, (surface, name))| Self {
            name,
            surface,
            polygons: polygon..polygon + 1,
            place: None,
            is_obstruction: false,
            masks: None,
            combined_with: None,
        };
        in_order.enumerate().map(face).collect()
    }
}

/// What is said of a masking surface where light or heat is asked for.
pub(super) fn masking_message(name: &str) -> String {
    format!(
        "`{name}` is a masking surface (`M`): it has view factors, but no place in space, since it lies upon its base; leave \
         it out, or make it a null surface (`N`)"
    )
}

/// The name of the face `number`, from 0, of a surface with `count` faces.
pub(super) fn numbered(surface: &str, number: usize, count: usize) -> String {
    if count == 1 { surface.to_owned() } else { format!("{surface}#{}", number + 1) }
}

impl Loaded {
    /// That no face masks another: in space two faces in one place are none.
    pub(super) fn check_masks(&self) -> Result<(), Error> {
        let masking = self.faces.iter().find(|face| face.masks.is_some());
        let Some(Face { name, place: Some(place), .. }) = masking else { return Ok(()) };
        Err(Problem::Malformed(masking_message(name)).at(place.clone()))
    }

    /// The faces that make up each row of a matrix of view factors by face, by their numbers: obstructions are left
    /// out, and faces that the file combines come together, under the name of the first.
    pub fn rows(&self) -> Vec<Vec<usize>> {
        let mut row_of = vec![None; self.faces.len()];
        let mut rows: Vec<Vec<usize>> = Vec::new();
        let radiates =
            |&index: &usize| !self.faces[index].is_obstruction || self.faces[index].masks.is_some();
        for index in (0..self.faces.len()).filter(radiates) {
            let head = self.faces[index].combined_with.unwrap_or(index);
            let row = *row_of[head].get_or_insert_with(|| {
                rows.push(Vec::new());
                rows.len() - 1
            });
            rows[row].push(index);
        }
        rows
    }
}
