//! Very many panels: F in blocks of low rank, GMRES on it, and the error from the residual between the nodes (paper, §1.1.3).
//!
//! Panels are cut where f is not resolved, before anything is solved, and then where φ_n is not. The residual is asked for at
//! places that no panel chose, by rules that are good to rounding there: so what the blocks leave out is in it, and what GMRES
//! left, and what a kernel does that panels are too long for.

use super::attempt::{SAFETY, largest, sampled};
use super::found::PanelFunction;
use super::panels::Panels;
use super::periodic::is_periodic;
use super::{DENSE, GRADED, Options, SHORT, has_singular_kernel, solve};
use crate::discretize::ProductNystrom;
use crate::equation::{Answer, Equation, EquationError, Scalar, Status};
use crate::memory;
use crate::operator::NotFinite;
use crate::product::{COARSE, Change, POINTS, Product};
use crate::second_kind::Blocks;
use rayon::prelude::*;
use std::sync::Arc;

/// As [`solve`]; where more unknowns are allowed than [`DENSE`] and it takes more, F is kept in blocks of low rank: memory and time
/// grow like n log n, a million real unknowns of one equation take some 4 GB. Whether I − A is singular is examined only as far as
/// [`solve`] does.
///
/// # Errors
///
/// As [`solve`]; [`EquationError::Method`] where F takes more memory than there is, or where I − A cannot be told from a singular
/// operator.
pub fn solve_large<'e, 'a: 'e, T: Scalar>(
    equation: &'e Equation<'a, T>,
    options: &Options,
) -> Result<Answer<'e, f64, T>, EquationError> {
    if options.unknowns <= DENSE {
        return solve(equation, options);
    }
    let product = Product::new(equation, options.class)?;
    let (of_panel, least) = (POINTS * equation.components(), product.change().least_panels());
    let most = options.unknowns.min((memory::limit() / LEAST_BYTES) as usize / T::PARTS) / of_panel;
    if most < least {
        return solve(equation, options);
    }
    let resolving = resolving(&product, least, most, options.tolerance)?;
    let within = |unknowns| match resolving.len() * of_panel <= unknowns {
        true => solve(equation, &Options { unknowns, ..*options }).map(Some),
        false => Ok(None),
    };
    let has_verdict = |answer: &Answer<'_, f64, T>| answer.status != Status::ToleranceNotMet;
    let graded = || {
        if !is_plain(&product) || !is_singular_at_ends(&product, &resolving) {
            return Ok(None);
        }
        let graded = product.changed(Change::graded(equation.interval()));
        in_blocks(&graded, &self::resolving(&graded, GRADED, most, options.tolerance)?, most, options)
    };
    let mut best = within(FEW)?;
    // A matrix may do with fewer panels than blocks, as its residual is known on each.
    let others: [&dyn Fn() -> Found<'e, T>; 3] =
        [&|| in_blocks(&product, &resolving, most, options), &graded, &|| within(DENSE)];
    for other in others {
        if best.as_ref().is_some_and(has_verdict) {
            break;
        }
        let better = |other: &Answer<'_, f64, T>| {
            best.as_ref().is_none_or(|best| has_verdict(other) || other.error_estimate < best.error_estimate)
        };
        match other() {
            // Too much memory for the next is no reason to lose what there is.
            Err(EquationError::Method(_)) if best.is_some() => {}
            found => best = found?.filter(better).or(best),
        }
    }
    best.ok_or_else(|| {
        EquationError::Method(format!(
            "the source alone takes more than {} unknowns: allow more of them, where there is memory, or take a larger tolerance",
            most * of_panel
        ))
    })
}

/// Whether panels are in x itself.
fn is_plain<T: Scalar>(product: &Product<'_, '_, T>) -> bool {
    matches!(product.change(), Change::Identity { .. })
}

/// Whether φ is singular at an end: with a singular kernel, unless the equation goes round a circle, or as the source is, which has
/// far shorter panels there.
fn is_singular_at_ends<T: Scalar>(product: &Product<'_, '_, T>, resolving: &Panels) -> bool {
    let is_short = |end: usize| resolving.share(end) * (resolving.len() as f64) < SHORT;
    has_singular_kernel(product) && !is_periodic(product.equation())
        || end_panels(product.change(), resolving).into_iter().any(is_short)
}

type Found<'e, T> = Result<Option<Answer<'e, f64, T>>, EquationError>;

