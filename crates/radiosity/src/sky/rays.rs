//! ∫ L V cosθ dω ≈ H₀/n Σ V(x, ω_k): of many hiders it is asked by rays alone which leave the sky to be seen, in directions ω_k
//! that are spread as its unobstructed light H₀ is. Where all is open, or nothing, that is exact; else 256 rays are off by half
//! a hundredth of the free horizontal's light in a yard with boxes and a fence.
//!
//! They are spread by a curve through small cells of the dome, along which the light that comes before is a number from 0 to 1,
//! at which points of a lattice are: close together on the curve is close together in the sky, so that rays that follow each
//! other go the same way.

use super::dome::{Dome, quarters};
use crate::reconstruct::{Rays, lattice};
use glam::DVec3;

/// A cell as rays find it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Target {
    corners: [DVec3; 3],
    /// ∫ L ω dω.
    moment: DVec3,
}

/// What no cell for rays has more of than this part of the horizontal's light: some 3 degrees of a uniform sky.
const SMALL: f64 = 1e-3;

/// The cells of a dome along the curve.
pub(super) fn targets(dome: &Dome) -> Vec<Target> {
    let mut targets = Vec::new();
    let most = SMALL * dome.horizontal();
    for root in 0..super::dome::ROOTS {
        cut(dome, root, dome.cells[root].corners, most, &mut targets);
    }
    targets
}

fn cut(dome: &Dome, number: usize, corners: [DVec3; 3], most: f64, targets: &mut Vec<Target>) {
    let cell = &dome.cells[number];
    let is_whole = corners == cell.corners;
    let moment = if is_whole { cell.moment } else { cell.luminance.moment(corners.into_iter()) };
    if moment.length() <= most {
        targets.push(Target { corners, moment });
        return;
    }
    let first = cell.parts.filter(|_| is_whole);
    for (k, part) in quarters(corners).into_iter().enumerate() {
        cut(dome, first.map_or(number, |first| first + k), part, most, targets);
    }
}

/// The irradiance at a point with a unit normal from a sky whose zenith has a radiance of 1, in sr, where `escape` says how many
/// rays in so many directions meet nothing.
pub(crate) fn received_by_rays(
    dome: &Dome,
    normal: DVec3,
    rays: Rays,
    escape: impl FnOnce(&[DVec3]) -> usize,
) -> f64 {
    let mut to = Vec::with_capacity(rays.count);
    let each = directions(dome, normal, rays, &mut to);
    each * escape(&to) as f64
}

/// Directions towards a sky as seen from a surface with a unit normal, and the irradiance that each brings if nothing is in its way,
/// for a radiance of 1 at the zenith; in sr.
pub(super) fn directions(dome: &Dome, normal: DVec3, rays: Rays, into: &mut Vec<DVec3>) -> f64 {
    let mut sum = 0.0;
    let before: Vec<f64> = (dome.targets.iter())
        .map(|target| {
            sum += target.moment.dot(normal).max(0.0);
            sum
        })
        .collect();
    if sum == 0.0 {
        return 0.0;
    }
    into.extend(lattice(rays.count, rays.rotation).map(|(s, t)| {
        // Less than the sum, also where it is rounded: the cell has some of the light.
        let light = (s * sum).min(sum.next_down());
        let k = before.partition_point(|b| *b <= light);
        let start = if k == 0 { 0.0 } else { before[k - 1] };
        let direction = dome.targets[k].direction((light - start) / (before[k] - start), t);
        // A cell across the horizon of the surface is taken for one above.
        direction - normal * (2.0 * direction.dot(normal).min(0.0))
    }));
    sum / rays.count as f64
}

impl Target {
    /// The direction at a place of the unit square, laid over the triangle.
    fn direction(&self, s: f64, t: f64) -> DVec3 {
        let ([a, b, c], root) = (self.corners, s.sqrt());
        (a * (1.0 - root) + b * (root * (1.0 - t)) + c * (root * t)).normalize()
    }
}

