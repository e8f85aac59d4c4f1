//! H(x) = Σ I cosθ V / r²: what point lights send to surfaces, which makes the equation's source f = E + ρ H.
//!
//! ∫ cosθ/r² dA over a polygon is the solid angle Ω under which the light sees it, and for a diffuse light ∫ cosθ′ cosθ/r² dA
//! is π times Lambert's form factor: both are exact. A patch that lies partly in shadow is cut along its edge.

use crate::form_factor::lambert::point_to_polygon;
use crate::kernel::SurfacePoint;
use crate::patches::Patches;
use crate::polygon::Polygon;
use crate::reconstruct::{Rotation, lattice};
use crate::scene::PointLight;
use crate::visibility::Visibility;
use fredholm::value::Value;
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::PI;

/// The irradiance at a point from lights that nothing hides from it, in W/m² or lx: exact, with one ray to each light.
pub fn irradiance<V: Value>(lights: &[PointLight<V>], visibility: &Visibility, at: &SurfacePoint) -> V {
    lights.iter().fold(V::splat(0.0), |sum, light| {
        let part = unoccluded(light, at);
        if part > 0.0 && arrives(visibility, light.position, at.position) {
            sum + light.intensity * part
        } else {
            sum
        }
    })
}

/// The mean irradiance of each patch from the lights of its scene, in W/m² or lx: exact in full light and in full shadow, and
/// to some thousandths of the light across an edge of a shadow.
pub fn mean_irradiances<V: Value>(patches: &Patches<V>, visibility: &Visibility) -> Vec<V> {
    if patches.lights.is_empty() {
        return vec![V::splat(0.0); patches.len()];
    }
    let mean = |patch: &Polygon| {
        patches.lights.iter().fold(V::splat(0.0), |sum, light| {
            sum + light.intensity * (lit(light, visibility, patch, 0) / patch.area())
        })
    };
    patches.polygons.par_iter().map(mean).collect()
}

/// cosθ/r² times the part of the intensity that goes there, in sr/m².
fn unoccluded<V>(light: &PointLight<V>, at: &SurfacePoint) -> f64 {
    let between = light.position - at.position;
    let distance = between.length();
    let cosine = between.dot(at.normal) / distance;
    if cosine > 0.0 { light.part_towards(at.position) * cosine / (distance * distance) } else { 0.0 }
}

/// Whether nothing is between a light and a point of a surface. The light may be anywhere, outside of all walls too, where
/// only the nearest hit leaves out none of them.
fn arrives(visibility: &Visibility, light: DVec3, point: DVec3) -> bool {
    let between = light - point;
    let distance = between.length();
    // A light on a surface is not hidden by it.
    visibility
        .nearest(point, between / distance)
        .is_none_or(|hit| hit.distance > distance * (1.0 - ON_SURFACE))
}

/// How near the end of a ray counts as its end.
const ON_SURFACE: f64 = 1e-9;

/// The corners of a patch in the coordinates of [`Polygon::point`], a thousandth within; and how many points between them are
/// looked at, of which no two have the same coordinate: an edge along the sides of the patch is found to a 16th as well.
const CORNERS: [(f64, f64); 4] = [(0.001, 0.001), (0.999, 0.001), (0.999, 0.999), (0.001, 0.999)];
const BETWEEN: usize = 16;

/// How often a patch is cut in four along the edge of a shadow: of the 4⁵ parts some 40 are on the edge, of each of which a
/// 16th is in doubt, which is 10⁻³ of the patch if all err alike.
const CUTS: u32 = 5;

/// ∫ over a polygon of cosθ/r² V times the part of the intensity that goes there, in sr.
fn lit<V>(light: &PointLight<V>, visibility: &Visibility, polygon: &Polygon, cuts: u32) -> f64 {
    let whole = whole(light, polygon);
    if whole == 0.0 {
        return 0.0;
    }
    let in_light = |(s, t): (f64, f64)| arrives(visibility, light.position, polygon.point(s, t));
    let count = lattice(BETWEEN, Rotation::NONE).filter(|at| in_light(*at)).count();
    let corners = CORNERS.into_iter().filter(|at| in_light(*at)).count();
    match (count, corners) {
        (0, 0) => 0.0,
        (BETWEEN, 4) => whole,
        _ if cuts == CUTS => whole * count as f64 / BETWEEN as f64,
        _ => polygon.quarters().iter().map(|part| lit(light, visibility, part, cuts + 1)).sum(),
    }
}

/// The same with nothing in between.
fn whole<V>(light: &PointLight<V>, polygon: &Polygon) -> f64 {
    match light.direction {
        Some(direction) => PI * point_to_polygon(light.position, direction, polygon),
        None if polygon.height_of(light.position) > 0.0 => {
            polygon.triangles().map(|corners| solid_angle(corners.map(|v| v - light.position))).sum()
        }
        None => 0.0,
    }
}

