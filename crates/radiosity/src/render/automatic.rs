//! A camera for a scene that brings none: the one, of some hundred, that sees the most of it.

use crate::polygon::Polygon;
use crate::render::view::{Rays, first_front};
use crate::scene::Camera;
use crate::visibility::Visibility;
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// Rays across and down a candidate's picture: enough to tell a wall from a chink.
const RAYS: usize = 24;

/// Directions to look from, around the vertical; 16 include the four along the axes.
const AZIMUTHS: u32 = 16;

/// Heights to look from, in degrees: level for rooms with an open front, a quarter down for objects on a floor.
const ELEVATIONS: [f64; 4] = [0.0, 12.0, 28.0, 50.0];

/// The vertical angle of view from outside: that of a normal lens.
const OUTSIDE_ANGLE: f64 = 40.0 * PI / 180.0;

/// The vertical angle of view from inside a room: that of a wide one.
const INSIDE_ANGLE: f64 = 75.0 * PI / 180.0;

impl Camera {
    /// A camera that shows a scene well, found by looking: at open rooms from in front, at closed ones from inside or
    /// through the backs of their walls, which do not hide anything, at objects from above and aside.
    /// The same scene always gets the same camera; an empty one is looked at from anywhere. `aspect` is the width of the
    /// picture over its height.
    pub fn automatic(polygons: &[Polygon], visibility: &Visibility, aspect: f64) -> Self {
        let bounds = Bounds::of(polygons);
        let up = upward(polygons, &bounds);
        let candidates: Vec<Camera> =
            outside(polygons, &bounds, up, aspect).chain(inside(&bounds, up)).collect();
        let scores: Vec<f64> = candidates.par_iter().map(|c| score(c, polygons, visibility)).collect();
        let best = (1..scores.len()).fold(0, |best, k| if scores[k] > scores[best] { k } else { best });
        candidates[best]
    }
}

/// A box with edges along the axes.
struct Bounds {
    low: DVec3,
    high: DVec3,
}

impl Bounds {
    fn of(polygons: &[Polygon]) -> Self {
        let vertices = || polygons.iter().flat_map(|p| p.vertices().iter().copied());
        let low = vertices().reduce(DVec3::min).unwrap_or(DVec3::NEG_ONE);
        Self { low, high: vertices().reduce(DVec3::max).unwrap_or(DVec3::ONE) }
    }

    fn centre(&self) -> DVec3 {
        0.5 * (self.low + self.high)
    }

    fn diagonal(&self) -> f64 {
        self.low.distance(self.high)
    }
}

/// Up is y, as in glTF, unless there is clearly more floor across z.
fn upward(polygons: &[Polygon], bounds: &Bounds) -> DVec3 {
    let near = 0.02 * bounds.diagonal();
    let floor = |up: DVec3| -> f64 {
        let lying = |p: &&Polygon| p.normal().dot(up) > 0.99 && (p.centroid() - bounds.low).dot(up) < near;
        polygons.iter().filter(lying).map(Polygon::area).sum()
    };
    if floor(DVec3::Z) > 1.2 * floor(DVec3::Y) { DVec3::Z } else { DVec3::Y }
}

/// The direction at an azimuth and an elevation, in radians; azimuth 0 is where a reader of plans stands.
fn direction(up: DVec3, azimuth: f64, elevation: f64) -> DVec3 {
    let (front, side) = if up == DVec3::Y { (DVec3::Z, DVec3::X) } else { (DVec3::NEG_Y, DVec3::X) };
    let level = front * azimuth.cos() + side * azimuth.sin();
    level * elevation.cos() + up * elevation.sin()
}

fn azimuths() -> impl Iterator<Item = f64> {
    (0..AZIMUTHS).map(|k| TAU * f64::from(k) / f64::from(AZIMUTHS))
}

/// Cameras that look at the middle from outside, just so far away that all vertices are in the picture.
fn outside(polygons: &[Polygon], bounds: &Bounds, up: DVec3, aspect: f64) -> impl Iterator<Item = Camera> {
    let target = bounds.centre();
    let whole = 0.5 * bounds.diagonal() / (0.5 * OUTSIDE_ANGLE).sin();
    ELEVATIONS.into_iter().flat_map(move |e| azimuths().map(move |a| direction(up, a, e.to_radians()))).map(
        move |from| {
            let distance = distance_to_fit(polygons, target, from, up, aspect).unwrap_or(whole);
            Camera { position: target + from * distance, target, up, vertical_angle: OUTSIDE_ANGLE }
        },
    )
}

/// How far from the target, towards `from`, every vertex is within the picture and its margin.
fn distance_to_fit(polygons: &[Polygon], target: DVec3, from: DVec3, up: DVec3, aspect: f64) -> Option<f64> {
    let right = up.cross(from).normalize();
    let over = from.cross(right);
    let slope = 0.93 * (0.5 * OUTSIDE_ANGLE).tan();
    let vertices = polygons.iter().flat_map(|p| p.vertices());
    vertices
        .map(|&v| {
            let v = v - target;
            v.dot(from) + (v.dot(right).abs() / aspect).max(v.dot(over).abs()) / slope
        })
        .reduce(f64::max)
}

/// Cameras at eye level in a grid over the plan, which look around.
fn inside(bounds: &Bounds, up: DVec3) -> impl Iterator<Item = Camera> {
    let size = bounds.high - bounds.low;
    let low = bounds.low;
    let places = [0.08, 0.36, 0.64, 0.92];
    let plan = places.into_iter().flat_map(move |s| places.into_iter().map(move |t| (s, t)));
    plan.flat_map(move |(s, t)| {
        let share = if up == DVec3::Y { DVec3::new(s, 0.55, t) } else { DVec3::new(s, t, 0.55) };
        let position = low + size * share;
        azimuths().step_by(2).map(move |a| {
            let target = position + direction(up, a, -0.1) * size.max_element();
            Camera { position, target, up, vertical_angle: INSIDE_ANGLE }
        })
    })
}

