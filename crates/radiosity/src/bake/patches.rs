//! B of patches as light at the vertices of triangles: at corners and in the middles, between which it is linear.

use super::vertices::{VertexLight, Vertices};
use crate::patches::{Corners, Patches};
use crate::scene::Scene;
use fredholm::value::Value;

impl<V: Value> VertexLight<V> {
    /// Of the radiosity of each patch. `error` is 0: nothing is known of what light is between patches.
    pub fn of_patches(scene: &Scene<V>, patches: &Patches<V>, radiosity: &[V]) -> Self {
        let corners = Corners::new(patches);
        let at_corners = corners.means(patches, radiosity, &vec![1.0; patches.len()]);
        Self { surfaces: surfaces(scene, patches, &corners, (&at_corners, radiosity)), error: 0.0 }
    }
}

/// The triangles between corners and middles.
fn surfaces<V: Value>(
    scene: &Scene<V>,
    patches: &Patches<V>,
    corners: &Corners,
    (at_corners, at_middles): (&[V], &[V]),
) -> Vec<Vertices<V>> {
    let mut surfaces: Vec<Vertices<V>> = scene.surfaces.iter().map(|_| Vertices::default()).collect();
    let mut known: Vec<Option<u32>> = vec![None; at_corners.len()];
    for face in 0..patches.faces() {
        let whole = patches.face(face);
        for i in patches.on_polygon(face) {
            let surface = &mut surfaces[patches.surface[i] as usize];
            let polygon = &patches.polygons[i];
            let mut rim = Vec::new();
            for (&vertex, &corner) in polygon.vertices().iter().zip(corners.of(patches, i)) {
                let corner = corner as usize;
                rim.push(
                    *known[corner].get_or_insert_with(|| surface.add(whole, vertex, at_corners[corner])),
                );
            }
            let middle = surface.add(whole, polygon.centroid(), at_middles[i]);
            let next = |k: usize| rim[(k + 1) % rim.len()];
            surface.triangles.extend((0..rim.len()).map(|k| [rim[k], next(k), middle]));
        }
    }
    surfaces
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
