//! Radiosity to an accuracy: what is known exactly, and whether the error is what it is said to be.

#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod common;

use common::*;
use fredholm::value::Value;
use glam::DVec3;
use radiosity::adaptive::{Domain, Field, Request, solve};
use radiosity::form_factor::lambert::point_to_polygon;
use radiosity::lights::mean_irradiances;
use radiosity::patches::Patches;
use radiosity::polygon::Polygon;
use radiosity::scene::{Distribution, PointLight, Scene, Spot, Sun, cut};
use radiosity::visibility::Visibility;
use std::f64::consts::PI;

fn request(accuracy: f64) -> Request {
    Request { accuracy, ..Request::default() }
}

/// Solves and looks at points of faces: (face, s, t) and the radiosity there.
fn solved<V: Value, R>(
    scene: &Scene<V>,
    accuracy: f64,
    look: impl FnOnce(&Field<'_, V>, &[Polygon]) -> R,
) -> R {
    let faces = scene.polygons();
    let domain = Domain::new(scene, &faces).unwrap();
    look(&solve(&domain, &request(accuracy), |_| true), &faces)
}

/// Some points of every face.
fn points(faces: &[Polygon]) -> Vec<(u32, DVec3)> {
    let of_face = |(k, face): (usize, &Polygon)| {
        let place = |i: usize| [0.819, 0.671].map(|step| (0.5 + step * (i + 7 * k) as f64).fract());
        (0..25).map(|i| (k as u32, face.point(place(i)[0], place(i)[1]))).collect::<Vec<_>>()
    };
    faces.iter().enumerate().flat_map(of_face).collect()
}

/// The root of the mean square over some points.
fn root_mean_square(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let n = values.len() as f64;
    (values.map(|v| v * v).sum::<f64>() / n).sqrt()
}

/// A lamp under the ceiling of a room of 1 m, and in the room a block that stands on the floor.
fn room(unit: f64) -> Scene<f64> {
    let at = |x, y, z| unit * p(x, y, z);
    let lamp = parallelogram(at(0.35, 0.3, 0.999), at(0.0, 0.25, 0.0), at(0.25, 0.0, 0.0));
    let block = walls(at(0.55, 0.5, 0.0), at(0.8, 0.85, 0.4), true);
    let mut scene =
        scene([walls(DVec3::ZERO, at(1.0, 1.0, 1.0), false).to_vec(), block.to_vec(), vec![lamp]], 0.6);
    scene.surfaces[2].emission = 10.0;
    scene
}

#[test]
fn a_furnace_with_blocks_is_equally_bright_all_over() {
    // One block is closed, one has no floor of its own, one floats askew.
    let mut hollow = walls(p(0.1, 0.15, 0.0), p(0.3, 0.3, 0.25), true).to_vec();
    hollow.remove(0);
    let (along, across) = (0.1 * p(0.8, 0.6, 0.0), 0.1 * p(-0.6, 0.8, 0.0));
    let (low, up) = (p(0.2, 0.6, 0.6), 0.2 * DVec3::Z);
    let floating = [
        parallelogram(low, across, along),
        parallelogram(low + up, along, across),
        parallelogram(low, along, up),
        parallelogram(low + across, up, along),
        parallelogram(low, up, across),
        parallelogram(low + along, across, up),
    ];
    let block = walls(p(0.55, 0.5, 0.0), p(0.8, 0.85, 0.4), true).to_vec();
    let room = walls(DVec3::ZERO, DVec3::ONE, false).to_vec();
    let mut scene = scene([room, block, hollow, floating.to_vec()], 0.5);
    scene.surfaces.iter_mut().for_each(|surface| surface.emission = 1.0);
    solved(&scene, 0.01, |field, faces| {
        for (face, x) in points(faces) {
            let under = face == 0
                && ((0.55..0.8).contains(&x.x) && (0.5..0.85).contains(&x.y)
                    || (0.1..0.3).contains(&x.x) && (0.15..0.3).contains(&x.y));
            let stands = x.z == 0.0 && face > 5;
            let expected = if under || stands { 1.0 } else { 2.0 };
            let got = field.radiosity(face, x);
            // A cell that reaches under a block has the light beside it: seen from near, a little more than there is.
            assert!((got - expected).abs() < 1e-3, "{got} on face {face} at {x}");
        }
    });
}

/// The corners of its halved trapezoids are off their planes by 10⁻⁹ m, as files write them: in the smaller room that is too much
/// for a convex body.
#[test]
fn a_ball_with_rounded_digits_hides_none_of_its_faces() {
    let rounded = |v: &DVec3| (0.3 * *v * 1e9).round() / 1e9;
    let outside = |polygon: &Polygon| {
        let corners: Vec<DVec3> = polygon.vertices().iter().rev().map(rounded).collect();
        cut(&corners).unwrap()
    };
    let ball: Vec<Polygon> = sphere(8).iter().flat_map(outside).collect();
    assert!(ball.iter().all(|polygon| polygon.vertices().len() == 3));
    for half in [0.5, 2.0] {
        let room = walls(DVec3::splat(-half), DVec3::splat(half), false).to_vec();
        let mut scene = scene([ball.clone(), room], 0.5);
        scene.surfaces.iter_mut().for_each(|surface| surface.emission = 1.0);
        solved(&scene, 0.01, |field, faces| {
            for (face, x) in points(faces) {
                let got = field.radiosity(face, x);
                assert!((got - 2.0).abs() < 5e-3, "{got} on face {face}, {half}");
            }
        });
    }
}

#[test]
fn light_straight_from_a_lamp_is_exact_behind_a_screen() {
    let square = |z: f64, half: f64| parallelogram(p(0.0, 0.0, z), half * DVec3::X, half * DVec3::Y);
    let down = |z: f64, half: f64| parallelogram(p(0.0, 0.0, z), half * DVec3::Y, half * DVec3::X);
    let mut scene = scene([vec![square(0.0, 1.0)], vec![down(1.0, 1.0)], vec![square(0.5, 0.5)]], 0.0);
    scene.surfaces[1].emission = 3.0;
    solved(&scene, 0.01, |field, _| {
        for (x, y) in [(0.25, 0.25), (0.1, 0.7), (0.9, 0.9), (0.01, 0.4)] {
            let x = p(x, y, 0.0);
            // From x the screen's corner at ½ is seen against the lamp twice as far away from x.
            let shadow = |x: f64| (1.0 - x).clamp(0.0, 1.0);
            let hidden = Polygon::quadrilateral(
                p(0.0, 0.0, 1.0),
                p(0.0, shadow(x.y), 1.0),
                p(shadow(x.x), shadow(x.y), 1.0),
                p(shadow(x.x), 0.0, 1.0),
            );
            let factor = |polygon: &Polygon| point_to_polygon(x, DVec3::Z, polygon);
            let expected = 3.0 * (factor(&down(1.0, 1.0)) - factor(&hidden));
            let got = field.irradiance(0, x);
            assert!((got - expected).abs() < 1e-12, "{got} for {expected} at {x}");
        }
    });
}

#[test]
fn the_error_is_no_larger_than_it_is_said_to_be() {
    let scene = room(1.0);
    let look = |field: &Field<'_, f64>, faces: &[Polygon]| {
        let light = field.light(points(faces).into_iter());
        (light.iter().map(|[b, _]| *b).collect::<Vec<f64>>(), field.bound().total())
    };
    let (reference, _) = solved(&scene, 0.01, look);
    let emitting = |k: usize| points(&scene.polygons())[k].0 == 12;
    for accuracy in [0.2, 0.05] {
        let (coarse, bound) = solved(&scene, accuracy, look);
        let reflected = (0..coarse.len()).filter(|&k| !emitting(k)).collect::<Vec<_>>();
        let error = root_mean_square(reflected.iter().map(|&k| coarse[k] - reference[k]));
        let scale = root_mean_square(reflected.iter().map(|&k| reference[k]));
        assert!(bound <= accuracy && error <= bound * scale, "{} said to be {bound}", error / scale);
        assert!(bound * scale < 30.0 * error, "{} said to be {bound}: too careful", error / scale);
    }
}