/// Unknowns of which a matrix takes less time than blocks do.
const FEW: usize = 1000;

/// The first answer that meets the tolerance, or the best one, of panels that are cut until they are more than `most`; none if they
/// are from the start.
fn in_blocks<'e, T: Scalar>(
    product: &Product<'e, '_, T>,
    resolving: &Panels,
    most: usize,
    options: &Options,
) -> Found<'e, T> {
    let tolerance = options.tolerance;
    let mut panels = resolving.clone();
    if is_plain(product) && has_singular_kernel(product) {
        // φ is as singular at the ends as x ln x, and worse.
        let shortest = (PART * tolerance).max(SHORTEST);
        let halvings = |panel: usize| (panels.share(panel) / shortest).log2().ceil().max(0.0) as usize;
        let ends = end_panels(product.change(), &panels);
        panels = towards_ends(product.change(), &panels, ends.map(halvings));
    }
    let mut best: Option<Answer<'e, f64, T>> = None;
    let (mut before, mut error) = (0, f64::INFINITY);
    while panels.len() <= most {
        let attempt = match Attempt::new(product, &panels, tolerance) {
            Ok(attempt) => attempt,
            // What was found before is kept where the next takes too much memory; a kernel that is infinite somewhere is told.
            Err(EquationError::Method(_)) if best.is_some() => break,
            Err(error) => return Err(error),
        };
        let (met, finer) = (attempt.meets(tolerance), attempt.cut(product.change(), tolerance));
        // Next to ends, at which doubles are too far apart, panels would be cut for ever.
        let in_vain = (panels.len() as f64) < FEW_MORE * before as f64 && attempt.error > GAIN * error;
        (before, error) = (panels.len(), attempt.error);
        if best.as_ref().is_none_or(|best| attempt.error < best.error_estimate) {
            best = Some(attempt.answer(product, tolerance));
        }
        match finer {
            Some(finer) if !met && !in_vain => panels = finer,
            _ => break,
        }
    }
    Ok(best)
}

/// So many times as many panels are few more, and an error that falls to such a part has hardly fallen.
const FEW_MORE: f64 = 1.1;
const GAIN: f64 = 0.9;

/// Bytes that an unknown takes, at least: in blocks it takes some thousands.
const LEAST_BYTES: u64 = 2000;

/// Places on a panel, from −1 to 1, where the source is looked at between the nodes: where a polynomial through these misses most,
/// near the ends, and in the middle.
const LOOKS: [f64; 3] = [-0.995, 0.05, 0.995];

/// A panel of this part of the interval is not cut any more: something is singular there.
const SHORTEST: f64 = 1e-14;

/// The part of what is allowed that may be left unresolved on a panel.
const PART: f64 = 0.1;

/// Panels on which the source is resolved, from `count` on but not more than `most`, of which there are one too many then.
fn resolving<T: Scalar>(
    product: &Product<'_, '_, T>,
    count: usize,
    most: usize,
    tolerance: f64,
) -> Result<Panels, EquationError> {
    let mut panels = Panels::equal(product.change().range(), count);
    loop {
        let f = sampled(product, &panels.nodes(&COARSE))?;
        let allowed = PART * tolerance * largest(&f);
        let is_cut = |(panel, missed): (usize, f64)| missed > allowed && panels.share(panel) > SHORTEST;
        let cut: Vec<bool> = missed(product, &panels, &f).into_iter().enumerate().map(is_cut).collect();
        if panels.len() > most || !cut.contains(&true) {
            return Ok(panels);
        }
        panels = panels.cut(|panel| if cut[panel] { 2 } else { 1 });
    }
}

/// By panel, how far a source is from its polynomial between the nodes, beyond rounding.
fn missed<T: Scalar>(product: &Product<'_, '_, T>, panels: &Panels, f: &[T]) -> Vec<f64> {
    let of = |c: usize, panel: usize| {
        let part = &f[(c * panels.len() + panel) * POINTS..][..POINTS];
        let (low, high) = panels.ends(panel);
        let at = |xi: f64| {
            let t = 0.5 * ((high + low) + (high - low) * xi);
            product.equation().source(c, product.change().point(t)) - COARSE.interpolate(part, xi)
        };
        (largest(&LOOKS.map(at)) - ROUNDING * largest(part)).max(0.0)
    };
    let components = 0..product.equation().components();
    let worst = |panel: usize| components.clone().map(|c| of(c, panel)).fold(0.0, f64::max);
    (0..panels.len()).into_par_iter().map(worst).collect()
}

