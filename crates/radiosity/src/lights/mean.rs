//! 1/A ∫_P H dA: the mean of what lights send to a patch.
//!
//! ∫ cosθ/r² dA over a polygon is the solid angle Ω under which the light sees it, and for a diffuse light ∫ cosθ′ cosθ/r² dA
//! is π times Lambert's form factor: both are exact, and so is a sun's. Other intensities are taken at the middles of parts, in
//! quarters and their quarters until these agree, as is the light of a sky. A patch that lies partly in shadow is cut along its
//! edge.

use super::arrives;
use crate::form_factor::lambert::point_to_polygon;
use crate::kernel::SurfacePoint;
use crate::patches::Patches;
use crate::polygon::Polygon;
use crate::reconstruct::{Rays, Rotation, lattice};
use crate::scene::{Distribution, Light, PointLight};
use crate::sky::Dome;
use crate::visibility::Visibility;
use fredholm::value::Value;
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::PI;

/// The mean irradiance of each patch from the lights of its scene, in W/m² or lx: exact in full light and in full shadow, and
/// to some thousandths of the light across an edge of a shadow or of a beam.
pub fn mean_irradiances<V: Value>(patches: &Patches<V>, visibility: &Visibility) -> Vec<V> {
    if patches.lights.is_empty() {
        return vec![V::splat(0.0); patches.len()];
    }
    let mean = |patch: &Polygon| {
        patches.lights.iter().fold(V::splat(0.0), |sum, light| {
            let mean = match light {
                Light::Sky(sky) => of_sky(&sky.dome, visibility, patch),
                Light::Point(_) | Light::Sun(_) => lit(light, visibility, patch, 0) / patch.area(),
            };
            sum + light.amount() * mean
        })
    };
    patches.polygons.par_iter().map(mean).collect()
}

/// The corners of a patch in the coordinates of [`Polygon::point`], a thousandth within; and how many points between them are
/// looked at, of which no two have the same coordinate: an edge along the sides of the patch is found to a 16th as well.
const CORNERS: [(f64, f64); 4] = [(0.001, 0.001), (0.999, 0.001), (0.999, 0.999), (0.001, 0.999)];
const BETWEEN: usize = 16;

/// How often a patch is cut in four along the edge of a shadow: of the 4⁵ parts some 40 are on the edge, of each of which a
/// 16th is in doubt, which is 10⁻³ of the patch if all err alike.
const CUTS: u32 = 5;

