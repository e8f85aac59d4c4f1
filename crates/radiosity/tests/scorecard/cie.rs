//! CIE 171:2006, the cases that follow from geometry alone.

use super::common::{p, parallelogram, visibility, walls};
use super::formulas::{parallel, perpendicular};
use super::{Case, Row};
use glam::DVec3;
use radiosity::adaptive::{Domain, Request, solve};
use radiosity::kernel::SurfacePoint;
use radiosity::lights::irradiance;
use radiosity::patches::Patches;
use radiosity::polygon::Polygon;
use radiosity::scene::{PointLight, Scene, Surface};
use radiosity::solve::{Options, Unobserved};
use std::f64::consts::PI;

const ACCEPTED: &str = "5 % at a point, 10 % over all";

pub fn cases() -> Vec<Case> {
    vec![point_source(), area_source(), uniform_floor(), obstruction(), indirect()]
}

/// The formula's value, which has the digits that were published.
#[track_caller]
fn published(formula: f64, digits: f64) -> f64 {
    assert!((formula - digits).abs() < 5.1e-5, "{formula} is not {digits}");
    formula
}

/// Black surfaces with their exitances.
fn black(surfaces: &[(f64, &[Polygon])]) -> Scene<f64> {
    let surface = |(k, (emission, polygons)): (usize, &(f64, &[Polygon]))| Surface {
        name: k.to_string(),
        reflectance: 0.0,
        emission: *emission,
        polygons: polygons.to_vec(),
    };
    let surfaces = surfaces.iter().enumerate().map(surface).collect();
    Scene { name: "CIE 171".into(), surfaces, lights: Vec::new(), camera: None }
}

/// The irradiance at points of faces: what hides the sources is clipped away.
fn at(scene: &Scene<f64>, points: &[(u32, DVec3)]) -> Vec<f64> {
    let faces = scene.polygons();
    let domain = Domain::new(scene, &faces).unwrap();
    // Where nothing is reflected there is no error to look for, and one mesh will do.
    let field = solve(&domain, &Request::default(), |_| false);
    points.iter().map(|(face, point)| field.irradiance(*face, *point)).collect()
}

fn point_source() -> Case {
    const LUX: [(f64, f64, f64); 10] = [
        (0.0, 0.0, 111.1111),
        (0.5, 0.0, 105.1863),
        (1.0, 0.0, 90.0),
        (1.5, 0.0, 71.1111),
        (0.5, 0.5, 99.7230),
        (1.0, 0.5, 85.6633),
        (1.5, 0.5, 68.0529),
        (1.0, 1.0, 74.3802),
        (1.5, 1.0, 59.9750),
        (1.5, 1.5, 49.3827),
    ];
    let light = PointLight::diffuse(3.0 * DVec3::Z, 1000.0, -DVec3::Z).into();
    let floor = black(&[(0.0, &[parallelogram(p(-2.0, -2.0, 0.0), 4.0 * DVec3::X, 4.0 * DVec3::Y)])]);
    let visibility = visibility(&floor);
    let row = |(x, y, lux): (f64, f64, f64)| {
        let square = x * x + y * y + 9.0;
        let at = SurfacePoint { position: p(x, y, 0.0), normal: DVec3::Z };
        let expected = published(1000.0 * 9.0 / (square * square), lux);
        Row::new(
            format!("({x}, {y}, 0)"),
            expected,
            irradiance(std::slice::from_ref(&light), &visibility, &at),
        )
    };
    Case {
        title: "CIE 171:2006, TC 5.2",
        about: "A diffuse point source of 1000 cd at (0, 0, 3) m; illuminance of the plane z = 0 in lx, by `lights::irradiance`.",
        accepted: ACCEPTED,
        within: 1e-6,
        decimals: 6,
        rows: LUX.map(row).into(),
    }
}

