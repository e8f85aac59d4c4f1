//! n(x) ∝ Σ_k λ_k(x) n_k: the normals of a curved surface that a polygon stands for (Phong, 1975).
//!
//! They are for the eye: form factors and the field are those of the flat polygon.

use super::Polygon;
use crate::patches::inverse_bilinear;
use glam::DVec3;

/// Why a polygon cannot have these normals.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NormalFault {
    /// There is not one for each vertex.
    #[error("not every corner has a normal")]
    Missing,
    /// One is zero or not finite.
    #[error("a normal is zero or not a finite number")]
    NoDirection,
    /// One points to the back of the polygon, or along it.
    #[error("a normal is 90 degrees or more from that of the polygon")]
    TurnedAway,
}

/// What a normal's cosine to the polygon's may miss 1 by and still be the polygon's own, which files write with four digits:
/// 1.4 mrad. A tenth of that would make curves of rounded walls; ten times as much shows as facets.
const FLAT: f64 = 1e-6;

impl Polygon {
    /// The same as a piece of a curved surface, with its normals at the vertices, of any length. Where all of them are
    /// those of the polygon it stays flat.
    ///
    /// # Errors
    ///
    /// When there is not one normal for each vertex, each with a direction in front of the polygon.
    pub fn with_normals(self, normals: &[DVec3]) -> Result<Self, NormalFault> {
        if normals.len() != self.vertices().len() {
            return Err(NormalFault::Missing);
        }
        let mut units = [self.normal; 4];
        for (unit, normal) in units.iter_mut().zip(normals) {
            // Halved by its largest coordinate first: the square of 1e200 is none.
            let size = normal.abs().max_element();
            *unit = (*normal / size).try_normalize().ok_or(NormalFault::NoDirection)?;
            if unit.dot(self.normal) <= TURNED_AWAY {
                return Err(NormalFault::TurnedAway);
            }
        }
        let is_flat = units.iter().all(|unit| unit.dot(self.normal) > 1.0 - FLAT);
        Ok(Self { normals: (!is_flat).then(|| Box::new(units)), ..self })
    }

    /// The same without the normals of a curved surface.
    pub fn flat(self) -> Self {
        Self { normals: None, ..self }
    }

    /// Whether it stands for a piece of a curved surface.
    pub fn is_curved(&self) -> bool {
        self.normals.is_some()
    }

    /// The curved surface where a point of the polygon lies: a point of it, and the unit normal there. The point and the
    /// polygon's own normal where it is flat.
    ///
    /// x′ = Σ λ_k (x − min(0, (x − v_k)·n_k) n_k): as far out as the planes through the vertices across their normals say
    /// (Hanika, *Hacking the shadow terminator*, 2021). From there a convex surface does not see itself, as from the polygon
    /// it would near the edge of its own shadow; where the surface is hollow x is kept.
    pub fn on_curve(&self, point: DVec3) -> (DVec3, DVec3) {
        let Some(normals) = &self.normals else { return (point, self.normal) };
        let shares = self.shares(point);
        let (mut out, mut normal) = (DVec3::ZERO, DVec3::ZERO);
        for ((share, vertex), n) in shares.into_iter().zip(&self.vertices).zip(normals.iter()) {
            out -= *n * (share * (point - *vertex).dot(*n).min(0.0));
            normal += *n * share;
        }
        (point + out, normal.normalize_or(self.normal))
    }

    /// λ_k: bilinear on a quadrilateral, linear on a triangle; of a point outside those of one on the rim near it.
    fn shares(&self, point: DVec3) -> [f64; 4] {
        let at = inverse_bilinear(self, point).clamp(glam::DVec2::ZERO, glam::DVec2::ONE);
        let (s, t) = (at.x, at.y);
        if self.sides == 4 {
            [(1.0 - s) * (1.0 - t), s * (1.0 - t), s * t, (1.0 - s) * t]
        } else {
            [(1.0 - s - t).max(0.0), s, t, 0.0]
        }
    }
}

