//! Patches side by side that look at the same things, eight at a time: a column of links is as many form factors of one sender.

use super::clusters::Sender;
use crate::polygon::Polygon;
use glam::DVec3;
use std::f64::consts::PI;
use wide::f64x8;

/// Eight numbers for each axis.
type Points = [f64x8; 3];

/// How many patches look together.
pub(super) const LANES: usize = 8;

/// Up to eight patches; what is missing has no normal and sees nothing.
pub(super) struct Eyes {
    normal: Points,
    area: f64x8,
    centroid: Points,
    /// Where clusters are looked at from.
    from: Vec<Points>,
    /// Where patches not far away are.
    gauss: [Points; 4],
}

/// A patch this many times the size of both away is a point.
const POINT: f64 = 12.0;

/// From so many on it is four: as one it would be up to 4 % too bright, and all of a building with large patches 1.5 %.
const POINTS: f64 = 4.0;

impl Eyes {
    /// Of at most eight patches. They look at clusters from their middles, or from four points if `fine`.
    pub fn new(patches: &[Polygon], fine: bool) -> Self {
        let lane = |of: &dyn Fn(&Polygon) -> f64| {
            f64x8::new(std::array::from_fn(|k| patches.get(k).map_or(0.0, of)))
        };
        let points = |of: &dyn Fn(&Polygon) -> DVec3| std::array::from_fn(|axis| lane(&|p| of(p)[axis]));
        let centroid = points(&Polygon::centroid);
        let at = |nodes: [[f64; 2]; 4]| nodes.map(|[s, t]| points(&|patch| patch.point(s, t)));
        Self {
            normal: points(&Polygon::normal),
            area: lane(&Polygon::area),
            centroid,
            from: if fine { at(QUARTERS).to_vec() } else { vec![centroid] },
            gauss: at(GAUSS),
        }
    }

    /// The form factors to an element of area.
    pub fn to_element(&self, sender: &Sender) -> f64x8 {
        let each = self.from.iter().map(|from| self.seen(from, sender.centre, sender.front));
        each.fold(f64x8::ZERO, |sum, factor| sum + factor) * f64x8::splat((self.from.len() as f64).recip())
    }

    /// The form factors to another patch, as a point where it is far, as four where it is less far and they are not to be `fine`;
    /// `None` where it is near.
    pub fn to_patch(&self, sender: &Sender, patch: &Polygon, fine: bool) -> [Option<f64>; LANES] {
        let square = square(&towards(&self.centroid, sender.centre));
        let size = self.area.fast_max(f64x8::splat(sender.front.length()));
        let beyond = |times: f64| square.simd_gt(f64x8::splat(times * times) * size).to_bitmask();
        let far = beyond(POINT);
        let apart = if fine { far } else { beyond(POINTS) };
        let point = self.seen(&self.centroid, sender.centre, sender.front).to_array();
        let points =
            if far == apart { f64x8::ZERO } else { self.seen_from_all(patch, sender.front) }.to_array();
        let is = |bits: u32, k: usize| bits >> k & 1 == 1;
        std::array::from_fn(|k| is(apart, k).then(|| if is(far, k) { point[k] } else { points[k] }))
    }

    /// The mean from four points to four.
    fn seen_from_all(&self, patch: &Polygon, front: DVec3) -> f64x8 {
        let mut sum = f64x8::ZERO;
        for [s, t] in GAUSS {
            let y = patch.point(s, t);
            for from in &self.gauss {
                sum += self.seen(from, y, front);
            }
        }
        sum * f64x8::splat(1.0 / 16.0)
    }

    /// From points of the patches to an element of area, whose normal times its area is `front`: cos θ cos θ' A/(π r²).
    fn seen(&self, from: &Points, at: DVec3, front: DVec3) -> f64x8 {
        let between = towards(from, at);
        let square = square(&between);
        let leaves = dot(&between, &self.normal);
        let arrives = -dot(&between, &front.to_array().map(f64x8::splat));
        let faces = leaves.simd_gt(f64x8::ZERO) & arrives.simd_gt(f64x8::ZERO);
        faces.select(leaves * arrives / (f64x8::splat(PI) * square * square), f64x8::ZERO)
    }
}

fn towards(from: &Points, at: DVec3) -> Points {
    std::array::from_fn(|axis| f64x8::splat(at[axis]) - from[axis])
}

fn dot(a: &Points, b: &Points) -> f64x8 {
    a[0].mul_add(b[0], a[1].mul_add(b[1], a[2] * b[2]))
}

fn square(a: &Points) -> f64x8 {
    dot(a, a)
}

/// The points of a square that integrate cubics.
const GAUSS: [[f64; 2]; 4] = {
    const NEAR: f64 = 0.211_324_865_405_187_1;
    const FAR: f64 = 1.0 - NEAR;
    [[NEAR, NEAR], [NEAR, FAR], [FAR, NEAR], [FAR, FAR]]
};

/// The middles of its quarters.
pub(super) const QUARTERS: [[f64; 2]; 4] = [[0.25, 0.25], [0.25, 0.75], [0.75, 0.25], [0.75, 0.75]];

#[cfg(test)]
mod tests {
    use super::super::clusters::cornell_clusters;
    use super::*;

    #[test]
    fn eight_patches_see_what_each_does_alone() {
        let (_, clusters) = cornell_clusters(0.04);
        let patches = &clusters.polygons[40..46];
        let eyes = Eyes::new(patches, false);
        let mut counts = [0; 2];
        for (leaf, patch) in clusters.tree.leaves().zip(&clusters.polygons) {
            let sender = clusters.sender(leaf);
            let as_elements = eyes.to_element(sender).to_array();
            let as_patches = eyes.to_patch(sender, patch, false);
            for (k, here) in patches.iter().enumerate() {
                let alone = |x: DVec3, y: DVec3| Sender { centre: y, ..*sender }.seen_from(x, here.normal());
                let middle = alone(here.centroid(), patch.centroid());
                assert!(
                    (as_elements[k] - middle).abs() <= 1e-14 * middle.max(1e-3),
                    "{} is not {middle}",
                    as_elements[k]
                );
                let size = here.area().max(sender.front.length()).sqrt();
                let apart = here.centroid().distance(patch.centroid()) / size;
                let nodes = GAUSS.map(|[s, t]| (here.point(s, t), patch.point(s, t)));
                let pairs = nodes.iter().flat_map(|(x, _)| nodes.iter().map(|(_, y)| alone(*x, *y)));
                let expected = match apart {
                    far if far > POINT => Some(middle),
                    middling if middling > POINTS => Some(pairs.sum::<f64>() / 16.0),
                    _ => None,
                };
                let close =
                    |(seen, expected): (f64, f64)| (seen - expected).abs() <= 1e-14 * expected.max(1e-3);
                assert!(
                    as_patches[k].zip(expected).map_or(as_patches[k] == expected, close),
                    "{:?} is not {expected:?}, {apart} sizes away",
                    as_patches[k]
                );
                counts[0] += usize::from(apart > POINT && middle > 0.0);
                counts[1] += usize::from(expected.is_some_and(|factor| factor > 0.0) && apart <= POINT);
            }
            assert_eq!(as_elements[6..], [0.0; 2], "there are but six");
        }
        assert!(counts[0] > 100 && counts[1] > 100, "{counts:?} pairs far and less far that see each other");
    }
}