/// What a candidate loses, at most, to an empty background: it says nothing, but a look at an object from its corner,
/// which fills the picture badly, is worth it.
const BACKGROUND: f64 = 0.2;

/// How much of the scene a camera sees, by area (so that the walls are seen) and by number (so that the things are),
/// less a little for the share of its rays that meet no front.
fn score(camera: &Camera, polygons: &[Polygon], visibility: &Visibility) -> f64 {
    let rays = Rays::new(camera, RAYS, RAYS);
    let pixels = (0..RAYS * RAYS).map(|k| (0.5 + (k % RAYS) as f64, 0.5 + (k / RAYS) as f64));
    let mut seen = vec![0.0; polygons.len()];
    let mut met = 0;
    for (x, y) in pixels {
        let direction = rays.direction(x, y);
        if let Some(hit) = first_front(polygons, visibility, rays.origin(), direction) {
            met += 1;
            let slope = direction.dot(polygons[hit.polygon as usize].normal()).abs();
            seen[hit.polygon as usize] += hit.distance.powi(2) * solid_angle(camera, direction) / slope;
        }
    }
    let areas: f64 = polygons.iter().map(Polygon::area).sum();
    let in_sight = |p: &Polygon, area: f64| area.min(p.area());
    let by_area: f64 = polygons.iter().zip(&seen).map(|(p, &area)| in_sight(p, area)).sum::<f64>() / areas;
    let by_number: f64 = polygons.iter().zip(&seen).map(|(p, &area)| in_sight(p, area) / p.area()).sum();
    let background = 1.0 - f64::from(met) / (RAYS * RAYS) as f64;
    (1.0 - BACKGROUND * background) * (by_area + by_number / polygons.len() as f64)
}

/// The solid angle of a ray's pixel, in sr.
fn solid_angle(camera: &Camera, direction: DVec3) -> f64 {
    let pixel = 2.0 * (0.5 * camera.vertical_angle).tan() / RAYS as f64;
    pixel * pixel * direction.dot((camera.target - camera.position).normalize()).powi(3)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn p(x: f64, y: f64, z: f64) -> DVec3 {
        DVec3::new(x, y, z)
    }

    /// The faces of the box from `low` to `high` with their fronts outside.
    fn faces(low: DVec3, high: DVec3) -> Vec<Polygon> {
        let (centre, half) = (0.5 * (low + high), 0.5 * (high - low));
        let directions = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| [axis, -axis]);
        let face = |n: DVec3| {
            let (s, t) = n.any_orthonormal_pair();
            let [a, b, c, d] = [n - s - t, n + s - t, n + s + t, n - s + t].map(|v| centre + half * v);
            let face = Polygon::quadrilateral(a, b, c, d);
            if face.normal().dot(n) > 0.0 { face } else { Polygon::quadrilateral(d, c, b, a) }
        };
        directions.map(face).collect()
    }

    fn inside_out(polygons: &[Polygon]) -> Vec<Polygon> {
        let turned = |p: &Polygon| match *p.vertices() {
            [a, b, c, d] => Polygon::quadrilateral(d, c, b, a),
            _ => p.clone(),
        };
        polygons.iter().map(turned).collect()
    }

    fn seen(polygons: &[Polygon]) -> (Camera, Vec<u32>) {
        let visibility = Visibility::new(polygons);
        let camera = Camera::automatic(polygons, &visibility, 1.0);
        let rays = Rays::new(&camera, 40, 40);
        let directions = (0..1600).map(|k| rays.direction((k % 40) as f64 + 0.5, (k / 40) as f64 + 0.5));
        let hits = directions.filter_map(|d| first_front(polygons, &visibility, rays.origin(), d));
        (camera, hits.map(|hit| hit.polygon).collect())
    }

    fn distinct(mut numbers: Vec<u32>) -> usize {
        numbers.sort_unstable();
        numbers.dedup();
        numbers.len()
    }

    #[test]
    fn a_closed_room_is_seen_with_five_of_its_walls() {
        let (_, numbers) = seen(&inside_out(&faces(DVec3::ZERO, p(5.0, 3.0, 4.0))));
        assert!(numbers.len() > 1600 / 2, "{}", numbers.len());
        assert!(distinct(numbers) >= 5);
    }

    #[test]
    fn a_box_with_an_open_front_is_seen_through_it() {
        let mut room = inside_out(&faces(DVec3::ZERO, DVec3::ONE));
        room.retain(|wall| wall.normal() != DVec3::X);
        let (camera, numbers) = seen(&room);
        assert_eq!(distinct(numbers), 5);
        assert!(camera.position.x < 0.0, "{camera:?}");
    }

    #[test]
    fn a_block_on_a_floor_is_seen_from_above_and_aside() {
        let mut scene = faces(p(-0.5, 0.0, -0.5), p(0.5, 1.0, 0.5));
        let q = |x, z| p(x, 0.0, z);
        scene.push(Polygon::quadrilateral(q(-2.0, -2.0), q(-2.0, 2.0), q(2.0, 2.0), q(2.0, -2.0)));
        let (camera, numbers) = seen(&scene);
        assert_eq!(distinct(numbers), 4, "top, two sides and the floor: {camera:?}");
        assert!(camera.position.y > 1.0);
    }

    #[test]
    fn an_empty_scene_has_a_camera() {
        let camera = Camera::automatic(&[], &Visibility::new(&[]), 1.0);
        assert!(camera.position.is_finite() && camera.position != camera.target);
    }
}