fn area_source() -> Case {
    const WALL: [(f64, f64); 6] = [
        (2.75, 32.6769),
        (2.25, 75.1939),
        (1.75, 81.3232),
        (1.25, 69.0606),
        (0.75, 53.4035),
        (0.25, 40.0019),
    ];
    const FLOOR: [(f64, f64); 4] = [(0.25, 61.4241), (0.75, 79.2552), (1.25, 95.6673), (1.75, 105.7782)];
    let exitance = PI * 1000.0;
    let [floor, _, wall, ..] = walls(DVec3::ZERO, p(4.0, 4.0, 3.0), false);
    let source = parallelogram(p(1.5, 1.5, 3.0), DVec3::Y, DVec3::X);
    let scene = black(&[(exitance, &[source]), (0.0, &[floor, wall])]);
    let on_wall = WALL.map(|(z, lux)| {
        let expected = exitance * perpendicular([-0.5, 0.5], [1.5, 2.5], 3.0 - z);
        (format!("wall (2, 0, {z})"), published(expected, lux), (2, p(2.0, 0.0, z)))
    });
    let on_floor = FLOOR.map(|(y, lux)| {
        let expected = exitance * parallel([-0.5, 0.5], [1.5 - y, 2.5 - y], 3.0);
        (format!("floor (2, {y}, 0)"), published(expected, lux), (1, p(2.0, y, 0.0)))
    });
    Case {
        title: "CIE 171:2006, TC 5.3",
        about: "A diffuse source of 1 × 1 m and 1000 cd/m² in the middle of the ceiling of a room of 4 × 4 × 3 m; direct \
                illuminance in lx, by `adaptive::Field::irradiance`.",
        accepted: ACCEPTED,
        within: 1e-6,
        decimals: 6,
        rows: computed(&scene, on_wall.into_iter().chain(on_floor)),
    }
}

/// A row for each (name, expected, (face, point)).
fn computed(scene: &Scene<f64>, points: impl Iterator<Item = (String, f64, (u32, DVec3))>) -> Vec<Row> {
    let points: Vec<_> = points.collect();
    let places: Vec<_> = points.iter().map(|(_, _, place)| *place).collect();
    let ours = at(scene, &places);
    points.into_iter().zip(ours).map(|((name, expected, _), ours)| Row::new(name, expected, ours)).collect()
}

fn uniform_floor() -> Case {
    const WALL: [(f64, f64); 5] =
        [(0.75, 35.9005), (1.25, 27.9916), (1.75, 21.6385), (2.25, 16.7163), (2.75, 12.9674)];
    const CEILING: [(f64, f64); 4] = [(0.25, 26.7952), (0.75, 30.9387), (1.25, 33.9757), (1.75, 35.5666)];
    let [floor, ceiling, wall, ..] = walls(DVec3::ZERO, p(4.0, 4.0, 3.0), false);
    let scene = black(&[(100.0, &[floor]), (0.0, &[ceiling, wall])]);
    let on_wall = WALL.map(|(z, percent)| {
        let expected = 100.0 * perpendicular([-2.0, 2.0], [0.0, 4.0], z);
        (format!("wall (2, 0, {z})"), published(expected, percent), (2, p(2.0, 0.0, z)))
    });
    let on_ceiling = CEILING.map(|(y, percent)| {
        let expected = 100.0 * parallel([-2.0, 2.0], [-y, 4.0 - y], 3.0);
        (format!("ceiling (2, {y}, 3)"), published(expected, percent), (1, p(2.0, y, 3.0)))
    });
    Case {
        title: "CIE 171:2006, TC 5.6",
        about: "A uniform floor of 4 × 4 m as the source, in a room 3 m high; 100 F, by `adaptive::Field::irradiance`.",
        accepted: ACCEPTED,
        within: 1e-6,
        decimals: 6,
        rows: computed(&scene, on_wall.into_iter().chain(on_ceiling)),
    }
}

