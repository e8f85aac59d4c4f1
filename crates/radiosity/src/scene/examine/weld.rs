//! Corners that lie in one place become one vertex: |p − q| ≤ tolerance.

use crate::polygon::Polygon;
use glam::{DVec3, I64Vec3};
use std::collections::HashMap;

/// Vertices, and the polygons by them.
pub(super) struct Welded {
    /// The place of each vertex: that of the first corner there.
    pub vertices: Vec<DVec3>,
    pub polygons: Vec<Vec<u32>>,
}

impl Welded {
    pub fn new(polygons: &[Polygon], tolerance: f64) -> Self {
        let mut weld = Weld { tolerance, vertices: Vec::new(), cells: HashMap::new() };
        let polygons = polygons.iter();
        let polygons =
            polygons.map(|polygon| polygon.vertices().iter().map(|&corner| weld.vertex(corner)).collect());
        let polygons = polygons.collect();
        Self { vertices: weld.vertices, polygons }
    }
}

struct Weld {
    tolerance: f64,
    vertices: Vec<DVec3>,
    /// The vertices in each cell of a grid.
    cells: HashMap<I64Vec3, Vec<u32>>,
}

/// Sides of a cell in tolerances: then a corner is rarely so near a border that it must look beyond.
const CELL: f64 = 16.0;

impl Weld {
    fn vertex(&mut self, corner: DVec3) -> u32 {
        let cell = |point: DVec3| (point / (CELL * self.tolerance)).floor().as_i64vec3();
        let reach = DVec3::splat(self.tolerance);
        let (low, high) = (cell(corner - reach), cell(corner + reach));
        let cells = (low.x..=high.x).flat_map(move |x| {
            (low.y..=high.y).flat_map(move |y| (low.z..=high.z).map(move |z| I64Vec3::new(x, y, z)))
        });
        let near = |&vertex: &u32| self.vertices[vertex as usize].distance(corner) <= self.tolerance;
        let found = cells.filter_map(|key| self.cells.get(&key)).flatten().copied().find(near);
        found.unwrap_or_else(|| {
            let number = self.vertices.len() as u32;
            self.vertices.push(corner);
            self.cells.entry(cell(corner)).or_default().push(number);
            number
        })
    }
}
