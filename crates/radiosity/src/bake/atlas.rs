//! (u, v) of every polygon: each has a rectangle of its own in a square of texels, as many a metre for all.

use crate::polygon::Polygon;
use crunch::{Item, Rect, Rotation};
use glam::{DVec2, DVec3};

/// Where each polygon of a scene is in a square of texels.
#[derive(Clone, Debug)]
pub struct Atlas {
    /// Texels across and down.
    pub size: usize,
    /// Texels a metre.
    pub density: f64,
    charts: Vec<Chart>,
}

/// The rectangle of a polygon.
#[derive(Clone, Copy, Debug, Default)]
struct Chart {
    /// Its first texel.
    x: usize,
    y: usize,
    width: usize,
    height: usize,
    /// The point of the polygon's plane at the centre of the first texel that is not margin, and two unit vectors.
    origin: DVec3,
    along: DVec3,
    across: DVec3,
}

/// More polygons than an atlas has room for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{polygons} polygons do not fit into {size} × {size} texels; ask for a larger atlas, or simplify the mesh"
)]
pub struct Crowded {
    /// How many polygons there are.
    pub polygons: usize,
    /// Texels across and down.
    pub size: usize,
}

/// Texels around a polygon that have what is at its rim: one is what a bilinear filter reaches.
const MARGIN: usize = 1;

/// The part of the atlas that is tried to be filled first, and by how much texels grow until all fit.
const FILL: f64 = 0.95;
const GROW: f64 = 0.97;

impl Atlas {
    /// Lays polygons into a square, with texels as small as fit.
    ///
    /// # Errors
    ///
    /// When there are too many polygons for the square even with three texels across for each.
    pub fn new(polygons: &[Polygon], size: usize) -> Result<Self, Crowded> {
        let area: f64 = polygons.iter().map(Polygon::area).sum();
        let mut density = (FILL / area).sqrt() * size as f64;
        loop {
            let charts: Vec<Chart> = polygons.iter().map(|polygon| Chart::new(polygon, density)).collect();
            let least = charts.iter().all(|chart| chart.width.max(chart.height) <= 2 + 2 * MARGIN);
            if let Some(charts) = packed(charts, size) {
                return Ok(Self { size, density, charts });
            }
            if least {
                return Err(Crowded { polygons: polygons.len(), size });
            }
            density *= GROW;
        }
    }

    /// Where a point of the k-th polygon is in the atlas, from (0, 0) in the upper left corner to (1, 1).
    pub fn place(&self, k: usize, point: DVec3) -> DVec2 {
        let chart = &self.charts[k];
        let from = point - chart.origin;
        let inside = DVec2::new(from.dot(chart.along), from.dot(chart.across)) * self.density;
        let first = DVec2::new((chart.x + MARGIN) as f64, (chart.y + MARGIN) as f64);
        (first + inside + DVec2::splat(0.5)) / self.size as f64
    }

    /// The texels that show the k-th polygon, or a filter reaches from it, and the points of it that are nearest to them.
    pub fn texels(&self, k: usize, polygon: &Polygon) -> Vec<(usize, DVec3)> {
        let chart = &self.charts[k];
        let step = 1.0 / self.density;
        let mut texels = Vec::new();
        for row in 0..chart.height {
            for column in 0..chart.width {
                let [i, j] = [column, row].map(|texel| (texel as f64 - MARGIN as f64) * step);
                let centre = chart.origin + chart.along * i + chart.across * j;
                let nearest = nearest(polygon, centre);
                if nearest.distance(centre) <= REACH * step {
                    texels.push(((chart.y + row) * self.size + chart.x + column, nearest));
                }
            }
        }
        texels
    }
}

/// How far from a polygon a texel is that a bilinear filter reaches: on the diagonal.
const REACH: f64 = 1.5;

impl Chart {
    fn new(polygon: &Polygon, density: f64) -> Self {
        let v = polygon.vertices();
        let edges = (0..v.len()).map(|k| v[(k + 1) % v.len()] - v[k]);
        let longest = edges.max_by(|a, b| a.length().total_cmp(&b.length())).unwrap_or(DVec3::X);
        let along = longest.normalize_or(DVec3::X);
        let across = polygon.normal().cross(along);
        let extent = |axis: DVec3| {
            let (low, high) = v
                .iter()
                .map(|p| (*p - v[0]).dot(axis))
                .fold((0.0, 0.0), |(low, high), c| (f64::min(low, c), f64::max(high, c)));
            (low, (((high - low) * density).ceil() as usize).max(1) + 1 + 2 * MARGIN)
        };
        let ((left, width), (top, height)) = (extent(along), extent(across));
        Self { width, height, origin: v[0] + along * left + across * top, along, across, ..Self::default() }
    }
}