#[test]
fn the_digits_depend_neither_on_the_threads_nor_on_the_unit() {
    let look = |field: &Field<'_, f64>, faces: &[Polygon]| -> Vec<f64> {
        field.light(points(faces).into_iter()).iter().map(|[b, _]| *b).collect()
    };
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| solved(&room(1.0), 0.05, look))
    };
    let metres = with(1);
    assert_eq!(metres, with(3));
    for unit in [1.0 / 1024.0, 1024.0] {
        let other = solved(&room(unit), 0.05, look);
        assert!(distance(&metres, &other) < 1e-9, "in units of {unit} m");
    }
}

#[test]
fn a_lamp_of_a_hundred_pieces_gives_the_light_of_one() {
    let whole = room(1.0);
    let mut cut = room(1.0);
    let lamp = &whole.surfaces[2].polygons[0];
    let cell = |k: usize| {
        let at = |i: usize, j: usize| lamp.point(i as f64 / 10.0, j as f64 / 10.0);
        let (i, j) = (k % 10, k / 10);
        Polygon::quadrilateral(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1))
    };
    cut.surfaces[2].polygons = (0..100).map(cell).collect();
    let places: Vec<(u32, DVec3)> =
        points(&whole.polygons()).into_iter().filter(|(face, _)| *face < 12).collect();
    let look = |field: &Field<'_, f64>, _: &[Polygon]| -> (Vec<f64>, f64) {
        (field.light(places.iter().copied()).iter().map(|[b, _]| *b).collect(), field.bound().total())
    };
    let ((one, first), (many, second)) = (solved(&whole, 0.03, look), solved(&cut, 0.03, look));
    let error = root_mean_square(one.iter().zip(&many).map(|(a, b)| a - b));
    assert!(error < (first + second) * root_mean_square(one.iter().copied()), "{error}");
}

