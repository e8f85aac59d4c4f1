//! A solved field as B at the vertices of triangles, between which it is linear: faces are cut where it is not.
//!
//! The mesh begins with the cells of the field's. Of each cell the light at points between its nodes is held against what is
//! linear there; cells with most of the error are cut in four until the rest is small enough. Where a cell has smaller neighbours it
//! takes their corners, so that no cracks open. Under what stands on a face it is dark: corners there take what the others of
//! their cell have, or each foot would have a dark rim as wide as a cell.

use super::cells::{Cell, Sites};
use crate::polygon::Polygon;
use crate::reconstruct::Lit;
use crate::scene::Scene;
use fredholm::value::Value;
use glam::DVec3;
use std::collections::HashMap;

/// The triangles of a surface, with light at their corners.
#[derive(Clone, Debug)]
pub struct Vertices<V> {
    /// Where they are, in metres.
    pub points: Vec<DVec3>,
    /// The unit normals, of the curved surface where a face stands for one.
    pub normals: Vec<DVec3>,
    /// The radiosity B, in W/m² or lm/m².
    pub radiosity: Vec<V>,
    /// Three vertices each, counter-clockwise seen from the front.
    pub triangles: Vec<[u32; 3]>,
}

impl<V> Default for Vertices<V> {
    fn default() -> Self {
        Self { points: Vec::new(), normals: Vec::new(), radiosity: Vec::new(), triangles: Vec::new() }
    }
}

/// Light at the vertices of a scene.
#[derive(Clone, Debug)]
pub struct VertexLight<V> {
    /// The triangles of each surface.
    pub surfaces: Vec<Vertices<V>>,
    /// How far what is linear between vertices is from the field: in the mean square over all surfaces, relative to the mean
    /// square of the light that they reflect.
    pub error: f64,
}

/// Cells after which no more are cut: some 12 MB of binary glTF.
const MOST: usize = 60_000;

/// So many points does [`VertexLight::new`] look at, at most and about.
pub const MOST_LOOKS: usize = 4 * MOST;

/// Cells are cut that have this part of the error: fewer are more rounds, more are finer than needed.
const BULK: f64 = 0.8;

impl<V: Value> VertexLight<V> {
    /// Cuts the faces until what is linear between vertices is within `accuracy` of the field. `polygons` are those of the
    /// scene and of the field; `progress` is told how many cells there are, and the error.
    pub fn new(
        scene: &Scene<V>,
        field: &dyn Lit<V>,
        polygons: &[Polygon],
        accuracy: f64,
        progress: &dyn Fn(usize, f64),
    ) -> Self {
        let scale = field.scale();
        let mut sites = Sites::new(field, polygons);
        let parts = field.cells().into_iter();
        let mut cells: Vec<Cell> = parts.map(|(face, part)| Cell::new(face, part, &mut sites)).collect();
        let area: f64 = polygons.iter().map(Polygon::area).sum();
        loop {
            sites.look();
            cells.iter_mut().for_each(|cell| cell.judge(&sites));
            let square: f64 = cells.iter().map(|cell| cell.square).sum();
            let error = if scale > 0.0 { (square / area).sqrt() / scale } else { 0.0 };
            progress(cells.len(), error);
            let cut = worst(&cells, BULK * square);
            if error <= accuracy || cells.len() + 3 * cut.iter().filter(|cut| **cut).count() > MOST {
                return Self { surfaces: triangles(scene, polygons, &cells, &mut sites), error };
            }
            let each = cells.into_iter().zip(cut);
            cells =
                each.flat_map(|(cell, cut)| if cut { cell.cut(&mut sites) } else { vec![cell] }).collect();
        }
    }

    /// How many vertices there are, and how many triangles.
    pub fn size(&self) -> [usize; 2] {
        let sum = |of: fn(&Vertices<V>) -> usize| self.surfaces.iter().map(of).sum();
        [sum(|surface| surface.points.len()), sum(|surface| surface.triangles.len())]
    }
}

/// Which cells have the largest errors, together so much.
fn worst(cells: &[Cell], bulk: f64) -> Vec<bool> {
    let mut order: Vec<usize> = (0..cells.len()).collect();
    order.sort_by(|&a, &b| cells[b].square.total_cmp(&cells[a].square).then(a.cmp(&b)));
    let mut cut = vec![false; cells.len()];
    let mut sum = 0.0;
    for k in order.into_iter().take_while(|&k| cells[k].square > 0.0) {
        if sum >= bulk {
            break;
        }
        sum += cells[k].square;
        cut[k] = true;
    }
    cut
}

/// The triangles of each surface.
fn triangles<V: Value>(
    scene: &Scene<V>,
    polygons: &[Polygon],
    cells: &[Cell],
    sites: &mut Sites<'_, V>,
) -> Vec<Vertices<V>> {
    let corners = sites.places(cells.iter().flat_map(|cell| cell.polygon.vertices()));
    let rims: Vec<Vec<u32>> = cells.iter().map(|cell| cell.rim(sites, &corners)).collect();
    sites.look();
    let surface_of: Vec<usize> = scene
        .surfaces
        .iter()
        .enumerate()
        .flat_map(|(s, surface)| surface.polygons.iter().map(move |_| s))
        .collect();
    let mut surfaces: Vec<Vertices<V>> = scene.surfaces.iter().map(|_| Vertices::default()).collect();
    let mut known = HashMap::new();
    for (cell, rim) in cells.iter().zip(&rims) {
        let surface = &mut surfaces[surface_of[cell.face as usize]];
        let face = &polygons[cell.face as usize];
        let dark = cell.of_sight(sites);
        let mut vertex = |site: u32| match sites.light(site) {
            Some(light) => *known.entry(site).or_insert_with(|| surface.add(face, sites.point(site), light)),
            None => surface.add(face, sites.point(site), dark),
        };
        let rim: Vec<u32> = rim.iter().map(|&site| vertex(site)).collect();
        let around = (rim.len() > 3).then(|| vertex(cell.middle()));
        match around {
            None => surface.triangles.push([rim[0], rim[1], rim[2]]),
            Some(middle) => {
                let next = |k: usize| rim[(k + 1) % rim.len()];
                surface.triangles.extend((0..rim.len()).map(|k| [rim[k], next(k), middle]));
            }
        }
    }
    surfaces
}

impl<V: Value> Vertices<V> {
    /// Adds a vertex of a face, and says its number.
    pub(super) fn add(&mut self, face: &Polygon, point: DVec3, radiosity: V) -> u32 {
        self.points.push(point);
        self.normals.push(face.on_curve(point).1);
        self.radiosity.push(radiosity);
        self.points.len() as u32 - 1
    }
}