/// The charts with their places, if all of them fit.
fn packed(mut charts: Vec<Chart>, size: usize) -> Option<Vec<Chart>> {
    if charts.iter().map(|chart| chart.width * chart.height).sum::<usize>() > size * size {
        return None;
    }
    let items = charts.iter().enumerate().map(|(k, c)| Item::new(k, c.width, c.height, Rotation::None));
    let items = items.collect::<Vec<_>>();
    for packed in crunch::pack(Rect::of_size(size, size), items).ok()? {
        (charts[packed.data].x, charts[packed.data].y) = (packed.rect.x, packed.rect.y);
    }
    Some(charts)
}

/// How far inside a polygon points of its rim are moved, as a part of the way to its middle: faces meet at the rim.
const INSIDE: f64 = 1e-6;

/// The point of a polygon that is nearest to one of its plane.
fn nearest(polygon: &Polygon, point: DVec3) -> DVec3 {
    let v = polygon.vertices();
    let on_edge = |k: usize| {
        let (a, edge) = (v[k], v[(k + 1) % v.len()] - v[k]);
        a + edge * ((point - a).dot(edge) / edge.length_squared()).clamp(0.0, 1.0)
    };
    let inside = if polygon.distance_outside(point) <= 0.0 {
        point
    } else {
        let rim = (0..v.len()).map(on_edge);
        rim.min_by(|a, b| a.distance(point).total_cmp(&b.distance(point))).unwrap_or(point)
    };
    inside.lerp(polygon.centroid(), INSIDE)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn squares(count: usize) -> Vec<Polygon> {
        let corner = |k: usize| DVec3::new(3.0 * k as f64, 0.0, 0.0);
        let square = |k: usize| {
            let size = 1.0 + k as f64 / count as f64;
            let (x, y) = (DVec3::X * size, DVec3::Y * size);
            Polygon::quadrilateral(corner(k), corner(k) + x, corner(k) + x + y, corner(k) + y)
        };
        (0..count).map(square).collect()
    }

    #[test]
    fn no_texel_belongs_to_two_polygons_and_each_point_is_where_its_texel_is() {
        let triangle = Polygon::triangle(
            DVec3::new(0.0, 0.0, 1.0),
            DVec3::new(0.3, 0.1, 1.0),
            DVec3::new(0.0, 2.0, 1.0),
        );
        let polygons: Vec<Polygon> = squares(7).into_iter().chain([triangle]).collect();
        let atlas = Atlas::new(&polygons, 128).unwrap();
        let mut taken = vec![false; 128 * 128];
        for (k, polygon) in polygons.iter().enumerate() {
            let texels = atlas.texels(k, polygon);
            assert!(texels.len() as f64 > polygon.area() * atlas.density.powi(2), "{k}");
            for (texel, point) in texels {
                assert!(!std::mem::replace(&mut taken[texel], true), "texel {texel} twice");
                let centre = DVec2::new((texel % 128) as f64 + 0.5, (texel / 128) as f64 + 0.5);
                assert!((atlas.place(k, point) * 128.0).distance(centre) < 1.51, "{point}");
            }
            // Whatever a bilinear filter reads for a point of the polygon is one of its texels.
            for (s, t) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.3, 0.9)] {
                let at = atlas.place(k, polygon.point(s, t)) * 128.0 - DVec2::splat(0.5);
                for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                    let texel = (at.y.floor() as usize + dy) * 128 + at.x.floor() as usize + dx;
                    assert!(taken[texel], "polygon {k}, {at}");
                }
            }
        }
        let filled = taken.iter().filter(|taken| **taken).count();
        assert!(filled > 128 * 128 / 2, "{filled}");
    }

    #[test]
    fn more_polygons_than_there_is_room_for_are_refused() {
        assert_eq!(Atlas::new(&squares(100), 16).unwrap_err(), Crowded { polygons: 100, size: 16 });
    }
}
