//! `--accuracy`: the walk of a scene to an accuracy. Mesh, form factors and iterations are found on the way.

mod report;
mod solved;
mod table;

pub use self::solved::{Ground, Parts, Solved};

use self::report::Report;
use super::args::{Quantity, Radiosity};
use super::outputs::{Outputs, write_field, write_png};
use super::picture::{TITLE, check_map, view_of};
use super::report::surfaces;
use super::timing::{Seconds, timed};
use crate::ending::Ending;
use crate::json::{self, Json};
use crate::terminal::bar;
use anyhow::Result;
use image::RgbImage;
use indicatif::ProgressBar;
use radiosity::adaptive::Round;
use radiosity::export;
use radiosity::polygon::Polygon;
use radiosity::render::{Colour, Exposure, Scale, Sightings, false_colour, map_of_values};
use radiosity::scene::{CleanUp, Scene, Units};
use radiosity::visibility::Visibility;
use std::f64::consts::FRAC_1_PI;
use std::time::Instant;

/// From the loaded scene to the last file.
pub fn walk<V: Colour>(
    scene: &Scene<V>,
    (units, clean_up): (Units, CleanUp),
    accuracy: f64,
    args: &Radiosity,
    start: Instant,
) -> Result<Ending> {
    check_map(args.map, units)?;
    let mut seconds = Seconds { load: start.elapsed().as_secs_f64(), ..Seconds::default() };
    let Outputs { picture, patches: list, json, .. } = Outputs::prepare(args, &scene.name)?;

    let polygons = scene.polygons();
    let ground = timed(&mut seconds.visibility, || Ground::new(scene, &polygons))?;
    let (solved, rounds) = timed(&mut seconds.solve, || ground.solve(accuracy))?;

    let (parts, bound, elements) = (solved.parts(scene), solved.bound(), solved.elements());
    let mut files = Vec::new();
    if let Some(output) = picture {
        let image = timed(&mut seconds.picture, || {
            draw(args, scene, units, (solved, &polygons, &ground.visibility), &parts)
        });
        files.push(timed(&mut seconds.write, || write_png(output, &image))?);
    }
    if let Some(output) = list {
        let light = (parts.radiosity.as_slice(), parts.irradiance.as_slice());
        let table = export::Field::light(scene, &parts.patches, light, units);
        files.push(timed(&mut seconds.write, || write_field(output, &table))?);
    }
    files.extend(json.as_ref().and_then(Json::file));
    seconds.total = start.elapsed().as_secs_f64();
    let means = surfaces(scene, &parts.patches, units, (&parts.radiosity, &parts.irradiance));
    let mut report = Report::new(scene, accuracy, (&rounds, elements), bound, (units, means), seconds, files);
    report.clean_up = clean_up;
    json::tell(json, &report, &table::table(&report))?;
    Ok(if report.is_met() { Ending::Converged } else { Ending::NotConverged })
}

/// How near the error is, on the terminal.
pub struct Progress {
    bar: ProgressBar,
    accuracy: f64,
}

impl Progress {
    /// Steps of the bar, from an error of 1 to the accuracy on a logarithmic scale.
    const STEPS: f64 = 1000.0;

    /// Towards an accuracy.
    pub fn new(accuracy: f64) -> Self {
        Self { bar: bar("refinement", Self::STEPS as u64), accuracy }
    }

    /// What a mesh has come to.
    pub fn tell(&self, round: &Round) {
        let error = round.error;
        let done = (error.ln() / self.accuracy.ln()).clamp(0.0, 1.0);
        self.bar.set_position((Self::STEPS * done) as u64);
        self.bar.set_message(format!("{} patches, error {:.2} %", round.patches, 100.0 * error));
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// The final picture, as a photograph or as a map of numbers, from the light at every pixel.
fn draw<V: Colour>(
    args: &Radiosity,
    scene: &Scene<V>,
    units: Units,
    (solved, polygons, visibility): (Solved<'_, V>, &[Polygon], &Visibility),
    parts: &Parts<V>,
) -> RgbImage {
    let view = view_of(args, scene, polygons, visibility);
    let bar = bar("picture", view.height as u64);
    let row = |done: usize| bar.set_position(done as u64);
    let field = solved.for_points(view.width * view.height);
    let sightings = Sightings::new(&view, &*field, polygons, visibility, &row);
    bar.finish_and_clear();
    let size = (view.width, view.height);
    let map = |values: &[V], number: &dyn Fn(V, V) -> f64, title: &str| {
        let scale = Scale::automatic(&parts.patches, values);
        map_of_values(sightings.values(number), size, &scale, title)
    };
    let luminance = || {
        let values: Vec<V> = parts.radiosity.iter().map(|b| *b * FRAC_1_PI).collect();
        map(&values, &|b, _| b.channels()[0] * FRAC_1_PI, "luminance, cd/m²")
    };
    match args.map {
        Some(Quantity::Illuminance) => map(&parts.irradiance, &|_, h| h.channels()[0], "illuminance, lx"),
        Some(Quantity::Luminance) => luminance(),
        _ if args.false_colour && units == Units::Photometric => luminance(),
        _ if args.false_colour => {
            let scale = Scale::automatic(&parts.patches, &parts.radiosity);
            false_colour(&sightings.picture(), &scale, TITLE)
        }
        _ => {
            let picture = sightings.picture();
            picture.develop(Exposure::automatic(&picture))
        }
    }
}
