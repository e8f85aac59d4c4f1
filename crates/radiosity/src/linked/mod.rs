//! û(x) = E + ρ (D(x) + H(x)) on very many faces, to an accuracy that is asked for: D comes straight from lamps, at x itself, H
//! from all patches, by links between them.
//!
//! What is solved for is the light that patches reflect, v = ρ D + ρ F v, for lamps are known: F as links to clusters
//! ([`crate::hierarchical`]), as coarse as light from second hand allows. H is linear between the middles and the corners of patches.
//! The residual of û, looked at where it is neither, says how far û is from the light; patches and links are made finer until it is
//! as small as was asked.

mod direct;
mod error;
mod field;

pub use field::Field;

use crate::adaptive::Round;
use crate::hierarchical::Plan;
use crate::patches::{PatchError, Patches, size_for_count};
use crate::polygon::Polygon;
use crate::scene::Scene;
use crate::visibility::Visibility;
use direct::Direct;
use error::Error;
use fredholm::krylov::Gmres;
use fredholm::operator::Operator;
use fredholm::relax::{Relaxation, Stop, relax};
use fredholm::system::{System, SystemError};
use fredholm::value::{Value, max_norm};
use rayon::prelude::*;

/// What is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Request {
    /// The error that the radiosity may have, in the mean square over all surfaces, relative to the mean square of the light
    /// that they reflect.
    pub accuracy: f64,
    /// The most patches; where they do not do, the answer is the best one that they give.
    pub most_patches: usize,
    /// The most bytes that links may take.
    pub memory: u64,
}

impl Default for Request {
    /// A hundredth, with a million patches in 8 GiB at most.
    fn default() -> Self {
        Self { accuracy: 0.01, most_patches: 1_000_000, memory: 8 << 30 }
    }
}

/// Why there is no answer.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum LinkedError {
    /// The scene cannot be cut into patches.
    #[error(transparent)]
    Patches(#[from] PatchError),
    /// Emission or reflectance is not finite.
    #[error(transparent)]
    System(#[from] SystemError),
    /// Not even the first links would fit.
    #[error("links between {patches} patches take about {} MB, and {} MB are free: ask for less accuracy, or simplify the mesh", needed >> 20, available >> 20)]
    Memory {
        /// The number of patches.
        patches: usize,
        /// Bytes of the links, about.
        needed: u64,
        /// Bytes that they may take.
        available: u64,
    },
}

/// The part of what arrives that one link may bring at first, in accuracies.
const PART: f64 = 10.0;

/// Links bring no more than that, however large the error may be.
const MOST_PART: f64 = 0.3;

/// The least patches to begin with, and how many there are to a face at first.
const FIRST: usize = 4000;

/// The residual of the iteration, as a part of the accuracy and of the brightest source.
const RESIDUAL: f64 = 0.01;

/// Rounds after which nothing is made any finer.
const MOST_ROUNDS: usize = 8;

/// Seeds of the rays: of the sketch, and of the links.
const SEEDS: [u64; 2] = [3, 4];

/// How fine an answer is.
#[derive(Clone, Copy, Debug)]
struct Fineness {
    patches: usize,
    part: f64,
}

/// Solves the radiosity equation to an accuracy; `faces` are the polygons of the scene, in its order, and what hides them.
///
/// `observe` is told of every round and says whether to go on. [`Field::bound`] tells whether the accuracy was reached: it may
/// not be, where the patches, the memory or the patience do not do.
pub fn solve<'a, V: Value>(
    scene: &'a Scene<V>,
    (faces, visibility): (&'a [Polygon], &'a Visibility),
    request: &Request,
    mut observe: impl FnMut(&Round) -> bool,
) -> Result<Field<'a, V>, LinkedError> {
    let direct = Direct::new(scene, faces, visibility);
    let mut fineness =
        Fineness { patches: FIRST.max(faces.len()), part: (PART * request.accuracy).min(MOST_PART) };
    let mut field = solved(scene, direct.clone(), fineness, request)?;
    for round in 1.. {
        let error = field.bound().total();
        let [patches, links] = field.size();
        let go_on = observe(&Round { patches, links, error }) && round < MOST_ROUNDS;
        fineness = fineness.finer(&field.error, patches, request.accuracy);
        if error <= request.accuracy || !go_on || fineness.patches > request.most_patches {
            break;
        }
        match solved(scene, direct.clone(), fineness, request) {
            Err(LinkedError::Memory { .. }) => break,
            better => field = better?,
        }
    }
    Ok(field)
}

