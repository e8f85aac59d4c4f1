//! Daylight through an opening without a pane, the sky component, after TC 5.9 and TC 5.11 of CIE 171:2006.

use super::common::{p, parallelogram, walls};
use super::{Case, Row};
use glam::DVec3;
use radiosity::adaptive::{Domain, Request, solve};
use radiosity::scene::{Light, Scene, Sky, Surface};
use radiosity::sky::{Dome, Kind, Model};
use std::f64::consts::PI;
use std::sync::Arc;

const SKIES: [(&str, Kind); 5] = [
    ("uniform", Kind::Uniform),
    ("1 : 3", Kind::Overcast),
    ("type 1", Kind::General(1)),
    ("type 7", Kind::General(7)),
    ("type 12", Kind::General(12)),
];

pub fn cases() -> Vec<Case> {
    vec![roof(), facade(), free()]
}

fn model(kind: Kind) -> Model {
    let [azimuth, elevation] = [150_f64, 40.0].map(f64::to_radians);
    let sun = p(azimuth.sin() * elevation.cos(), azimuth.cos() * elevation.cos(), elevation.sin());
    Model::new(kind, DVec3::Z, sun)
}

/// A black room of 4 × 4 × 3 m of which some walls are replaced.
fn room(replaced: usize, by: Vec<radiosity::polygon::Polygon>, kind: Kind) -> Scene<f64> {
    let mut polygons = walls(DVec3::ZERO, p(4.0, 4.0, 3.0), false).to_vec();
    polygons.splice(replaced..=replaced, by);
    let surfaces = vec![Surface { name: "room".into(), reflectance: 0.0, emission: 0.0, polygons }];
    let sky = Sky { zenith: 1000.0, dome: Arc::new(Dome::new(model(kind))) };
    Scene { name: "CIE 171".into(), surfaces, lights: vec![Light::Sky(sky)], camera: None }
}

/// ∫ L cosθ cosθ′/r² over an opening from a corner along two edges, by Gauss's rule of three points on 120² cells.
fn through(kind: Kind, (corner, along, across): (DVec3, DVec3, DVec3), point: DVec3, normal: DVec3) -> f64 {
    const CELLS: u32 = 120;
    const NODES: [(f64, f64); 3] =
        [(-0.774_596_669_241_483_4, 5.0 / 18.0), (0.0, 4.0 / 9.0), (0.774_596_669_241_483_4, 5.0 / 18.0)];
    let model = model(kind);
    let vector_area = along.cross(across);
    let mut sum = 0.0;
    for (i, j) in (0..CELLS).flat_map(|i| (0..CELLS).map(move |j| (i, j))) {
        for ((s, u), (t, v)) in NODES.iter().flat_map(|a| NODES.iter().map(move |b| (*a, *b))) {
            let [s, t] =
                [(i, s), (j, t)].map(|(k, node)| (f64::from(k) + 0.5 + 0.5 * node) / f64::from(CELLS));
            let between = corner + along * s + across * t - point;
            let (distance, omega) = (between.length(), between.normalize());
            let solid_angle = vector_area.dot(omega).abs() / (distance * distance);
            sum += u * v * solid_angle * model.relative(omega) * omega.dot(normal).max(0.0);
        }
    }
    1000.0 * sum / f64::from(CELLS * CELLS)
}

/// Rows of points of faces, for each sky.
fn rows(
    scene: impl Fn(Kind) -> Scene<f64>,
    opening: (DVec3, DVec3, DVec3),
    points: &[(&str, u32, DVec3)],
) -> Vec<Row> {
    let mut rows = Vec::new();
    for (name, kind) in SKIES {
        let scene = scene(kind);
        let faces = scene.polygons();
        let domain = Domain::new(&scene, &faces).unwrap();
        let field = solve(&domain, &Request::default(), |_| false);
        for (place, face, point) in points {
            let expected = through(kind, opening, *point, faces[*face as usize].normal());
            rows.push(Row::new(format!("{name}: {place}"), expected, field.irradiance(*face, *point)));
        }
    }
    rows
}

