//! u = Σ_i Σ_a u_ia φ_ia: a polynomial on each patch, none of whose coefficients belongs to two (paper, §3.1, §3.2).

use super::adaptive::{Adaptive, Block};
use super::degree::{Degree, Local, MOST, Reference};
use crate::kernel::SurfacePoint;
use crate::patches::inverse_bilinear;
use crate::polygon::Polygon;
use fredholm::value::Value;
use glam::DVec3;
use rayon::prelude::*;
use std::ops::Range;

/// The broken space of degree k on some patches: P_k on the triangles, Q_k through the bilinear map on the quadrilaterals.
///
/// The basis of an element is Lagrange's: φ_a is 1 at node a and 0 at the other nodes, so that a coefficient is a value of u
/// and the φ_a add up to 1. The nodes are those of a quadrature rule that is exact for products of two basis functions, also
/// where the Jacobian of a quadrilateral varies. So
///
/// - they lie inside, never on an edge or a corner, where two patches meet and the kernel is singular: the barycentric nodes
///   (3.1) of the paper do, and serve conforming spaces, which light, discontinuous across edges, does not have;
/// - the basis is orthogonal, ∫ φ_a φ_b = m_a δ_ab: the projection onto the space needs no mass matrix but the weights m_a, and
///   Σ m_a is the area.
#[derive(Debug)]
pub struct Space<'a> {
    degree: Degree,
    polygons: &'a [Polygon],
    pub(super) areas: Vec<f64>,
    pub(super) diameters: Vec<f64>,
    maps: Vec<Map>,
    first: Vec<usize>,
    weights: Vec<f64>,
    triangle: Reference,
    square: Reference,
}

/// How points of a patch find their place on the reference element.
#[derive(Clone, Copy, Debug)]
enum Map {
    /// (s, t) = ((x − corner) · along, (x − corner) · across).
    Affine { corner: DVec3, along: DVec3, across: DVec3 },
    /// By Newton's method.
    Bilinear,
}

/// The least that a quadrilateral's fourth corner is off a parallelogram's, in diameters, to be no parallelogram.
const TWIST: f64 = 1e-12;

impl Map {
    fn of(polygon: &Polygon) -> Self {
        let v = polygon.vertices();
        let (u, w) = (v[1] - v[0], v[v.len() - 1] - v[0]);
        if v.len() == 4 && v[2].distance(v[0] + u + w) > TWIST * polygon.diameter() {
            return Self::Bilinear;
        }
        let normal = polygon.normal();
        let doubled = u.cross(w).dot(normal);
        Self::Affine { corner: v[0], along: w.cross(normal) / doubled, across: normal.cross(u) / doubled }
    }
}

impl<'a> Space<'a> {
    /// The space on these patches.
    pub fn new(polygons: &'a [Polygon], degree: Degree) -> Self {
        let mut space = Self {
            degree,
            polygons,
            areas: polygons.iter().map(Polygon::area).collect(),
            diameters: polygons.iter().map(Polygon::diameter).collect(),
            maps: polygons.iter().map(Map::of).collect(),
            first: vec![0],
            weights: Vec::new(),
            triangle: Reference::triangle(degree),
            square: Reference::square(degree),
        };
        for (polygon, area) in polygons.iter().zip(&space.areas) {
            let reference = space.reference(polygon);
            let weights = reference.nodes.iter().zip(&reference.weights).map(|(&[s, t], w)| {
                let stretch = if is_triangle(polygon) { *area } else { polygon.density(s, t) };
                w * stretch
            });
            space.weights.extend(weights.collect::<Vec<_>>());
            space.first.push(space.weights.len());
        }
        space
    }

    /// The degree k.
    pub fn degree(&self) -> Degree {
        self.degree
    }

