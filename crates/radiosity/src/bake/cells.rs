//! Parts of faces between whose nodes light is linear, and the points that they look at, each of which is looked at once.

use crate::polygon::Polygon;
use crate::reconstruct::Lit;
use fredholm::value::Value;
use glam::DVec3;
use rayon::prelude::*;
use std::collections::{HashMap, HashSet};

/// A part of a face, and the numbers of its sites: the nodes of a triangle are its corners, those of a quadrilateral its middle as
/// well; checks lie between them.
#[derive(Clone, Debug)]
pub(super) struct Cell {
    pub(super) face: u32,
    pub(super) polygon: Polygon,
    /// The corners, and the middle.
    nodes: Vec<u32>,
    /// The middles of the edges, and of a quadrilateral those of its quarters.
    checks: Vec<u32>,
    /// The integral of the square of what light is off its linear interpolant; NaN before it is judged.
    pub(super) square: f64,
}

impl Cell {
    pub(super) fn new<V: Value>(face: u32, polygon: Polygon, sites: &mut Sites<'_, V>) -> Self {
        let v = polygon.vertices();
        let edges = (0..v.len()).map(|k| v[k].midpoint(v[(k + 1) % v.len()]));
        let quarters = polygon.quarters().map(|quarter| middle(&quarter));
        let inner = if v.len() == 4 { &quarters[..] } else { &[] };
        let mut number = |point: DVec3| sites.number(face, point);
        let nodes = v.iter().copied().chain([middle(&polygon)]).map(&mut number).collect();
        let checks = edges.chain(inner.iter().copied()).map(&mut number).collect();
        Self { face, nodes, checks, polygon, square: f64::NAN }
    }

    /// The site in its middle.
    pub(super) fn middle(&self) -> u32 {
        self.nodes[self.nodes.len() - 1]
    }

    /// Its four parts.
    pub(super) fn cut<V: Value>(&self, sites: &mut Sites<'_, V>) -> Vec<Self> {
        self.polygon.quarters().map(|quarter| Self::new(self.face, quarter, sites)).into()
    }

    /// Holds the light at the checks against what is linear there.
    pub(super) fn judge<V: Value>(&mut self, sites: &Sites<'_, V>) {
        if !self.square.is_nan() {
            return;
        }
        let dark = self.of_sight(sites);
        let nodes: Vec<V> = self.nodes.iter().map(|&site| sites.light(site).unwrap_or(dark)).collect();
        let count = nodes.len() - 1;
        let (corners, middle) = (&nodes[..count], nodes[count]);
        let mut off: Vec<V> = Vec::new();
        for (k, &check) in self.checks.iter().enumerate() {
            let other = if k < count { corners[(k + 1) % count] } else { middle };
            let linear = (corners[k % count] + other) * 0.5;
            off.extend(sites.light(check).map(|light| light - linear));
        }
        if count == 3 {
            let linear = corners.iter().fold(V::splat(0.0), |sum, u| sum + *u * (1.0 / 3.0));
            off.extend(sites.light(self.middle()).map(|light| light - linear));
        }
        let squares = off.iter().flat_map(|off| off.channels()).map(|c| c * c).sum::<f64>();
        self.square = if off.is_empty() { 0.0 } else { self.polygon.area() * squares / off.len() as f64 };
    }

    /// The mean light of its nodes that nothing stands on.
    pub(super) fn of_sight<V: Value>(&self, sites: &Sites<'_, V>) -> V {
        let lit: Vec<V> = self.nodes.iter().filter_map(|&site| sites.light(site)).collect();
        let sum = lit.iter().fold(V::splat(0.0), |sum, light| sum + *light);
        sum * (1.0 / lit.len().max(1) as f64)
    }

    /// The sites around it: its corners, and on its edges those of smaller neighbours.
    pub(super) fn rim<V: Value>(&self, sites: &mut Sites<'_, V>, corners: &HashSet<Place>) -> Vec<u32> {
        let v = self.polygon.vertices();
        let mut points = Vec::new();
        for k in 0..v.len() {
            along(v[k], v[(k + 1) % v.len()], &mut points, &|point| corners.contains(&sites.place(point)));
        }
        points.into_iter().map(|point| sites.number(self.face, point)).collect()
    }
}