impl Fineness {
    /// The next one, for an error that is too large. That of links falls about as the part does, that of the mesh, which has edges of
    /// shadows in it, about as the number of patches grows.
    fn finer(self, error: &Error, patches: usize, accuracy: f64) -> Self {
        let [links, mesh] = [error.links, error.mesh].map(|error| error / (GOAL * accuracy));
        Self {
            part: if links > 1.0 { self.part / links.clamp(1.5, 8.0) } else { self.part },
            patches: if mesh > 1.0 { (patches as f64 * mesh.clamp(1.5, 8.0)) as usize } else { self.patches },
        }
    }
}

/// What each of two errors may have of the accuracy.
const GOAL: f64 = 0.5;

/// One round: patches, links, and the light between them.
fn solved<'a, V: Value>(
    scene: &Scene<V>,
    direct: Direct<'a, V>,
    Fineness { patches: count, part }: Fineness,
    request: &Request,
) -> Result<Field<'a, V>, LinkedError> {
    let patches = Patches::new(scene, size_for_count(scene, count))?;
    let mut exposed: Vec<f64> =
        patches.polygons.par_iter().map(|patch| direct.visibility.exposed(patch)).collect();
    let lit = direct.means(&patches);
    // Of a patch that something stands on the rest has more of the light, and sends all of it.
    let mut open = patches.clone();
    open.reflectance = reflected(&patches, &exposed);
    let source = direct.source(&open, &lit);
    let plan = Plan::new(&open, direct.visibility).shaped();
    let light = plan.sketched(&source, &lit, part, SEEDS[0])?;
    let (needed, available) = (plan.bytes(&light, part), request.memory);
    if needed > available {
        return Err(LinkedError::Memory { patches: patches.len(), needed, available });
    }
    let operator = plan.assemble(&light, part, SEEDS[1], |_| ());
    let mut arriving = vec![V::splat(0.0); patches.len()];
    operator.apply(&vec![V::splat(1.0); patches.len()], &mut arriving);
    widen(&mut exposed, &arriving);
    let reflectance = reflected(&patches, &exposed);
    let mut relaxation = Gmres::new(System::new(&source, &reflectance, &operator)?);
    let stop = Stop { residual: RESIDUAL * request.accuracy * max_norm(&source), sweeps: SWEEPS };
    let report = relax(&mut relaxation, stop, |_, _, _| true);
    let sent = relaxation.solution();
    operator.apply(&sent, &mut arriving);
    let links = operator.statistics().links as usize;
    let mut field = Field::new(direct, patches, (lit, arriving, &exposed), links);
    field.error = Error::new(&field, &plan, (&sent, &light, part), report.residual);
    Ok(field)
}

/// No patch sees more than is open of it: where the rays of links found more (the sums of its row) than points of the patch did, what
/// they found is open. Otherwise a sliver of which they find too much would reflect more than it gets.
fn widen<V: Value>(exposed: &mut [f64], sums: &[V]) {
    let open = exposed.iter_mut().zip(sums).filter(|(part, _)| **part > 0.0);
    open.for_each(|(part, sum)| *part = part.max(sum.magnitude()));
}

/// What the open parts of patches reflect, of the mean that arrives at all of them.
fn reflected<V: Value>(patches: &Patches<V>, exposed: &[f64]) -> Vec<V> {
    patches.reflectance.iter().zip(exposed).map(|(rho, part)| *rho * inverse(*part)).collect()
}

/// 1 over a part that is not buried; 0 where all is.
fn inverse(exposed: f64) -> f64 {
    if exposed > 0.0 { exposed.recip() } else { 0.0 }
}

/// Sweeps of the iteration; whatever converges in use needs far fewer.
const SWEEPS: usize = 1000;

#[cfg(test)]
mod tests {
    use super::widen;

    #[test]
    fn a_sliver_reflects_no_more_than_it_gets() {
        let mut exposed = [0.02, 0.6, 0.0];
        widen(&mut exposed, &[0.5, 0.5, 0.3]);
        assert_eq!(exposed, [0.5, 0.6, 0.0]);
    }
}
