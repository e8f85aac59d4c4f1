//! Scenes with known answers, built in code.

#![allow(dead_code, reason = "each test file uses some of it")]

use fredholm::value::{Value, max_norm};
use glam::DVec3;
use radiosity::patches::Patches;
use radiosity::polygon::Polygon;
use radiosity::scene::{Scene, Surface};
use radiosity::visibility::Visibility;
use std::f64::consts::{PI, TAU};

pub fn p(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// The parallelogram from a corner along two edges; its front is where `along` × `across` points.
pub fn parallelogram(corner: DVec3, along: DVec3, across: DVec3) -> Polygon {
    Polygon::quadrilateral(corner, corner + along, corner + along + across, corner + across)
}

/// The walls of the box from `low` to `high` seen from within, or, with `outside`, from without:
/// z low, z high, y low, y high, x low, x high.
pub fn walls(low: DVec3, high: DVec3, outside: bool) -> [Polygon; 6] {
    let size = high - low;
    let (x, y, z) = (size.x * DVec3::X, size.y * DVec3::Y, size.z * DVec3::Z);
    let wall = |corner: DVec3, along: DVec3, across: DVec3| match outside {
        false => parallelogram(corner, along, across),
        true => parallelogram(corner, across, along),
    };
    [
        wall(low, x, y),
        wall(low + z, y, x),
        wall(low, z, x),
        wall(low + y, x, z),
        wall(low, y, z),
        wall(low + x, z, y),
    ]
}

/// A surface for each group of polygons, named "0", "1", …, with the same ρ and no emission.
pub fn scene<V: Value>(groups: impl IntoIterator<Item = Vec<Polygon>>, reflectance: V) -> Scene<V> {
    let surface = |(k, polygons): (usize, Vec<Polygon>)| Surface {
        name: k.to_string(),
        reflectance,
        emission: V::splat(0.0),
        polygons,
    };
    Scene {
        name: "test".into(),
        surfaces: groups.into_iter().enumerate().map(surface).collect(),
        lights: Vec::new(),
        camera: None,
    }
}

pub fn visibility<V>(scene: &Scene<V>) -> Visibility {
    Visibility::new(&scene.polygons())
}

/// The inside of the unit sphere as `rows` rows of planar trapezoids, triangles at the poles, corners on the sphere.
pub fn sphere(rows: usize) -> Vec<Polygon> {
    let columns = 2 * rows;
    let at = |i: usize, j: usize| {
        let (polar, turn) = (PI * i as f64 / rows as f64, TAU * (j % columns) as f64 / columns as f64);
        p(polar.sin() * turn.cos(), polar.sin() * turn.sin(), polar.cos())
    };
    let cell = |(i, j)| match i {
        0 => Polygon::triangle(DVec3::Z, at(1, j + 1), at(1, j)),
        i if i == rows - 1 => Polygon::triangle(at(i, j), at(i, j + 1), -DVec3::Z),
        _ => Polygon::quadrilateral(at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)),
    };
    (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j))).map(cell).collect()
}

pub fn distance<V: Value>(a: &[V], b: &[V]) -> f64 {
    assert_eq!(a.len(), b.len());
    max_norm(&a.iter().zip(b).map(|(a, b)| *a - *b).collect::<Vec<_>>())
}

/// Area-weighted mean over some patches.
pub fn mean<V: Value>(patches: &Patches<V>, values: &[f64], over: impl Fn(usize) -> bool) -> f64 {
    let chosen = (0..patches.len()).filter(|&i| over(i));
    let (sum, area) =
        chosen.fold((0.0, 0.0), |(s, a), i| (s + patches.areas[i] * values[i], a + patches.areas[i]));
    sum / area
}
