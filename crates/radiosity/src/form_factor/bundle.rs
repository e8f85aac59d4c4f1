//! What a hider leaves in the dark of a polygon, from eight points at once.
//!
//! Between two kinks all points clip the polygon alike: the same vertices are cut off, the same edges are cut. So the
//! eight go side by side, one a lane, as long as they agree. All seven nodes of a cell take as long as two did one by one.

use super::hider::Hider;
use super::outline::{MOST, Outline};
use glam::DVec3;
use std::f64::consts::TAU;
use wide::f64x8;

/// A point or a vector in each lane.
pub(super) type Lanes = [f64x8; 3];

/// A convex polygon as it is seen from eight points.
#[derive(Clone, Debug)]
struct Bundle {
    vertices: [Lanes; MOST],
    count: usize,
}

/// Room for a polygon, and for what is left of it.
#[derive(Clone, Debug)]
pub(super) struct Bundles([Bundle; 2]);

impl Default for Bundles {
    fn default() -> Self {
        let empty = Bundle { vertices: [[f64x8::ZERO; 3]; MOST], count: 0 };
        Self([empty.clone(), empty])
    }
}

/// The part of the lengths' product that a height may be below 0 by and still count as 0.
const ROUNDING: f64 = 1e-14;

/// The form factor from each x, where the normal is n, to what the hider hides of a polygon; none if the points do not
/// agree on which edges are cut.
pub(super) fn hidden(
    target: &Outline,
    hider: &Hider,
    x: &Lanes,
    n: DVec3,
    Bundles([whole, next]): &mut Bundles,
) -> Option<f64x8> {
    if hider.straddled.is_some() {
        return None;
    }
    for (place, v) in whole.vertices.iter_mut().zip(target.vertices()) {
        *place = towards(v, x);
    }
    whole.count = target.len();
    let (mut part, mut next) = (whole, next);
    for edge in hider.edges() {
        let plane = cross(&towards(edge.to, x), &towards(edge.from, x));
        match part.cut(&plane, next)? {
            Cut::Nothing => return Some(f64x8::ZERO),
            Cut::Part => (part, next) = (next, part),
            Cut::All => (),
        }
    }
    Some(part.form_factor(n))
}

/// How much of a polygon is above a plane.
enum Cut {
    Nothing,
    Part,
    All,
}

impl Bundle {
    /// What is above planes through the eyes, into `part` if it is a part.
    #[inline(always)]
    fn cut(&self, plane: &Lanes, part: &mut Self) -> Option<Cut> {
        let size = plane[0].abs() + plane[1].abs() + plane[2].abs();
        let mut heights = [f64x8::ZERO; MOST];
        let mut above = 0_u32;
        for (k, (height, v)) in heights.iter_mut().zip(&self.vertices[..self.count]).enumerate() {
            *height = dot(plane, v);
            let rounding = size * (v[0].abs() + v[1].abs() + v[2].abs()) * ROUNDING;
            match height.simd_ge(-rounding).to_bitmask() & 0xff {
                0xff => above |= 1 << k,
                0 => (),
                _ => return None,
            }
        }
        if above == 0 {
            return Some(Cut::Nothing);
        }
        if above + 1 == 1 << self.count {
            return Some(Cut::All);
        }
        part.count = 0;
        let mut before = self.count - 1;
        for k in 0..self.count {
            let (was, is) = (above >> before & 1, above >> k & 1);
            if was != is {
                let (h, g) = (heights[before], heights[k]);
                let share = h / (h - g);
                let (from, to) = (&self.vertices[before], &self.vertices[k]);
                part.push(std::array::from_fn(|axis| from[axis] + share * (to[axis] - from[axis])));
            }
            if is == 1 {
                part.push(self.vertices[k]);
            }
            before = k;
        }
        Some(if part.count < 3 { Cut::Nothing } else { Cut::Part })
    }

    fn push(&mut self, v: Lanes) {
        if self.count < MOST {
            self.vertices[self.count] = v;
            self.count += 1;
        }
    }

    /// Lambert's formula, (1/2π) Σ_k Γ_k · n; see [`lambert`](super::lambert).
    fn form_factor(&self, n: DVec3) -> f64x8 {
        let mut turned = f64x8::ZERO;
        let mut before = &self.vertices[self.count - 1];
        for v in &self.vertices[..self.count] {
            turned += along_normal(n, before, v);
            before = v;
        }
        (turned * (-1.0 / TAU)).max(f64x8::ZERO)
    }
}

/// Γ · n: the angle of the edge from a to b as seen from the origin, along the normal of the plane through both.
#[inline(always)]
fn along_normal(n: DVec3, a: &Lanes, b: &Lanes) -> f64x8 {
    let c = cross(a, b);
    let (square, cosine) = (dot(&c, &c), dot(a, b));
    let along = c[0] * n.x + c[1] * n.y + c[2] * n.z;
    let terms = along * angle_over_sine(square, cosine);
    // An edge that is a point, or passes through the origin, is 0/0 there.
    square.simd_gt(f64x8::ZERO).select(terms, f64x8::ZERO)
}

