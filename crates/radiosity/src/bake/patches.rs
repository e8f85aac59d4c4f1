//! B of patches as light at the vertices of triangles: at corners and in the middles, between which it is linear.

use super::vertices::{VertexLight, Vertices};
use crate::patches::{Corners, Patches};
use crate::reconstruct::{Lit, scattered};
use crate::scene::Scene;
use fredholm::value::Value;
use glam::DVec3;
use rayon::prelude::*;

impl<V: Value> VertexLight<V> {
    /// Of the radiosity of each patch. `error` is 0: nothing is known of what light is between patches.
    pub fn of_patches(scene: &Scene<V>, patches: &Patches<V>, radiosity: &[V]) -> Self {
        let corners = Corners::new(patches);
        let at_corners = corners.means(patches, radiosity, &vec![1.0; patches.len()]);
        Self { surfaces: surfaces(scene, patches, &corners, (&at_corners, radiosity)), error: 0.0 }
    }

    /// Of a field, looked at in the corners and the middles of patches, and between some of them.
    pub fn of_field(scene: &Scene<V>, patches: &Patches<V>, field: &dyn Lit<V>) -> Self {
        let corners = Corners::new(patches);
        let faces: Vec<u32> = patches.face_of_each();
        let looked = |points: &[(u32, DVec3)]| -> Vec<[V; 2]> {
            let seen = |points: &[(u32, DVec3)]| field.seen(&mut points.iter().copied());
            points.par_chunks(LOOK).flat_map_iter(seen).collect()
        };
        let middle = |i: usize| (faces[i], patches.polygons[i].centroid());
        let at_middles = looked(&(0..patches.len()).map(middle).collect::<Vec<_>>());
        let lit: Vec<f64> =
            at_middles.iter().map(|[_, h]| if h.magnitude() > 0.0 { 1.0 } else { 0.0 }).collect();
        let at_middles: Vec<V> = at_middles.into_iter().map(|[b, _]| b).collect();
        // Corners without any light are under something that stands there: they take what the patches around them have, or each
        // foot would have a dark rim as wide as a patch.
        let around = corners.means(patches, &at_middles, &lit);
        let at_corners = looked(&corners.places(patches, &faces)).into_iter().zip(around);
        let at_corners: Vec<V> =
            at_corners.map(|([b, h], around)| if h.magnitude() > 0.0 { b } else { around }).collect();

        let step = patches.len().div_ceil(LOOKS).max(1);
        let between: Vec<usize> = (0..patches.len()).step_by(step).collect();
        let point = |i: &usize| {
            let (s, t) = scattered(*i);
            (faces[*i], patches.polygons[*i].point(s, t))
        };
        let points: Vec<(u32, DVec3)> = between.iter().map(point).collect();
        let (mut off, mut reflected) = (0.0, 0.0);
        for ((i, (_, point)), [light, _]) in between.iter().zip(&points).zip(looked(&points)) {
            let linear = corners.between(patches, (*i, *point), &at_corners, at_middles[*i]);
            off += patches.areas[*i] * (light - linear).square();
            reflected += patches.areas[*i] * (light - patches.emission[*i]).square();
        }
        let error = if reflected > 0.0 { (off / reflected).sqrt() } else { 0.0 };
        Self { surfaces: surfaces(scene, patches, &corners, (&at_corners, &at_middles)), error }
    }
}

/// Points that one thread looks at.
const LOOK: usize = 1024;

/// Patches between whose corners the field is looked at.
const LOOKS: usize = 8192;

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