#[cfg(test)]
mod tests {
    use super::super::cover::Cover;
    use super::super::model::{Kind, Model};
    use super::super::view::{received, tests::yard};
    use super::*;
    use crate::kernel::SurfacePoint;
    use crate::polygon::Polygon;
    use crate::reconstruct::Rotation;
    use crate::visibility::Visibility;

    fn domes() -> impl Iterator<Item = Dome> {
        let sun = DVec3::new(-0.5, -0.3, 0.6).normalize();
        let kinds = [Kind::Uniform, Kind::Overcast, Kind::General(12), Kind::General(15)];
        kinds.into_iter().map(move |kind| Dome::new(Model::new(kind, DVec3::Z, sun)))
    }

    #[test]
    fn rays_find_what_is_clipped_to_some_thousandths() {
        let polygons = yard();
        let (cover, visibility) = (Cover::new(&polygons, 1e-9), Visibility::new(&polygons));
        for dome in domes() {
            let (mut square, mut points) = (0.0, 0.0);
            for (k, polygon) in polygons.iter().enumerate() {
                for (s, t) in lattice(40, Rotation::of(k)) {
                    let (point, normal) = (polygon.point(s, t), polygon.normal());
                    let exact = received(&dome, &cover, point, normal);
                    let to_sky = |to: &[DVec3]| {
                        to.iter().filter(|to| visibility.nearest(point, **to).is_none()).count()
                    };
                    let found = received_by_rays(&dome, normal, Rays::from(point), to_sky);
                    square += ((found - exact) / dome.horizontal()).powi(2);
                    points += 1.0;
                }
            }
            let error = f64::sqrt(square / points);
            assert!(error < 7e-3, "{:?}: {error}", dome.model().kind());
        }
    }

    #[test]
    fn rays_that_go_together_find_what_each_does() {
        // Two yards are too many polygons to be clipped; beyond all is a wall, which hides nothing between points of them.
        let beside = |polygon: &Polygon| {
            let corners: Vec<DVec3> = polygon.vertices().iter().map(|v| *v + 20.0 * DVec3::X).collect();
            match corners[..] {
                [a, b, c, d] => Polygon::quadrilateral(a, b, c, d),
                _ => Polygon::triangle(corners[0], corners[1], corners[2]),
            }
        };
        let [low, high] = [-12.0, 12.0].map(|y| DVec3::new(-12.0, y, 0.0));
        let mut polygons = yard();
        polygons.extend(yard().iter().map(beside));
        polygons.push(Polygon::quadrilateral(low, high, high + 9.0 * DVec3::Z, low + 9.0 * DVec3::Z));
        let visibility = Visibility::new(&polygons);
        assert!(!visibility.clips_sky());
        let dome = domes().last().unwrap();
        for (k, polygon) in polygons.iter().enumerate() {
            let (position, normal) = (polygon.point(0.3, 0.4), polygon.normal());
            let alone =
                |to: &[DVec3]| to.iter().filter(|to| visibility.nearest(position, **to).is_none()).count();
            let rays = Rays { count: 100, rotation: Rotation::of(k) };
            let expected = received_by_rays(&dome, normal, rays, alone);
            assert_eq!(
                visibility.received_from(&dome, &SurfacePoint { position, normal }, rays),
                expected,
                "{k}"
            );
        }
    }

    #[test]
    fn what_is_open_is_exact() {
        for dome in domes() {
            for normal in [DVec3::Z, DVec3::X, DVec3::new(0.6, 0.0, 0.8), DVec3::new(0.6, 0.0, -0.8)] {
                let found = received_by_rays(&dome, normal, Rays::from(normal), <[DVec3]>::len);
                let error = (found - dome.unobstructed(normal)).abs() / dome.horizontal();
                assert!(error < 3e-4, "{normal}: {error}");
            }
            assert_eq!(received_by_rays(&dome, -DVec3::Z, Rays::from(DVec3::Z), <[DVec3]>::len), 0.0);
        }
    }
}
