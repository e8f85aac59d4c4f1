//! Where the form factor from x to what is hidden of a polygon has kinks, as a function of x: on the straight lines along
//! which a vertex of the polygon stands behind an edge of what hides it, or a vertex of that before an edge of the polygon.
//!
//! Between these lines it is smooth, but for where the edges of two hiders cross before an edge of the polygon.

use super::outline::Outline;
use super::shadow::Hider;
use crate::polygon::Polygon;
use glam::DVec3;

/// A segment in the plane of x on which there may be a kink.
#[derive(Clone, Copy, Debug)]
pub(super) struct Kink {
    ends: [DVec3; 2],
    /// A normal of the segment in the plane of x, of length 1, and where it lies along it.
    normal: DVec3,
    offset: f64,
}

/// A triangle of the plane of x.
pub(super) type Cell = [DVec3; 3];

impl Kink {
    fn new(p: DVec3, q: DVec3, plane: DVec3) -> Option<Self> {
        let normal = (q - p).cross(plane).normalize_or_zero();
        (normal != DVec3::ZERO).then(|| Self { ends: [p, q], normal, offset: normal.dot(p) })
    }

    /// How evenly it cuts a cell: the least height of a corner on the side of one over the greatest on that of two, by
    /// which their line divides the cell; 0 if it does not reach into it.
    pub fn cuts(&self, cell: &Cell, plane: DVec3) -> f64 {
        let heights = cell.map(|v| self.normal.dot(v) - self.offset);
        let (low, high) = heights.iter().fold((0.0_f64, 0.0_f64), |(l, h), x| (l.min(*x), h.max(*x)));
        let evenness = (-low).min(high) / (high - low);
        if evenness.is_nan() || evenness <= LEAST_PART {
            return 0.0;
        }
        let apart = (0..3).any(|k| {
            let inward = plane.cross(cell[(k + 1) % 3] - cell[k]);
            self.ends.iter().all(|end| inward.dot(*end - cell[k]) <= 0.0)
        });
        if apart { 0.0 } else { evenness }
    }

    /// The two or three triangles that its line makes of a cell.
    pub fn divide(&self, cell: &Cell) -> Vec<Cell> {
        let heights = cell.map(|v| self.normal.dot(v) - self.offset);
        // The corner that is alone on its side, and the points opposite to it where the line leaves the cell.
        let alone = (0..3).find(|&k| {
            let others = [heights[(k + 1) % 3], heights[(k + 2) % 3]];
            heights[k] != 0.0 && others.iter().all(|h| h * heights[k] <= 0.0)
        });
        let Some(k) = alone else { return vec![*cell] };
        let [a, b, c] = [cell[k], cell[(k + 1) % 3], cell[(k + 2) % 3]];
        let [h, g, f] = [heights[k], heights[(k + 1) % 3], heights[(k + 2) % 3]];
        let (ab, ac) = (a.lerp(b, h / (h - g)), a.lerp(c, h / (h - f)));
        let parts = [[a, ab, ac], [ab, b, c], [ab, c, ac]];
        parts.into_iter().filter(|[a, b, c]| (*b - *a).cross(*c - *a).length_squared() > 0.0).collect()
    }
}

/// A kink nearer to a corner than this part of the cell is of no account.
const LEAST_PART: f64 = 1e-6;

/// All kinks on the plane of `outer` that `hiders` make of `target`.
pub(super) fn kinks(outer: &Polygon, target: &Outline, hiders: &[Hider]) -> Vec<Kink> {
    let plane = outer.normal();
    let reach = 4.0 * outer.diameter();
    let (middle, rounding) = (outer.centroid(), 1e-9 * reach);
    let height = |v: DVec3| outer.height_of(v);
    let mut kinks = Vec::new();
    let mut add = |p: Option<DVec3>, q: Option<DVec3>| {
        if let (Some(p), Some(q)) = (p, q) {
            kinks.extend(Kink::new(p, q, plane).filter(|kink| {
                let side = |v: &DVec3| kink.normal.dot(*v) > kink.offset;
                let first = side(&outer.vertices()[0]);
                outer.vertices().iter().any(|v| side(v) != first)
            }));
        }
    };
    for (index, hider) in hiders.iter().enumerate() {
        let outer_edge = |(p, q): (DVec3, DVec3)| {
            let on_plane = height(p).abs() <= rounding && height(q).abs() <= rounding;
            !on_plane && !is_inner(hiders, index, p, q)
        };
        let count = hider.outline.len();
        let is_outer: Vec<bool> = ring(&hider.outline).map(outer_edge).collect();
        for (k, (o, next)) in ring(&hider.outline).enumerate() {
            if is_outer[k] {
                for v in target.vertices() {
                    let [p, q] = projected_edge([o, next], height, height(v));
                    add(through(v, p, height), through(v, q, height));
                }
            }
            if is_outer[k] || is_outer[(k + count - 1) % count] {
                for (v, w) in ring(target) {
                    let [p, q] = projected_edge([v, w], |v| -height(v), -height(o));
                    add(through(p, o, height), through(q, o, height));
                }
            }
        }
        if hider.straddled {
            let along = plane.cross(hider.normal).normalize_or_zero();
            let across = along.cross(plane);
            let foot = middle - across * (hider.height_of(middle) / hider.normal.dot(across));
            add(Some(foot - along * reach), Some(foot + along * reach));
        }
    }
    kinks
}

/// Whether an edge lies inside of the shadow of two hiders, seen from all points from the same side.
fn is_inner(hiders: &[Hider], index: usize, p: DVec3, q: DVec3) -> bool {
    let hider = &hiders[index];
    !hider.straddled
        && hiders.iter().enumerate().any(|(other, candidate)| {
            other != index
                && !candidate.straddled
                && candidate.in_front == hider.in_front
                && has_edge(&candidate.outline, q, p)
        })
}

fn has_edge(outline: &Outline, p: DVec3, q: DVec3) -> bool {
    let near = 1e-18 * p.distance_squared(q);
    ring(outline).any(|(v, w)| v.distance_squared(p) <= near && w.distance_squared(q) <= near)
}

/// The edges of an outline.
fn ring(outline: &Outline) -> impl Iterator<Item = (DVec3, DVec3)> {
    let count = outline.len();
    (0..count).map(move |k| (outline.vertex(k), outline.vertex(if k + 1 == count { 0 } else { k + 1 })))
}

/// The part of an edge that is lower than a height, or nearly: what is as high has no shadow at a finite place.
fn projected_edge(ends: [DVec3; 2], height: impl Fn(DVec3) -> f64, top: f64) -> [DVec3; 2] {
    let heights = ends.map(&height);
    let limit = top - 1e-3 * (heights[0] - heights[1]).abs();
    let cut = |k: usize| {
        let (h, other) = (heights[k], heights[1 - k]);
        if h > limit && other < limit {
            ends[1 - k].lerp(ends[k], (limit - other) / (h - other))
        } else {
            ends[k]
        }
    };
    [cut(0), cut(1)]
}

/// Where the ray from a target point v through a hider's point o meets the plane of height 0, if it does.
fn through(v: DVec3, o: DVec3, height: impl Fn(DVec3) -> f64) -> Option<DVec3> {
    let (from, to) = (height(v), height(o));
    (to < from && from > 0.0).then(|| v + (o - v) * (from / (from - to)))
}
