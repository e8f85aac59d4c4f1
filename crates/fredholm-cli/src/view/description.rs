//! `/scene.json` and `/geometry.bin`: what a page has to know of a scene before it sees light.

use super::discrete::{Discrete, Kind};
use super::lamps::Lamp;
use super::protocol::numbers;
use super::solvers::Solver;
use super::stage::ranges;
use crate::radiosity::frames::exposure;
use fredholm::value::Rgb;
use radiosity::patches::Patches;
use radiosity::polygon::Polygon;
use radiosity::render::Colour;
use radiosity::scene::{Camera, Light, Scene, Sky, Units};
use radiosity::sky;
use radiosity::visibility::Visibility;
use serde::Serialize;
use std::ops::Range;

/// The scene in words.
#[derive(Clone, Debug, Serialize)]
pub struct Description {
    /// What it is called.
    pub name: String,
    /// How many patches.
    pub patches: usize,
    /// The longest that their edges may be, in metres.
    pub patch_size: f64,
    /// What numbers are in.
    pub units: Symbols,
    /// The surfaces, in the order of their patches.
    pub surfaces: Vec<Surface>,
    /// The lamps, in the order of their factors; none where nothing can be dimmed.
    pub lamps: Vec<Dimmable>,
    /// What is seen beyond the surfaces; none where that is nothing.
    pub sky: Option<Beyond>,
    /// Where it is looked at from at first.
    pub camera: Viewpoint,
    /// From radiance to a screen on which 1 is white.
    pub exposure: f64,
    /// The method and the polynomials that begin; none where nothing is solved.
    pub kind: Option<Kind>,
    /// The solvers that can be watched, the first of which begins.
    pub solvers: Vec<Solver>,
}

/// Units, as they are printed.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Symbols {
    exitance: &'static str,
    irradiance: &'static str,
    radiance: &'static str,
    power: &'static str,
    length: &'static str,
}

impl Symbols {
    /// Of light in these units.
    pub fn new(units: Units) -> Self {
        let power = if units == Units::Photometric { "lm" } else { "W" };
        Self {
            exitance: units.exitance(),
            irradiance: units.irradiance(),
            radiance: units.radiance(),
            power,
            length: "m",
        }
    }
}

/// A lamp.
#[derive(Clone, Debug, Serialize)]
pub struct Dimmable {
    name: String,
    /// Which surfaces it is; none if it is a point.
    surfaces: Vec<usize>,
}

impl Dimmable {
    fn new(lamp: &Lamp) -> Self {
        Self { name: lamp.name.clone(), surfaces: lamp.surfaces.clone() }
    }
}

/// A surface.
#[derive(Clone, Debug, Serialize)]
pub struct Surface {
    name: String,
    /// The first of its patches, and the one after its last.
    patches: [usize; 2],
    reflectance: [f64; 3],
    emission: [f64; 3],
}

/// A sky, as a page needs it to find its radiance in any direction.
#[derive(Clone, Debug, Serialize)]
pub struct Beyond {
    /// The radiance of the zenith, in W/(m² sr) or cd/m².
    zenith: [f64; 3],
    /// Unit vectors.
    up: [f64; 3],
    towards_sun: [f64; 3],
    /// Whether it is (1 + 2 cos Z)/3 of that of the zenith; if not, `numbers` say what it is.
    overcast: bool,
    /// a, b, c, d, e of the CIE's general skies.
    numbers: [f64; 5],
    /// The lamp that dims it; none where nothing can be dimmed.
    lamp: Option<usize>,
}

/// The fifth of the CIE's general skies: alike in all directions.
const ALIKE: [f64; 5] = [0.0, -1.0, 0.0, -1.0, 0.0];

impl Beyond {
    fn new<V: Colour>(sky: &Sky<V>) -> Self {
        let model = sky.dome.model();
        Self {
            zenith: sky.zenith.to_rgb().0,
            up: model.up().to_array(),
            towards_sun: model.towards_sun().to_array(),
            overcast: model.kind() == sky::Kind::Overcast,
            numbers: model.kind().numbers().unwrap_or(ALIKE),
            lamp: None,
        }
    }
}

/// The sky of a scene, of which a file has one at most, and its number among the lights.
fn sky_of<V>(lights: &[Light<V>]) -> Option<(usize, &Sky<V>)> {
    lights.iter().enumerate().find_map(|(k, light)| match light {
        Light::Sky(sky) => Some((k, sky)),
        Light::Point(_) | Light::Sun(_) => None,
    })
}

/// A camera: metres, and degrees.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Viewpoint {
    position: [f64; 3],
    target: [f64; 3],
    up: [f64; 3],
    vertical_angle: f64,
}

impl From<Camera> for Viewpoint {
    fn from(camera: Camera) -> Self {
        Self {
            position: camera.position.to_array(),
            target: camera.target.to_array(),
            up: camera.up.to_array(),
            vertical_angle: camera.vertical_angle.to_degrees(),
        }
    }
}

impl Description {
    /// Of a scene in patches, of which nothing can be dimmed and nothing solved.
    pub fn new<V: Colour>(
        (scene, units): (&Scene<V>, Units),
        (patches, visibility): (&Patches<V>, &Visibility),
        patch_size: f64,
        camera: Camera,
    ) -> Self {
        let colour = |value: &V| -> [f64; 3] { value.to_rgb().0 };
        let parts = ranges(&patches.surface, scene.surfaces.len());
        let surfaces = scene.surfaces.iter().zip(parts).map(|(surface, Range { start, end })| Surface {
            name: surface.name.clone(),
            patches: [start, end],
            reflectance: colour(&surface.reflectance),
            emission: colour(&surface.emission),
        });
        Self {
            name: scene.name.clone(),
            patches: patches.len(),
            patch_size,
            units: Symbols::new(units),
            surfaces: surfaces.collect(),
            lamps: Vec::new(),
            sky: sky_of(&scene.lights).map(|(_, sky)| Beyond::new(sky)),
            camera: camera.into(),
            exposure: exposure(patches, visibility).scale,
            kind: None,
            solvers: Vec::new(),
        }
    }

    /// With what a page can change.
    pub fn with(self, discrete: &Discrete, lights: &[Light<Rgb>], first: Solver) -> Self {
        let dims = |k: usize| discrete.lamps.iter().position(|lamp| lamp.points.contains(&k));
        let lamp = sky_of(lights).and_then(|(k, _)| dims(k));
        let can = |solver: &Solver| discrete.is_stored || solver.shoots();
        let others = Solver::ALL.into_iter().filter(|solver| *solver != first && can(solver));
        Self {
            lamps: discrete.lamps.iter().map(Dimmable::new).collect(),
            sky: self.sky.map(|sky| Beyond { lamp, ..sky }),
            kind: Some(discrete.kind),
            solvers: std::iter::once(first).chain(others).collect(),
            ..self
        }
    }
}

/// The corners of patches, as the protocol has them.
pub fn geometry(polygons: &[Polygon]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(48 * polygons.len());
    for polygon in polygons {
        let corners = polygon.vertices();
        let last = corners[corners.len() - 1];
        let four = corners.iter().chain([&last; 4]).take(4);
        numbers(&mut bytes, four.flat_map(|corner| corner.to_array()));
    }
    bytes
}
