//! ∫ (a + b·ω) ω dω over a spherical polygon, in closed form: its scalar product with a normal is an irradiance.
//!
//! ∫ ω dω = ½ Σ θ_k N_k over the edges, with the angle θ_k of an edge and the unit normal N_k of its plane on the inner side, is
//! Lambert's; and ∫ ω ωᵀ dω = ⅓ (Ω 1 + Σ s_k N_kᵀ), where s_k = ∫ ω ds = (p + q) tan(θ_k/2) along the edge from p to q, is of
//! the tensors of J. Arvo, *Applications of irradiance tensors* (1995).

use glam::DVec3;

/// a + b·ω.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Affine {
    pub constant: f64,
    pub slope: DVec3,
}

impl Affine {
    /// The integral over what is inside of edges that go counter-clockwise about it, given by the directions of their corners,
    /// of any length; it is convex, and no two corners are opposite.
    pub fn moment(&self, corners: impl Iterator<Item = DVec3> + Clone) -> DVec3 {
        let mut units = corners.map(DVec3::normalize_or_zero);
        let Some(first) = units.next() else { return DVec3::ZERO };
        let (mut lambert, mut along, mut solid_angle) = (DVec3::ZERO, DVec3::ZERO, 0.0);
        let mut edge = |p: DVec3, q: DVec3| {
            let (cross, cosine) = (p.cross(q), p.dot(q));
            let sine = cross.length();
            if sine > 0.0 {
                let inner = cross / sine;
                lambert += inner * sine.atan2(cosine);
                along += (p + q) * (sine / (1.0 + cosine) * inner.dot(self.slope));
            }
        };
        let mut before = first;
        for corner in units {
            edge(before, corner);
            solid_angle += signed_solid_angle(first, before, corner);
            before = corner;
        }
        edge(before, first);
        lambert * (0.5 * self.constant) + (self.slope * solid_angle + along) / 3.0
    }
}

/// The solid angle of a triangle of unit vectors, in sr, after Van Oosterom and Strackee (1983).
fn signed_solid_angle(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let below = 1.0 + a.dot(b) + b.dot(c) + c.dot(a);
    2.0 * a.dot(b.cross(c)).atan2(below)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// The integral over the half of all directions about z, in four parts.
    fn over_half(function: Affine) -> DVec3 {
        let around = [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y];
        (0..4).map(|k| function.moment([around[k], around[(k + 1) % 4], DVec3::Z].into_iter())).sum()
    }

    #[test]
    fn a_hemisphere_has_its_moments() {
        assert!(over_half(Affine { constant: 1.0, slope: DVec3::ZERO }).distance(PI * DVec3::Z) < 1e-14);
        // ∫ ω_x ω = 2π/3 x, and ∫ ω_z ω = 2π/3 z.
        for slope in [DVec3::X, DVec3::Z, DVec3::new(0.3, -0.4, 2.0)] {
            let linear = Affine { constant: 0.0, slope };
            assert!(over_half(linear).distance(2.0 * PI / 3.0 * slope) < 1e-14);
        }
    }

    #[test]
    fn a_triangle_is_what_a_fine_sum_says() {
        let corners = [DVec3::new(1.0, 0.1, 0.2), DVec3::new(0.2, 1.0, 0.3), DVec3::new(-0.1, 0.2, 0.9)];
        let function = Affine { constant: 0.7, slope: DVec3::new(0.5, -0.8, 0.3) };
        // The part of a grid of cells over the box that looks through the triangle's plane: dω = h/r³ dA.
        let [a, b, c] = corners;
        let doubled = (b - a).cross(c - a);
        let n = 800;
        let mut sum = DVec3::ZERO;
        for i in 0..n {
            for j in 0..n - i {
                let at = |s: f64, t: f64| a + (b - a) * (s / f64::from(n)) + (c - a) * (t / f64::from(n));
                let (i, j, half) = (f64::from(i), f64::from(j), 1.0 / 3.0);
                let mut add = |x: DVec3| {
                    let solid = 0.5 * doubled.dot(x) / x.length().powi(3) / f64::from(n * n);
                    let omega = x.normalize();
                    sum += omega * (solid * (function.constant + function.slope.dot(omega)));
                };
                add(at(i + half, j + half));
                if i + j + 1.5 < f64::from(n) {
                    add(at(i + 2.0 * half, j + 2.0 * half));
                }
            }
        }
        let found = function.moment(corners.into_iter());
        assert!(found.distance(sum) < 1e-5 * sum.length(), "{found} {sum}");
    }

    #[test]
    fn parts_add_up() {
        let [a, b, c] = [DVec3::X, DVec3::Y, DVec3::Z];
        let function = Affine { constant: 0.7, slope: DVec3::new(0.5, -0.8, 0.3) };
        let middle = (a + b) * 3.0;
        let parts = function.moment([a, middle, c].into_iter()) + function.moment([middle, b, c].into_iter());
        assert!(parts.distance(function.moment([a, b, c].into_iter())) < 1e-15);
    }
}