fn obstruction() -> Case {
    const WALL: [(f64, f64); 6] =
        [(2.75, 16.0706), (2.25, 16.3297), (1.75, 15.3988), (1.25, 13.3220), (0.75, 10.3169), (0.25, 7.0790)];
    const FLOOR: [(f64, f64); 5] = [(0.25, 3.3823), (0.75, 3.6290), (1.25, 3.0130), (1.75, 0.0), (2.25, 0.0)];
    let [floor, _, wall, source, ..] = walls(DVec3::ZERO, p(4.0, 4.0, 3.0), false);
    let [_, top, front, back, ..] = walls(p(0.0, 2.5, 0.0), p(4.0, 2.7, 1.0), true);
    let scene = black(&[(100.0, &[source]), (0.0, &[floor, wall, top, front, back])]);
    // From (y, z) the box hides the source up to the height where the line over one of its upper edges meets it.
    let hidden = |y: f64, z: f64| {
        let over = |edge: f64| z + (1.0 - z) * (4.0 - y) / (edge - y);
        over(2.5).max(over(2.7)).clamp(0.0, 3.0)
    };
    let on_wall = WALL.map(|(z, percent)| {
        let expected = 100.0 * parallel([-2.0, 2.0], [hidden(0.0, z) - z, 3.0 - z], 4.0);
        (format!("wall (2, 0, {z})"), published(expected, percent), (2, p(2.0, 0.0, z)))
    });
    let on_floor = FLOOR.map(|(y, percent)| {
        let expected = 100.0 * perpendicular([-2.0, 2.0], [hidden(y, 0.0), 3.0], 4.0 - y);
        (format!("floor (2, {y}, 0)"), published(expected, percent), (1, p(2.0, y, 0.0)))
    });
    Case {
        title: "CIE 171:2006, TC 5.7",
        about: "A uniform wall y = 4 of 4 × 3 m as the source, and across the room a black box from y = 2.5 to 2.7 and up to \
                z = 1 that hides part of it; 100 F, by `adaptive::Field::irradiance`, which clips. (Table 19 of the standard \
                has other numbers; these are the formula's.)",
        accepted: ACCEPTED,
        within: 1e-6,
        decimals: 6,
        rows: computed(&scene, on_wall.into_iter().chain(on_floor)),
    }
}

fn indirect() -> Case {
    const LUX: [(f64, f64); 11] = [
        (0.05, 5.4825),
        (0.1, 11.5741),
        (0.2, 26.0417),
        (0.3, 44.6429),
        (0.4, 69.4444),
        (0.5, 104.1667),
        (0.6, 156.25),
        (0.7, 243.0556),
        (0.8, 416.6667),
        (0.9, 937.5),
        (0.95, 1979.1667),
    ];
    let direct = 10_000.0 / 96.0;
    let mut rows = Vec::new();
    for (rho, lux) in LUX {
        let (lit, all) = means_of_the_cube(rho);
        if rows.is_empty() {
            rows.push(Row::new("direct, mean", published(direct, 104.1667), lit));
        }
        let expected = published(direct * rho / (1.0 - rho), lux);
        rows.push(Row::new(format!("ρ = {rho}, indirect, mean"), expected, all - lit));
    }
    Case {
        title: "CIE 171:2006, TC 5.8",
        about: "An isotropic point source of 10 000 lm in the middle of a cube of 4 m of one reflectance; mean illuminance in \
                lx, Φρ/(S(1 − ρ)), by `solve` on 96 patches.",
        accepted: ACCEPTED,
        within: 1e-3,
        decimals: 3,
        rows,
    }
}

/// The mean illuminance straight from the light, and all of it.
fn means_of_the_cube(reflectance: f64) -> (f64, f64) {
    let mut cube = super::common::scene([walls(DVec3::ZERO, DVec3::splat(4.0), false).to_vec()], reflectance);
    let intensity = 10_000.0 / (4.0 * PI);
    cube.lights = vec![PointLight::uniform(DVec3::splat(2.0), intensity).into()];
    let (patches, visibility) = (Patches::new(&cube, 1.0).unwrap(), visibility(&cube));
    let options = Options { tolerance: 1e-10, accuracy: 1e-6, ..Options::default() };
    let solution = radiosity::solve::solve(&patches, &visibility, &options, &mut Unobserved).unwrap();
    let lit = radiosity::lights::mean_irradiances(&patches, &visibility);
    let mean = |values: &[f64]| super::common::mean(&patches, values, |_| true);
    (mean(&lit), mean(&solution.irradiance))
}