#[test]
fn without_light_there_is_none_and_no_error() {
    let mut dark = room(1.0);
    dark.surfaces[2].emission = 0.0;
    solved(&dark, 0.01, |field, faces| {
        assert_eq!((field.radiosity(0, faces[0].centroid()), field.bound().total()), (0.0, 0.0));
    });
}

#[test]
fn parts_are_the_faces_and_their_means_those_of_the_field() {
    let scene = room(1.0);
    solved(&scene, 0.05, |field, faces| {
        let parts = field.parts();
        for (k, face) in faces.iter().enumerate() {
            let mine = || parts.iter().filter(|part| part.face == k as u32);
            let area: f64 = mine().map(|part| part.polygon.area()).sum();
            assert!((area / face.area() - 1.0).abs() < 1e-12);
            let mean = mine().map(|part| part.radiosity * part.polygon.area()).sum::<f64>() / area;
            let n = 40;
            let place = |i: usize| (i as f64 + 0.5) / n as f64;
            let grid = (0..n * n).map(|i| field.radiosity(k as u32, face.point(place(i % n), place(i / n))));
            let sampled = grid.sum::<f64>() / (n * n) as f64;
            assert!((mean - sampled).abs() <= 0.03 * sampled, "face {k}: {mean} for {sampled}");
        }
    });
}

#[test]
fn patience_ends_where_the_observer_says() {
    let scene = room(1.0);
    let faces = scene.polygons();
    let domain = Domain::new(&scene, &faces).unwrap();
    let mut rounds = 0;
    let field = solve(&domain, &request(1e-4), |_| {
        rounds += 1;
        rounds < 2
    });
    assert_eq!(rounds, 2);
    assert!(field.bound().total() > 1e-4);
    let few = solve(&domain, &Request { accuracy: 1e-4, most_patches: 40 }, |_| true);
    assert!(few.size()[0] <= 1000);
}

#[test]
fn a_point_light_in_a_cube_is_reflected_as_geometry_says() {
    // CIE 171:2006, TC 5.8: the mean of what is reflected is Φ ρ/(S (1 − ρ)), whatever the shape of a closed room.
    let mut scene = scene([walls(DVec3::ZERO, DVec3::splat(4.0), false).to_vec()], 0.7);
    let position = p(1.0, 2.5, 3.0);
    scene.lights = vec![PointLight::uniform(position, 10_000.0 / (4.0 * PI)).into()];
    solved(&scene, 0.01, |field, faces| {
        let parts = field.parts();
        let all: f64 = parts.iter().map(|part| part.irradiance * part.polygon.area()).sum();
        let expected = 10_000.0 / (1.0 - 0.7);
        assert!((all / expected - 1.0).abs() < 0.01, "{all} lm for {expected}");
        // The point under the light has its light to the last digit, and what else there is.
        let under = field.irradiance(0, p(1.0, 2.5, 0.0));
        let straight = 10_000.0 / (4.0 * PI) / 9.0;
        let reflected = 10_000.0 * 0.7 / (96.0 * 0.3);
        assert!((0.7..1.3).contains(&((under - straight) / reflected)), "{under}");
        assert_eq!(faces.len(), 6);
    });
}

#[test]
fn a_spot_in_a_cube_loses_nothing() {
    let mut scene = scene([walls(DVec3::ZERO, DVec3::splat(4.0), false).to_vec()], 0.7);
    let spot = Spot { direction: p(0.3, -0.2, -1.0).normalize(), inner: 0.3, outer: 0.6 };
    let distribution = Distribution::Spot(spot);
    let flux = 1000.0 * distribution.flux_of_unit();
    scene.lights = vec![PointLight { position: p(1.0, 2.5, 3.0), intensity: 1000.0, distribution }.into()];
    solved(&scene, 0.01, |field, _| {
        let all: f64 = field.parts().iter().map(|part| part.irradiance * part.polygon.area()).sum();
        let expected = flux / (1.0 - 0.7);
        assert!((all / expected - 1.0).abs() < 0.01, "{all} lm for {expected}");
    });
}

