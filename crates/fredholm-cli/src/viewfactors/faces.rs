//! What a row of the matrix is: a face of the file, of one polygon or several.

use fredholm::value::{Rgb, Value};
use radiosity::polygon::Polygon;
use radiosity::scene::{Loaded, Scene};

/// A row, and so a column, of the matrix.
#[derive(Clone, Debug, PartialEq)]
pub struct Face {
    /// What it is called.
    pub name: String,
    /// Its polygons, by their numbers in the scene.
    pub polygons: Vec<usize>,
    /// Its surface, by its number in the scene: the group.
    pub surface: usize,
    /// The row that it masks: it lies upon a part of that, sees all of its light there, and nothing else.
    pub masks: Option<usize>,
}

/// The faces of a scene, in its order: without those that only block, and with those in one that the file combines.
pub fn faces(loaded: &Loaded) -> Vec<Face> {
    let rows = loaded.rows();
    let face = |row: &Vec<usize>| {
        let first = &loaded.faces[row[0]];
        let polygons = row.iter().flat_map(|&index| loaded.faces[index].polygons.clone()).collect();
        let masks = first.masks.and_then(|base| rows.iter().position(|row| row.contains(&base)));
        Face { name: first.name.clone(), polygons, surface: first.surface, masks }
    };
    rows.iter().map(face).collect()
}

/// The area of each face, in m², with what is masked of it.
pub fn areas(faces: &[Face], polygons: &[Polygon]) -> Vec<f64> {
    let mut areas: Vec<f64> = faces.iter().map(|face| face.own_area(polygons)).collect();
    for face in faces {
        if let Some(base) = face.masks {
            areas[base] += face.own_area(polygons);
        }
    }
    areas
}

impl Face {
    /// The area of its polygons, in m².
    pub fn own_area(&self, polygons: &[Polygon]) -> f64 {
        self.polygons.iter().map(|&k| polygons[k].area()).sum()
    }

    /// The polygons that see others.
    pub fn in_sight(&self) -> Vec<usize> {
        if self.masks.is_some() { Vec::new() } else { self.polygons.clone() }
    }
}

/// The groups of a scene that have faces: which of them each face is in, and the surface that each is.
pub fn groups(faces: &[Face], scene: &Scene<Rgb>) -> (Vec<usize>, Vec<usize>) {
    let mut surfaces: Vec<usize> = faces.iter().map(|face| face.surface).collect();
    surfaces.sort_unstable();
    surfaces.dedup();
    let mut number = vec![0; scene.surfaces.len()];
    for (group, &surface) in surfaces.iter().enumerate() {
        number[surface] = group;
    }
    (faces.iter().map(|face| number[face.surface]).collect(), surfaces)
}

/// The emittance of a surface, 1 − ρ, as a grey one has it.
pub fn emittance(scene: &Scene<Rgb>, surface: usize) -> f64 {
    let channels = scene.surfaces[surface].reflectance.channels().iter();
    1.0 - channels.sum::<f64>() / 3.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_are_numbered_without_gaps() {
        let scene = radiosity::scene::cornell_box();
        let face = |surface| Face { name: String::new(), polygons: vec![], surface, masks: None };
        let (group_of, surfaces) = groups(&[face(5), face(1), face(5), face(0)], &scene);
        assert_eq!((group_of, surfaces), (vec![2, 1, 2, 0], vec![0, 1, 5]));
    }
}