/// ∫ over a polygon of what a light of amount 1 sends there, V and all: in sr of a point, in m² of a sun.
fn lit<V>(light: &Light<V>, visibility: &Visibility, polygon: &Polygon, cuts: u32) -> f64 {
    let whole = whole(light, polygon);
    if whole == 0.0 {
        return 0.0;
    }
    let in_light = |(s, t): (f64, f64)| arrives(light, visibility, polygon.point(s, t));
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
fn whole<V>(light: &Light<V>, polygon: &Polygon) -> f64 {
    match light {
        Light::Sun(sun) => (-sun.direction).dot(polygon.normal()).max(0.0) * polygon.area(),
        Light::Point(light) => of_point(light, polygon),
        // Its mean is another: see `of_sky`.
        Light::Sky(_) => 0.0,
    }
}

/// The mean over a patch of what comes from a sky whose zenith has a radiance of 1, in sr.
fn of_sky(dome: &Dome, visibility: &Visibility, patch: &Polygon) -> f64 {
    let normal = patch.normal();
    let received = |position: DVec3, rays: Rays| {
        visibility.received_from(dome, &SurfacePoint { position, normal }, rays)
    };
    if !visibility.clips_sky() {
        let rotation = Rotation::at(patch.centroid());
        let from = |(k, (s, t)): (usize, (f64, f64))| {
            let rays = Rays { count: SKY_RAYS, rotation: rotation.next(k) };
            (received(patch.point(s, t), rays) * patch.density(s, t), patch.density(s, t))
        };
        let points = lattice(SKY_POINTS, rotation).enumerate().map(from);
        let [sum, area] = points.fold([0.0; 2], |[sum, area], (h, d)| [sum + h, area + d]);
        return sum / area;
    }
    let at = |point: DVec3| received(point, Rays::from(point));
    let tolerance = SOFT * dome.horizontal();
    mean_of(&at, patch, at(patch.centroid()), tolerance, 0)
}

/// Points of a patch where rays go to the sky, and how many from each.
const SKY_POINTS: usize = 16;
const SKY_RAYS: usize = 32;

/// The part of the light of a free horizontal by which the middles of a patch and of its quarters may differ, a third of which is
/// left; the light of a sky has soft edges, so that so many cuts in four are enough.
const SOFT: f64 = 5e-4;
const SOFT_CUTS: u32 = 3;

/// The mean of a function over a polygon, at whose middle it is `coarse`.
fn mean_of(at: &impl Fn(DVec3) -> f64, polygon: &Polygon, coarse: f64, tolerance: f64, cuts: u32) -> f64 {
    let quarters = polygon.quarters();
    let middles: Vec<f64> = quarters.iter().map(|part| at(part.centroid())).collect();
    let mean = |values: &[f64]| {
        let sum: f64 = quarters.iter().zip(values).map(|(part, value)| part.area() * value).sum();
        sum / polygon.area()
    };
    let fine = mean(&middles);
    if cuts == SOFT_CUTS || (fine - coarse).abs() <= tolerance {
        return fine;
    }
    let parts = quarters.iter().zip(&middles);
    mean(&parts.map(|(part, middle)| mean_of(at, part, *middle, tolerance, cuts + 1)).collect::<Vec<_>>())
}

fn of_point<V>(light: &PointLight<V>, polygon: &Polygon) -> f64 {
    if polygon.height_of(light.position) <= 0.0 {
        return 0.0;
    }
    match light.distribution {
        Distribution::Diffuse(direction) => PI * point_to_polygon(light.position, direction, polygon),
        Distribution::Uniform => seen_from(light.position, polygon),
        Distribution::Spot(_) | Distribution::Measured(_) => by_parts(light, polygon, 0),
    }
}

/// Parts are cut until the intensity at their middles and at those of their quarters differ by less than this part of the
/// largest: what is left is a third of it. The edge of a beam is followed through so many generations of parts that are small
/// beside the beam.
const ALIKE: f64 = 2e-3;
const GENERATIONS: u32 = 5;

/// ∫ of the part of the intensity over the solid angle of a polygon, in sr.
fn by_parts<V>(light: &PointLight<V>, polygon: &Polygon, generation: u32) -> f64 {
    let at_middle = |part: &Polygon| seen_from(light.position, part) * light.part_towards(part.centroid());
    let quarters = polygon.quarters();
    let (angle, coarse) = (seen_from(light.position, polygon), at_middle(polygon));
    let fine: f64 = quarters.iter().map(at_middle).sum();
    let is_small = angle <= light.distribution.resolution().powi(2);
    if generation == GENERATIONS || (is_small && (fine - coarse).abs() <= ALIKE * angle) {
        return fine;
    }
    quarters.iter().map(|part| by_parts(light, part, generation + u32::from(is_small))).sum()
}

/// The solid angle of a polygon, in sr.
fn seen_from(position: DVec3, polygon: &Polygon) -> f64 {
    polygon.triangles().map(|corners| solid_angle(corners.map(|v| v - position))).sum()
}

/// The solid angle of a triangle seen from the origin, in sr: tan(Ω/2) of Van Oosterom and Strackee (1983).
fn solid_angle([a, b, c]: [DVec3; 3]) -> f64 {
    let [x, y, z] = [a, b, c].map(DVec3::length);
    let below = x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y;
    2.0 * a.dot(b.cross(c)).abs().atan2(below)
}

#[cfg(test)]
mod tests {
    use super::super::tests::{points, square};
    use super::*;
    use crate::kernel::SurfacePoint;
    use crate::lights::irradiance;
    use crate::scene::Sun;

    fn lights() -> Vec<Light<f64>> {
        let sun = Sun { direction: DVec3::new(0.3, -0.5, -1.0).normalize(), irradiance: 1.0 };
        points().map(Light::from).into_iter().chain([sun.into()]).collect()
    }

    /// ∫ of the irradiance by a midpoint rule of n × n cells.
    fn by_rule(light: &Light<f64>, polygon: &Polygon, visibility: &Visibility, n: u32) -> f64 {
        let cells = (0..n * n).map(|k| [k % n, k / n].map(|i| (f64::from(i) + 0.5) / f64::from(n)));
        let at = |position| SurfacePoint { position, normal: polygon.normal() };
        let value = |[s, t]: [f64; 2]| {
            irradiance(std::slice::from_ref(light), visibility, &at(polygon.point(s, t)))
                * polygon.density(s, t)
        };
        cells.map(value).sum::<f64>() / f64::from(n * n)
    }

    #[test]
    fn the_light_on_a_polygon_is_the_integral_of_the_light_at_its_points() {
        let nothing = Visibility::new(&[square(0.0, 1.0)]);
        for (k, light) in lights().iter().enumerate() {
            let (exact, rule) =
                (whole(light, &square(0.0, 1.0)), by_rule(light, &square(0.0, 1.0), &nothing, 400));
            // A beam is integrated to some thousandths.
            let within = if [3, 4].contains(&k) { 1e-3 } else { 1e-4 };
            assert!((exact - rule).abs() < within * exact, "{exact} {rule} {light:?}");
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
        for (k, light) in points().iter().enumerate() {
            let sum: f64 = walls.iter().map(|wall| of_point(light, wall)).sum();
            let within = if k < 3 { 1e-13 } else { 1e-3 };
            let flux = light.distribution.flux_of_unit();
            assert!((sum / flux - 1.0).abs() < within, "{sum} {flux}");
        }
    }

    #[test]
    fn a_narrow_beam_on_a_large_polygon_is_found() {
        let spot = crate::scene::Spot { direction: -DVec3::Z, inner: 0.02, outer: 0.05 };
        let light = PointLight {
            distribution: Distribution::Spot(spot),
            ..PointLight::uniform(DVec3::new(1.3, 0.7, 1.0), 1.0)
        };
        let (found, flux) = (of_point(&light, &square(0.0, 5.0)), light.distribution.flux_of_unit());
        assert!((found / flux - 1.0).abs() < 0.01, "{found} {flux}");
    }

    #[test]
    fn a_shadow_takes_its_part() {
        // A plate from x = 0 on, half-way between the light and the floor, whose shadow begins at x = −0.3; that of the sun at
        // x = 0.225.
        let (floor, p) = (square(0.0, 1.0), |x, y| DVec3::new(x, y, 0.75));
        let plate = Polygon::quadrilateral(p(0.0, -3.0), p(3.0, -3.0), p(3.0, 3.0), p(0.0, 3.0));
        let visibility = Visibility::new(&[floor.clone(), plate]);
        let p = |x, y| DVec3::new(x, y, 0.0);
        let up_to = |x| Polygon::quadrilateral(p(-1.0, -1.0), p(x, -1.0), p(x, 1.0), p(-1.0, 1.0));
        let all = lights();
        for (light, edge) in [(&all[0], -0.3), (&all[1], -0.3), (&all[3], -0.3), (&all[5], 0.225)] {
            let (found, expected) = (lit(light, &visibility, &floor, 0), whole(light, &up_to(edge)));
            assert!((found - expected).abs() < 1e-3 * whole(light, &floor), "{found} {expected}");
        }
    }

    #[test]
    fn behind_a_polygon_there_is_no_light_for_it() {
        let visibility = Visibility::new(&[square(0.0, 1.0), square(1.0, 3.0)]);
        let above = Light::from(points()[0].clone());
        assert_eq!(lit(&above, &visibility, &square(0.0, 1.0), 0), 0.0);
        let below = PointLight::uniform(DVec3::new(0.0, 0.0, -1.0), 1.0);
        assert_eq!(whole(&below.into(), &square(0.0, 1.0)), 0.0);
    }
}
