//! `--thermal`: the walk of heat, from temperatures and fluxes given to those found.

mod report;
mod table;

use self::report::{Given, Report, Scene};
use super::args::{Quantity, Radiosity};
use super::domain::Domain;
use super::outputs::{Outputs, write_field, write_png};
use super::picture::map_of_patches;
use super::settings::Settings;
use super::timing::{Seconds, timed};
use crate::args::name;
use crate::ending::Ending;
use crate::json::{self, Json};
use crate::terminal::{bar, complain};
use anyhow::{Result, anyhow, bail};
use fredholm::operator::{Dense, Rows};
use image::RgbImage;
use radiosity::closure::Closure;
use radiosity::export::Field;
use radiosity::form_factor::FormFactors;
use radiosity::render::Scale;
use radiosity::scene::{Thermal, ThermalScene, load_thermal};
use radiosity::thermal::{Answer, Bands, Enclosure, Exchange, Node, Options, State, ThermalError};
use std::path::Path;
use std::time::Instant;

/// `fredholm radiosity FILE --thermal`.
pub fn command(file: &Path, args: &Radiosity, start: Instant) -> Result<Ending> {
    if let Some(quantity @ (Quantity::Illuminance | Quantity::Luminance)) = args.map {
        bail!("--map {} is of light; with --thermal there are temperature and heat-flux", name(&quantity));
    }
    let ended = match load_thermal(file)? {
        Thermal::Scene(scene) => walk(file, &scene, args, start),
        Thermal::Enclosure(name, enclosure) => without_mesh(&name, &enclosure, args, start),
    };
    match ended {
        Err(error) if is_alternative(&error) => {
            complain(&anyhow!("{}: {error:#}", file.display()))?;
            Ok(Ending::NoAnswer)
        }
        other => other,
    }
}

/// Whether it is the equation that has no answer, or more than one.
fn is_alternative(error: &anyhow::Error) -> bool {
    use ThermalError::{NoSolution, NotUnique, TooCold};
    matches!(error.downcast_ref(), Some(NoSolution { .. } | NotUnique { .. } | TooCold { .. }))
}

/// Surfaces without a shape: no patches, no picture.
fn without_mesh(name: &str, enclosure: &Enclosure, args: &Radiosity, start: Instant) -> Result<Ending> {
    if args.output.is_some() || args.patches.is_some() || args.map.is_some() {
        bail!(
            "an [enclosure] has no shape to be drawn or cut; ask for --json, or leave -o, --map and --patches out"
        );
    }
    let Outputs { json, .. } = Outputs::of(args, None)?;
    let exchange = enclosure.exchange();
    let answer = exchange.solve(&options(args, None))?;
    let seconds = Seconds { total: start.elapsed().as_secs_f64(), ..Seconds::default() };
    let closed = enclosure.is_closed().then(|| enclosure.closure_defect());
    let given = Given { name, exchange: &exchange, mesh: None, closed, seconds, files: Vec::new() };
    tell(&given, &answer, json)
}

