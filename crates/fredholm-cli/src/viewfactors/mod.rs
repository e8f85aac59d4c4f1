//! `fredholm viewfactors`: a mesh becomes the factors F_ij between its faces, each with its error, and files.

pub mod args;
mod asked;
mod engine;
mod faces;
mod outputs;
mod report;
mod table;

use self::args::ViewFactors as Arguments;
use self::asked::{Asked, not_done};
use self::engine::{between, counts};
use self::faces::{Face, areas, emittance, faces, groups};
use self::outputs::{Outputs, write};
use self::report::{Corrected, Errors, Matrix, Report, Stages};
use self::table::table;
use crate::ending::Ending;
use crate::json::{self, Json};
use crate::output::clear_on_interrupt;
use crate::radiosity::timing::timed;
use crate::terminal::{bar, warn};
use anyhow::{Context, Result, bail};
use fredholm::memory;
use fredholm::value::Rgb;
use radiosity::closure::Enclosure;
use radiosity::export::factors::Surroundings;
use radiosity::form_factor::pairs::Pairs;
use radiosity::polygon::Polygon;
use radiosity::scene::{Scene, examine, load_unlit};
use radiosity::view_factors::{Storage, ViewFactors};
use radiosity::visibility::Visibility;
use rayon::prelude::*;
use std::time::Instant;

/// The part of the tolerance that is left to the integration: an error is rounded up by 15 % when it is stored, and an
/// `f32` takes up to an eighth of the smallest tolerance that it is used for; (0.7 + 0.12) · 1.15 = 0.94.
const TO_INTEGRATE: f64 = 0.7;

/// `fredholm viewfactors`.
pub fn command(args: &Arguments) -> Result<Ending> {
    clear_on_interrupt()?;
    if let Some(threads) = args.threads {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build_global().with_context(|| format!("cannot start {threads} threads"))?;
    }
    let start = Instant::now();
    let mut stages = Stages::default();
    let loaded = timed(&mut stages.load, || load_unlit(&args.mesh))?;
    let (scene, faces) = (&loaded.scene, faces(&loaded));
    let asked = Asked::new(args.tolerance, loaded.control.as_ref());
    let tolerance = asked.tolerance;
    check_memory(&faces, scene, args, &asked)?;
    let outputs = Outputs::prepare(args)?;
    let examined = timed(&mut stages.load, || examine(scene, &loaded.faces));

    let polygons = scene.polygons();
    let visibility = timed(&mut stages.load, || Visibility::new(&polygons));
    let pairs = timed(&mut stages.factors, || Pairs::new(&polygons, TO_INTEGRATE * tolerance));
    let by_face = timed(&mut stages.factors, || assemble(&pairs, &faces, &polygons, tolerance));
    let enclosure = enclosure(&by_face, &faces, &polygons, &visibility);
    let closing = || close(by_face, &enclosure, args);
    let (by_face, correction) = timed(&mut stages.enforce, closing)?;
    let totals = timed(&mut stages.reflections, || total(&by_face, &faces, scene, &asked));
    let rows = Rows::new(by_face, &faces, scene, &enclosure, args.groups);
    let totals = totals.map(|totals| rows.alike(totals, &faces, scene, args.groups));
    let told = totals.as_ref().unwrap_or(&rows.factors);

    let surroundings = Surroundings {
        is_closed: enclosure.is_closed(),
        with_reflections: asked.reflections,
        emittances: &rows.emittances,
    };
    let mut files = Vec::new();
    for output in outputs.matrices {
        files.push(timed(&mut stages.write, || write(output, told, &surroundings, &asked))?);
    }
    files.extend(outputs.json.as_ref().and_then(Json::file));
    let sums = rows.factors.row_sums();
    let told_sums = totals.as_ref().map_or_else(|| sums.clone(), ViewFactors::row_sums);
    let missing =
        told_sums.iter().zip(&rows.emittances).map(|(sum, emittance)| (sum.value - emittance).abs());
    let checked = || sums.iter().zip(&rows.whole).filter(|(_, whole)| **whole || !enclosure.is_closed());
    let report = Report {
        scene: scene.name.clone(),
        faces: faces.len(),
        groups: args.groups.then_some(told.len()),
        names: told.names(),
        areas: told.areas(),
        emittances: asked.reflections.then_some(rows.emittances.as_slice()),
        factors: Matrix(told),
        error: Errors(told),
        asked,
        largest_error: told.largest_error().map_or(0.0, |(error, _)| error),
        largest_row_error: told_sums.iter().map(|sum| sum.error).fold(0.0, f64::max),
        closed: enclosure.is_closed(),
        escaping: enclosure.escaping,
        closure_defect: checked().map(|(sum, _)| (sum.value - 1.0).abs()).fold(0.0, f64::max),
        emittance_defect: (asked.reflections
            && enclosure.is_closed()
            && rows.whole.iter().all(|whole| *whole))
        .then(|| missing.fold(0.0, f64::max)),
        closure_rows: rows.whole.iter().filter(|whole| **whole).count(),
        reciprocity_defect: told.reciprocity_defect(),
        correction,
        pairs: counts(&pairs),
        rays: 0,
        seconds: start.elapsed().as_secs_f64(),
        stages,
        peak_memory_bytes: memory::peak(),
        files,
    };
    // What is refused has one message; what is not has these beside its table.
    loaded.warnings.iter().try_for_each(warn)?;
    let control = loaded.control.iter();
    let not_done = control.flat_map(|control| not_done(control, &args.mesh, enclosure.is_closed()));
    not_done.into_iter().try_for_each(|message| warn(&message))?;
    examined.findings.iter().try_for_each(|finding| warn(&format!("{}: {finding}", args.mesh.display())))?;
    json::stream(outputs.json, &report, &table(&report, told))?;
    Ok(if report.is_met() { Ending::Converged } else { Ending::NotConverged })
}

