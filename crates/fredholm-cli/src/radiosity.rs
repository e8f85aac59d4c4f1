//! The walk: a scene becomes patches, form factors, a solved field, a picture and files.

use crate::args::{Bands, Radiosity};
use crate::domain::Domain;
use crate::frames::Frames;
use crate::output::{Output, clear_on_interrupt};
use crate::outputs::{Outputs, Report as ReportTo, write_field, write_png};
use crate::picture::draw;
use crate::progress::Watcher;
use crate::report::Report;
use crate::settings::Settings;
use crate::table::table;
use crate::terminal::{Stream, say};
use crate::timing::{Seconds, timed};
use anyhow::{Context, Result, bail};
use fredholm::relax::Outcome;
use fredholm::value::Value;
use radiosity::export::Field;
use radiosity::render::Colour;
use radiosity::scene::{Scene, SolveOptions, cornell_box, cornell_box_spectral, load};
use radiosity::solve::{Solution, solve};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// How a run ended that has written all its files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// The residual is as small as was asked.
    Converged,
    /// The iterations were used up.
    NotConverged,
}

/// `fredholm radiosity`.
pub fn command(args: &Radiosity) -> Result<Ending> {
    clear_on_interrupt()?;
    if let Some(threads) = args.threads {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build_global().with_context(|| format!("cannot start {threads} threads"))?;
    }
    let start = Instant::now();
    let unsaid = SolveOptions::default();
    match (&args.scene, args.bands) {
        (None, Bands::Rgb) => walk(&cornell_box(), &unsaid, args, start),
        (None, Bands::Spectral) => walk(&cornell_box_spectral(), &unsaid, args, start),
        (Some(file), Bands::Rgb) => {
            let loaded = load(file)?;
            walk(&loaded.scene, &loaded.solve, args, start)
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
    wishes: &SolveOptions,
    args: &Radiosity,
    start: Instant,
) -> Result<Ending> {
    let mut seconds = Seconds { load: start.elapsed().as_secs_f64(), ..Seconds::default() };
    let settings = Settings::new(args, wishes, args.scene.as_deref().unwrap_or(Path::new("")))?;
    let Outputs { picture, patches, report, frames } = Outputs::prepare(args, &scene.name)?;

    let domain = Domain::new(scene, settings.size(scene), &mut seconds)?;
    let frames = frames.map(|folder| Frames::new(folder, args, &settings, &domain));
    let mut watcher = Watcher::new(&settings, &domain.patches, frames);
    let options = settings.options(domain.patches.len());
    let solution = solve(&domain.patches, &domain.visibility, &options, &mut watcher)?;
    let mut files = watcher.finish(&solution, &mut seconds)?;

    if let Some(output) = picture {
        let image = timed(&mut seconds.picture, || draw(args, &domain, &solution.radiosity));
        files.push(timed(&mut seconds.write, || write_png(output, &image))?);
    }
    if let Some(output) = patches {
        files.push(timed(&mut seconds.write, || write_patches(output, &domain, &solution))?);
    }
    if let Some(ReportTo::File(output)) = &report {
        files.push(output.path().to_owned());
    }
    seconds.total = start.elapsed().as_secs_f64();
    tell(&Report::new(&domain, &settings, &solution, seconds, files), report)?;
    Ok(if solution.report.outcome == Outcome::Converged { Ending::Converged } else { Ending::NotConverged })
}

fn write_patches<V: Value>(
    output: Output,
    domain: &Domain<'_, V>,
    solution: &Solution<V>,
) -> Result<PathBuf> {
    let Domain { scene, patches, .. } = domain;
    let field = Field { scene, patches, radiosity: &solution.radiosity, irradiance: &solution.irradiance };
    write_field(output, &field)
}

/// The table for people, and the JSON for programs where it is asked for.
fn tell(report: &Report, to: Option<ReportTo>) -> Result<()> {
    let mut json = serde_json::to_string_pretty(report)?;
    json.push('\n');
    let stream = match to {
        None => Stream::Out,
        Some(ReportTo::File(output)) => {
            output.write(|out| out.write_all(json.as_bytes()))?;
            Stream::Out
        }
        Some(ReportTo::Terminal) => {
            say(Stream::Out, &json)?;
            Stream::Err
        }
    };
    Ok(say(stream, &table(report))?)
}