/// The points of an edge from a on, before b: a itself, and whatever corners there are halfway.
fn along(a: DVec3, b: DVec3, points: &mut Vec<DVec3>, is_corner: &impl Fn(DVec3) -> bool) {
    let middle = a.midpoint(b);
    if is_corner(middle) && middle != a && middle != b {
        along(a, middle, points, is_corner);
        along(middle, b, points, is_corner);
    } else {
        points.push(a);
    }
}

/// Of a quadrilateral where the middles of its edges meet, of a triangle the centre of mass.
fn middle(polygon: &Polygon) -> DVec3 {
    match *polygon.vertices() {
        [a, b, c, d] => a.midpoint(b).midpoint(c.midpoint(d)),
        _ => polygon.centroid(),
    }
}

/// A point, up to rounding.
pub(super) type Place = [i64; 3];

/// Points that are this near are one, as a part of the scene: far more than rounding, far less than a cell.
const NEAR: f64 = 1e-8;

/// Where between two places their border is: not where round numbers are.
const BORDER: f64 = 0.37;

/// How far inside a face points of its rim are moved, as a part of the way to its middle: faces meet at the rim.
const INSIDE: f64 = 1e-6;

/// Points that are looked at together: a thread's share must be neither a drop nor all.
const TOGETHER: usize = 64;

/// The points of faces, numbered, and the light there.
pub(super) struct Sites<'a, V> {
    field: &'a dyn Lit<V>,
    faces: &'a [Polygon],
    low: DVec3,
    unit: f64,
    numbers: HashMap<(u32, Place), u32>,
    points: Vec<(u32, DVec3)>,
    /// B of the points looked at so far; none under what stands on a face.
    light: Vec<Option<V>>,
}

impl<'a, V: Value> Sites<'a, V> {
    pub(super) fn new(field: &'a dyn Lit<V>, faces: &'a [Polygon]) -> Self {
        let vertices = || faces.iter().flat_map(Polygon::vertices);
        let low = vertices().fold(DVec3::INFINITY, |low, v| low.min(*v));
        let extent = vertices().fold(0.0, |extent, v| f64::max(extent, (*v - low).max_element()));
        let (numbers, points, light) = (HashMap::new(), Vec::new(), Vec::new());
        Self { field, faces, low, unit: NEAR * extent, numbers, points, light }
    }

    pub(super) fn place(&self, point: DVec3) -> Place {
        ((point - self.low) / self.unit).to_array().map(|c| (c + BORDER).floor() as i64)
    }

    /// The places of points.
    pub(super) fn places<'b>(&self, points: impl Iterator<Item = &'b DVec3>) -> HashSet<Place> {
        points.map(|point| self.place(*point)).collect()
    }

    /// The number of a point of a face, to be looked at unless it is known.
    pub(super) fn number(&mut self, face: u32, point: DVec3) -> u32 {
        let next = self.points.len() as u32;
        let number = *self.numbers.entry((face, self.place(point))).or_insert(next);
        if number == next {
            self.points.push((face, point));
        }
        number
    }

    pub(super) fn point(&self, site: u32) -> DVec3 {
        self.points[site as usize].1
    }

    /// B at a site; none under what stands on its face.
    pub(super) fn light(&self, site: u32) -> Option<V> {
        self.light[site as usize]
    }

    /// Looks at the points that are new.
    pub(super) fn look(&mut self) {
        let (field, faces) = (self.field, self.faces);
        let inside =
            |&(face, point): &(u32, DVec3)| (face, point.lerp(faces[face as usize].centroid(), INSIDE));
        let look = |points: &[(u32, DVec3)]| {
            let light = field.seen(&mut points.iter().map(inside));
            let covered = points.iter().map(inside).map(|(face, point)| field.is_covered(face, point));
            let light = covered.zip(light).map(|(covered, [b, _])| (!covered).then_some(b));
            light.collect::<Vec<_>>()
        };
        let new: Vec<_> = self.points[self.light.len()..].par_chunks(TOGETHER).map(look).collect();
        self.light.extend(new.into_iter().flatten());
    }
}
