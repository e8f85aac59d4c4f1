//! The walk: a scene becomes patches, form factors, a solved field, a picture and files.

pub mod accuracy;
pub mod args;
mod checkpoint;
mod domain;
pub mod frames;
mod html;
pub mod lights;
pub mod outputs;
mod picture;
mod progress;
pub mod report;
pub mod settings;
pub mod table;
mod thermal;
pub mod timing;

use self::args::{Bands, Radiosity};
use self::checkpoint::Checkpoint;
use self::domain::Domain;
use self::frames::Frames;
use self::html::Recording;
use self::outputs::{Outputs, write_field, write_png};
use self::picture::{draw, view};
use self::progress::{Watched, Watcher};
use self::report::Report;
use self::settings::Settings;
use self::table::table;
use self::timing::{Seconds, timed};
use crate::ending::Ending;
use crate::json::{self, Json};
use crate::output::Output;
use crate::terminal::warn;
use anyhow::{Context, Result, bail};
use fredholm::relax::Outcome;
use fredholm::value::Value;
use radiosity::elements::Space;
use radiosity::export::Field;
use radiosity::render::Colour;
use radiosity::scene::{CleanUp, Scene, SolveOptions, Units, cornell_box, cornell_box_spectral, load_in};
use radiosity::solve::{Solution, SolveError, solve, solve_elements};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// `fredholm radiosity`.
pub fn command(args: &Radiosity) -> Result<Ending> {
    let checkpoint = Checkpoint::prepare(args)?;
    if let Some(threads) = args.threads {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build_global().with_context(|| format!("cannot start {threads} threads"))?;
    }
    let start = Instant::now();
    let unsaid = SolveOptions::default();
    let (watts, untouched) = (Units::Radiometric, CleanUp::default());
    match (&args.scene, args.bands) {
        (Some(file), _) if args.thermal => thermal::command(file, args, start),
        (None, Bands::Rgb) => walk(&cornell_box(), (watts, untouched), &unsaid, args, (start, checkpoint)),
        (None, Bands::Spectral) => {
            walk(&cornell_box_spectral(), (watts, untouched), &unsaid, args, (start, checkpoint))
        }
        (Some(file), Bands::Rgb) => {
            let mut loaded = load_in(file, args.photometric.then_some(Units::Photometric))?;
            loaded.warnings.iter().try_for_each(warn)?;
            if args.flat {
                loaded.scene = loaded.scene.flat();
            }
            let mesh = (loaded.units, loaded.clean_up);
            match loaded.units {
                Units::Photometric => walk(&loaded.grey(), mesh, &loaded.solve, args, (start, checkpoint)),
                Units::Radiometric => walk(&loaded.scene, mesh, &loaded.solve, args, (start, checkpoint)),
            }
        }
        (Some(file), Bands::Spectral) => bail!(
            "{}: scene files give red, green and blue; leave --bands spectral to the built-in Cornell box",
            file.display()
        ),
    }
}

/// From the loaded scene to the last file.
fn walk<V: Colour>(
    scene: &Scene<V>,
    (units, clean_up): (Units, CleanUp),
    wishes: &SolveOptions,
    args: &Radiosity,
    (start, checkpoint): (Instant, Checkpoint),
) -> Result<Ending> {
    if let Some(accuracy) = args.accuracy.or(wishes.accuracy.filter(|_| !args.has_ways())) {
        return accuracy::walk(scene, (units, clean_up), accuracy, args, start);
    }
    picture::check_map(args.map, units)?;
    let mut seconds = Seconds { load: start.elapsed().as_secs_f64(), ..Seconds::default() };
    let settings = Settings::new(args, wishes, scene, args.scene.as_deref().unwrap_or(Path::new("")))?;
    let Outputs { picture, patches, html, links, json, frames } = Outputs::prepare(args, &scene.name)?;

    let domain = Domain::new(scene, settings.size(scene), &mut seconds)?;
    let frames = frames.map(|folder| Frames::new(folder, args, (&settings, units), &domain));
    let Domain { patches: mesh, visibility, .. } = &domain;
    let space = settings.space.degree().map(|degree| Space::new(&mesh.polygons, degree));
    let unknowns = space.as_ref().map_or(mesh.len(), Space::dim);
    let recording = html.is_some().then(|| Recording::new(&settings, unknowns)).transpose()?;
    let resume = args.resume.as_deref().map(checkpoint::open).transpose()?;
    let on = (checkpoint.stop(), resume);
    let watcher = Watcher::new((&settings, units), mesh, space.as_ref(), (frames, recording), on);
    let mut watcher = watcher.drawing_links(links.is_some());
    let options = settings.options(unknowns);
    let solved = match &space {
        None => solve(mesh, visibility, &options, &mut watcher),
        Some(space) => {
            solve_elements(space, mesh, visibility, &options, &mut watcher).map(|found| means(space, found))
        }
    };
    let solution = match solved {
        Err(SolveError::Interrupted { patches, kept }) => {
            watcher.clear();
            return checkpoint.keep(&kept, patches);
        }
        Err(error @ SolveError::Kept(_)) => {
            return Err(error)
                .with_context(|| format!("{}", args.resume.as_deref().unwrap_or(Path::new("")).display()));
        }
        solved => solved?,
    };
    checkpoint.close();
    let Watched { mut files, recording, links: drawn } = watcher.finish(&solution, &mut seconds)?;

    if let Some(output) = picture {
        let image = timed(&mut seconds.picture, || draw(args, &domain, units, &solution));
        files.push(timed(&mut seconds.write, || write_png(output, &image))?);
    }
    if let Some(output) = patches {
        files.push(timed(&mut seconds.write, || write_patches(output, &domain, units, &solution))?);
    }
    if let (Some(output), Some(recording)) = (html, recording) {
        let page =
            || recording.page(&domain, (units, view(args, &domain).camera), settings.size(scene), &solution);
        let page = timed(&mut seconds.frames, page)?;
        files.push(timed(&mut seconds.write, || output.write(|out| out.write_all(page.as_bytes())))?);
    }
    if let (Some(output), Some(drawn)) = (links, drawn) {
        files.push(timed(&mut seconds.write, || output.write(|out| out.write_all(drawn.as_bytes())))?);
    }
    files.extend(json.as_ref().and_then(Json::file));
    seconds.total = start.elapsed().as_secs_f64();
    let mut report = Report::new(&domain, (&settings, units), space.as_ref(), &solution, seconds, files);
    report.clean_up = clean_up;
    json::tell(json, &report, &table(&report))?;
    Ok(if solution.report.outcome == Outcome::Converged { Ending::Converged } else { Ending::NotConverged })
}

/// The solution by its means over patches: what pictures, tables and files show.
fn means<V: Value>(space: &Space<'_>, solution: Solution<V>) -> Solution<V> {
    Solution {
        radiosity: space.means(&solution.radiosity),
        irradiance: space.means(&solution.irradiance),
        ..solution
    }
}

fn write_patches<V: Value>(
    output: Output,
    domain: &Domain<'_, V>,
    units: Units,
    solution: &Solution<V>,
) -> Result<PathBuf> {
    let Domain { scene, patches, .. } = domain;
    let field = Field::light(scene, patches, (&solution.radiosity, &solution.irradiance), units);
    write_field(output, &field)
}