/// The solid angle of a triangle seen from the origin, in sr: tan(Ω/2) of Van Oosterom and Strackee (1983).
fn solid_angle([a, b, c]: [DVec3; 3]) -> f64 {
    let [x, y, z] = [a, b, c].map(DVec3::length);
    let below = x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y;
    2.0 * a.dot(b.cross(c)).abs().atan2(below)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ISOTROPIC: PointLight<f64> =
        PointLight { position: DVec3::new(0.3, -0.2, 1.5), intensity: 1.0, direction: None };

    fn square(z: f64, half: f64) -> Polygon {
        let p = |x, y| DVec3::new(x, y, z);
        Polygon::quadrilateral(p(-half, -half), p(half, -half), p(half, half), p(-half, half))
    }

    fn lights() -> [PointLight<f64>; 3] {
        let towards = |x, y, z| Some(DVec3::new(x, y, z).normalize());
        [
            ISOTROPIC,
            PointLight { direction: towards(0.2, 0.5, -1.0), ..ISOTROPIC },
            // The square reaches above and below its horizon.
            PointLight { direction: towards(1.0, 0.1, -0.1), ..ISOTROPIC },
        ]
    }

    /// ∫ of the irradiance by a midpoint rule of n × n cells.
    fn by_rule(light: &PointLight<f64>, polygon: &Polygon, visibility: &Visibility, n: u32) -> f64 {
        let cells = (0..n * n).map(|k| [k % n, k / n].map(|i| (f64::from(i) + 0.5) / f64::from(n)));
        let at = |position| SurfacePoint { position, normal: polygon.normal() };
        let value = |[s, t]: [f64; 2]| {
            irradiance(&[*light], visibility, &at(polygon.point(s, t))) * polygon.density(s, t)
        };
        cells.map(value).sum::<f64>() / f64::from(n * n)
    }

    #[test]
    fn the_light_on_a_polygon_is_the_integral_of_the_light_at_its_points() {
        let nothing = Visibility::new(&[square(0.0, 1.0)]);
        for light in lights() {
            let (exact, rule) =
                (whole(&light, &square(0.0, 1.0)), by_rule(&light, &square(0.0, 1.0), &nothing, 400));
            assert!((exact - rule).abs() < 1e-4 * exact, "{exact} {rule} {light:?}");
        }
    }

    #[test]
    fn all_of_the_light_arrives_in_a_closed_room() {
        let axes = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|n| [n, -n]);
        let walls: Vec<_> = axes
            .map(|n| {
                let (s, t) = n.any_orthonormal_pair();
                let [a, b, c, d] = [n - s - t, n - s + t, n + s + t, n + s - t].map(|v| 2.0 * v);
                Polygon::quadrilateral(a, b, c, d)
            })
            .collect();
        for light in lights() {
            let sum: f64 = walls.iter().map(|wall| whole(&light, wall)).sum();
            assert!((sum - light.flux_of_unit()).abs() < 1e-13, "{sum}");
        }
    }

    #[test]
    fn a_shadow_takes_its_part() {
        // A plate from x = 0 on, half-way between the light and the floor, whose shadow begins at x = −0.3.
        let (floor, p) = (square(0.0, 1.0), |x, y| DVec3::new(x, y, 0.75));
        let plate = Polygon::quadrilateral(p(0.0, -3.0), p(3.0, -3.0), p(3.0, 3.0), p(0.0, 3.0));
        let visibility = Visibility::new(&[floor.clone(), plate]);
        let p = |x, y| DVec3::new(x, y, 0.0);
        let in_light = Polygon::quadrilateral(p(-1.0, -1.0), p(-0.3, -1.0), p(-0.3, 1.0), p(-1.0, 1.0));
        for light in &lights()[..2] {
            let (found, expected) = (lit(light, &visibility, &floor, 0), whole(light, &in_light));
            assert!((found - expected).abs() < 1e-3 * whole(light, &floor), "{found} {expected}");
        }
    }

    #[test]
    fn walls_keep_light_out_and_backs_get_none() {
        let (floor, ceiling) = (square(0.0, 1.0), square(1.0, 3.0));
        let visibility = Visibility::new(&[floor.clone(), ceiling]);
        assert_eq!(lit(&ISOTROPIC, &visibility, &floor, 0), 0.0);
        let below = PointLight { position: DVec3::new(0.0, 0.0, -1.0), ..ISOTROPIC };
        assert_eq!(whole(&below, &floor), 0.0);
        let at = SurfacePoint { position: DVec3::ZERO, normal: DVec3::Z };
        assert_eq!(irradiance(&[ISOTROPIC, below], &visibility, &at), 0.0);
        // On the ceiling, not behind it.
        let on = PointLight { position: DVec3::Z, ..ISOTROPIC };
        assert!((irradiance(&[on], &visibility, &at) - 1.0).abs() < 1e-12);
    }
}
