//! What is left of a planar region when convex parts are cut out: A(rest) = A(region) − Σ A(parts).

use crate::polygon::Polygon;
use crate::scene::cut::cut;
use glam::DVec3;

/// What counts as on a line, as a fraction of the region's size: coordinates have six digits or so.
const ON_LINE: f64 = 1e-6;

/// A region as convex pieces in one plane.
pub(super) struct Region {
    pieces: Vec<Vec<DVec3>>,
    normal: DVec3,
    /// The distance below which a point is on a line, in metres.
    tolerance: f64,
}

impl Region {
    pub fn new(polygons: &[Polygon]) -> Self {
        let pieces = polygons.iter().map(|polygon| polygon.vertices().to_vec()).collect();
        let normal = polygons.first().map_or(DVec3::ZERO, Polygon::normal);
        let size = polygons.iter().map(Polygon::diameter).fold(0.0, f64::max);
        Self { pieces, normal, tolerance: ON_LINE * size }
    }

    /// Cuts a part out; whether the part lay within what was there. Else the region is of no use.
    pub fn cut_out(&mut self, part: &[Polygon]) -> bool {
        let before = self.area();
        for hole in part {
            let pieces = std::mem::take(&mut self.pieces);
            self.pieces = pieces.into_iter().flat_map(|piece| self.outside(piece, hole)).collect();
        }
        let missing = before - self.area() - part.iter().map(Polygon::area).sum::<f64>();
        let boundary = part.iter().map(Polygon::diameter).sum::<f64>() * 4.0;
        missing.abs() <= self.tolerance * boundary
    }

    pub fn polygons(&self) -> Vec<Polygon> {
        // A piece that is refused is a shaving between two lines that are one but for rounding.
        self.pieces.iter().filter_map(|piece| cut(piece).ok()).flatten().collect()
    }

    fn area(&self) -> f64 {
        self.pieces.iter().map(|piece| self.area_of(piece)).sum()
    }

    fn area_of(&self, piece: &[DVec3]) -> f64 {
        let fan = piece.windows(2).skip(1).map(|edge| (edge[0] - piece[0]).cross(edge[1] - piece[0]));
        0.5 * self.normal.dot(fan.sum())
    }

    /// The parts of a convex piece beyond each edge of a convex hole in turn; what is beyond none lies in the hole.
    fn outside(&self, piece: Vec<DVec3>, hole: &Polygon) -> Vec<Vec<DVec3>> {
        let corners = hole.vertices();
        // A null surface faces the other way, and so runs round the other way.
        let inward = self.normal * self.normal.dot(hole.normal()).signum();
        let (mut within, mut outside) = (piece, Vec::new());
        for (k, &start) in corners.iter().enumerate() {
            let along = corners[(k + 1) % corners.len()] - start;
            let across = inward.cross(along).normalize_or_zero();
            let height = |point: DVec3| {
                let height = across.dot(point - start);
                if height.abs() <= self.tolerance { 0.0 } else { height }
            };
            let beyond = clipped(&within, |point| -height(point));
            within = clipped(&within, height);
            outside.extend((!beyond.is_empty()).then_some(beyond));
            if within.is_empty() {
                break;
            }
        }
        outside
    }
}

/// The part of a convex outline at a height of 0 and more; empty unless some corner is higher.
fn clipped(outline: &[DVec3], height: impl Fn(DVec3) -> f64) -> Vec<DVec3> {
    let mut kept = Vec::new();
    for (k, &point) in outline.iter().enumerate() {
        let next = outline[(k + 1) % outline.len()];
        let (h, h_next) = (height(point), height(next));
        if h >= 0.0 {
            kept.push(point);
        }
        if h * h_next < 0.0 {
            kept.push(point.lerp(next, h / (h - h_next)));
        }
    }
    if kept.iter().any(|&point| height(point) > 0.0) { kept } else { Vec::new() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rectangle(x: [f64; 2], y: [f64; 2]) -> Polygon {
        let p = |x, y| DVec3::new(x, y, 3.0);
        Polygon::quadrilateral(p(x[0], y[0]), p(x[1], y[0]), p(x[1], y[1]), p(x[0], y[1]))
    }

    fn area(polygons: &[Polygon]) -> f64 {
        polygons.iter().map(Polygon::area).sum()
    }

    #[test]
    fn windows_and_doors_leave_the_rest_of_the_wall() {
        let wall = rectangle([0.0, 5.0], [0.0, 3.0]);
        let mut region = Region::new(std::slice::from_ref(&wall));
        assert!(region.cut_out(&[rectangle([1.0, 2.0], [1.0, 2.0])]), "a window");
        assert!(region.cut_out(&[rectangle([3.0, 4.0], [0.0, 2.0])]), "a door, down to the floor");
        assert!(region.cut_out(&[rectangle([2.0, 3.0], [1.0, 2.0])]), "a window beside the other");
        let rest = region.polygons();
        assert!((area(&rest) - 11.0).abs() < 1e-12);
        assert!(rest.iter().all(|polygon| polygon.normal().distance(wall.normal()) < 1e-12));
        for (k, a) in rest.iter().enumerate() {
            assert!(rest[k + 1..].iter().all(|b| a.centroid().distance(b.centroid()) > 1e-3));
        }
    }

    #[test]
    fn a_part_outside_or_over_another_is_noticed() {
        let wall = [rectangle([0.0, 5.0], [0.0, 3.0])];
        assert!(!Region::new(&wall).cut_out(&[rectangle([4.0, 5.01], [1.0, 2.0])]));
        assert!(!Region::new(&wall).cut_out(&[rectangle([6.0, 7.0], [1.0, 2.0])]));
        let mut region = Region::new(&wall);
        assert!(region.cut_out(&[rectangle([1.0, 2.0], [1.0, 2.0])]));
        assert!(!region.cut_out(&[rectangle([1.99, 3.0], [1.0, 2.0])]));
    }

    #[test]
    fn nothing_is_left_of_what_is_covered() {
        let wall = [rectangle([0.0, 5.0], [0.0, 3.0])];
        let mut region = Region::new(&wall);
        assert!(region.cut_out(&[rectangle([0.0, 2.0], [0.0, 3.0])]));
        assert!(region.cut_out(&[rectangle([2.0, 5.0], [0.0, 3.0])]));
        assert!(region.polygons().is_empty());
    }
}
