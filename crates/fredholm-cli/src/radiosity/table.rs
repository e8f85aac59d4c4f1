//! The numbers of a run as people read them.

use super::report::{Links, Report, Surface};
use super::timing::Seconds;
use crate::text::{self, Digits};
use radiosity::scene::CleanUp;
use std::f64::consts::FRAC_1_PI;
use std::path::PathBuf;

/// The table, a line per matter.
pub fn table(report: &Report) -> String {
    let matters = text::lines(&lines(report));
    let surfaces = of_surfaces(&report.surfaces, |_| {
        [1.0, FRAC_1_PI].map(|part| part * report.error_bound.unwrap_or(0.0))
    });
    format!("{}: {} with {}\n\n{matters}{}", report.scene, report.method, report.solver, surfaces)
}

/// What a lighting designer asks of each surface; nothing where the units are watts. `errors` are those of
/// illuminances and luminances up to the two that it is given.
pub fn of_surfaces(surfaces: &[Surface], errors: impl Fn([f64; 2]) -> [f64; 2]) -> String {
    let header = ["surface", "area, m²", "illuminance, lx", "luminance, cd/m²"].map(str::to_owned);
    let numbers = |surface: &Surface| Some((surface.mean_illuminance?, surface.mean_luminance?));
    let known: Vec<_> = surfaces.iter().filter_map(|s| numbers(s).map(|(h, l)| (s, h, l))).collect();
    if known.is_empty() {
        return String::new();
    }
    let largest = known.iter().fold([0.0, 0.0], |[h, l], known| [known.1.max(h), known.2.max(l)]);
    let errors = errors(largest);
    // Patches are of a size, whatever the solver knows: five digits are more than anyone has use for.
    let digits = |k: usize| Digits::new(largest[k], errors[k].max(1e-4 * largest[k]));
    let (lux, candela) = (digits(0), digits(1));
    let row = |(surface, h, l): &(&Surface, f64, f64)| {
        vec![surface.name.clone(), short(surface.area), lux.write(*h), candela.write(*l)]
    };
    let rows: Vec<Vec<String>> = std::iter::once(header.to_vec()).chain(known.iter().map(row)).collect();
    format!("\n{}", text::columns(&rows))
}

fn lines(report: &Report) -> Vec<(&'static str, String)> {
    let mut lines = vec![
        (
            "patches",
            format!("{}, edges up to {} m", grouped(report.patches as u64), short(report.patch_size)),
        ),
        ("form factors", grouped(report.form_factors)),
        ("rays", grouped(report.rays)),
        ("iterations", iterations(report)),
        ("residual", residual(report)),
        ("error bound", error_bound(report)),
        ("closure", closure(report)),
    ];
    if report.unknowns > report.patches {
        lines.insert(1, ("space", space(report)));
    }
    if let Some(of) = &report.links {
        let each = of.links as f64 / report.patches as f64;
        let links = format!(
            "{}, {each:.0} a patch, to {} clusters; {} MB",
            grouped(of.links),
            grouped(of.clusters as u64),
            grouped(of.bytes >> 20)
        );
        // In the place of form factors: a link is one.
        lines[1] = ("links", links);
        lines.push(("error", error_of(of)));
    }
    lines.splice(0..0, report.lights.lines());
    lines.extend(of_mesh(report.smooth_normals, report.clean_up));
    lines.extend(last(report.peak_memory_bytes, report.dark, &report.seconds, &report.files));
    lines
}

/// How many polygons have smooth normals, and what was done to the mesh, if anything.
pub fn of_mesh(smooth_normals: usize, clean_up: CleanUp) -> impl Iterator<Item = (&'static str, String)> {
    let smooth = grouped(smooth_normals as u64);
    let normals =
        format!("of {smooth} polygons, in the picture: the light on them is solved as on flat ones");
    let done = [
        (clean_up.faces_without_area_left_out, "without area left out"),
        (clean_up.faces_turned_round, "turned round, since their nodes mirror"),
        (clean_up.faces_drawn_flat, "drawn flat, for wrong normals"),
    ];
    let done: Vec<String> = done
        .iter()
        .filter(|(count, _)| *count > 0)
        .map(|(count, what)| format!("{} faces {what}", grouped(*count as u64)))
        .collect();
    let normals = (smooth_normals > 0).then_some(("normals", normals));
    normals.into_iter().chain((!done.is_empty()).then(|| ("clean-up", done.join("; "))))
}

/// What every table of light ends with; a scene in which no surface is lit is told.
pub fn last(
    memory: Option<u64>,
    dark: bool,
    seconds: &Seconds,
    files: &[PathBuf],
) -> impl Iterator<Item = (&'static str, String)> {
    let memory = memory.map(|bytes| ("memory", format!("{} MB at most", grouped(bytes >> 20))));
    let light = "NONE reaches any surface: do the faces of the lamps look the wrong way?";
    let light = dark.then(|| ("light", light.to_owned()));
    memory.into_iter().chain(light).chain([("time", time(seconds)), ("written", written(files))])
}

fn space(report: &Report) -> String {
    let k = report.space.trim_start_matches('p');
    let count = grouped(report.unknowns as u64);
    format!("{count} coefficients, P{k} on triangles and Q{k} on quadrilaterals")
}