/// Patches of meshes.
fn walk(file: &Path, given: &ThermalScene, args: &Radiosity, start: Instant) -> Result<Ending> {
    let ThermalScene { scene, surfaces, bands, surroundings, solve } = given;
    if let Some(method) = solve.method.as_deref().filter(|method| *method != "galerkin") {
        bail!(
            "{}: [solve] method = \"{method}\" has no reciprocity and loses heat; write galerkin or leave it out",
            file.display()
        );
    }
    if solve.accuracy.is_some() {
        bail!(
            "{}: [solve] accuracy is of light; write factor_accuracy for that of form factors, or leave it out",
            file.display()
        );
    }
    let mut seconds = Seconds { load: start.elapsed().as_secs_f64(), ..Seconds::default() };
    let settings = Settings::new(args, &without_method(solve), scene, file)?;
    let Outputs { picture, patches: table, json, .. } = Outputs::prepare(args, &scene.name)?;
    let domain = Domain::new(scene, settings.size(scene), &mut seconds)?;
    let accuracy = settings.options(domain.patches.len()).accuracy;
    let coupling = FormFactors::patch_to_patch(&domain.patches, &domain.visibility, accuracy);
    settings.check_memory(domain.patches.len())?;
    let operator = timed(&mut seconds.form_factors, || assemble(&coupling, domain.patches.len()))?;
    let closure = closure(&domain, &operator);
    let nodes = nodes(&domain);
    let exchange = Exchange {
        surfaces,
        nodes: &nodes,
        bands,
        operator: &operator,
        surroundings: *surroundings,
        closed: matches!(closure, Closure::Closed { .. }),
    };
    let answer = timed(&mut seconds.solve, || exchange.solve(&options(args, solve.tolerance)))?;
    let mut files = Vec::new();
    if let Some(output) = picture {
        let image = timed(&mut seconds.picture, || draw(args, &domain, &answer));
        files.push(timed(&mut seconds.write, || write_png(output, &image))?);
    }
    if let Some(output) = table {
        let field = Field::heat(scene, &domain.patches, &answer.nodes);
        files.push(timed(&mut seconds.write, || write_field(output, &field))?);
    }
    files.extend(json.as_ref().and_then(Json::file));
    seconds.total = start.elapsed().as_secs_f64();
    let mesh = Scene {
        patches: domain.patches.len(),
        patch_size: settings.size(scene),
        accuracy,
        escaping: if let Closure::Open { escaping } = closure { Some(escaping) } else { None },
        rays: coupling.rays(),
    };
    let closed = if let Closure::Closed { defect, .. } = closure { Some(defect) } else { None };
    let given = Given { name: &scene.name, exchange: &exchange, mesh: Some(mesh), closed, seconds, files };
    tell(&given, &answer, json)
}

/// The wishes that heat listens to: which solver is used follows from the size.
fn without_method(wishes: &radiosity::scene::SolveOptions) -> radiosity::scene::SolveOptions {
    radiosity::scene::SolveOptions { method: None, solver: None, ..wishes.clone() }
}

fn options(args: &Radiosity, wish: Option<f64>) -> Options {
    let usual = Options::default();
    Options {
        tolerance: args.tolerance.or(wish).unwrap_or(usual.tolerance),
        steps: args.iterations.unwrap_or(usual.steps),
    }
}

fn assemble(coupling: &FormFactors<'_>, n: usize) -> Result<Dense<f32>> {
    let bar = bar("form factors", (n * (n + 1) / 2) as u64);
    let matrix = Dense::assemble(coupling, |entries| bar.inc(entries as u64)).map_err(ThermalError::from)?;
    bar.finish_and_clear();
    Ok(matrix)
}

fn closure(domain: &Domain<'_, f64>, operator: &impl Rows) -> Closure {
    let all: Vec<usize> = (0..domain.patches.len()).collect();
    let sums = fredholm::system::row_sums(operator, &all);
    let rows: Vec<(usize, f64)> = all.into_iter().zip(sums).collect();
    Closure::test(&domain.patches, &domain.visibility, &rows)
}

fn nodes(domain: &Domain<'_, f64>) -> Vec<Node> {
    let node = |(surface, area): (&u32, &f64)| Node { surface: *surface as usize, area: *area };
    domain.patches.surface.iter().zip(&domain.patches.areas).map(node).collect()
}

/// The map of the temperatures, or of the heat fluxes.
fn draw(args: &Radiosity, domain: &Domain<'_, f64>, answer: &Answer) -> RgbImage {
    let (of, title): (fn(&State) -> f64, _) = match args.map {
        Some(Quantity::HeatFlux) => (|state| state.heat_flux, "net heat flux, W/m²"),
        _ => (|state| state.temperature.unwrap_or(f64::NAN), "temperature, K"),
    };
    let values: Vec<f64> = answer.nodes.iter().map(of).collect();
    map_of_patches(args, domain, &values, &Scale::of_values(values.iter().copied()), title)
}

fn tell<F: Rows>(given: &Given<'_, F>, answer: &Answer, json: Option<Json>) -> Result<Ending> {
    let mut report = Report::new(given, answer);
    if report.files.is_empty() {
        report.files.extend(json.as_ref().and_then(Json::file));
    }
    json::tell(json, &report, &table::table(&report))?;
    Ok(if answer.converged { Ending::Converged } else { Ending::NotConverged })
}

/// How many bands, as people say it.
fn bands(bands: &Bands) -> String {
    let limits: Vec<String> = bands.limits().iter().map(f64::to_string).collect();
    match limits.as_slice() {
        [] => "grey".to_owned(),
        _ => format!("{} bands, cut at {} µm", bands.count(), limits.join(", ")),
    }
}
