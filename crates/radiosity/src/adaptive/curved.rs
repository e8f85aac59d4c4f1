//! û(x) about the normal n of the curved surface that a face stands for: E + ρ (D(x′, n) + Σ_links F u F₀(x, n)/F₀(x)).
//!
//! The links of x are those of the flat face, with what hides what; F₀, Lambert's factor with nothing in between, says how much
//! more or less of each arrives about n. Nothing comes from below the horizon of the face, nor from below that of the curve;
//! the sliver of the sky between the two, a fiftieth of its light where they meet at 16°, is taken to be as bright as the
//! rest, or the edges of faces would be dark. Straight from lamps light comes to x′ on the curve itself, by rays: a lamp
//! behind the plane of a face may well shine on the curve.

use super::field::Field;
use crate::form_factor::lambert::point_to_polygon;
use crate::form_factor::view::View;
use crate::kernel::SurfacePoint;
use crate::lights;
use crate::polygon::Polygon;
use crate::reconstruct::{Lamps, Lit, Rays, Rotation, Site, on_surface};
use crate::scene::Light;
use fredholm::value::Value;
use glam::DVec3;

/// What goes from point to point.
struct Look<'a, V> {
    lamps: Lamps<'a, V>,
    lift: f64,
    view: View,
}

impl<V: Value> Lit<V> for Field<'_, V> {
    fn seen(&self, points: &mut dyn Iterator<Item = (u32, DVec3)>) -> Vec<[V; 2]> {
        let domain = self.domain;
        let mut look = Look { lamps: domain.lamps(), lift: domain.rays().lift(), view: View::default() };
        let at = |(face, point): (u32, DVec3)| {
            let irradiance = if domain.faces()[face as usize].is_curved() {
                self.irradiance_on_curve(face, point, &mut look)
            } else {
                self.irradiance_with(face, point, &mut look.view)
            };
            [domain.emission(face) + domain.reflectance(face) * irradiance, irradiance]
        };
        points.map(at).collect()
    }

    fn is_covered(&self, face: u32, point: DVec3) -> bool {
        self.domain.is_buried(face, point)
    }

    fn cells(&self) -> Vec<(u32, Polygon)> {
        let quarters = |(face, patch): (u32, &Polygon)| patch.quarters().map(|quarter| (face, quarter));
        self.patches().flat_map(quarters).collect()
    }

    fn scale(&self) -> f64 {
        self.scale()
    }

    fn lights(&self) -> &[Light<V>] {
        self.domain.lights()
    }
}

impl<V: Value> Field<'_, V> {
    fn irradiance_on_curve(&self, face: u32, point: DVec3, look: &mut Look<'_, V>) -> V {
        let (domain, flat) = (self.domain, &self.domain.faces()[face as usize]);
        if domain.is_buried(face, point) {
            return V::splat(0.0);
        }
        let at = on_surface(flat, point, domain.rays(), look.lift);
        let site = Site { point: at.position, normal: at.normal, rotation: Rotation::at(point) };
        let direct = look.lamps.irradiance(&site)
            + lights::irradiance_by(Rays::turned(site.rotation), domain.lights(), domain.rays(), &at);
        let turned = SurfacePoint { position: point, normal: at.normal };
        let from_parts =
            self.links_from(face, point, &mut look.view).iter().fold(V::splat(0.0), |sum, link| {
                let node = self.tree.node(link.node);
                sum + self.sent[link.node as usize]
                    * (f64::from(link.factor) * change(flat, &turned, &node.polygon))
            });
        direct + from_parts * (1.0 / above_both(flat, at.normal))
    }
}

/// The part of the light of an even sky that comes from above both horizons, of that from above the curve's.
fn above_both(face: &Polygon, normal: DVec3) -> f64 {
    0.5 * (1.0 + face.normal().dot(normal))
}

/// F₀(x, n)/F₀(x): what a part in front of a face sends to the curve there, over what it sends to the face.
fn change(face: &Polygon, at: &SurfacePoint, part: &Polygon) -> f64 {
    let about = |normal: DVec3, part: &Polygon| point_to_polygon(at.position, normal, part);
    let whole = about(face.normal(), part);
    let is_in_front = part.vertices().iter().all(|v| face.height_of(*v) >= 0.0);
    let turned = match is_in_front {
        true => about(at.normal, part),
        false => part.in_front_of(face).iter().map(|piece| about(at.normal, piece)).sum(),
    };
    if whole > 0.0 { turned / whole } else { 0.0 }
}
