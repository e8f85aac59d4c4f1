//! F as links to clusters: a sketch tells how bright patches are, then there are the links that this brightness needs.

use super::{Observer, Run, SAMPLED_ROWS, Solution, SolveError, spread};
use crate::hierarchical::{Judged, Kept, Light, Plan, Statistics, clusters_bytes};
use fredholm::operator::Operator;
use fredholm::system::System;
use fredholm::value::Value;
use std::time::Instant;

/// What is told of links beside a [`Solution`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Links {
    /// How many there are, of what.
    pub statistics: Statistics,
    /// The bytes that were expected before there were any.
    pub planned_bytes: u64,
    /// How far the solution is from the light itself.
    pub judged: Judged,
}

/// The part of what arrives that one link may bring, for a standard error of 1 of a row sum: a row has so many links that these
/// err by some hundredth of one. At 10⁻³ the light errs by .2 to .6 % (BENCHMARKS.md).
const PART: f64 = 100.0;

/// Links bring no more than that, however large the error may be.
const MOST: f64 = 0.3;

/// Seeds of the rays.
const SEEDS: [u64; 2] = [1, 2];

impl<V: Value> Run<'_, V> {
    /// Solves with links.
    pub(super) fn link(&self, observer: &mut dyn Observer<V>) -> Result<Solution<V>, SolveError> {
        let start = Instant::now();
        self.plan_factors(self.patches.len(), observer)?;
        let part = (PART * self.options.accuracy).min(MOST);
        self.check_links(clusters_bytes(self.patches.len()))?;
        let plan = Plan::new(self.patches, self.visibility);
        let kept = match observer.kept() {
            Some(mut file) => Kept::read(&plan, part, self.source, &mut file)?,
            None => Kept::none(&plan, self.sketched(&plan, part)?, part, self.source),
        };
        let patches = self.patches.len();
        let planned_bytes = self.check_links(plan.bytes(kept.light(), part))?;
        observer.planned(planned_bytes);
        // A bar counts the entries of a matrix.
        let row = patches.div_ceil(2);
        let hooks = (|patches: usize| observer.assembled(patches * row), || observer.stops());
        let light = kept.light().clone();
        let interrupted = |kept: Kept| SolveError::Interrupted { patches, kept: Box::new(kept) };
        let operator = plan.go_on(kept, part, SEEDS[1], hooks).map_err(interrupted)?;
        let assembly_seconds = start.elapsed().as_secs_f64();
        observer.linked(&operator);
        let start = Instant::now();
        let system = System::new(self.source, self.reflectance, &operator)?;
        let mut relaxation = self.relaxation(system);
        let report = self.relax(&mut *relaxation, observer)?;
        let mut irradiance = vec![V::splat(0.0); self.source.len()];
        operator.apply(&relaxation.solution(), &mut irradiance);
        let checked = spread(self.source.len(), SAMPLED_ROWS);
        let solution = self.judge(system, &irradiance, report, &checked);
        let found = Light::of(self.patches, &solution.radiosity, &solution.irradiance);
        // Nobody waits for an error who does not wait for the answer.
        let judged = (!observer.stops()).then(|| plan.judge(self.source, &solution.radiosity, &found, part));
        drop(relaxation);
        let Some(judged) = judged.filter(|_| !observer.stops()) else {
            return Err(interrupted(operator.into_kept(plan.digest(part, self.source), light)));
        };
        let statistics = *operator.statistics();
        Ok(Solution {
            form_factors: statistics.links,
            rays: statistics.rays,
            assembly_seconds,
            solve_seconds: start.elapsed().as_secs_f64(),
            links: Some(Links { statistics, planned_bytes, judged }),
            ..solution
        })
    }

    /// The bytes that clusters and links will take, if there are so many.
    fn check_links(&self, needed: u64) -> Result<u64, SolveError> {
        let (patches, available) = (self.patches.len(), self.options.memory);
        if needed > available { Err(SolveError::Links { patches, needed, available }) } else { Ok(needed) }
    }

    /// The light by coarser links, found for light that is the same everywhere.
    fn sketched(&self, plan: &Plan<'_, V>, part: f64) -> Result<Light, SolveError> {
        let ambient = Light::ambient(self.patches, self.source);
        // For light that is the same everywhere there are about as many as for the true one: too many are told at once.
        self.check_links(plan.bytes(&ambient, part))?;
        Ok(plan.sketched(self.source, &self.lit.irradiance, part, SEEDS[0])?)
    }
}
