//! Light from a sky: what is known of it, by patches and to an accuracy.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the message, in its helpers too")]

mod common;

use common::*;
use glam::DVec3;
use radiosity::adaptive::{Domain, Request};
use radiosity::closure::Closure;
use radiosity::kernel::SurfacePoint;
use radiosity::lights::{beyond, irradiance, mean_irradiances};
use radiosity::patches::Patches;
use radiosity::polygon::Polygon;
use radiosity::scene::{Light, Scene, Sky};
use radiosity::sky::{Dome, Kind, Model};
use radiosity::solve::{Options, Unobserved};
use std::f64::consts::PI;
use std::sync::Arc;

fn sky(kind: Kind, zenith: f64) -> Light<f64> {
    let sun = p(0.3, -0.8, 0.7).normalize();
    Light::Sky(Sky { zenith, dome: Arc::new(Dome::new(Model::new(kind, DVec3::Z, sun))) })
}

/// A room of 4 × 4 × 3 m with an opening of 1 × 1 m in the middle of its roof; the opening is last, if it is there.
fn room(reflectance: f64, with_opening: bool) -> Scene<f64> {
    let mut faces = walls(DVec3::ZERO, p(4.0, 4.0, 3.0), false).to_vec();
    let roof = |x: f64, y: f64, along: f64, across: f64| {
        parallelogram(p(x, y, 3.0), across * DVec3::Y, along * DVec3::X)
    };
    faces.splice(
        1..2,
        [
            roof(0.0, 0.0, 4.0, 1.5),
            roof(0.0, 2.5, 4.0, 1.5),
            roof(0.0, 1.5, 1.5, 1.0),
            roof(2.5, 1.5, 1.5, 1.0),
        ],
    );
    let mut scene = scene([faces], reflectance);
    if with_opening {
        let lamp = radiosity::scene::Surface {
            name: "opening".into(),
            reflectance: 0.0,
            emission: PI * 1000.0,
            polygons: vec![roof(1.5, 1.5, 1.0, 1.0)],
        };
        scene.surfaces.push(lamp);
    }
    scene
}

/// The mean irradiance of the surfaces, but for an opening, as patches have it.
fn by_patches(scene: &Scene<f64>) -> (f64, Closure) {
    let patches = Patches::new(scene, 0.5).unwrap();
    let options = Options { tolerance: 1e-9, accuracy: 1e-4, ..Options::default() };
    let solution = radiosity::solve::solve(&patches, &visibility(scene), &options, &mut Unobserved).unwrap();
    (mean(&patches, &solution.irradiance, |k| patches.surface[k] == 0), solution.closure)
}

#[test]
fn a_uniform_sky_through_an_opening_is_a_lamp_in_it() {
    let (mut open, lamp) = (room(0.6, false), room(0.6, true));
    open.lights = vec![sky(Kind::Uniform, 1000.0)];
    let ((found, closure), (expected, _)) = (by_patches(&open), by_patches(&lamp));
    assert!((found / expected - 1.0).abs() < 2e-3, "{found} {expected}");
    assert!(matches!(closure, Closure::Open { escaping } if escaping > 0.0 && escaping < 0.1), "{closure:?}");
    // To an accuracy, straight from the sky, to rounding; and with all reflections.
    let request = Request { accuracy: 0.01, ..Request::default() };
    let at = |scene: &Scene<f64>, normal: DVec3, point: DVec3| {
        let light = irradiance(&scene.lights, &visibility(scene), &SurfacePoint { position: point, normal });
        let faces = scene.polygons();
        let domain = Domain::new(scene, &faces).unwrap();
        let field = radiosity::adaptive::solve(&domain, &request, |_| true);
        assert!(field.bound().total() <= 0.01);
        let face = faces.iter().position(|f| f.normal().dot(normal) > 0.9).unwrap() as u32;
        (light, field.irradiance(face, point))
    };
    for (normal, point) in [(DVec3::Z, p(1.3, 2.2, 0.0)), (DVec3::Y, p(0.7, 0.0, 1.1))] {
        let ((straight, all), (_, of_lamp)) = (at(&open, normal, point), at(&lamp, normal, point));
        let opening = lamp.surfaces[1].polygons[0].clone();
        let exact = PI * 1000.0 * radiosity::form_factor::lambert::point_to_polygon(point, normal, &opening);
        assert!((straight / exact - 1.0).abs() < 1e-10, "{straight} {exact}");
        assert!((all / of_lamp - 1.0).abs() < 0.02, "{all} {of_lamp}");
    }
}