fn iterations(report: &Report) -> String {
    let meaning = match report.solver.as_str() {
        "successive" => ", each one bounce of light",
        "southwell" => ", each one shot",
        _ => "",
    };
    format!("{}{meaning}", grouped(report.iterations as u64))
}

fn residual(report: &Report) -> String {
    let (Report { residual, target, .. }, unit) = (report, report.units.radiosity);
    let mend = match report.outcome {
        "converged" => return format!("{residual:.1e} {unit}, of {target:.1e} allowed"),
        "stalled at rounding" => "no solver gets below rounding, ask for a larger --tolerance",
        _ if report.solver == "direct" => "this is its rounding, ask for a larger --tolerance",
        _ => "allow more --iterations",
    };
    format!("{residual:.1e} {unit}: NOT CONVERGED to {target:.1e}; {mend}")
}

fn error_bound(report: &Report) -> String {
    let unit = report.units.radiosity;
    match report.error_bound {
        Some(bound) if report.norm_rows < report.unknowns => {
            let Report { norm, norm_rows, .. } = report;
            format!("{bound:.1e} {unit} from the solver, if ‖ρF‖ ≤ {norm:.3} as in {norm_rows} rows")
        }
        Some(bound) => format!("{bound:.1e} {unit} from the solver, since ‖ρF‖ ≤ {:.3}", report.norm),
        None => format!("none, since ‖ρF‖ = {:.3} is not less than 1", report.norm),
    }
}

/// The error of light by links, of what surfaces reflect and of all that they send.
fn error_of(links: &Links) -> String {
    let Links { error, discretisation_error, link_error, reflected, .. } = *links;
    if reflected == 0.0 {
        return "none: nothing is reflected".to_owned();
    }
    let percent = |part: f64| format!("{:.2} %", 100.0 * part);
    let [all, patches, links] =
        [error, discretisation_error, link_error].map(|part| percent(part / reflected));
    let told = format!(
        "{all} of the light that surfaces reflect, in the mean square: patches {patches}, links {links}"
    );
    // Without lamps there is no other light.
    if reflected > 0.999 {
        told
    } else {
        format!("{told}; {} of all light, with that of lamps", percent(error))
    }
}

fn closure(report: &Report) -> String {
    match (report.escaping, report.closure_defect) {
        (Some(share), _) => {
            let where_to =
                if report.lights.has_sky() { "end in the sky or under it" } else { "leave the scene" };
            let from = match report.norm_rows < report.patches {
                true => format!(" from {} patches", report.norm_rows),
                false => String::new(),
            };
            format!("open: {:.1} % of the sight lines{from} {where_to}", 100.0 * share)
        }
        (None, Some(defect)) => {
            let rows = grouped(report.closure_rows.unwrap_or(0) as u64);
            if report.links.is_some() {
                return format!(
                    "links of {rows} patches add up to 1 within {defect:.1e}: those to dark places are coarse"
                );
            }
            let word = format!("form factors of {rows} patches add up to 1 within {defect:.1e}");
            match defect > SUSPICIOUS * report.accuracy {
                true => format!("{word}, MORE THAN ASKED FOR: do faces lie in one another?"),
                false => word,
            }
        }
        (None, None) => "closed, but every patch sees a back: no row to check".to_owned(),
    }
}

/// A defect this many times the standard error asked for is no accident: the worst of 10⁵ normal errors is 4.5 times
/// it, and what is neither seen nor hidden by patches that lie partly under others adds to it.
const SUSPICIOUS: f64 = 20.0;

/// Two digits or three, whatever the size.
fn short(number: f64) -> String {
    if (1e-3..1e4).contains(&number) { format!("{number:.3}") } else { format!("{number:.2e}") }
}

/// The stages that took any time worth a word, and their sum.
fn time(seconds: &Seconds) -> String {
    let stages = [
        ("load", seconds.load),
        ("patches", seconds.patches),
        ("visibility", seconds.visibility),
        ("lights", seconds.lights),
        ("form factors", seconds.form_factors),
        ("solve", seconds.solve),
        ("frames", seconds.frames),
        ("picture", seconds.picture),
        ("write", seconds.write),
    ];
    let stages = stages.iter().filter(|(_, seconds)| *seconds >= 0.005);
    let words: Vec<String> = stages.map(|(stage, seconds)| format!("{stage} {seconds:.2}")).collect();
    format!("{:.2} s: {}", seconds.total, words.join(", "))
}

/// The files, of which frames are many.
fn written(files: &[PathBuf]) -> String {
    let names: Vec<String> = files.iter().map(|file| file.display().to_string()).collect();
    match names.as_slice() {
        [] => "no file".to_owned(),
        [first, .., last] if names.len() > 6 => format!("{} files: {first} … {last}", names.len()),
        _ => names.join(", "),
    }
}

/// Digits in groups of three.
pub fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (k, digit) in digits.chars().enumerate() {
        if k > 0 && (digits.len() - k).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_stand_in_groups_of_three() {
        for (number, text) in [(0, "0"), (999, "999"), (1000, "1 000"), (12_345_678, "12 345 678")] {
            assert_eq!(grouped(number), text);
        }
    }
}
