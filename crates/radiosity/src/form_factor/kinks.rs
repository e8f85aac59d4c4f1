//! Where the form factor from x to what is hidden of a polygon has kinks, as a function of x: on the straight lines along
//! which a vertex of the polygon stands behind an edge of what hides it, or a vertex of that before an edge of the polygon.
//!
//! Between these lines it is smooth, but for where the edges of two hiders cross before an edge of the polygon.

use super::hider::{Edge, Hider};
use super::outline::Outline;
use glam::DVec3;

/// An affine function of x.
#[derive(Clone, Copy, Debug)]
struct Affine {
    normal: DVec3,
    foot: DVec3,
}

impl Affine {
    const ZERO: Self = Self { normal: DVec3::ZERO, foot: DVec3::ZERO };

    /// x ↦ det[to − x, from − x, v − x]: on which side of the plane through x and an edge a point is.
    fn side(from: DVec3, to: DVec3, v: DVec3) -> Self {
        Self { normal: (from - v).cross(to - v), foot: v }
    }

    fn at(&self, x: DVec3) -> f64 {
        self.normal.dot(x - self.foot)
    }
}

/// A line in the plane of x on which there may be a kink, where two functions are not negative.
#[derive(Clone, Copy, Debug)]
pub(super) struct Kink {
    line: Affine,
    within: [Affine; 2],
}

/// A kink nearer to a corner than this part of a cell is of no account.
const LEAST_PART: f64 = 1e-6;

/// A height below this part of the lengths' product is rounding.
const ROUNDING: f64 = 1e-12;

impl Kink {
    /// How evenly it cuts a convex cell: the least height of a corner on the side of fewer over the greatest on that of more, by
    /// which its line divides the cell; 0 if it does not reach into it.
    pub fn cuts(&self, cell: &[DVec3]) -> f64 {
        let heights = cell.iter().map(|x| self.line.at(*x));
        let (low, high) = heights.fold((0.0_f64, 0.0_f64), |(l, h), x| (l.min(x), h.max(x)));
        let evenness = (-low).min(high) / (high - low);
        // NaN is where both are 0.
        if evenness > LEAST_PART && self.within.iter().all(|within| self.reaches(cell, within)) {
            evenness
        } else {
            0.0
        }
    }

    /// Whether a function is not negative on all of the line in a cell.
    fn reaches(&self, cell: &[DVec3], within: &Affine) -> bool {
        if within.normal == DVec3::ZERO {
            return true;
        }
        let mut before = cell[cell.len() - 1];
        let mut height = self.line.at(before);
        cell.iter().any(|&x| {
            let h = self.line.at(x);
            let crosses = (h < 0.0) != (height < 0.0);
            // The function at the crossing, times a number above 0.
            let there = (within.at(before) * h - within.at(x) * height) * (h - height).signum();
            (before, height) = (x, h);
            crosses && there > 0.0
        })
    }

    /// The height of a point over its line.
    pub fn height_of(&self, x: DVec3) -> f64 {
        self.line.at(x)
    }
}

/// All kinks that `hiders` make of `target` and that divide the convex polygon with these corners.
pub(super) fn kinks(corners: &[DVec3], target: &Outline, hiders: &[Hider], reach: f64) -> Vec<Kink> {
    let mut kinks = Vec::new();
    let mut add = |line: Affine, within: [Affine; 2]| {
        let kink = Kink { line, within };
        let rounding = ROUNDING * reach * reach * reach;
        if corners.iter().any(|x| line.at(*x).abs() > rounding) && kink.cuts(corners) > 0.0 {
            kinks.push(kink);
        }
    };
    for hider in hiders {
        let neighbour = |joins: &dyn Fn(&Edge) -> bool| hider.edges().iter().find(|edge| joins(edge));
        // Seen from both sides it has no inner side.
        let side = |edge: Option<&Edge>, v: DVec3| match edge {
            Some(edge) if hider.straddled.is_none() => Affine::side(edge.from, edge.to, v),
            _ => Affine::ZERO,
        };
        for edge in hider.edges() {
            let before = neighbour(&|other| other.to == edge.from);
            let after = neighbour(&|other| other.from == edge.to);
            if !edge.inner {
                for v in target.vertices() {
                    add(Affine::side(edge.from, edge.to, v), [side(before, v), side(after, v)]);
                }
            }
            if after.is_some_and(|after| !(edge.inner && after.inner)) {
                vertex_kinks(edge.to, target, &mut add);
            }
        }
        if let Some(plane) = hider.straddled {
            let line = Affine { normal: plane.normal * reach * reach, foot: plane.normal * plane.offset };
            add(line, [Affine::ZERO; 2]);
        }
    }
    kinks
}

/// Where a hider's vertex is before an edge of the target.
fn vertex_kinks(o: DVec3, target: &Outline, add: &mut impl FnMut(Affine, [Affine; 2])) {
    let count = target.len();
    let side = |k: usize| Affine::side(target.vertex(k % count), target.vertex((k + 1) % count), o);
    for k in 0..count {
        add(side(k), [side(k + count - 1), side(k + 1)]);
    }
}
