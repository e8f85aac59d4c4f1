//! r ≥ 5 d: from where on a luminaire of size d is a point, to about 1 %.

use crate::scene::{Distribution, PointLight, Scene};

/// How far away a luminaire is a point, in its largest sides: nearer than five times that its light differs by more than 1 %
/// from that of a point (the photometric distance of CIE 121).
pub const FAR: f64 = 5.0;

/// What of the largest intensity counts as light that arrives.
const FAINT: f64 = 0.01;

/// Points across a polygon that are looked at, in each direction.
const LOOKS: usize = 8;

/// How far it is from a luminaire to the nearest front that it shines on, in metres, walls between them left out of account;
/// infinite where there is none, none for a light without a size.
pub fn nearest_lit<V, W>(light: &PointLight<V>, scene: &Scene<W>) -> Option<f64> {
    let Distribution::Measured(aimed) = &light.distribution else { return None };
    if aimed.web.size == 0.0 {
        return None;
    }
    let polygons = scene.surfaces.iter().flat_map(|surface| &surface.polygons);
    let points = polygons.filter(|polygon| polygon.height_of(light.position) > 0.0).flat_map(|polygon| {
        let place = |k: usize| (k as f64 + 0.5) / LOOKS as f64;
        let foot = light.position - polygon.normal() * polygon.height_of(light.position);
        let foot = (polygon.distance_outside(foot) <= 0.0).then_some(foot);
        let spread = (0..LOOKS * LOOKS).map(move |k| polygon.point(place(k % LOOKS), place(k / LOOKS)));
        spread.chain(foot)
    });
    let lit = points.filter(|point| light.part_towards(*point) > FAINT);
    Some(lit.map(|point| point.distance(light.position)).fold(f64::INFINITY, f64::min))
}
