//! The Cornell box as it was measured: skewed walls, 76 bands of wavelength, the lamp in a hole of the ceiling.

use super::{Camera, Scene, Surface, cut};
use crate::polygon::Polygon;
use fredholm::value::{Rgb, Spectrum, Value};
use glam::DVec3;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// Walls, then the short and the tall block: the order in which they were published.
const QUADS: [&str; 15] = [
    "floor", "ceiling", "back", "right", "left", "s_top", "s_1", "s_2", "s_3", "s_4", "t_top", "t_1", "t_2",
    "t_3", "t_4",
];

const METRES_PER_MILLIMETRE: f64 = 1e-3;

/// The Cornell box in red, green and blue: the colours that McGuire's archive gives it, under a lamp of radiance
/// (17, 12, 4) W/(m² sr).
pub fn cornell_box() -> Scene<Rgb> {
    let data = Data::embedded();
    let rgb = &data.rgb_mcguire;
    let reflectance = |material: &str| match material {
        "red" => Spectrum(rgb.red),
        "green" => Spectrum(rgb.green),
        _ => Spectrum(rgb.white),
    };
    data.scene(reflectance, Spectrum(rgb.light_radiance))
}

/// The Cornell box in its 76 measured bands, 400 nm, 404 nm … 700 nm; the lamp was measured at 400, 500, 600 and
/// 700 nm and is interpolated between.
pub fn cornell_box_spectral() -> Scene<Spectrum<76>> {
    let data = Data::embedded();
    let bands = |values: &[f64]| Spectrum(std::array::from_fn(|k| values[k]));
    let reflectance = |material: &str| match material {
        "red" => bands(&data.red),
        "green" => bands(&data.green),
        _ => bands(&data.white),
    };
    data.scene(reflectance, Spectrum(std::array::from_fn(|k| data.light.radiance(data.wavelengths_nm[k]))))
}

/// The published file; lengths in millimetres.
#[derive(Deserialize)]
struct Data {
    camera: CameraData,
    light: Light,
    quads: BTreeMap<String, Quad>,
    wavelengths_nm: Vec<f64>,
    white: Vec<f64>,
    green: Vec<f64>,
    red: Vec<f64>,
    rgb_mcguire: Colours,
}

#[derive(Deserialize)]
struct CameraData {
    position: [f64; 3],
    direction: [f64; 3],
    up: [f64; 3],
    focal_length: f64,
    height: f64,
}

#[derive(Deserialize)]
struct Light {
    vertices: [[f64; 3]; 4],
    emission_nm: BTreeMap<u32, f64>,
    reflectance: f64,
}

#[derive(Deserialize)]
struct Quad {
    material: String,
    vertices: [[f64; 3]; 4],
}

#[derive(Deserialize)]
struct Colours {
    white: [f64; 3],
    red: [f64; 3],
    green: [f64; 3],
    light_radiance: [f64; 3],
}

impl Data {
    #[expect(clippy::expect_used, reason = "the file is part of the program, and a test reads it")]
    fn embedded() -> Self {
        serde_json::from_str(include_str!("cornell-box.json"))
            .expect("the embedded Cornell box is well formed")
    }

    fn scene<V: Value>(&self, reflectance: impl Fn(&str) -> V, lamp_radiance: V) -> Scene<V> {
        let walls = QUADS.iter().map(|&name| {
            let quad = &self.quads[name];
            let corners = quad.vertices.map(metres);
            let polygons = if name == "ceiling" { self.ceiling(corners) } else { measured(corners) };
            surface(name, reflectance(&quad.material), V::splat(0.0), polygons)
        });
        let [a, b, c, d] = self.light.vertices.map(metres);
        let lamp = vec![Polygon::quadrilateral(a, b, c, d)];
        let lamp = surface("light", V::splat(self.light.reflectance), lamp_radiance * PI, lamp);
        let surfaces = walls.chain([lamp]).collect();
        Scene {
            name: "Cornell box".to_owned(),
            surfaces,
            lights: Vec::new(),
            camera: Some(self.camera.camera()),
        }
    }