fn roof() -> Case {
    let part = |x: f64, y: f64, along: f64, across: f64| {
        parallelogram(p(x, y, 3.0), across * DVec3::Y, along * DVec3::X)
    };
    let ring = vec![
        part(0.0, 0.0, 4.0, 1.5),
        part(0.0, 2.5, 4.0, 1.5),
        part(0.0, 1.5, 1.5, 1.0),
        part(2.5, 1.5, 1.5, 1.0),
    ];
    let points = [
        ("floor (2, 2, 0)", 0, p(2.0, 2.0, 0.0)),
        ("floor (2, 0.5, 0)", 0, p(2.0, 0.5, 0.0)),
        ("floor (0.25, 0.25, 0)", 0, p(0.25, 0.25, 0.0)),
        ("wall (2, 0, 1.5)", 5, p(2.0, 0.0, 1.5)),
        ("wall (2, 0, 2.75)", 5, p(2.0, 0.0, 2.75)),
    ];
    Case {
        title: "Sky component under an opening in the roof",
        about: "After CIE 171:2006, TC 5.9: a room of 4 × 4 × 3 m with an opening of 1 × 1 m without a pane in the middle of its roof, \
                under skies of 1000 cd/m² at the zenith, the sun at azimuth 150° and elevation 40°; illuminance in lx straight \
                from the sky, by `adaptive::Field::irradiance`, which clips. Expected is a product rule over the opening.",
        accepted: "5 % at a point, 10 % over all",
        within: 1e-3,
        decimals: 3,
        rows: rows(|kind| room(1, ring.clone(), kind), (p(1.5, 1.5, 3.0), DVec3::X, DVec3::Y), &points),
    }
}

fn facade() -> Case {
    // In the wall y = 4, from x = 1 to 3 and z = 1 to 2.
    let part =
        |x: f64, z: f64, along: f64, up: f64| parallelogram(p(x, 4.0, z), along * DVec3::X, up * DVec3::Z);
    let ring = vec![
        part(0.0, 0.0, 4.0, 1.0),
        part(0.0, 2.0, 4.0, 1.0),
        part(0.0, 1.0, 1.0, 1.0),
        part(3.0, 1.0, 1.0, 1.0),
    ];
    let points = [
        ("floor (2, 3, 0)", 0, p(2.0, 3.0, 0.0)),
        ("floor (2, 0.5, 0)", 0, p(2.0, 0.5, 0.0)),
        ("floor (0.25, 3.75, 0)", 0, p(0.25, 3.75, 0.0)),
        ("wall (2, 0, 0.5)", 2, p(2.0, 0.0, 0.5)),
    ];
    Case {
        title: "Sky component by an opening in the facade",
        about: "After CIE 171:2006, TC 5.11: the same room with an opening of 2 × 1 m in the wall y = 4, and no ground outside. All \
                of these points see the sky alone through it.",
        accepted: "5 % at a point, 10 % over all",
        within: 1e-3,
        decimals: 3,
        rows: rows(|kind| room(3, ring.clone(), kind), (p(1.0, 4.0, 1.0), 2.0 * DVec3::X, DVec3::Z), &points),
    }
}

fn free() -> Case {
    let of = |kind| Dome::new(model(kind));
    let (uniform, overcast) = (of(Kind::Uniform), of(Kind::Overcast));
    Case {
        title: "Free surfaces under the sky",
        about: "E/L_z of a horizontal and of a vertical plane from which nothing is hidden, by `sky::Dome::unobstructed`; π, π/2, \
                7π/9 and π/6 + 4/9.",
        accepted: "",
        within: 1e-6,
        decimals: 6,
        rows: vec![
            Row::new("uniform, horizontal", PI, uniform.unobstructed(DVec3::Z)),
            Row::new("uniform, vertical", PI / 2.0, uniform.unobstructed(DVec3::X)),
            Row::new("1 : 3, horizontal", 7.0 / 9.0 * PI, overcast.unobstructed(DVec3::Z)),
            Row::new("1 : 3, vertical", PI / 6.0 + 4.0 / 9.0, overcast.unobstructed(DVec3::X)),
        ],
    }
}