/// What evaluating a function and its interpolant leaves, as a part of it.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Places where the residual is asked for: at each the kernel is asked for on all panels.
const PLACES: usize = 126;

/// Two more are next to the ends, on the last panel's way from −1 to 1.
const NEXT: f64 = 0.9999;

/// The most halvings of a panel at an end at once.
const HALVINGS: f64 = 24.0;

/// The solution on given panels, judged.
struct Attempt<T> {
    panels: Arc<Panels>,
    /// A φ_n: φ is f and this, so that an f which is singular at an end is not taken for a polynomial there.
    images: PanelFunction<T>,
    unknowns: usize,
    error: f64,
    scale: f64,
    condition: f64,
    inverse_norm: f64,
    /// What is left unresolved of f and of A φ_n, by panel.
    tails: Vec<f64>,
}

impl<T: Scalar> Attempt<T> {
    fn new(product: &Product<'_, '_, T>, panels: &Panels, tolerance: f64) -> Result<Self, EquationError> {
        let coupling = ProductNystrom::of_panels(product.clone(), panels.edges().to_vec());
        let not_finite = |entry: NotFinite| coupling.told(entry);
        let blocks = Blocks::new(&coupling, &coupling.points(), (tolerance, memory::limit()), not_finite)?;
        let source = sampled(product, &panels.nodes(&COARSE))?;
        let values = coupling.values(&blocks.solve(&coupling.unknowns(&source)));
        let (norm, inverse_norm, condition) = (blocks.norm(), blocks.inverse_norm(), blocks.condition());
        let (unknowns, scale) = (values.len(), largest(&values));
        let mut tails = missed(product, panels, &source);
        let images: Vec<T> = values.iter().zip(&source).map(|(value, f)| *value - *f).collect();
        let count = panels.len();
        for (k, part) in images.chunks(POINTS).enumerate() {
            tails[k % count] += COARSE.unresolved(part);
        }
        let panels = Arc::new(panels.clone());
        let images = PanelFunction::new(product, &panels, images);
        let phi = PanelFunction::new(product, &panels, values);
        let residual = Residual::new(product, &panels, &phi)?;
        let unseen = largest(&tails);
        for (end, at_end) in end_panels(product.change(), &panels).into_iter().zip(residual.at_ends) {
            // Where φ is as x ln x, the last coefficients tell less than what they leave out comes to next to an end.
            if at_end > SAFETY * residual.inside {
                tails[end] = tails[end].max(at_end);
            }
        }
        let rounding = 2.0 * f64::EPSILON * (1.0 + norm) + residual.rule;
        let error = inverse_norm.max(1.0) * (SAFETY * residual.largest() + unseen + rounding * scale);
        let error = if error.is_nan() { f64::INFINITY } else { error };
        Ok(Self { panels, images, unknowns, error, scale, condition, inverse_norm, tails })
    }

    fn meets(&self, tolerance: f64) -> bool {
        self.error <= tolerance * self.scale || self.error == 0.0
    }

    /// Panels cut where φ_n is not resolved; all where it is, and the residual says that something else is not. None where those that
    /// are to be cut are too short for it.
    fn cut(&self, change: Change, tolerance: f64) -> Option<Panels> {
        let allowed = PART * tolerance * self.scale / self.inverse_norm.max(1.0);
        let panels = &self.panels;
        let unresolved: Vec<usize> = (0..panels.len()).filter(|k| self.tails[*k] > allowed).collect();
        if unresolved.is_empty() {
            return Some(panels.cut(|_| 2));
        }
        if unresolved.iter().all(|k| panels.share(*k) <= SHORTEST) {
            return None;
        }
        // Next to an end, where φ may be as x ln x, what is missed falls as the last panel's length does.
        let ends = end_panels(change, panels);
        let halvings =
            ends.map(|end| (self.tails[end] / allowed).log2().ceil().clamp(0.0, HALVINGS) as usize);
        let is_cut = |k: usize| self.tails[k] > allowed && !ends.contains(&k) && panels.share(k) > SHORTEST;
        Some(towards_ends(change, &panels.cut(|k| if is_cut(k) { 2 } else { 1 }), halvings))
    }