/// That the matrix fits, before anything is computed.
fn check_memory(faces: &[Face], scene: &Scene<Rgb>, args: &Arguments, asked: &Asked) -> Result<()> {
    let storage = Storage::for_tolerance(asked.tolerance);
    let grouped = if args.groups { ViewFactors::grouped_bytes(groups(faces, scene).1.len()) } else { 0 };
    let reflections = if asked.reflections { ViewFactors::reflections_bytes(faces.len()) } else { 0 };
    let needed = ViewFactors::bytes(faces.len(), storage) + grouped + reflections;
    let free = memory::limit();
    if needed <= free {
        return Ok(());
    }
    let less = match storage {
        _ if asked.reflections => " ask for `emit=0`, without reflections, which takes a tenth of it; or",
        Storage::Double => " ask for a --tolerance of 1e-6 or more, which takes little more than half; or",
        Storage::Single => "",
    };
    bail!(
        "{}: the view factors of {} faces take {} MB, and {} MB are free:{less} make fewer faces of the mesh",
        args.mesh.display(),
        faces.len(),
        needed >> 20,
        free >> 20
    )
}

/// The factors between all faces.
fn assemble(pairs: &Pairs<'_>, faces: &[Face], polygons: &[Polygon], tolerance: f64) -> ViewFactors {
    let n = faces.len() as u64;
    let bar = bar("view factors", n * (n + 1) / 2);
    let names = faces.iter().map(|face| face.name.clone()).collect();
    let storage = Storage::for_tolerance(tolerance);
    let pair = |i, j| between(pairs, faces, polygons, i, j);
    let computed = |pairs: usize| bar.inc(pairs as u64);
    let factors = ViewFactors::assemble(names, areas(faces, polygons), storage, pair, computed);
    bar.finish_and_clear();
    factors
}

/// Whether the faces are an enclosure.
fn enclosure(
    factors: &ViewFactors,
    faces: &[Face],
    polygons: &[Polygon],
    visibility: &Visibility,
) -> Enclosure {
    let sums = factors.row_sums();
    let rows = faces.par_iter().zip(&sums).map(|(face, sum)| (face.in_sight(), sum.value));
    Enclosure::test(polygons, visibility, rows)
}

/// Closes the factors, where that is asked for.
fn close(
    mut factors: ViewFactors,
    enclosure: &Enclosure,
    args: &Arguments,
) -> Result<(ViewFactors, Option<Corrected>)> {
    if !args.enforce {
        return Ok((factors, None));
    }
    let file = args.mesh.display();
    if !enclosure.is_closed() {
        bail!(
            "{file}: the mesh is open, {:.1} % of the sight lines leave it, so its rows do not add up to 1: close it, with the fronts inside, or leave out --enforce",
            100.0 * enclosure.escaping
        );
    }
    let correction = factors.enforce(&enclosure.whole).with_context(|| format!("{file}: --enforce"))?;
    Ok((factors, Some(correction.into())))
}

/// The factors with reflections in them, where these are asked for.
fn total(factors: &ViewFactors, faces: &[Face], scene: &Scene<Rgb>, asked: &Asked) -> Option<ViewFactors> {
    let emittances = faces.iter().map(|face| emittance(scene, face.surface));
    asked.reflections.then(|| factors.with_reflections(&emittances.collect::<Vec<_>>()))
}

/// The rows of the matrix that is told: faces, or groups of them.
struct Rows {
    factors: ViewFactors,
    emittances: Vec<f64>,
    /// Whether they see nothing but fronts.
    whole: Vec<bool>,
}

impl Rows {
    fn new(
        by_face: ViewFactors,
        faces: &[Face],
        scene: &Scene<Rgb>,
        enclosure: &Enclosure,
        in_groups: bool,
    ) -> Self {
        if !in_groups {
            let emittances = faces.iter().map(|face| emittance(scene, face.surface)).collect();
            return Self { factors: by_face, emittances, whole: enclosure.whole.clone() };
        }
        let (group_of, surfaces) = groups(faces, scene);
        let names = surfaces.iter().map(|&surface| scene.surfaces[surface].name.clone()).collect();
        let mut whole = vec![true; surfaces.len()];
        for (group, is_whole) in group_of.iter().zip(&enclosure.whole) {
            whole[*group] &= is_whole;
        }
        let emittances = surfaces.iter().map(|&surface| emittance(scene, surface)).collect();
        Self { factors: by_face.grouped(&group_of, names), emittances, whole }
    }

    /// Other factors of the faces, in the same rows.
    fn alike(
        &self,
        by_face: ViewFactors,
        faces: &[Face],
        scene: &Scene<Rgb>,
        in_groups: bool,
    ) -> ViewFactors {
        let names = self.factors.names().to_vec();
        if in_groups { by_face.grouped(&groups(faces, scene).0, names) } else { by_face }
    }
}