/// atan2(s, c)/s from s² and c, by the series of arctan after as many halvings of the angle as bring it below π/8.
///
/// No root is taken of the edges that are seen under a small angle, which most are.
#[inline(always)]
fn angle_over_sine(square: f64x8, cosine: f64x8) -> f64x8 {
    let limit = f64x8::splat(LIMIT);
    // tan² of the angle, and the angle over s divided by arctan over tan.
    let mut factor = f64x8::ONE / cosine;
    let mut tangent = square * factor * factor;
    let small = cosine.simd_gt(f64x8::ZERO) & tangent.simd_le(limit);
    if !small.all() {
        let half = f64x8::ONE / (cosine + (square + cosine * cosine).sqrt());
        (factor, tangent) = (half * 2.0, square * half * half);
        while tangent.simd_gt(limit).any() {
            let half = f64x8::ONE / (f64x8::ONE + (f64x8::ONE + tangent).sqrt());
            // From an edge through the eye, which is not counted, ∞ would come again for ever.
            (factor, tangent) = (factor * half * 2.0, (tangent * half * half).min(f64x8::ONE));
        }
    }
    ARCTAN.iter().rev().fold(f64x8::ZERO, |sum, &c| sum.mul_add(tangent, f64x8::splat(c))) * factor
}

/// tan²(π/8) = 3 − 2√2.
const LIMIT: f64 = 0.171_572_875_253_809_9;

/// arctan(√z)/√z on [0, [`LIMIT`]] by powers of z, with an error of 3.5·10⁻¹⁷: its best polynomial of degree 10.
const ARCTAN: [f64; 11] = [
    0.999_999_999_999_999_97,
    -0.333_333_333_333_284_4,
    0.199_999_999_988_551_1,
    -0.142_857_141_809_764_67,
    0.111_111_061_804_559_45,
    -0.090_907_730_748_084_14,
    0.076_899_534_963_068_58,
    -0.066_402_339_304_294_1,
    0.056_883_492_268_090_105,
    -0.043_480_522_157_164_62,
    0.021_135_373_157_693_245,
];

fn towards(v: DVec3, x: &Lanes) -> Lanes {
    std::array::from_fn(|axis| f64x8::splat(v[axis]) - x[axis])
}

fn cross(a: &Lanes, b: &Lanes) -> Lanes {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: &Lanes, b: &Lanes) -> f64x8 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::super::hider::{Edge, Scene};
    use super::super::shadow::{Room, Shadows};
    use super::*;

    #[test]
    fn eight_points_see_what_each_sees_alone() {
        let p = |x, y, z| DVec3::new(x, y, z);
        let target = Outline::new(&[p(0.0, 0.0, 2.0), p(0.0, 1.0, 2.0), p(1.0, 1.0, 2.0), p(1.0, 0.0, 2.0)]);
        let eyes = [p(0.1, 0.2, 0.0), p(0.3, 0.2, 0.0), p(0.2, 0.4, 0.0)];
        // A corner of the screen is before the target, and so one of each is cut off.
        let screen = [p(0.3, 0.3, 1.0), p(5.0, 0.3, 1.0), p(5.0, 5.0, 1.0), p(0.3, 5.0, 1.0)];
        let edges = (0..4).map(|k| Edge { from: screen[(k + 1) % 4], to: screen[k], inner: false });
        let scene = Scene::new(&eyes, &target, 5.0);
        let hider = Hider::of_edges(edges, &scene).ok().flatten().expect("something is hidden");
        assert_eq!(hider.edges().len(), 2);
        let points: [DVec3; 8] = std::array::from_fn(|k| eyes[0].lerp(eyes[1 + k % 2], k as f64 / 8.0));
        let lanes: Lanes = std::array::from_fn(|axis| f64x8::new(points.map(|x| x[axis])));
        let together =
            hidden(&target, &hider, &lanes, DVec3::Z, &mut Bundles::default()).expect("they agree");
        let shadows = Shadows { target, normal: DVec3::Z, hiders: &[hider] };
        for (x, got) in points.iter().zip(together.to_array()) {
            let alone = shadows.hidden(*x, &mut Room::default());
            assert!(alone > 0.01 && (got - alone).abs() < 1e-15, "{got} is {alone}");
        }
    }

    #[test]
    fn the_angle_over_its_sine_is_exact_to_rounding_at_any_angle() {
        for k in 0..4000 {
            let angle = std::f64::consts::PI * f64::from(k) / 4000.0 + 1e-9;
            for size in [1e-3, 1.0, 1e4] {
                let (sine, cosine) = (size * angle.sin(), size * angle.cos());
                let got = angle_over_sine(f64x8::splat(sine * sine), f64x8::splat(cosine)).to_array()[3];
                let expected = sine.atan2(cosine) / sine;
                assert!(
                    (got / expected - 1.0).abs() < 3e-15 / (1.0 - angle / 3.2),
                    "{angle}: {got} {expected}"
                );
            }
        }
    }
}
