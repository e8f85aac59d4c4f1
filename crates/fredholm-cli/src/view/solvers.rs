//! One solver on its way: iterations made, form factors used, and how it stands.

use super::kept::Kept;
use super::protocol::{Head, State, frame};
use crate::radiosity::args;
use fredholm::krylov::Gmres;
use fredholm::relax::{GaussSeidel, Jacobi, Relaxation, Southwell, SuccessiveApproximation};
use fredholm::system::{System, error_bound};
use fredholm::value::{Rgb, Value, max_norm};
use radiosity::elements::Space;
use radiosity::render::luminance;
use serde::{Deserialize, Serialize};

/// The solvers that can be watched: those that improve step by step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Solver {
    /// Shooting, patch by patch.
    Southwell,
    /// Gathering, sweep by sweep.
    GaussSeidel,
    /// All patches at once.
    Jacobi,
    /// Bounce by bounce.
    Successive,
    /// Krylov's method.
    Gmres,
}

impl Solver {
    /// All of them.
    pub const ALL: [Self; 5] =
        [Self::Southwell, Self::GaussSeidel, Self::Jacobi, Self::Successive, Self::Gmres];

    /// Whether it makes do with columns that are computed when shot.
    pub fn shoots(self) -> bool {
        self == Self::Southwell
    }

    /// The one of the command line, if it can be watched.
    pub fn watched(solver: args::Solver) -> Option<Self> {
        match solver {
            args::Solver::Southwell => Some(Self::Southwell),
            args::Solver::GaussSeidel => Some(Self::GaussSeidel),
            args::Solver::Jacobi => Some(Self::Jacobi),
            args::Solver::Successive => Some(Self::Successive),
            args::Solver::Gmres => Some(Self::Gmres),
            args::Solver::Direct => None,
        }
    }
}

/// Residuals this many times the smallest mean divergence, and so many sweeps that end below the target without meeting
/// it mean rounding: as in `fredholm::relax`, whose loop cannot be paused.
const DIVERGENCE: f64 = 1e3;
const PATIENCE: usize = 12;

/// A solver and how far it is.
pub struct Lane<'a> {
    system: System<'a, Rgb, Kept<'a>>,
    space: &'a Space<'a>,
    relaxation: Box<dyn Relaxation<Rgb> + 'a>,
    shoots: bool,
    iteration: usize,
    shot: Option<usize>,
    smallest: f64,
    mistaken: usize,
    target: f64,
    /// The frame of so many iterations.
    told: Option<(usize, Vec<u8>)>,
    /// How it stands.
    pub state: State,
}

impl<'a> Lane<'a> {
    /// A solver that has done nothing yet; `space` is whose coefficients the unknowns are, `target` the residual at which it
    /// ends.
    pub fn new(solver: Solver, system: System<'a, Rgb, Kept<'a>>, space: &'a Space<'a>, target: f64) -> Self {
        let relaxation: Box<dyn Relaxation<Rgb> + 'a> = match solver {
            Solver::Southwell => Box::new(Southwell::new(system, space.weights())),
            Solver::GaussSeidel => Box::new(GaussSeidel::new(system)),
            Solver::Jacobi => Box::new(Jacobi::new(system)),
            Solver::Successive => Box::new(SuccessiveApproximation::new(system)),
            Solver::Gmres => Box::new(Gmres::new(system)),
        };
        Self {
            system,
            space,
            relaxation,
            shoots: solver.shoots(),
            iteration: 0,
            shot: None,
            smallest: f64::INFINITY,
            mistaken: 0,
            target,
            told: None,
            state: State::Running,
        }
    }

    /// The form factors of an iteration, in passes.
    pub fn cost(&self) -> f64 {
        if self.shoots { 1.0 / self.system.dim() as f64 } else { 1.0 }
    }

    /// Those of all iterations so far.
    pub fn work(&self) -> f64 {
        self.iteration as f64 * self.cost()
    }

    /// Whether there is more to do.
    pub fn runs(&self) -> bool {
        self.state == State::Running
    }

    /// One iteration.
    pub fn sweep(&mut self) {
        self.shot = self.shoots.then(|| self.brightest());
        let norm = self.relaxation.sweep();
        self.iteration += 1;
        self.smallest = self.smallest.min(norm);
        if !norm.is_finite() || norm > DIVERGENCE * self.smallest {
            self.state = State::Diverged;
        } else if norm <= self.target {
            self.mistaken += 1;
            // The method's own norm may be of another moment: the residual itself decides.
            if max_norm(&self.relaxation.residual()) <= self.target {
                self.state = State::Converged;
            } else if self.mistaken > PATIENCE {
                self.state = State::Stalled;
            }
        }
    }

    /// The unknown with the most unshot light, which Southwell's method takes next.
    fn brightest(&self) -> usize {
        let residual = self.relaxation.residual();
        let weights = self.space.weights();
        let light = |i: usize| residual[i].magnitude() * weights[i];
        (1..residual.len()).fold(0, |best, i| if light(i) > light(best) { i } else { best })
    }

    /// What the method shows now: the mean over each patch.
    pub fn shown(&self) -> Vec<Rgb> {
        self.space.means(&self.relaxation.preview())
    }

    /// ‖r‖∞ of now.
    pub fn residual(&self) -> f64 {
        max_norm(&self.relaxation.residual())
    }

    /// Iterations made.
    pub fn iteration(&self) -> usize {
        self.iteration
    }

    /// The frame of now; `norm` is ‖ρF‖∞. In a race it may be asked for many times during a sweep, and costs as much.
    pub fn frame(&mut self, lane: usize, run: u32, norm: f64) -> Vec<u8> {
        match &self.told {
            Some((iteration, frame)) if *iteration == self.iteration => frame.clone(),
            _ => {
                let frame = self.new_frame(lane, run, norm);
                self.told = Some((self.iteration, frame.clone()));
                frame
            }
        }
    }

    fn new_frame(&self, lane: usize, run: u32, norm: f64) -> Vec<u8> {
        let residual = self.relaxation.residual();
        let largest = max_norm(&residual);
        let head = Head {
            lane: lane as u32,
            run,
            iteration: self.iteration as u32,
            shot: self.shot.map(|unknown| self.space.element_of(unknown)),
            state: self.state,
            work: self.work(),
            residual: largest,
            bound: error_bound(largest, norm),
            unshot: unshot(&residual, self.space.weights()),
        };
        // Of a patch with several unknowns that which is furthest off.
        let worst = |i: usize| residual[self.space.range(i)].iter().map(Value::magnitude).fold(0.0, f64::max);
        frame(&head, &self.shown(), (0..self.space.polygons().len()).map(worst))
    }
}

/// Σ A_i |r_i|, as luminance: the power that is still to be passed on, in W or lm.
pub fn unshot(residual: &[Rgb], areas: &[f64]) -> f64 {
    residual.iter().zip(areas).map(|(r, area)| luminance(r.map(f64::abs)) * area).sum()
}