#[test]
fn the_sun_through_a_hole_lights_as_much_as_comes_through() {
    // A roof of 4 m with a hole of a square metre, over black walls.
    let mut walls = walls(DVec3::ZERO, DVec3::splat(4.0), false).to_vec();
    let roof = |x: f64, y: f64, along: f64, across: f64| {
        parallelogram(p(x, y, 4.0), across * DVec3::Y, along * DVec3::X)
    };
    walls.splice(
        1..2,
        [
            roof(0.0, 0.0, 4.0, 1.0),
            roof(0.0, 2.0, 4.0, 2.0),
            roof(0.0, 1.0, 1.0, 1.0),
            roof(2.0, 1.0, 2.0, 1.0),
        ],
    );
    let mut scene = scene([walls], 0.0);
    let direction = p(0.2, 0.35, -1.0).normalize();
    scene.lights = vec![Sun { direction, irradiance: 1000.0 }.into()];
    let expected = -1000.0 * direction.z;
    let patches = Patches::new(&scene, 0.5).unwrap();
    let lit = mean_irradiances(&patches, &Visibility::new(&scene.polygons()));
    let all: f64 = lit.iter().zip(&patches.areas).map(|(h, area)| h * area).sum();
    // A dozen patches of 0.25 m² lie on the edge, and know their light to some thousandths.
    assert!((all - expected).abs() < 12.0 * 0.25 * 2e-3 * expected, "{all} W for {expected}");
    solved(&scene, 0.01, |field, _| {
        // Under the hole, on the way of the sun, and beside it.
        let at = |x: f64, y: f64| field.irradiance(0, p(x + 0.8, y + 1.4, 0.0));
        assert_eq!(
            [at(1.01, 1.01), at(1.99, 1.5), at(0.99, 1.5), at(1.5, 2.01)],
            [expected, expected, 0.0, 0.0]
        );
    });
}

#[test]
fn where_nothing_is_reflected_one_mesh_will_do() {
    let mut black = room(1.0);
    black.surfaces.iter_mut().for_each(|surface| surface.reflectance = 0.0);
    let faces = black.polygons();
    let domain = Domain::new(&black, &faces).unwrap();
    let mut rounds = 0;
    let field = solve(&domain, &request(0.001), |_| {
        rounds += 1;
        true
    });
    assert_eq!((rounds, field.bound().total()), (1, 0.0));
    assert!(field.irradiance(0, p(0.4, 0.4, 0.0)) > 0.0);
}

#[test]
fn behind_many_triangles_rays_tell_what_is_in_sight() {
    // A furnace with a ball of 224 faces: more than it is worth to clip by.
    let ball = sphere(8).into_iter().map(|face| {
        let v: Vec<DVec3> = face.vertices().iter().rev().map(|v| 0.5 * DVec3::ONE + 0.25 * *v).collect();
        match *v.as_slice() {
            [a, b, c, d] => Polygon::quadrilateral(a, b, c, d),
            _ => Polygon::triangle(v[0], v[1], v[2]),
        }
    });
    let halves = ball
        .flat_map(|face| face.triangles().map(|[a, b, c]| Polygon::triangle(a, b, c)).collect::<Vec<_>>());
    let mut scene = scene([walls(DVec3::ZERO, DVec3::ONE, false).to_vec(), halves.collect()], 0.5);
    scene.surfaces.iter_mut().for_each(|surface| surface.emission = 1.0);
    solved(&scene, 0.05, |field, faces| {
        let of_walls = |(face, _): &(u32, DVec3)| *face < 6;
        let light = field.light(points(faces).into_iter().filter(of_walls));
        let errors: Vec<f64> = light.iter().map(|[b, _]| b / 2.0 - 1.0).collect();
        assert!(root_mean_square(errors.iter().copied()) < 0.01, "{errors:?}");
    });
}

#[test]
fn more_faces_than_pairs_can_be_looked_at_are_refused() {
    let faces = vec![parallelogram(DVec3::ZERO, DVec3::X, DVec3::Y); 6001];
    let error = Domain::new(&scene([faces.clone()], 0.5), &faces).unwrap_err();
    assert!(error.to_string().contains("6001 faces"), "{error}");
}
