//! The numbers of a thermal run as people read them.

use super::report::{Report, Surface};
use crate::text::{self, Digits, short};

/// The table: a line per matter, then a row per surface.
pub fn table(report: &Report) -> String {
    let matters = text::lines(&lines(report));
    format!(
        "{}: heat by radiation, {}\n\n{matters}\n{}",
        report.scene,
        report.bands_in_words,
        surfaces(report)
    )
}

fn lines(report: &Report) -> Vec<(&'static str, String)> {
    let mut lines = Vec::new();
    if let Some(mesh) = &report.mesh {
        lines.push(("patches", format!("{}, edges up to {} m", mesh.patches, three(mesh.patch_size))));
        lines.push(("rays", mesh.rays.to_string()));
    }
    lines.push(("closure", closure(report)));
    lines.push(("residual", residual(report)));
    let whose = if report.closure_defect.is_some() { "" } else { ", with the surroundings'," };
    let (defect, exchanged) = (tiny(report.balance_defect), three(report.heat_exchanged));
    lines.push(("balance", format!("Σ Q{whose} = 0 within {defect} W, of {exchanged} W exchanged")));
    lines.push(("time", format!("{:.2} s", report.seconds.total)));
    if !report.files.is_empty() {
        let names: Vec<String> = report.files.iter().map(|file| file.display().to_string()).collect();
        lines.push(("written", names.join(", ")));
    }
    lines
}

fn closure(report: &Report) -> String {
    let sums = match report.mesh {
        Some(_) => "form factors",
        None => "view factors",
    };
    let escaping = report.mesh.as_ref().and_then(|mesh| mesh.escaping);
    let kelvin = report.surroundings;
    let outside =
        format!("the surroundings, at {} K, get {} W", short(kelvin), three(report.heat_to_surroundings));
    match (report.closure_defect, escaping) {
        (Some(defect), _) => format!("closed: {sums} add up to 1 within {}", tiny(defect)),
        (None, Some(share)) => {
            format!("open: {:.1} % of the sight lines leave the scene; {outside}", 100.0 * share)
        }
        (None, None) => format!("open; {outside}"),
    }
}

fn residual(report: &Report) -> String {
    let Report { residual, largest_radiosity: largest, steps, .. } = report;
    let steps = match steps {
        1 => String::new(),
        steps => format!(", after {steps} steps of Newton's method"),
    };
    match report.outcome {
        "converged" => format!("{residual:.1e} W/m², of B up to {} W/m²{steps}", three(*largest)),
        _ => format!(
            "{residual:.1e} W/m²{steps}: NOT CONVERGED; allow more --iterations, or a larger --tolerance"
        ),
    }
}

/// A size that is to be small.
fn tiny(number: f64) -> String {
    if number == 0.0 { "0".to_owned() } else { format!("{number:.1e}") }
}

/// Four digits, whatever the size.
fn three(number: f64) -> String {
    let magnitude = number.abs();
    if magnitude == 0.0 {
        "0".to_owned()
    } else if (1e-3..1e5).contains(&magnitude) {
        Digits::new(magnitude, magnitude * 2e-4).write(number)
    } else {
        format!("{number:.3e}")
    }
}

fn surfaces(report: &Report) -> String {
    let surfaces = &report.surfaces;
    let temperatures = column(surfaces, |s| s.temperature, |s| s.error_bounds.and_then(|e| e.temperature));
    let fluxes = column(surfaces, |s| Some(s.heat_flux), |s| s.error_bounds.map(|e| e.heat_flux));
    let heats = column(surfaces, |s| Some(s.heat), |s| s.error_bounds.map(|e| e.heat));
    let ranges = surfaces.iter().map(range);
    let has_range = ranges.clone().any(|range| !range.is_empty());
    let header =
        ["surface", "area, m²", "emissivity", "T, K", "from … to, K", "q, W/m²", "Q, W", "± W", "given"];
    let mut rows = vec![header.map(str::to_owned).to_vec()];
    for (k, (surface, range)) in surfaces.iter().zip(ranges).enumerate() {
        let bound =
            surface.error_bounds.map_or_else(|| "?".to_owned(), |errors| format!("{:.0e}", errors.heat));
        rows.push(vec![
            surface.name.clone(),
            short(surface.area),
            emissivity(surface),
            temperatures[k].clone(),
            range,
            fluxes[k].clone(),
            heats[k].clone(),
            bound,
            given(surface),
        ]);
    }
    if !has_range {
        rows.iter_mut().for_each(|row| drop(row.remove(4)));
    }
    text::columns(&rows)
}

/// One number, or one for each band where they differ.
fn emissivity(surface: &Surface) -> String {
    let mut numbers: Vec<String> = surface.emissivity.iter().map(|e| short(*e)).collect();
    numbers.dedup();
    match numbers.len() {
        1 => numbers.remove(0),
        _ => surface.emissivity.iter().map(|e| short(*e)).collect::<Vec<_>>().join(" "),
    }
}

fn given(surface: &Surface) -> String {
    match (surface.given, &surface.linked) {
        ("temperature", _) => "T".to_owned(),
        ("heat flux", _) => "q".to_owned(),
        (other, Some(body)) => format!("{other}: {body}"),
        (other, None) => other.to_owned(),
    }
}

/// Between which temperatures the patches of a surface are, where they differ.
fn range(surface: &Surface) -> String {
    match (surface.lowest_temperature, surface.highest_temperature) {
        (Some(lowest), Some(highest)) if highest - lowest > 0.01 => format!("{lowest:.1} … {highest:.1}"),
        _ => String::new(),
    }
}

/// A column of numbers, with no more digits than are known of the worst of them.
fn column(
    surfaces: &[Surface],
    number: impl Fn(&Surface) -> Option<f64>,
    error: impl Fn(&Surface) -> Option<f64>,
) -> Vec<String> {
    let largest = surfaces.iter().filter_map(&number).map(f64::abs).fold(0.0, f64::max);
    let worst = surfaces.iter().filter_map(error).fold(0.0, f64::max);
    // A patch is a mean of its own: of a mesh no one asks for ten digits.
    let is_mesh = surfaces.iter().any(|surface| surface.lowest_temperature != surface.highest_temperature);
    let digits = Digits::new(largest, if is_mesh { worst.max(1e-5 * largest) } else { worst });
    surfaces
        .iter()
        .map(|surface| number(surface).map_or_else(|| "–".to_owned(), |n| digits.write(n)))
        .collect()
}
