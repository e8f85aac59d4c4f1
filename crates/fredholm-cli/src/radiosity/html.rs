//! u after every iteration as one page that shows it converge: `fredholm view` without a server.

use super::domain::Domain;
use super::settings::Settings;
use crate::args::name;
use crate::view::Kind;
use crate::view::description::{Description, geometry};
use crate::view::page;
use crate::view::protocol::{Head, State, head};
use crate::view::solvers::{Solver, unshot};
use anyhow::{Context, Result};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use fredholm::relax::{Outcome, Relaxation};
use fredholm::system::error_bound;
use fredholm::value::{Rgb, Value, max_norm};
use half::f16;
use radiosity::patches::Patches;
use radiosity::render::Colour;
use radiosity::scene::{Camera, Units};
use radiosity::solve::Solution;
use serde::Serialize;

/// From one recorded iteration to the next: all at first, then ever fewer, as light changes ever less. 30 000 shots are
/// 70 frames, and in 5000 patches 4 MB; at 1.05 they would be 11 MB, at 1.5 they jump.
const GROWTH: f64 = 1.12;

/// The frames of a run.
pub struct Recording {
    kind: Kind,
    solver: Solver,
    unknowns: usize,
    frames: Vec<Frame>,
    next: usize,
}

/// A moment, in half precision.
struct Frame {
    head: Head,
    scales: [f32; 2],
    halves: Vec<u8>,
}

impl Recording {
    /// Of the solver that is going to run, if it has steps, on so many unknowns.
    pub fn new(settings: &Settings, unknowns: usize) -> Result<Self> {
        let solver = Solver::watched(settings.solver).with_context(|| {
            format!(
                "--html shows how light converges, and the {} solver has no steps",
                name(&settings.solver)
            )
        })?;
        let kind = Kind { method: settings.method, space: settings.space };
        Ok(Self { kind, solver, unknowns, frames: Vec::new(), next: 1 })
    }

    /// Keeps an iteration if it is its turn, or perhaps the last; `means` makes values of patches of the unknowns.
    pub fn record<V: Colour>(
        &mut self,
        (iteration, last): (usize, bool),
        patches: &Patches<V>,
        relaxation: &dyn Relaxation<V>,
        means: impl Fn(Vec<V>) -> Vec<V>,
    ) {
        if iteration < self.next && !last {
            return;
        }
        self.next = (iteration + 1).max((iteration as f64 * GROWTH) as usize);
        let residual = relaxation.residual();
        let largest = max_norm(&residual);
        self.keep(iteration, patches, (&means(relaxation.preview()), &means(residual), largest));
    }

    fn keep<V: Colour>(
        &mut self,
        iteration: usize,
        patches: &Patches<V>,
        (u, r, largest): (&[V], &[V], f64),
    ) {
        let colours = |values: &[V]| -> Vec<Rgb> { values.iter().map(Colour::to_rgb).collect() };
        let (radiosity, residual) = (colours(u), colours(r));
        let cost = if self.solver.shoots() { 1.0 / self.unknowns as f64 } else { 1.0 };
        let head = Head {
            lane: 0,
            run: 0,
            iteration: iteration as u32,
            shot: None,
            state: State::Running,
            work: iteration as f64 * cost,
            residual: largest,
            bound: None,
            unshot: unshot(&residual, &patches.areas),
        };
        let mut halves = Vec::with_capacity(8 * patches.len());
        let first = scaled(&mut halves, &radiosity.iter().flat_map(|colour| colour.0).collect::<Vec<f64>>());
        let second = scaled(&mut halves, &residual.iter().map(Value::magnitude).collect::<Vec<f64>>());
        self.frames.push(Frame { head, scales: [first, second], halves });
    }

    /// The page, all of it.
    pub fn page<V: Colour>(
        mut self,
        domain: &Domain<'_, V>,
        (units, camera): (Units, Camera),
        size: f64,
        solution: &Solution<V>,
    ) -> Result<String> {
        if self.frames.is_empty() {
            // Solved before the first iteration: no patch has a residual that matters.
            let none = vec![V::splat(0.0); domain.patches.len()];
            self.keep(0, &domain.patches, (&solution.radiosity, &none, solution.report.residual));
        }
        let ended = match solution.report.outcome {
            Outcome::Converged => State::Converged,
            Outcome::Stalled => State::Stalled,
            Outcome::Diverged => State::Diverged,
            Outcome::OutOfSweeps | Outcome::Interrupted => State::Running,
        };
        let finished = |(k, frame): (usize, &Frame)| {
            let state = if k + 1 == self.frames.len() { ended } else { State::Running };
            let bound = error_bound(frame.head.residual, solution.norm);
            frame.text(Head { state, bound, ..frame.head })
        };
        let Domain { scene, patches, visibility, .. } = domain;
        let recorded = Recorded {
            scene: Description::new((scene, units), (patches, visibility), size, camera),
            started: Started {
                kind: self.kind,
                solvers: [self.solver],
                unknowns: self.unknowns,
                stored: false,
                // What a bound needs is in the norm.
                row_sum: 1.0,
                norm: solution.norm,
                target: solution.target,
            },
            geometry: STANDARD.encode(geometry(&patches.polygons)),
            frames: self.frames.iter().enumerate().map(finished).collect(),
        };
        Ok(page::alone(&serde_json::to_string(&recorded)?))
    }
}

impl Frame {
    fn text(&self, as_told: Head) -> String {
        let mut bytes = head(&as_told);
        self.scales.iter().for_each(|scale| bytes.extend(scale.to_le_bytes()));
        bytes.extend(&self.halves);
        STANDARD.encode(bytes)
    }
}

/// Numbers as halves of the largest, which is returned: an exitance in lm/m² may be more than a half can hold.
fn scaled(bytes: &mut Vec<u8>, numbers: &[f64]) -> f32 {
    let largest = numbers.iter().fold(0.0_f64, |largest, number| largest.max(number.abs())) as f32;
    let scale = if largest > 0.0 { largest } else { 1.0 };
    numbers.iter().for_each(|number| bytes.extend(f16::from_f64(number / f64::from(scale)).to_le_bytes()));
    scale
}

/// What the page reads: viewer/src/source.ts.
#[derive(Serialize)]
struct Recorded {
    scene: Description,
    started: Started,
    geometry: String,
    frames: Vec<String>,
}

#[derive(Serialize)]
struct Started {
    kind: Kind,
    solvers: [Solver; 1],
    unknowns: usize,
    stored: bool,
    row_sum: f64,
    norm: f64,
    target: f64,
}
