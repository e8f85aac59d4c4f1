//! `fredholm bake`: the light of a scene, to an accuracy, laid around its surfaces and written for other programs.

pub mod args;
mod laid;
mod report;

use self::args::Bake;
use self::laid::Light;
use self::report::Report;
use crate::ending::Ending;
use crate::json::{self, Json};
use crate::output::{Output, clear_on_interrupt, refuse_twins};
use crate::radiosity::accuracy::Ground;
use crate::radiosity::outputs::stem;
use crate::radiosity::timing::{Seconds, timed};
use crate::terminal::warn;
use anyhow::{Context, Result};
use radiosity::bake::Atlas;
use radiosity::render::Colour;
use radiosity::scene::{Camera, CleanUp, Scene, SolveOptions, Units, cornell_box, load_in};
use std::path::PathBuf;
use std::time::Instant;

/// What light is baked to, unless something else is asked for.
const ACCURACY: f64 = 0.01;

/// `fredholm bake`.
pub fn command(args: &Bake) -> Result<Ending> {
    clear_on_interrupt()?;
    if let Some(threads) = args.threads {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build_global().with_context(|| format!("cannot start {threads} threads"))?;
    }
    let start = Instant::now();
    let Some(file) = &args.scene else {
        let as_built = (Units::Radiometric, CleanUp::default());
        return walk(&cornell_box(), as_built, &SolveOptions::default(), args, start);
    };
    let loaded = load_in(file, args.photometric.then_some(Units::Photometric))?;
    loaded.warnings.iter().try_for_each(warn)?;
    let read = (loaded.units, loaded.clean_up);
    match loaded.units {
        Units::Photometric => walk(&loaded.grey(), read, &loaded.solve, args, start),
        Units::Radiometric => walk(&loaded.scene, read, &loaded.solve, args, start),
    }
}

/// From the loaded scene to the last file.
fn walk<V: Colour>(
    scene: &Scene<V>,
    (units, clean_up): (Units, CleanUp),
    wishes: &SolveOptions,
    args: &Bake,
    start: Instant,
) -> Result<Ending> {
    let mut seconds = Seconds { load: start.elapsed().as_secs_f64(), ..Seconds::default() };
    let accuracy = args.accuracy.or(wishes.accuracy).unwrap_or(ACCURACY);
    let output = args.output.clone().unwrap_or_else(|| PathBuf::from(format!("{}.glb", stem(&scene.name))));
    refuse_twins(&[Some(&output), args.irradiance.as_deref(), args.json.as_deref()])?;
    let glb = Output::prepare(&output)?;
    let exr = args.irradiance.as_deref().map(Output::prepare).transpose()?;
    let json = args.json.as_deref().map(Json::prepare).transpose()?;

    let polygons = scene.polygons();
    // What does not fit is told before anything is solved.
    let atlas =
        (!args.vertex_colours).then(|| timed(&mut seconds.patches, || Atlas::new(&polygons, args.size)));
    let atlas = atlas.transpose()?;
    let ground = timed(&mut seconds.visibility, || Ground::new(scene, &polygons))?;
    let (field, _) = timed(&mut seconds.solve, || ground.solve(accuracy))?;

    let bound = field.bound();
    let light = timed(&mut seconds.picture, || Light::new(atlas, (scene, &polygons), field, accuracy));
    let camera = scene.camera.unwrap_or_else(|| Camera::automatic(&polygons, &ground.visibility, 1.0));
    let glb = light.write_glb((scene, &camera, units), (accuracy, bound.total()), (glb, &mut seconds))?;
    let mut files = vec![glb];
    if let Some(exr) = exr {
        files.extend(timed(&mut seconds.write, || light.write_exr(exr, units, bound.total()))?);
    }
    files.extend(json.as_ref().and_then(Json::file));
    seconds.total = start.elapsed().as_secs_f64();
    let mut report = Report::new(scene, accuracy, bound, light.laid(), units, seconds, files);
    report.clean_up = clean_up;
    report.dark = light.is_dark(scene);
    json::tell(json, &report, &report.table())?;
    Ok(if report.is_met() { Ending::Converged } else { Ending::NotConverged })
}