/// A cosine that is none: nearer to 90 degrees no surface is lit to speak of.
const TURNED_AWAY: f64 = 1e-6;

#[cfg(test)]
mod tests {
    use super::*;

    fn p(x: f64, y: f64, z: f64) -> DVec3 {
        DVec3::new(x, y, z)
    }

    /// A triangle and a quadrilateral with their corners on the unit sphere about the origin.
    fn on_sphere() -> [Polygon; 2] {
        let at = |polar: f64, turn: f64| p(polar.sin() * turn.cos(), polar.sin() * turn.sin(), polar.cos());
        let triangle = Polygon::triangle(at(0.1, 0.0), at(0.5, 0.2), at(0.3, 1.1));
        let trapezoid = Polygon::quadrilateral(at(0.9, 0.0), at(0.9, 0.4), at(0.6, 0.4), at(0.6, 0.0));
        [triangle, trapezoid].map(|polygon| {
            let normals = polygon.vertices().to_vec();
            polygon.with_normals(&normals.iter().map(|n| 3.0 * *n).collect::<Vec<_>>()).unwrap()
        })
    }

    #[test]
    fn the_normals_of_a_sphere_lead_back_to_it() {
        for polygon in on_sphere() {
            for (s, t) in [(0.5, 0.5), (0.1, 0.8), (0.0, 0.0), (1.0, 0.3)] {
                let x = polygon.point(s, t);
                let (out, normal) = polygon.on_curve(x);
                assert!(normal.distance(x.normalize()) < 0.01, "{normal} at {x}");
                // Never within the sphere, of which the polygon is: else its rim would shade it. Nor beyond where the planes
                // through the corners meet, which are up to 0.28 from the middle: 1/cos 0.28.
                assert!((1.0 - 1e-12..1.041).contains(&out.length()), "{out}");
            }
            for (vertex, k) in polygon.vertices().iter().zip(0..) {
                let (out, normal) = polygon.on_curve(*vertex);
                assert!(normal.distance(*vertex) < 1e-12 && out.distance(*vertex) < 1e-12, "{k}");
            }
        }
    }

    #[test]
    fn a_hollow_surface_keeps_its_points() {
        let corners = [p(0.0, 0.0, -1.0), p(0.4, 0.0, -0.9), p(0.0, 0.4, -0.9)];
        let [a, b, c] = corners;
        let polygon = Polygon::triangle(a, b, c).with_normals(&corners.map(|v| -v)).unwrap();
        let x = polygon.centroid();
        assert!(polygon.on_curve(x).0.distance(x) < 1e-15);
        assert!(polygon.on_curve(x).1.distance(-x.normalize()) < 0.01);
    }

    #[test]
    fn normals_that_are_none_are_refused_and_those_of_the_polygon_make_no_curve() {
        let polygon = || Polygon::triangle(DVec3::ZERO, DVec3::X, DVec3::Y);
        let with = |last: DVec3| polygon().with_normals(&[DVec3::Z, 2.0 * DVec3::Z, last]);
        assert_eq!(polygon().with_normals(&[DVec3::Z; 2]), Err(NormalFault::Missing));
        for bad in [DVec3::ZERO, DVec3::NAN, p(f64::INFINITY, 0.0, 1.0)] {
            assert_eq!(with(bad), Err(NormalFault::NoDirection), "{bad}");
        }
        for bad in [DVec3::X, p(1.0, 0.0, -1e-3), -DVec3::Z] {
            assert_eq!(with(bad), Err(NormalFault::TurnedAway), "{bad}");
        }
        assert_eq!(with(p(0.0005, 0.0, 1.0)), Ok(polygon()));
        for good in [p(0.1, 0.0, 1.0), p(1e200, 0.0, 1e200), p(1e-300, 0.0, 1e-300)] {
            let curved = with(good).unwrap();
            assert!(curved.is_curved() && curved.on_curve(DVec3::Y).1.x > 0.09, "{good}");
            assert_eq!(curved.flat(), polygon());
        }
    }
}