#[test]
fn all_of_the_light_that_goes_through_an_opening_arrives() {
    // Of a uniform sky π L each square metre; of the overcast one 7/9 of that.
    for (kind, part) in [(Kind::Uniform, 1.0), (Kind::Overcast, 7.0 / 9.0)] {
        let mut scene = room(0.0, false);
        scene.lights = vec![sky(kind, 1000.0)];
        let patches = Patches::new(&scene, 0.5).unwrap();
        let lit = mean_irradiances(&patches, &visibility(&scene));
        let all: f64 = lit.iter().zip(&patches.areas).map(|(h, area)| h * area).sum();
        let expected = part * PI * 1000.0;
        assert!((all / expected - 1.0).abs() < 2e-3, "{kind:?}: {all} {expected}");
    }
}

#[test]
fn a_free_surface_sees_all_of_the_sky_or_half() {
    let square = |along: DVec3, across: DVec3| vec![parallelogram(DVec3::ZERO, along, across)];
    for (kind, horizontal, vertical) in
        [(Kind::Uniform, PI, PI / 2.0), (Kind::Overcast, 7.0 / 9.0 * PI, PI / 6.0 + 4.0 / 9.0)]
    {
        for (polygons, expected) in [
            (square(DVec3::X, DVec3::Y), horizontal),
            (square(DVec3::X, DVec3::Z), vertical),
            (square(DVec3::Y, DVec3::X), 0.0),
        ] {
            let mut scene = scene([polygons], 0.5);
            scene.lights = vec![sky(kind, 10.0)];
            let patches = Patches::new(&scene, 0.5).unwrap();
            let options = Options::default();
            let solution =
                radiosity::solve::solve(&patches, &visibility(&scene), &options, &mut Unobserved).unwrap();
            for (h, b) in solution.irradiance.iter().zip(&solution.radiosity) {
                assert!((h - 10.0 * expected).abs() < 1e-12 && (b - 0.5 * h).abs() < 1e-12, "{kind:?}: {h}");
            }
        }
    }
}

#[test]
fn a_camera_sees_the_sky_above_the_horizon() {
    let lights = [sky(Kind::Overcast, 9.0)];
    let seen = |direction: DVec3| beyond(&lights, direction.normalize());
    assert_eq!([seen(DVec3::Z), seen(-DVec3::Z)], [9.0, 0.0]);
    assert!((seen(DVec3::X) - 3.0).abs() < 1e-12);
}

#[test]
fn the_sky_looks_alike_from_a_body_of_many_faces_and_of_few() {
    // A cube in 6 faces, or each in 2 × 3²; and a tower beside it: nothing but rounding may differ.
    let boxes = |cuts: usize| -> Vec<Polygon> {
        let [low, high] = [p(0.0, 0.0, 0.0), p(1.0, 1.0, 1.0)];
        let cut = |face: &Polygon| -> Vec<Polygon> {
            (0..cuts * cuts)
                .map(|k| {
                    let at = |i: usize| i as f64 / cuts as f64;
                    let (s, t) = (k % cuts, k / cuts);
                    let [a, b, c, d] = [(s, t), (s + 1, t), (s + 1, t + 1), (s, t + 1)]
                        .map(|(s, t)| face.point(at(s), at(t)));
                    Polygon::quadrilateral(a, b, c, d)
                })
                .collect()
        };
        let mut all: Vec<Polygon> = walls(low, high, true).iter().flat_map(cut).collect();
        all.extend(walls(p(1.4, -0.5, 0.0), p(1.6, 1.5, 2.0), true));
        all
    };
    let lights = [sky(Kind::General(10), 100.0)];
    let [few, many] = [1, 3].map(|cuts| visibility(&scene([boxes(cuts)], 0.5)));
    for (position, normal) in [
        (p(0.3, 0.4, 1.0), DVec3::Z),
        (p(1.0, 0.4, 0.5), DVec3::X),
        (p(0.4, 0.0, 0.2), -DVec3::Y),
        (p(1.2, 0.4, 0.0), DVec3::Z),
    ] {
        let at = SurfacePoint { position, normal };
        let [a, b] = [&few, &many].map(|visibility| irradiance(&lights, visibility, &at));
        assert!((a / b - 1.0).abs() < 1e-9 && a > 10.0, "{a} {b} at {position}");
    }
}
