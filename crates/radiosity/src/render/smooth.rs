//! Noise of the gather is averaged away between neighbouring pixels: 7 × 7 of them, on one plane or one curved surface only,
//! and only as far as the irradiance is alike.

use crate::polygon::Polygon;
use crate::render::fragments::Fragments;
use crate::scene::Scene;
use fredholm::value::{Rgb, Spectrum};
use glam::DVec3;
use rayon::prelude::*;
use std::collections::HashMap;
use std::f64::consts::FRAC_1_SQRT_2;

/// What a fragment sends to the camera, in W/(m² sr).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lit {
    /// Its own light and what it reflects of the lamps'.
    pub(crate) direct: Rgb,
    /// What it reflects of the light of patches.
    pub(crate) indirect: Rgb,
    /// The harmonic mean of the distances to what it sees, in m.
    pub(crate) openness: f64,
    /// The normal about which light was looked for.
    pub(crate) normal: DVec3,
}

/// How many pixels each way.
const REACH: usize = 3;

/// How far irradiance is alike: the distance over the harmonic mean distance of what is seen, and √(1 − n·n′), the two terms of
/// Ward's error of an irradiance taken from beside (1988). At 1 the shading of a
/// corner and of a block's foot is washed out; at 0.1 it keeps its grain.
const ALIKE: f64 = 0.3;

/// The indirect light of every fragment, smoothed.
pub(crate) fn smooth(fragments: &Fragments, planes: &Planes, lit: &[Lit]) -> Vec<Rgb> {
    let row = |y: usize| -> Vec<Rgb> {
        let pixels = (0..fragments.width).map(|x| (x, y));
        let each =
            pixels.flat_map(|(x, y)| fragments.of_pixel(y * fragments.width + x).map(move |k| (x, y, k)));
        each.map(|(x, y, k)| mean_about(fragments, planes, lit, (x, y), k)).collect()
    };
    (0..fragments.height).into_par_iter().map(row).collect::<Vec<_>>().concat()
}

fn mean_about(
    fragments: &Fragments,
    planes: &Planes,
    lit: &[Lit],
    (x, y): (usize, usize),
    centre: usize,
) -> Rgb {
    let (mut sum, mut weights) = (Spectrum([0.0; 3]), 0.0);
    let here = &fragments.all[centre];
    for v in y.saturating_sub(REACH)..(y + REACH + 1).min(fragments.height) {
        for u in x.saturating_sub(REACH)..(x + REACH + 1).min(fragments.width) {
            for k in fragments.of_pixel(v * fragments.width + u) {
                let there = &fragments.all[k];
                if !planes.same(here.shown, there.shown) {
                    continue;
                }
                let openness = lit[centre].openness.min(lit[k].openness);
                let unlike = unlike(here.point.distance(there.point), openness)
                    + lit[centre].normal.distance(lit[k].normal) * FRAC_1_SQRT_2;
                let weight = tent(x.abs_diff(u)) * tent(y.abs_diff(v)) * (1.0 - unlike / ALIKE).max(0.0);
                weights += weight;
                sum += lit[k].indirect * weight;
            }
        }
    }
    sum * (1.0 / weights)
}

/// A weight that falls to nothing one pixel beyond the reach.
fn tent(pixels: usize) -> f64 {
    1.0 - pixels as f64 / (REACH + 1) as f64
}

/// A distance over the openness there; a point is alike itself.
fn unlike(distance: f64, openness: f64) -> f64 {
    if distance == 0.0 { 0.0 } else { distance / openness }
}

/// Which polygons lie in one plane of one surface, or are curved and of one surface, and so reflect alike.
pub(crate) struct Planes {
    /// The number of each polygon's plane, or of its surface's curve.
    plane: Vec<usize>,
}

/// Normals and, relative to 1 m, offsets that round to the same multiple of this are one plane.
const FLATNESS: f64 = 1e-5;