    /// The ceiling without the lamp's hole: nine rectangles without the middle one, which share whole edges.
    fn ceiling(&self, corners: [DVec3; 4]) -> Vec<Polygon> {
        let hole = self.light.vertices.map(metres);
        let (xs, zs) = (grid_lines(corners, hole, |v| v.x), grid_lines(corners, hole, |v| v.z));
        let at = |i: usize, j: usize| DVec3::new(xs[i], corners[0].y, zs[j]);
        let cells = (0..9).filter(|&cell| cell != 4).map(|cell| (cell / 3, cell % 3));
        cells
            .map(|(i, j)| Polygon::quadrilateral(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)))
            .collect()
    }
}

impl Light {
    /// Linear between the measured wavelengths.
    fn radiance(&self, nanometres: f64) -> f64 {
        let measured: Vec<(f64, f64)> =
            self.emission_nm.iter().map(|(&at, &value)| (f64::from(at), value)).collect();
        let interval = measured.windows(2).find(|pair| nanometres <= pair[1].0);
        interval.map_or(0.0, |pair| {
            let t = (nanometres - pair[0].0) / (pair[1].0 - pair[0].0);
            (1.0 - t) * pair[0].1 + t * pair[1].1
        })
    }
}

impl CameraData {
    fn camera(&self) -> Camera {
        let position = metres(self.position);
        Camera {
            position,
            target: position + DVec3::from(self.direction),
            up: DVec3::from(self.up),
            vertical_angle: 2.0 * (0.5 * self.height / self.focal_length).atan(),
        }
    }
}

fn metres(millimetres: [f64; 3]) -> DVec3 {
    DVec3::from(millimetres) * METRES_PER_MILLIMETRE
}

fn surface<V>(name: &str, reflectance: V, emission: V, polygons: Vec<Polygon>) -> Surface<V> {
    Surface { name: name.to_owned(), reflectance, emission, polygons }
}

/// A wall as measured: the left one is twisted by 3 mm and so becomes two triangles.
fn measured(corners: [DVec3; 4]) -> Vec<Polygon> {
    let [a, b, c, d] = corners;
    cut(&corners).unwrap_or_else(|_| vec![Polygon::triangle(a, b, c), Polygon::triangle(a, c, d)])
}

