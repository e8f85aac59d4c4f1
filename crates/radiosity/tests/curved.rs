//! Polygons that stand for pieces of a curved surface: pictures have its light, and the solved field that of the polygons.

#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod common;

use common::*;
use fredholm::value::Value;
use glam::DVec3;
use radiosity::adaptive::{Domain, Request, solve};
use radiosity::form_factor::lambert::point_to_polygon;
use radiosity::patches::Patches;
use radiosity::polygon::Polygon;
use radiosity::render::{Colour, Rays, Sightings, View, final_picture};
use radiosity::scene::{Camera, PointLight, Scene};
use radiosity::visibility::Visibility;
use std::f64::consts::PI;

const EXITANCE: f64 = 10.0;
const REFLECTANCE: f64 = 0.5;

/// The outside of the unit sphere in trapezoids, with its normals.
fn ball(rows: usize, smooth: bool) -> Vec<Polygon> {
    let outside = |polygon: &Polygon| {
        let corners: Vec<DVec3> = polygon.vertices().iter().rev().copied().collect();
        let polygon = match corners[..] {
            [a, b, c] => Polygon::triangle(a, b, c),
            [a, b, c, d] => Polygon::quadrilateral(a, b, c, d),
            _ => panic!("{corners:?}"),
        };
        if smooth { polygon.with_normals(&corners).unwrap() } else { polygon }
    };
    sphere(rows).iter().map(outside).collect()
}

/// A lamp 2 m above the centre and 3 m aside that faces the ball.
fn lamp() -> Polygon {
    let (centre, away) = (p(3.0, 0.3, 2.0), p(3.0, 0.3, 2.0).normalize());
    let (s, t) = away.any_orthonormal_pair();
    parallelogram(centre - 0.5 * (s + t), t, s)
}

fn lit_ball(rows: usize, smooth: bool) -> Scene<f64> {
    let mut scene = scene([ball(rows, smooth), vec![lamp()]], REFLECTANCE);
    (scene.surfaces[1].emission, scene.surfaces[1].reflectance) = (EXITANCE, 0.0);
    scene
}

/// From where half of the ball that is seen lies in the dark.
fn view() -> View {
    let camera =
        Camera { position: p(1.5, -3.0, 0.5), target: DVec3::ZERO, up: DVec3::Z, vertical_angle: 0.7 };
    View { camera, width: 64, height: 64, samples: 1, gather: 16 }
}

/// Which polygon each pixel shows, and at which point.
fn shown(view: &View, visibility: &Visibility) -> Vec<Option<(u32, DVec3)>> {
    let rays = Rays::new(&view.camera, view.width, view.height);
    let pixel = |k: usize| {
        let direction = rays.direction((k % view.width) as f64 + 0.5, (k / view.width) as f64);
        let hit = visibility.nearest(view.camera.position, direction)?;
        Some((hit.polygon, view.camera.position + hit.distance * direction))
    };
    (0..view.width * view.height).map(pixel).collect()
}

/// The irradiance of every pixel as it is drawn: the ordinary way, and to an accuracy.
fn drawn(scene: &Scene<f64>) -> [Vec<f64>; 2] {
    let (polygons, view) = (scene.polygons(), view());
    let visibility = Visibility::new(&polygons);
    let patches = Patches::new(scene, 1.0).unwrap();
    let picture = final_picture(&view, scene, &patches, &visibility, &patches.emission, &|_| ());
    let gathered = picture.pixels.iter().map(|pixel| pixel.0[0] * PI / REFLECTANCE).collect();
    let domain = Domain::new(scene, &polygons).unwrap();
    let field = solve(&domain, &Request { accuracy: 0.05, ..Request::default() }, |_| true);
    let sightings = Sightings::new(&view, &field, &polygons, &visibility, &|_| ());
    let values = sightings.values(|_, irradiance| irradiance);
    [gathered, values.into_iter().map(|value| value.unwrap_or(0.0)).collect()]
}

/// The largest and the mean difference from the light of a round ball, as parts of the brightest.
fn errors(scene: &Scene<f64>, irradiance: &[f64], exact: impl Fn(DVec3) -> f64) -> [f64; 2] {
    let (visibility, balls) = (Visibility::new(&scene.polygons()), scene.surfaces[0].polygons.len());
    let on_ball: Vec<(f64, f64)> = shown(&view(), &visibility)
        .into_iter()
        .zip(irradiance)
        .filter_map(|(seen, h)| seen.filter(|(k, _)| (*k as usize) < balls).map(|(_, x)| (x, *h)))
        .map(|(x, h)| (h, exact(x.normalize())))
        .collect();
    assert!(on_ball.len() > 1000, "{}", on_ball.len());
    assert!(on_ball.iter().all(|(h, _)| *h >= 0.0));
    let brightest = on_ball.iter().fold(0.0, |most: f64, (_, exact)| most.max(*exact));
    let off = || on_ball.iter().map(|(h, exact)| (h - exact).abs() / brightest);
    [off().fold(0.0, f64::max), off().sum::<f64>() / on_ball.len() as f64]
}

