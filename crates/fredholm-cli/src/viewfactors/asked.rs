//! What a View3D file asks for on its control line, and what is made of it: taken, checked, or told that it is not done.

use radiosity::scene::Control;
use serde::Serialize;
use std::path::Path;

/// The tolerance if neither the command line nor the mesh has one; View3D's as well.
const TOLERANCE: f64 = 1e-4;

/// Where the tolerance comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Origin {
    /// `--tolerance`.
    Option,
    /// `eps` of the mesh.
    File,
    /// Neither.
    Default,
}

/// What is asked of this run, by the command line and by the mesh.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Asked {
    /// The greatest error of a factor and of the sum of a row.
    pub tolerance: f64,
    /// Where it comes from.
    pub tolerance_from: Origin,
    /// `eps` of the mesh.
    pub eps: Option<f64>,
    /// Whether the mesh says that it is an enclosure, `encl=1`.
    #[serde(rename = "encl")]
    pub enclosure: bool,
    /// Whether it wants factors with reflections in them, Hottel's script F, `emit=1`.
    pub reflections: bool,
    /// Whether it wants View3D's binary format, `out=1`.
    pub binary: bool,
}

impl Asked {
    /// By `--tolerance`, and by the control line of the mesh.
    pub fn new(tolerance: Option<f64>, control: Option<&Control>) -> Self {
        let eps = control.and_then(|control| control.accuracy);
        let (tolerance, tolerance_from) = match (tolerance, eps) {
            (Some(tolerance), _) => (tolerance, Origin::Option),
            (None, Some(eps)) => (eps, Origin::File),
            (None, None) => (TOLERANCE, Origin::Default),
        };
        let enclosure = control.is_some_and(|control| control.is_enclosure);
        let reflections = control.is_some_and(|control| control.with_reflection);
        let binary = control.is_some_and(|control| control.output == 1);
        Self { tolerance, tolerance_from, eps, enclosure, reflections, binary }
    }

    /// What is taken from the mesh, in a line of the table; `None` if nothing is.
    pub fn told(&self) -> Option<String> {
        let eps = self.eps.map(|eps| match self.tolerance_from {
            Origin::Option => format!("eps={eps:e}, but --tolerance is given"),
            _ => format!("eps={eps:e} is the tolerance"),
        });
        let enclosure = self.enclosure.then(|| "encl=1: closure is checked, and not enforced".to_owned());
        let reflections = self.reflections.then(|| "emit=1: the factors are Hottel's script F".to_owned());
        let binary = self.binary.then(|| "out=1: .out and .vf are binary".to_owned());
        let words: Vec<String> = [eps, enclosure, reflections, binary].into_iter().flatten().collect();
        (!words.is_empty()).then(|| words.join("; "))
    }
}

/// What the mesh asks for and is not done, each with its place and what to do.
pub fn not_done(control: &Control, mesh: &Path, is_closed: bool) -> Vec<String> {
    let place = match control.line {
        Some(line) => format!("{}:{line}", mesh.display()),
        None => mesh.display().to_string(),
    };
    let mut told = Vec::new();
    let mut tell = |message: &str| told.push(format!("{place}: {message}"));
    match (control.row, control.column) {
        (Some(row), Some(column)) => {
            tell(&format!("`row={row} col={column}` asks for one factor; all are computed"));
        }
        (Some(row), None) => tell(&format!("`row={row}` asks for one row; all are computed")),
        _ => {}
    }
    if control.output == 2 {
        tell(
            "`out=2` is a format that View3D reserves and does not write; .out and .vf are text, as of `out=0`",
        );
    }
    if control.is_enclosure && !is_closed {
        tell(
            "`encl=1` says that the surfaces form an enclosure, but sight lines leave them: is there a gap, or does a \
             front look outwards?",
        );
    }
    told
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_comes_before_the_file() {
        let control = Control { accuracy: Some(1e-3), is_enclosure: true, output: 1, ..Control::default() };
        let origin = |asked: Asked| (asked.tolerance, asked.tolerance_from);
        assert_eq!(origin(Asked::new(None, None)), (1e-4, Origin::Default));
        assert_eq!(origin(Asked::new(None, Some(&Control::default()))), (1e-4, Origin::Default));
        assert_eq!(origin(Asked::new(None, Some(&control))), (1e-3, Origin::File));
        assert_eq!(origin(Asked::new(Some(1e-6), Some(&control))), (1e-6, Origin::Option));
        assert_eq!(Asked::new(None, Some(&Control::default())).told(), None);
    }

    #[test]
    fn what_is_not_done_is_told_with_its_line() {
        let control = Control { line: Some(7), row: Some(2), output: 2, ..Control::default() };
        let control = Control { is_enclosure: true, with_reflection: true, ..control };
        let told = not_done(&control, Path::new("a.vs3"), false);
        for (told, word) in told.iter().zip(["`row=2`", "`out=2`", "`encl=1`"]) {
            assert!(told.starts_with("a.vs3:7: ") && told.contains(word), "{told}");
        }
        assert_eq!((told.len(), not_done(&control, Path::new("a.vs3"), true).len()), (3, 2));
        assert!(not_done(&Control::default(), Path::new("a.vs3"), false).is_empty());
    }
}
