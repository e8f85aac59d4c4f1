//! n grows until the estimated ‖φ − φ_n‖∞ meets the tolerance, and where growth does not pay the domain is divided (paper,
//! §1.2.3).

use super::alternative::{alternative, is_resolved};
use super::estimate::{Error, defects, error, largest};
use super::mesh::Mesh;
use super::nystrom::Nystrom;
use super::{PlaneEquation, product};
use crate::equation::{Alternative, Answer, Class, EquationError, Scalar, Status};
use crate::memory;

/// How exactly, and at what cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// The greatest error wanted, as a part of max |φ|.
    pub tolerance: f64,
    /// Nodes in each direction, on the undivided domain (a disk has n radii and 4n angles); `None`: as many as it takes.
    pub n: Option<usize>,
    /// The most numbers to solve for.
    pub unknowns: usize,
}

/// Unknowns of which a matrix takes some ten seconds and half a GB.
pub const DENSE: usize = 4096;

impl Default for Options {
    fn default() -> Self {
        Self { tolerance: 1e-12, n: None, unknowns: DENSE }
    }
}

/// The first n: with it the finer rule still sees twice as much.
const FIRST: usize = 6;

/// What counts are multiplied by; the second where the first asks for more than the most unknowns.
const GROWTHS: [f64; 2] = [1.5, 1.2];

/// A solution with its error, and Fredholm's alternative if I − A is singular or close to it.
struct Found<'e, 'a, T: Scalar> {
    nystrom: Nystrom<'e, 'a, T>,
    error: Error,
    /// Whether the nodes tell small singular values from zero.
    resolved: bool,
    /// `NoSolution` or `NotUnique`.
    verdict: Option<Status>,
    alternative: Option<Alternative<'e, [f64; 2], T>>,
}

/// Solves by Nyström's method, with Gauss's rules on rectangles and triangles, and Gauss in r² and the trapezoid rule in the
/// angle on a disk; where K is singular at p = q like ln |p − q| or |p − q|^β, β > −2, or has a bend there, by a product rule on graded
/// elements of 16 × 16 nodes.
///
/// # Errors
///
/// A domain without area, options that ask for nothing, a source that is infinite or NaN at a node, a kernel that is so
/// elsewhere than at p = q or that cannot be integrated, fewer unknowns allowed than the first elements have.
pub fn solve<'e, 'a, T: Scalar>(
    equation: &'e PlaneEquation<'a, T>,
    options: &Options,
) -> Result<Answer<'e, [f64; 2], T>, EquationError> {
    solve_by(equation, &options.fitting::<T>(), product::Attempt::dense)
}

/// As [`solve`]; where more unknowns are allowed than [`DENSE`] an equation with a singular kernel is solved with A in blocks of low
/// rank: 20 000 real ones take 1 GB and not 13. Whether I − A is singular is then not examined.
///
/// # Errors
///
/// As [`solve`]; [`EquationError::Method`] where I − A cannot be told from a singular operator.
pub fn solve_large<'e, 'a, T: Scalar>(
    equation: &'e PlaneEquation<'a, T>,
    options: &Options,
) -> Result<Answer<'e, [f64; 2], T>, EquationError> {
    solve_by(equation, options, product::in_blocks)
}

fn solve_by<'e, 'a, T: Scalar>(
    equation: &'e PlaneEquation<'a, T>,
    options: &Options,
    find: product::Find<'e, 'a, T>,
) -> Result<Answer<'e, [f64; 2], T>, EquationError> {
    equation.domain.checked()?;
    options.check()?;
    let class = product::class(equation)?;
    if matches!(class, Class::Logarithmic | Class::Algebraic { .. }) {
        return match options.n {
            None => product::solve(equation, class, options, find),
            Some(_) => Err(EquationError::Method(
                "n is for kernels that are smooth: this one takes elements of 16 × 16 nodes, as many as are needed".to_owned(),
            )),
        };
    }
    // A bend along lines, and not at p = q alone, is as hard for the product rule as for the other.
    let bent = match class {
        Class::Kink if options.n.is_none() => product::solve(equation, class, options, find).ok(),
        _ => None,
    };
    match bent {
        Some(answer) if answer.status != Status::ToleranceNotMet => Ok(answer),
        bent => match solve_smooth(equation, &options.fitting::<T>()) {
            // As sin |p − q| / |p − q| is.
            Err(EquationError::PlaneKernelNotFinite { p, q, .. }) if p == q && options.n.is_none() => {
                product::solve(equation, class, options, find)
            }
            Ok(smooth) if bent.as_ref().is_none_or(|bent| smooth.error_estimate < bent.error_estimate) => {
                Ok(smooth)
            }
            other => bent.map_or(other, Ok),
        },
    }
}