impl Planes {
    pub(crate) fn new<V>(scene: &Scene<V>) -> Self {
        let mut numbers = HashMap::new();
        let polygons = scene.surfaces.iter().enumerate().flat_map(|(s, surface)| {
            let plane = |polygon: &Polygon| (!polygon.is_curved()).then(|| rounded_plane(polygon));
            surface.polygons.iter().map(move |polygon| (s, plane(polygon)))
        });
        let plane = polygons
            .map(|key| {
                let next = numbers.len();
                *numbers.entry(key).or_insert(next)
            })
            .collect();
        Self { plane }
    }

    fn same(&self, a: u32, b: u32) -> bool {
        self.plane[a as usize] == self.plane[b as usize]
    }
}

/// (n, n·x) in multiples of the flatness.
fn rounded_plane(polygon: &Polygon) -> [i64; 4] {
    let n = polygon.normal();
    [n.x, n.y, n.z, n.dot(polygon.centroid())].map(|c| (c / FLATNESS).round() as i64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::fragments::Fragment;
    use crate::scene::Surface;

    fn triangle(z: f64) -> Polygon {
        let p = |x, y| DVec3::new(x, y, z);
        Polygon::triangle(p(0.0, 0.0), p(1.0, 0.0), p(0.0, 1.0))
    }

    /// A row of pixels, of which the right half shows a second polygon.
    fn row(second_height: f64, openness: f64) -> Vec<Rgb> {
        row_of(&[triangle(0.0), triangle(second_height)], DVec3::Z, openness)
    }

    /// The same of these polygons, the second with another normal.
    fn row_of(polygons: &[Polygon; 2], second_normal: DVec3, openness: f64) -> Vec<Rgb> {
        let polygons = polygons.to_vec();
        let surface = Surface { name: "s".into(), reflectance: 0.5, emission: 0.0, polygons };
        let scene = Scene { name: "t".into(), surfaces: vec![surface], lights: Vec::new(), camera: None };
        let fragment =
            |x: usize| Fragment { shown: u32::from(x >= 8), weight: 1.0, point: x as f64 * 0.01 * DVec3::X };
        let fragments = Fragments::with_one_each(16, 1, (0..16).map(fragment).collect());
        let level = |x: usize| Rgb::from(Spectrum([if x >= 8 { 3.0 } else { (x % 2) as f64 }; 3]));
        let normal = |x: usize| if x >= 8 { second_normal } else { DVec3::Z };
        let lit: Vec<_> = (0..16)
            .map(|x| Lit { direct: Spectrum([0.0; 3]), indirect: level(x), openness, normal: normal(x) })
            .collect();
        smooth(&fragments, &Planes::new(&scene), &lit)
    }

    #[test]
    fn noise_goes_and_edges_stay() {
        let smoothed = row(0.5, f64::INFINITY);
        assert!(smoothed[..8].iter().all(|l| (l.0[0] - 0.5).abs() < 0.15), "{smoothed:?}");
        assert!(smoothed[8..].iter().all(|l| (l.0[0] - 3.0).abs() < 1e-12));
    }

    #[test]
    fn one_plane_is_smoothed_across_its_polygons() {
        assert!(row(0.0, f64::INFINITY)[7].0[0] > 1.0);
    }

    #[test]
    fn a_curved_surface_is_smoothed_across_its_polygons_as_far_as_its_normals_agree() {
        let lean = [DVec3::new(0.2, 0.0, 1.0); 3];
        let curved = || [0.0, 0.5].map(|z| triangle(z).with_normals(&lean).unwrap());
        let smoothed =
            |angle: f64| row_of(&curved(), DVec3::new(angle.sin(), 0.0, angle.cos()), f64::INFINITY)[7].0[0];
        assert!(smoothed(0.05) > 1.0, "{}", smoothed(0.05));
        let apart = row(0.5, f64::INFINITY)[7].0[0];
        assert!((smoothed(0.5) - apart).abs() < 1e-12, "{}", smoothed(0.5));
    }

    #[test]
    fn in_a_tight_corner_nothing_is_blurred() {
        assert_eq!(row(0.0, 0.001)[3].0[0], 1.0);
    }
}