    fn answer<'e>(self, product: &Product<'e, '_, T>, tolerance: f64) -> Answer<'e, f64, T> {
        let met = self.meets(tolerance);
        Answer {
            status: if met { Status::Converged } else { Status::ToleranceNotMet },
            method: format!(
                "automatic: collocation on {} panels of degree 15, in blocks of low rank",
                self.panels.len()
            ),
            class: Some(product.worst_class()),
            unknowns: self.unknowns,
            error_estimate: self.error,
            condition: self.condition,
            solution: self.images.after_source(product.equation()),
            alternative: None,
        }
    }
}

/// The residual between the nodes, of a system the largest of all components.
struct Residual {
    /// |f + A φ_n − φ_n| at its largest, but not next to the ends.
    inside: f64,
    /// Next to either end.
    at_ends: [f64; 2],
    /// What the rules leave out of ∫ K g with |g| ≤ 1.
    rule: f64,
}

impl Residual {
    fn new<T: Scalar>(
        product: &Product<'_, '_, T>,
        panels: &Panels,
        phi: &PanelFunction<T>,
    ) -> Result<Self, EquationError> {
        const GOLDEN: f64 = 0.618_033_988_749_895;
        let components = 0..product.equation().components();
        let at = |(panel, xi): (usize, f64)| -> Result<[f64; 2], EquationError> {
            let (low, high) = panels.ends(panel);
            let t = 0.5 * ((high + low) + (high - low) * xi);
            let x = product.change().point(t);
            components.clone().try_fold([0.0, 0.0], |[worst, rule]: [f64; 2], c| {
                let (image, error) = phi.transported(product, c, t, |weight| weight)?;
                let residual = product.equation().source(c, x) + image - phi.on_panel(c, panel, xi);
                Ok([largest(&[worst, residual.modulus()]), rule.max(error)])
            })
        };
        let [first, last] = end_panels(product.change(), panels);
        let inside = |k: usize| {
            ((2 * k + 1) * panels.len() / (2 * PLACES), 2.0 * (0.5 + GOLDEN * k as f64).fract() - 1.0)
        };
        let mut places = vec![(first, -NEXT), (last, NEXT)];
        places.extend((0..PLACES).map(inside));
        let all = places.into_par_iter().map(at).collect::<Result<Vec<_>, _>>()?;
        let (residuals, rules): (Vec<f64>, Vec<f64>) = all.into_iter().map(|[r, rule]| (r, rule)).unzip();
        Ok(Self {
            inside: largest(&residuals[2..]),
            at_ends: [residuals[0], residuals[1]],
            rule: largest(&rules),
        })
    }

    fn largest(&self) -> f64 {
        largest(&[self.inside, self.at_ends[0], self.at_ends[1]])
    }
}

/// The panel that begins at an end of the interval, and the one that stops at the other. Both infinities of the whole line are at
/// t = 0, where the panels on either side meet.
fn end_panels(change: Change, panels: &Panels) -> [usize; 2] {
    match change {
        Change::WholeLine => {
            let after = panels.edges().partition_point(|t| *t < 0.0);
            [after, after - 1]
        }
        _ => [0, panels.len() - 1],
    }
}

/// The panels at the ends halved so many times towards these.
fn towards_ends(change: Change, panels: &Panels, halvings: [usize; 2]) -> Panels {
    let mut finer = panels.clone();
    for round in 0..halvings[0].max(halvings[1]) {
        let [first, last] = end_panels(change, &finer);
        let is_cut = |panel| {
            (panel == first && round < halvings[0] || panel == last && round < halvings[1])
                && finer.share(panel) > SHORTEST
        };
        finer = finer.cut(|panel| if is_cut(panel) { 2 } else { 1 });
    }
    finer
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panels_are_halved_towards_the_ends_and_towards_both_infinities() {
        let plain = towards_ends(Change::Identity { a: 0.0, b: 1.0 }, &Panels::equal((0.0, 1.0), 2), [2, 1]);
        assert_eq!(plain.edges(), [0.0, 0.125, 0.25, 0.5, 0.75, 1.0]);
        let whole = towards_ends(Change::WholeLine, &Panels::equal((-1.0, 1.0), 2), [2, 1]);
        assert_eq!(whole.edges(), [-1.0, -0.5, 0.0, 0.25, 0.5, 1.0]);
    }
}