/// Where a rectangle and the one in its midst begin and end along an axis, in order.
fn grid_lines(outer: [DVec3; 4], inner: [DVec3; 4], axis: impl Fn(DVec3) -> f64) -> [f64; 4] {
    let low = |corners: [DVec3; 4]| corners.map(&axis).into_iter().fold(f64::INFINITY, f64::min);
    let high = |corners: [DVec3; 4]| corners.map(&axis).into_iter().fold(f64::NEG_INFINITY, f64::max);
    [low(outer), low(inner), high(inner), high(outer)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polygons<'a>(
        scene: &'a Scene<Rgb>,
        pick: impl Fn(&str) -> bool + 'a,
    ) -> impl Iterator<Item = &'a Polygon> {
        scene.surfaces.iter().filter(move |surface| pick(&surface.name)).flat_map(|surface| &surface.polygons)
    }

    fn is_block(name: &str, letter: char) -> bool {
        name.starts_with(letter) && name[1..].starts_with('_')
    }

    fn is_room(name: &str) -> bool {
        !is_block(name, 's') && !is_block(name, 't')
    }

    #[test]
    fn the_embedded_file_is_well_formed_and_the_scenes_pass_their_checks() {
        let (rgb, spectral) = (cornell_box(), cornell_box_spectral());
        rgb.check().unwrap();
        spectral.check().unwrap();
        let names: Vec<_> = rgb.surfaces.iter().map(|surface| surface.name.as_str()).collect();
        assert_eq!(names[..15], QUADS);
        assert_eq!(names[15..], ["light"]);
        assert!(rgb.surfaces.iter().zip(&spectral.surfaces).all(|(a, b)| a.polygons == b.polygons));
    }

    #[test]
    fn ceiling_and_lamp_make_the_whole_rectangle() {
        let scene = cornell_box();
        assert!((scene.surfaces[15].area() - 0.130 * 0.105).abs() < 1e-15);
        assert!((scene.surfaces[1].area() + scene.surfaces[15].area() - 0.556 * 0.5592).abs() < 1e-15);
        assert_eq!(scene.surfaces[1].polygons.len(), 8);
        assert!(
            polygons(&scene, |name| name == "ceiling" || name == "light")
                .all(|p| p.normal().y < -1.0 + 1e-12)
        );
    }

    #[test]
    fn only_the_left_wall_is_twisted() {
        let scene = cornell_box();
        let count: Vec<_> = scene.surfaces.iter().map(|surface| surface.polygons.len()).collect();
        assert_eq!(count, [1, 8, 1, 1, 2, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1]);
    }

    #[test]
    fn walls_face_into_the_room_and_blocks_out_of_themselves() {
        let scene = cornell_box();
        let middle = DVec3::splat(0.275);
        assert!(polygons(&scene, is_room).all(|p| p.height_of(middle) > 0.2));
        for letter in ['s', 't'] {
            let block = || polygons(&scene, move |name| is_block(name, letter));
            let inside = block().map(Polygon::centroid).sum::<DVec3>() / 5.0;
            assert_eq!(block().count(), 5);
            assert!(block().all(|p| p.height_of(inside) < -0.01));
        }
    }

    #[test]
    fn the_room_is_open_only_to_the_camera() {
        // ∮ n dA = 0 over a closed surface; what is missing is the front at z = 0, 0.5528 and 0.556 wide, 0.5488 high.
        let scene = cornell_box();
        let sum: DVec3 = polygons(&scene, is_room).map(|p| p.normal() * p.area()).sum();
        assert!(sum.distance(DVec3::new(0.0, 0.0, -0.5 * (0.5528 + 0.556) * 0.5488)) < 1e-12);
    }

    #[test]
    fn colours_are_those_published() {
        let scene = cornell_box();
        let reflectance = |k: usize| scene.surfaces[k].reflectance;
        assert_eq!(reflectance(0), Spectrum([0.725, 0.71, 0.68]));
        assert_eq!(reflectance(3), Spectrum([0.14, 0.45, 0.091]));
        assert_eq!(reflectance(4), Spectrum([0.63, 0.065, 0.05]));
        assert_eq!(reflectance(15), Rgb::splat(0.78));
        assert_eq!(scene.surfaces[15].emission, Spectrum([17.0, 12.0, 4.0]) * PI);
    }

    #[test]
    fn the_lamps_spectrum_is_linear_between_the_measured_wavelengths() {
        let scene = cornell_box_spectral();
        let lamp = scene.surfaces[15].emission.0.map(|e| e / PI);
        let expected = [(0, 0.0), (25, 8.0), (26, 8.0 + 0.04 * 7.6), (50, 15.6), (75, 18.4), (12, 3.84)];
        assert!(expected.iter().all(|&(band, radiance)| (lamp[band] - radiance).abs() < 1e-12));
        assert_eq!(scene.surfaces[0].reflectance.0[0], 0.343);
        assert_eq!(scene.surfaces[4].reflectance.0[75], 0.642);
        assert_eq!(scene.surfaces[15].reflectance, Spectrum::splat(0.78));
    }

    #[test]
    fn the_camera_sees_40_degrees() {
        let camera = cornell_box().camera.unwrap();
        assert!((camera.vertical_angle.to_degrees() - 39.307_645).abs() < 1e-5);
        assert!(camera.position.distance(DVec3::new(0.278, 0.273, -0.8)) < 1e-15);
        assert!((camera.target - camera.position).normalize().distance(DVec3::Z) < 1e-15);
    }
}
