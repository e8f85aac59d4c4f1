//! How far the work is, on the terminal, and the frames on the way; silent where nobody looks.

use super::args::Method;
use super::checkpoint::Stop;
use super::frames::Frames;
use super::html::Recording;
use super::settings::Settings;
use super::timing::Seconds;
use crate::args::name;
use crate::terminal::{Stream, bar, say};
use anyhow::Result;
use fredholm::relax::Relaxation;
use indicatif::ProgressBar;
use radiosity::elements::Space;
use radiosity::hierarchical::Hierarchical;
use radiosity::patches::Patches;
use radiosity::render::Colour;
use radiosity::scene::Units;
use radiosity::solve::{Observer, Solution};
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::PathBuf;

/// Steps of the bar of a relaxation, from the first residual to the last on a logarithmic scale.
const STEPS: f64 = 1000.0;

/// So many are told beforehand, also where nobody looks at a bar.
const MANY_MEGABYTES: u64 = 100;

/// Watches the solver: moves its bars and records its frames.
pub struct Watcher<'a, V> {
    patches: &'a Patches<V>,
    space: Option<&'a Space<'a>>,
    assembly: ProgressBar,
    relaxation: ProgressBar,
    first: Option<f64>,
    unit: &'static str,
    frames: Option<Frames>,
    recording: Option<Recording>,
    failed: Option<anyhow::Error>,
    stop: Stop,
    resume: Option<File>,
    /// A picture of the links, once there are some, if it is asked for.
    links: Option<String>,
}

/// What was seen.
pub struct Watched {
    /// The files of the frames.
    pub files: Vec<PathBuf>,
    /// What a page tells.
    pub recording: Option<Recording>,
    /// A picture of the links.
    pub links: Option<String>,
}

impl<'a, V: Colour> Watcher<'a, V> {
    /// A watcher over these patches, or the coefficients of a space on them.
    pub fn new(
        (settings, units): (&Settings, Units),
        patches: &'a Patches<V>,
        space: Option<&'a Space<'a>>,
        (frames, recording): (Option<Frames>, Option<Recording>),
        (stop, resume): (Stop, Option<File>),
    ) -> Self {
        let n = space.map_or(patches.len(), Space::dim) as u64;
        // Reciprocity, A_i F_ij = A_j F_ji, halves the work where patches are tested as wholes or both as points.
        let entries = if settings.method == Method::Collocation { n * n } else { n * (n + 1) / 2 };
        let relaxation = bar("relaxation", STEPS as u64).with_message(name(&settings.solver));
        Self {
            patches,
            space,
            assembly: bar("form factors", entries),
            relaxation,
            first: None,
            unit: units.exitance(),
            frames,
            recording,
            failed: None,
            stop,
            resume,
            links: None,
        }
    }

    /// The same, which draws the links.
    pub fn drawing_links(self, draws: bool) -> Self {
        Self { links: draws.then(String::new), ..self }
    }

    /// Takes the bars off the terminal.
    pub fn clear(&self) {
        self.assembly.finish_and_clear();
        self.relaxation.finish_and_clear();
    }

    /// What was seen, and the time of what was watched.
    pub fn finish(self, solution: &Solution<V>, seconds: &mut Seconds) -> Result<Watched> {
        self.clear();
        if let Some(error) = self.failed {
            return Err(error);
        }
        seconds.lights = solution.light_seconds;
        seconds.form_factors = solution.assembly_seconds;
        seconds.solve = solution.solve_seconds;
        let mut files = Vec::new();
        if let Some(mut frames) = self.frames {
            seconds.solve -= frames.recording;
            frames.finish(solution.report.residuals.len(), self.patches, &solution.radiosity)?;
            seconds.frames = frames.preparing + frames.recording;
            files = frames.files;
        }
        Ok(Watched { files, recording: self.recording, links: self.links })
    }
}

impl<V: Colour> Observer<V> for Watcher<'_, V> {
    fn kept(&mut self) -> Option<Box<dyn Read>> {
        let file = self.resume.take()?;
        Some(Box::new(BufReader::new(file)))
    }

    fn stops(&self) -> bool {
        self.stop.is_asked()
    }

    fn planned(&mut self, bytes: u64) {
        let megabytes = bytes >> 20;
        self.assembly.set_message(format!("about {megabytes} MB"));
        if self.assembly.is_hidden() && megabytes >= MANY_MEGABYTES {
            // Who closes the standard error wants the answer all the same.
            let _ = say(Stream::Err, &format!("note: about {megabytes} MB of memory will be taken\n"));
        }
    }

    fn linked(&mut self, links: &Hierarchical) {
        if let Some(picture) = &mut self.links {
            *picture = links.picture();
        }
    }

    fn assembled(&self, entries: usize) {
        self.assembly.inc(entries as u64);
    }

    fn relaxed(&mut self, iteration: usize, norm: f64, target: f64, relaxation: &dyn Relaxation<V>) -> bool {
        if !self.relaxation.is_hidden() {
            self.assembly.finish_and_clear();
            let first = *self.first.get_or_insert(norm);
            let done = if norm > target { (first / norm).ln() / (first / target).ln() } else { 1.0 };
            self.relaxation.set_position((STEPS * done.clamp(0.0, 1.0)) as u64);
            self.relaxation.set_message(format!("iteration {iteration}, residual {norm:.1e} {}", self.unit));
        }
        let means = |values: Vec<V>| match self.space {
            Some(space) => space.means(&values),
            None => values,
        };
        if let Some(recording) = &mut self.recording {
            recording.record((iteration, norm <= target), self.patches, relaxation, means);
        }
        let Some(frames) = &mut self.frames else { return !self.stop.is_asked() };
        let shown = || means(relaxation.preview());
        self.failed = frames.record(iteration, self.patches, shown).err();
        self.failed.is_none() && !self.stop.is_asked()
    }
}