#[test]
fn a_coarse_ball_has_the_shading_of_a_round_one() {
    let exact = |n: DVec3| EXITANCE * point_to_polygon(n, n, &lamp());
    for rows in [8, 16] {
        let (smooth, flat) = (lit_ball(rows, true), lit_ball(rows, false));
        let [smooth, flat] =
            [&smooth, &flat].map(|scene| drawn(scene).map(|drawn| errors(scene, &drawn, exact)));
        for (way, (smooth, flat)) in smooth.iter().zip(&flat).enumerate() {
            // Half of the angle between neighbours, 11° and 6°, is 0.2 and 0.1 of the light; the curve is right to the square of
            // that.
            let most = if rows == 8 { [0.025, 0.0025] } else { [0.007, 0.0007] };
            assert!(smooth[0] < most[0] && smooth[1] < most[1], "{rows} {way}: {smooth:?}");
            assert!(
                flat[0] > 9.0 * smooth[0] && flat[1] > 14.0 * smooth[1],
                "{rows} {way}: {smooth:?} {flat:?}"
            );
        }
    }
}

#[test]
fn a_point_light_has_no_steps_at_the_edge_of_the_dark_side() {
    let light = PointLight::uniform(p(3.0, 0.3, 2.0), 20.0);
    let exact = |n: DVec3| {
        let between = light.position - n;
        20.0 * between.dot(n).max(0.0) / between.length().powi(3)
    };
    let errors = [true, false].map(|smooth| {
        let mut scene = scene([ball(8, smooth)], REFLECTANCE);
        scene.lights = vec![light.clone().into()];
        drawn(&scene).map(|drawn| errors(&scene, &drawn, exact))
    });
    for [smooth, flat] in [[errors[0][0], errors[1][0]], [errors[0][1], errors[1][1]]] {
        assert!(smooth[0] < 0.025 && flat[0] > 8.0 * smooth[0], "{smooth:?} {flat:?}");
    }
}

/// What light a ball gets in a room that is equally bright all over is equal all over, whatever its normals.
#[test]
fn in_a_furnace_nothing_is_seen_of_facets() {
    let mut scene = scene([ball(8, true), walls(p(-2.0, -4.0, -2.0), p(2.5, 2.0, 2.0), false).to_vec()], 0.6);
    scene.surfaces.iter_mut().for_each(|surface| surface.emission = 2.0);
    let (polygons, view) = (scene.polygons(), view());
    let visibility = Visibility::new(&polygons);
    let patches = Patches::new(&scene, 1.0).unwrap();
    let radiosity = vec![5.0; patches.len()];
    let picture = final_picture(&view, &scene, &patches, &visibility, &radiosity, &|_| ());
    let domain = Domain::new(&scene, &polygons).unwrap();
    let field = solve(&domain, &Request { accuracy: 0.01, ..Request::default() }, |_| true);
    let of_field = Sightings::new(&view, &field, &polygons, &visibility, &|_| ()).picture();
    for (picture, most) in [(picture, 1e-12), (of_field, 1e-4)] {
        let off = picture.pixels.iter().map(|pixel| (pixel.to_rgb().0[0] * PI / 5.0 - 1.0).abs());
        let worst = off.fold(0.0, f64::max);
        assert!(worst < most, "{worst}");
    }
}

/// A floor whose normals all lean over, and a lamp under it on that side: the lamp is above the horizon of the normals.
#[test]
fn no_light_comes_through_a_polygon_whose_normals_lean() {
    let floor = parallelogram(p(-1.0, -1.0, 0.0), 2.0 * DVec3::X, 2.0 * DVec3::Y);
    let leaning = floor.with_normals(&[p(0.9, 0.0, 0.4); 4]).unwrap();
    let under = parallelogram(p(0.2, -0.2, -0.4), 0.4 * DVec3::X, 0.4 * DVec3::Y);
    assert!(point_to_polygon(p(-0.5, 0.0, 0.0), p(0.9, 0.0, 0.4).normalize(), &under) > 0.01);
    let mut scene = scene([vec![leaning], vec![under]], REFLECTANCE);
    scene.surfaces[1].emission = EXITANCE;
    let light = PointLight::uniform(p(0.5, 0.0, -0.5), 5.0);
    scene.lights = vec![light.clone().into()];
    for drawn in drawn_from_above(&scene) {
        assert!(drawn.iter().all(|h| *h == 0.0), "{drawn:?}");
    }
}

fn drawn_from_above(scene: &Scene<f64>) -> [Vec<f64>; 2] {
    let (polygons, patches) = (scene.polygons(), Patches::new(scene, 1.0).unwrap());
    let visibility = Visibility::new(&polygons);
    let camera =
        Camera { position: p(0.0, 0.0, 3.0), target: DVec3::ZERO, up: DVec3::Y, vertical_angle: 0.6 };
    let view = View { camera, width: 16, height: 16, samples: 1, gather: 16 };
    let picture = final_picture(&view, scene, &patches, &visibility, &patches.emission, &|_| ());
    let domain = Domain::new(scene, &polygons).unwrap();
    let field = solve(&domain, &Request { accuracy: 0.05, ..Request::default() }, |_| true);
    let sightings = Sightings::new(&view, &field, &polygons, &visibility, &|_| ());
    let numbers = sightings.values(|_, h| h).into_iter().map(Option::unwrap).collect();
    [picture.pixels.iter().map(|pixel| pixel.0[0]).collect(), numbers]
}

/// The field is that of the polygons, with the same digits.
#[test]
fn normals_change_nothing_of_the_field() {
    let field_of = |smooth| {
        let scene = lit_ball(6, smooth);
        let faces = scene.polygons();
        let domain = Domain::new(&scene, &faces).unwrap();
        let field = solve(&domain, &Request { accuracy: 0.05, ..Request::default() }, |_| true);
        (0..20)
            .map(|face| field.radiosity(face, faces[face as usize].centroid()).magnitude())
            .collect::<Vec<_>>()
    };
    assert_eq!(field_of(true), field_of(false));
}