/// With a kernel that is smooth.
fn solve_smooth<'e, 'a, T: Scalar>(
    equation: &'e PlaneEquation<'a, T>,
    options: &Options,
) -> Result<Answer<'e, [f64; 2], T>, EquationError> {
    let mut mesh = Mesh::new(equation.domain, options.n.unwrap_or(FIRST));
    if mesh.unknowns() > options.unknowns {
        let (needed, most) = (mesh.unknowns(), options.unknowns);
        return Err(EquationError::Method(format!(
            "{needed} unknowns are asked for, and {most} are allowed, or fit into the memory"
        )));
    }
    let mut best = attempt(equation, &mesh, options.tolerance)?;
    let mut latest = None;
    while options.n.is_none() && !best.is_final(options.tolerance) {
        let found = latest.as_ref().unwrap_or(&best);
        let Some(next) = refined(found, &mesh, options)? else { break };
        mesh = next;
        let found = attempt(equation, &mesh, options.tolerance)?;
        let is_told = found.verdict.is_some() || found.resolved && !best.resolved;
        if is_told || found.error.estimate() < best.error.estimate() {
            best = found;
            latest = None;
        } else {
            latest = Some(found);
        }
    }
    Ok(best.into_answer(options.tolerance))
}

/// Bytes at the peak for each byte of a matrix, measured: A, I − A, its factors, and what it takes to make them.
const COPIES: u64 = 4;

impl Options {
    /// With no more unknowns than the memory has room for a matrix of.
    fn fitting<T>(&self) -> Self {
        let entries = memory::limit() / (COPIES * size_of::<T>() as u64);
        Self { unknowns: self.unknowns.min(entries.isqrt() as usize), ..*self }
    }

    fn check(&self) -> Result<(), EquationError> {
        if !(self.tolerance >= 0.0 && self.tolerance.is_finite()) {
            let tolerance = self.tolerance;
            return Err(EquationError::Method(format!("the tolerance {tolerance} is no number from 0 on")));
        }
        if self.n == Some(0) {
            return Err(EquationError::Method("n = 0: a rule has at least one node".to_owned()));
        }
        Ok(())
    }
}

fn attempt<'e, 'a, T: Scalar>(
    equation: &'e PlaneEquation<'a, T>,
    mesh: &Mesh,
    tolerance: f64,
) -> Result<Found<'e, 'a, T>, EquationError> {
    let nystrom = Nystrom::new(equation, mesh.rule())?;
    let finer = mesh.finer();
    let mut error = error(&nystrom, &finer, mesh)?;
    let resolved = is_resolved(&nystrom, &finer)?;
    let (mut verdict, mut told) = (None, None);
    if resolved {
        (verdict, told) = alternative(&nystrom, &finer, tolerance)?.unzip();
    } else if nystrom.singular.as_ref().is_some_and(|singular| singular.nullity() > 0) {
        // The solution is orthogonal to what may be no null function.
        error.correction = f64::INFINITY;
    }
    Ok(Found { nystrom, error, resolved, verdict: verdict.flatten(), alternative: told })
}

/// The next mesh; none where more nodes do not help or are not allowed.
fn refined<T: Scalar>(
    found: &Found<'_, '_, T>,
    mesh: &Mesh,
    options: &Options,
) -> Result<Option<Mesh>, EquationError> {
    if found.error.is_rounding() {
        return Ok(None);
    }
    let defects = defects(&found.nystrom, mesh)?;
    let target = found.error.floor.max(options.tolerance * largest(&found.nystrom.values))
        / found.nystrom.inverse_norm();
    let meshes = GROWTHS.map(|growth| mesh.refined(&defects, target, growth));
    Ok(meshes.into_iter().find(|next| next.unknowns() <= options.unknowns))
}

impl<'e, T: Scalar> Found<'e, '_, T> {
    fn meets(&self, tolerance: f64) -> bool {
        self.resolved && self.error.estimate() <= tolerance * largest(&self.nystrom.values)
    }

    fn is_final(&self, tolerance: f64) -> bool {
        self.meets(tolerance) || self.verdict == Some(Status::NoSolution)
    }

    fn into_answer(self, tolerance: f64) -> Answer<'e, [f64; 2], T> {
        let met = if self.meets(tolerance) { Status::Converged } else { Status::ToleranceNotMet };
        let none = self.verdict == Some(Status::NoSolution);
        let nystrom = self.nystrom;
        Answer {
            status: self.verdict.unwrap_or(met),
            method: format!("nystrom, product rule on the {}", nystrom.equation.domain),
            class: None,
            unknowns: nystrom.values.len(),
            error_estimate: if none { f64::INFINITY } else { self.error.estimate() },
            condition: nystrom.condition,
            solution: nystrom.function(),
            alternative: self.alternative,
        }
    }
}
