//! u = Σ_k g_k u_k with u_k = f_k + ρ ⊙ (F u_k): one solution per lamp, so that lamps can be dimmed without solving.
//!
//! New reflectances start from the old solutions: with v = u − ũ the equation is v = r + ρ ⊙ (F v), r the residual of ũ
//! under the new ρ, and the same solver finds v.

use super::discrete::{Discrete, Kind};
use super::kept::Kept;
use super::protocol::{Message, State, lamp};
use super::stage::Stage;
use fredholm::operator::Dense;
use fredholm::relax::{GaussSeidel, Relaxation};
use fredholm::system::System;
use fredholm::value::{Rgb, Value, max_norm};
use radiosity::elements::Space;

/// The lamps' solutions on their way.
pub struct Relight {
    /// Of which unknowns.
    kind: Kind,
    /// u_k, of each lamp.
    solutions: Vec<Vec<Rgb>>,
    job: Option<Job>,
}

/// What is to be solved.
struct Job {
    reflectance: Vec<Rgb>,
    version: u32,
    lamp: usize,
    /// ‖r‖∞ of the lamp before the last sweeps.
    last: f64,
}

/// Sweeps between two answers. Each answer costs a residual as well, so fewer are wasteful; more are seen as jerks.
const SWEEPS: usize = 2;

impl Relight {
    /// No lamp is solved for yet.
    pub fn new(discrete: &Discrete) -> Self {
        let dark = vec![Rgb::splat(0.0); discrete.dim()];
        Self { kind: discrete.kind, solutions: vec![dark; discrete.lamps.len()], job: None }
    }

    /// Forgets the solutions if they are of other unknowns.
    pub fn enter(&mut self, discrete: &Discrete) {
        if self.kind != discrete.kind {
            *self = Self::new(discrete);
        }
    }

    /// Asks for all lamps with these reflectances of unknowns.
    pub fn ask(&mut self, reflectance: Vec<Rgb>, version: u32) {
        self.job = Some(Job { reflectance, version, lamp: 0, last: f64::INFINITY });
    }

    /// Whether there is something to do.
    pub fn is_busy(&self) -> bool {
        self.job.is_some()
    }

    /// Does a little of it, and says what came of it.
    pub fn advance(
        &mut self,
        stage: &Stage,
        (discrete, space): (&Discrete, &Space<'_>),
        matrix: &Dense<f32>,
    ) -> Option<Message> {
        let job = self.job.as_mut()?;
        let solution = &mut self.solutions[job.lamp];
        let on = (&stage.scene, discrete.surface.as_slice());
        let source = discrete.lamps[job.lamp].source(on, &job.reflectance);
        let kept = Kept::Stored(matrix);
        let target = stage.how.tolerance * max_norm(&source);
        let (state, norm) = improve(solution, (&source, &job.reflectance, &kept), (target, job.last));
        let answer = lamp(job.lamp as u32, job.version, state, &space.means(solution));
        job.last = norm;
        if state != State::Running {
            (job.lamp, job.last) = (job.lamp + 1, f64::INFINITY);
            if job.lamp == self.solutions.len() {
                self.job = None;
            }
        }
        Some(Message::Bytes(answer))
    }
}

/// Sweeps that leave more of the residual than this are at the end of what rounding lets them do: in a closed white room
/// of reflectance 0.99 they leave 0.98.
const STALLED: f64 = 0.999;

/// A few sweeps on the equation of what ũ lacks, unless it lacks less than the target; with the residual before them.
fn improve(
    solution: &mut [Rgb],
    (source, coefficient, operator): (&[Rgb], &[Rgb], &Kept<'_>),
    (target, last): (f64, f64),
) -> (State, f64) {
    let system = System { source, coefficient, operator };
    let residual = system.residual(solution);
    let norm = max_norm(&residual);
    if norm <= target {
        return (State::Converged, norm);
    }
    if norm > STALLED * last {
        return (State::Stalled, norm);
    }
    let mut lacking = GaussSeidel::new(System { source: &residual, ..system });
    for _ in 0..SWEEPS {
        if !lacking.sweep().is_finite() {
            return (State::Diverged, norm);
        }
    }
    solution.iter_mut().zip(lacking.solution()).for_each(|(u, v)| *u += v);
    (State::Running, norm)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::discrete::{Matrix, space};
    use crate::view::stage::tests::cornell;
    use radiosity::solve::{Options, Unobserved, solve};

    fn solve_all(relight: &mut Relight, stage: &Stage, matrix: &Matrix) -> usize {
        let space = space(stage, stage.how.kind);
        let on = (stage.first(), &space);
        (0..200).take_while(|_| relight.advance(stage, on, &matrix.entries).is_some()).count()
    }

    #[test]
    fn lamps_together_are_the_scene_and_new_walls_take_fewer_steps() {
        let stage = cornell(300);
        let matrix = stage.first().matrix().unwrap().as_ref().unwrap();
        let mut relight = Relight::new(stage.first());
        relight.ask(stage.patches.reflectance.clone(), 1);
        let first = solve_all(&mut relight, &stage, matrix);
        let check = |relight: &Relight, reflectance: &[Rgb]| {
            let mut patches = stage.patches.clone();
            patches.reflectance = reflectance.to_vec();
            let expected =
                solve(&patches, &stage.visibility, &Options::default(), &mut Unobserved).unwrap().radiosity;
            let sum = |i: usize| relight.solutions.iter().fold(Rgb::splat(0.0), |sum, u| sum + u[i]);
            let off: Vec<Rgb> = expected.iter().enumerate().map(|(i, u)| *u - sum(i)).collect();
            let size = max_norm(&patches.emission);
            assert!(max_norm(&off) < 10.0 * stage.how.tolerance * size, "{} of {size}", max_norm(&off));
        };
        check(&relight, &stage.patches.reflectance);
        let mut darker = stage.patches.reflectance.clone();
        darker.iter_mut().filter(|rho| rho.0[0] > 0.7).for_each(|rho| *rho = *rho * 0.98);
        relight.ask(darker.clone(), 2);
        let again = solve_all(&mut relight, &stage, matrix);
        check(&relight, &darker);
        assert!(again < first, "{again} steps after {first}");
    }
}