    /// The elements: the patches.
    pub fn polygons(&self) -> &'a [Polygon] {
        self.polygons
    }

    /// The number of coefficients of all elements.
    pub fn dim(&self) -> usize {
        self.weights.len()
    }

    /// Which coefficients are element i's.
    pub fn range(&self, i: usize) -> Range<usize> {
        self.first[i]..self.first[i + 1]
    }

    /// The element that a coefficient belongs to.
    pub fn element_of(&self, unknown: usize) -> usize {
        self.first.partition_point(|&first| first <= unknown) - 1
    }

    /// m_a = ∫ φ_a = ∫ φ_a², in m², for each coefficient; positive.
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// The nodes of element i, where the coefficients are values; that of a constant is the centroid.
    pub fn nodes(&self, i: usize) -> impl Iterator<Item = SurfacePoint> + use<'_> {
        let polygon = &self.polygons[i];
        let place = |at| match self.degree {
            Degree::Constant => polygon.centroid(),
            _ => point(polygon, at),
        };
        let nodes = &self.reference(polygon).nodes;
        nodes.iter().map(move |&at| SurfacePoint { position: place(at), normal: polygon.normal() })
    }

    /// φ_a at a point of element i's plane, in metres; as many as the element has coefficients, then zeros.
    pub fn values(&self, i: usize, at: DVec3) -> Local {
        self.reference(&self.polygons[i]).values(self.place(i, at))
    }

    /// The coefficients of the function that interpolates `field` at the nodes.
    pub fn interpolate<V>(&self, field: impl Fn(&SurfacePoint) -> V) -> Vec<V> {
        (0..self.polygons.len()).flat_map(|i| self.nodes(i)).map(|node| field(&node)).collect()
    }

    /// The coefficients of the orthogonal projection of `field`, each with an error of about `tolerance`: the means
    /// ∫ φ_a g/m_a by a rule that is cut where g bends, as an irradiance does towards the edges of a room.
    pub fn project(&self, field: impl Fn(&SurfacePoint) -> f64 + Sync, tolerance: f64) -> Vec<f64> {
        let element = |i: usize| {
            let polygon = &self.polygons[i];
            let mut ones = [0.0; MOST];
            ones[0] = 1.0;
            let sample = |position| {
                let value = field(&SurfacePoint { position, normal: polygon.normal() });
                (self.values(i, position), ones.map(|one| one * value))
            };
            let weights = &self.weights[self.range(i)];
            let norm = |block: &Block| {
                block.iter().zip(weights).map(|(row, m)| row[0].abs() / m).fold(0.0, f64::max)
            };
            let block = Adaptive::new(self.degree.order(), polygon, sample, norm).integrate(|_| tolerance);
            block.iter().zip(weights).map(|(row, m)| row[0] / m).collect::<Vec<_>>()
        };
        (0..self.polygons.len()).into_par_iter().flat_map(element).collect()
    }

    /// The coefficients of the function that has one value on each element.
    pub fn spread<V: Copy>(&self, per_element: &[V]) -> Vec<V> {
        let copies = per_element.iter().enumerate().map(|(i, value)| vec![*value; self.range(i).len()]);
        copies.flatten().collect()
    }

    /// u at a point of element i.
    pub fn evaluate<V: Value>(&self, u: &[V], i: usize, at: DVec3) -> V {
        let values = self.values(i, at);
        u[self.range(i)].iter().zip(values).fold(V::splat(0.0), |sum, (u, value)| sum + *u * value)
    }

    /// The mean of u over each element: exact.
    pub fn means<V: Value>(&self, u: &[V]) -> Vec<V> {
        let mean = |i: usize| {
            let terms = u[self.range(i)].iter().zip(&self.weights[self.range(i)]);
            terms.fold(V::splat(0.0), |sum, (u, m)| sum + *u * (m / self.areas[i]))
        };
        (0..self.polygons.len()).map(mean).collect()
    }

    /// (∫ u²)^½ by channel, in W/m² × m: exact, since the basis is orthogonal.
    pub fn norm<V: Value>(&self, u: &[V]) -> V {
        let terms = u.iter().zip(&self.weights);
        terms.fold(V::splat(0.0), |sum, (u, m)| sum + *u * *u * *m).map(f64::sqrt)
    }

    /// The coordinates on the reference element of a point of element i's plane.
    pub(super) fn place(&self, i: usize, at: DVec3) -> [f64; 2] {
        match self.maps[i] {
            Map::Affine { corner, along, across } => {
                let from = at - corner;
                [from.dot(along), from.dot(across)]
            }
            Map::Bilinear => inverse_bilinear(&self.polygons[i], at).to_array(),
        }
    }

    /// The reference element of a patch.
    pub(super) fn reference(&self, polygon: &Polygon) -> &Reference {
        if is_triangle(polygon) { &self.triangle } else { &self.square }
    }
}

pub(super) fn is_triangle(polygon: &Polygon) -> bool {
    polygon.vertices().len() == 3
}

/// The point of a patch with these coordinates on the reference element.
pub(super) fn point(polygon: &Polygon, [s, t]: [f64; 2]) -> DVec3 {
    match *polygon.vertices() {
        [a, b, c] => a + (b - a) * s + (c - a) * t,
        _ => polygon.point(s, t),
    }
}
