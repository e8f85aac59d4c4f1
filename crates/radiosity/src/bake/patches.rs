//! B of patches as light at the vertices of triangles: at corners the mean over those patches of one surface in one plane that meet
//! there, in the middle each patch's own.

use super::vertices::{VertexLight, Vertices};
use crate::patches::Patches;
use crate::polygon::Polygon;
use crate::scene::Scene;
use fredholm::value::Value;
use glam::DVec3;
use std::collections::HashMap;

/// Corners that are this near, as a part of the scene, are one; normals that differ by no more are of one plane.
const NEAR: f64 = 1e-5;

/// A corner of one surface in one plane, up to rounding.
type Corner = (u32, [i64; 3], [i64; 3]);

impl<V: Value> VertexLight<V> {
    /// Of the radiosity of each patch. `error` is 0: nothing is known of what light is between patches.
    pub fn of_patches(scene: &Scene<V>, patches: &Patches<V>, radiosity: &[V]) -> Self {
        let vertices = || patches.polygons.iter().flat_map(Polygon::vertices);
        let low = vertices().fold(DVec3::INFINITY, |low, v| low.min(*v));
        let unit = NEAR * vertices().fold(0.0, |extent, v| f64::max(extent, (*v - low).max_element()));
        let corner = |i: usize, vertex: DVec3| -> Corner {
            let normal = patches.polygons[i].normal().to_array().map(|c| (c / NEAR).round() as i64);
            (patches.surface[i], normal, ((vertex - low) / unit).to_array().map(|c| c.round() as i64))
        };
        let mut sums: HashMap<Corner, (V, f64)> = HashMap::new();
        for (i, polygon) in patches.polygons.iter().enumerate() {
            for &vertex in polygon.vertices() {
                let sum = sums.entry(corner(i, vertex)).or_insert((V::splat(0.0), 0.0));
                *sum = (sum.0 + radiosity[i], sum.1 + 1.0);
            }
        }
        let mut surfaces: Vec<Vertices<V>> = scene.surfaces.iter().map(|_| Vertices::default()).collect();
        let mut known = HashMap::new();
        for (i, polygon) in patches.polygons.iter().enumerate() {
            let surface = &mut surfaces[patches.surface[i] as usize];
            let mut rim = Vec::new();
            for &vertex in polygon.vertices() {
                let corner = corner(i, vertex);
                let (sum, count) = sums[&corner];
                let add = || surface.add(polygon, vertex, sum * (1.0 / count));
                rim.push(*known.entry(corner).or_insert_with(add));
            }
            let middle = surface.add(polygon, polygon.centroid(), radiosity[i]);
            let next = |k: usize| rim[(k + 1) % rim.len()];
            surface.triangles.extend((0..rim.len()).map(|k| [rim[k], next(k), middle]));
        }
        Self { surfaces, error: 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::cornell_box;

    #[test]
    fn neighbours_share_their_corners_and_no_light_crosses_an_edge_of_the_room() {
        let scene = cornell_box();
        let patches = Patches::new(&scene, 0.1).unwrap();
        // Each surface has a number of its own for light: whatever is mixed is seen.
        let radiosity: Vec<_> =
            patches.surface.iter().map(|&s| fredholm::value::Rgb::splat(f64::from(s) + 1.0)).collect();
        let light = VertexLight::of_patches(&scene, &patches, &radiosity);
        let corners: usize = patches.polygons.iter().map(|polygon| polygon.vertices().len()).sum();
        assert_eq!(light.size()[1], corners);
        assert!(light.size()[0] < patches.len() + corners / 2, "{:?} of {corners}", light.size());
        for (s, vertices) in light.surfaces.iter().enumerate() {
            assert!(vertices.radiosity.iter().all(|b| (b.0[0] - s as f64 - 1.0).abs() < 1e-12), "{s}");
            let area = |t: &[u32; 3]| {
                let [a, b, c] = t.map(|k| vertices.points[k as usize]);
                0.5 * (b - a).cross(c - a).dot(vertices.normals[t[0] as usize])
            };
            let whole: f64 = vertices.triangles.iter().map(area).sum();
            assert!((whole / scene.surfaces[s].area() - 1.0).abs() < 1e-6, "{s}");
        }
        // Halfway between a bright patch and a dark one it is half as bright.
        let mut one = vec![fredholm::value::Rgb::splat(0.0); patches.len()];
        one[0] = fredholm::value::Rgb::splat(4.0);
        let light = VertexLight::of_patches(&scene, &patches, &one);
        let levels: Vec<f64> =
            light.surfaces[0].radiosity.iter().map(|b| b.0[0]).filter(|b| *b > 0.0).collect();
        // Its middle and four corners: one its own, of the room, two that two patches share, one of four patches.
        let mut sorted = levels.clone();
        sorted.sort_by(f64::total_cmp);
        assert_eq!(sorted, [1.0, 2.0, 2.0, 4.0, 4.0]);
    }
}
