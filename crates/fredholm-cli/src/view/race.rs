//! One solver, or two that race: each iteration is that of the solver that will have used fewer form factors after it.

use super::kept::Kept;
use super::setup::Setup;
use super::solvers::Lane;
use std::time::Instant;

/// The solvers of now.
pub struct Run<'a> {
    /// What is solved.
    pub setup: &'a Setup,
    /// F.
    pub kept: &'a Kept<'a>,
    /// ‖ρF‖∞.
    pub norm: f64,
    /// One solver, or two.
    pub lanes: Vec<Lane<'a>>,
}

impl Run<'_> {
    /// Whether one of them has more to do.
    pub fn runs(&self) -> bool {
        self.lanes.iter().any(Lane::runs)
    }

    /// The work of the solver that has done most.
    pub fn work(&self) -> f64 {
        self.lanes.iter().map(Lane::work).fold(0.0, f64::max)
    }

    /// Iterates until the work is done or the time is up, the one that will have done least first; says whether anything was done.
    pub fn advance(&mut self, due: f64, until: Option<Instant>) -> bool {
        let mut worked = false;
        while self.iterate(due) {
            worked = true;
            if until.is_some_and(|until| Instant::now() >= until) {
                break;
            }
        }
        worked
    }

    /// One iteration of the solver whose turn it is; says whether there was one.
    fn iterate(&mut self, due: f64) -> bool {
        // Half a shot of slack: sums of many small costs do not meet the due exactly.
        let slack = 0.5 / self.setup.source.len() as f64;
        // Who would have done least after it: a sweep waits until the other has shot as much.
        let after = |lane: &Lane<'_>| lane.work() + lane.cost();
        let ready = |lane: &&mut Lane<'_>| lane.runs() && after(lane) <= due + slack;
        let least = |a: &&mut Lane<'_>, b: &&mut Lane<'_>| after(a).total_cmp(&after(b));
        let Some(lane) = self.lanes.iter_mut().filter(ready).min_by(least) else { return false };
        lane.sweep();
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::discrete::{Factors, space};
    use crate::view::solvers::Solver;
    use crate::view::stage::tests::cornell;
    use fredholm::system::System;

    #[test]
    fn no_solver_is_ahead_when_the_time_is_up() {
        let stage = cornell(200);
        let space = space(&stage, stage.how.kind);
        let computed = Factors::new(&stage, stage.how.kind, &space);
        let kept = stage.first().kept(&computed);
        let setup = Setup::of(&stage, Solver::GaussSeidel);
        let system = System::new(&setup.source, &setup.reflectance, &kept).unwrap();
        let lane = |solver| Lane::new(solver, system, &space, setup.target);
        let lanes = [Solver::GaussSeidel, Solver::Southwell].map(lane).into_iter().collect();
        let mut run = Run { setup: &setup, kept: &kept, norm: 0.5, lanes };
        let past = Instant::now();
        for _ in 0..10 {
            assert!(run.advance(5.0, Some(past)));
        }
        assert_eq!((run.lanes[0].iteration(), run.lanes[1].iteration()), (0, 10));
        run.advance(5.0, None);
        let n = stage.patches.len();
        assert_eq!((run.lanes[0].iteration(), run.lanes[1].iteration()), (5, 5 * n));
    }
}
