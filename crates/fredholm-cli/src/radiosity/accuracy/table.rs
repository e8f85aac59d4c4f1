//! The numbers of a run to an accuracy as people read them.

use super::report::Report;
use crate::radiosity::table::{grouped, last, of_mesh, of_surfaces};
use crate::text::{self, percent};

/// The table, a line per matter.
pub fn table(report: &Report) -> String {
    let matters = text::lines(&lines(report));
    let asked = percent(report.accuracy);
    let surfaces = of_surfaces(&report.surfaces, |largest| largest.map(|number| report.error * number));
    format!("{}: to an accuracy of {asked}\n\n{matters}{surfaces}", report.scene)
}

fn lines(report: &Report) -> Vec<(&'static str, String)> {
    let met = if report.is_met() { "" } else { "; NOT MET: no more patches fit" };
    let mut lines = vec![
        (
            "error",
            format!("{} of the light that surfaces reflect, in the mean square{met}", percent(report.error)),
        ),
        ("of the mesh", percent(report.discretisation_error)),
        ("form factors", percent(report.form_factor_error)),
        ("iteration", percent(report.iteration_error)),
        ("mesh", mesh(report)),
    ];
    lines.splice(0..0, report.lights.lines());
    lines.extend(of_mesh(report.smooth_normals, report.clean_up));
    lines.extend(last(report.peak_memory_bytes, report.dark, &report.seconds, &report.files));
    lines
}

fn mesh(report: &Report) -> String {
    let (patches, factors) = (grouped(report.patches as u64), grouped(report.form_factors as u64));
    let rounds = report.rounds.len();
    format!(
        "{patches} {} {factors} form factors, after {rounds} round{}",
        report.elements,
        if rounds == 1 { "" } else { "s" }
    )
}
