//! Corners that patches share: those of one surface that lie in one place, in one plane or on one curve.

use super::Patches;
use fredholm::value::Value;
use glam::DVec3;
use std::collections::HashMap;

/// Corners that are this near, as a part of the scene, are one; normals that differ by no more are the same.
const NEAR: f64 = 1e-5;

/// The corners of patches, by number.
#[derive(Clone, Debug)]
pub(crate) struct Corners {
    /// Those of each patch; of a triangle the first three.
    of: Vec<[u32; 4]>,
    /// How many there are.
    count: usize,
}

impl Corners {
    /// Numbers the corners of patches. Light has steps where surfaces meet, or planes do: there each has its own.
    pub fn new<V: Value>(patches: &Patches<V>) -> Self {
        let vertices = || patches.polygons.iter().flat_map(|patch| patch.vertices());
        let low = vertices().fold(DVec3::INFINITY, |low, v| low.min(*v));
        let unit = NEAR * vertices().fold(0.0, |extent, v| f64::max(extent, (*v - low).max_element()));
        let rounded = |vector: DVec3, unit: f64| (vector / unit).to_array().map(|c| c.round() as i64);
        let mut numbers: HashMap<(u32, [i64; 3], [i64; 3]), u32> = HashMap::new();
        let mut of = vec![[0; 4]; patches.len()];
        for face in 0..patches.faces() {
            let whole = patches.face(face);
            for patch in patches.on_polygon(face) {
                for (number, vertex) in of[patch].iter_mut().zip(patches.polygons[patch].vertices()) {
                    let normal = rounded(whole.on_curve(*vertex).1, NEAR);
                    let new = numbers.len() as u32;
                    let place = rounded(*vertex - low, unit);
                    *number = *numbers.entry((patches.surface[patch], normal, place)).or_insert(new);
                }
            }
        }
        Self { of, count: numbers.len() }
    }

    /// The numbers of a patch's corners, in its order.
    pub fn of<V>(&self, patches: &Patches<V>, patch: usize) -> &[u32] {
        &self.of[patch][..patches.polygons[patch].vertices().len()]
    }

    /// At each corner the mean over the patches that meet there, each with a weight; 0 where they have none.
    pub fn means<V: Value>(&self, patches: &Patches<V>, values: &[V], weights: &[f64]) -> Vec<V> {
        let mut sums = vec![(V::splat(0.0), 0.0); self.count];
        for (patch, (value, weight)) in values.iter().zip(weights).enumerate() {
            for corner in self.of(patches, patch) {
                let (sum, weights) = &mut sums[*corner as usize];
                *sum += *value * *weight;
                *weights += *weight;
            }
        }
        let mean = |(sum, weight): (V, f64)| if weight > 0.0 { sum * weight.recip() } else { V::splat(0.0) };
        sums.into_iter().map(mean).collect()
    }

    /// What is linear between corners and the middle of a patch, at a point of it.
    pub fn between<V: Value>(
        &self,
        patches: &Patches<V>,
        (patch, point): (usize, DVec3),
        at_corners: &[V],
        at_middle: V,
    ) -> V {
        let polygon = &patches.polygons[patch];
        let (vertices, corners) = (polygon.vertices(), self.of(patches, patch));
        let (middle, normal) = (polygon.centroid(), polygon.normal());
        let area = |a: DVec3, b: DVec3| (a - point).cross(b - point).dot(normal);
        // The shares of two corners and of the middle, in the triangle that the point is in, or least outside of.
        let shares = |k: usize| {
            let [a, b] = [vertices[k], vertices[(k + 1) % vertices.len()]];
            let parts = [area(b, middle), area(middle, a), area(a, b)];
            let sum: f64 = parts.iter().sum();
            (k, parts.map(|part| part / sum))
        };
        let least = |[a, b, c]: [f64; 3]| a.min(b).min(c);
        let triangles = (0..vertices.len()).map(shares);
        let Some((k, [a, b, c])) = triangles.max_by(|p, q| least(p.1).total_cmp(&least(q.1))) else {
            return at_middle;
        };
        let corner = |k: usize| at_corners[corners[k % corners.len()] as usize];
        corner(k) * a + corner(k + 1) * b + at_middle * c
    }
}
