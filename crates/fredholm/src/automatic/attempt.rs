//! r = f + A φ_n − φ_n, φ − (f + A φ_n) = (I − A)⁻¹ A r: one attempt with given panels, and the error that the equation's
//! own residual tells (paper, §1.1.3).

use super::discrete::Discrete;
use super::panels::{Panels, coarsened, refined};
use super::singular::{Singular, examine};
use crate::equation::{EquationError, Scalar, Status};
use crate::product::{COARSE, FINE, Product};
use crate::second_kind::SecondKind;

/// The solution on given panels, judged.
pub(crate) struct Attempt<T: Scalar> {
    pub(crate) panels: Panels,
    /// φ_n at the nodes.
    pub(crate) values: Vec<T>,
    /// The estimated error of Nyström's interpolant of φ_n.
    pub(crate) error: f64,
    /// The part of it that is rounding, and that no panels will lessen.
    pub(crate) floor: f64,
    /// max |φ|.
    pub(crate) scale: f64,
    /// What each panel's residual contributes to the error.
    pub(crate) contributions: Vec<f64>,
    pub(crate) condition: f64,
    pub(crate) depth: u32,
    /// What is known of the null spaces, if I − A is singular.
    pub(crate) singular: Option<Singular<T>>,
    pub(crate) status: Option<Status>,
}

/// What the estimate may be too small by, as the first term of a series.
pub(super) const SAFETY: f64 = 2.0;

/// A residual whose last coefficients are more than this part of it is not resolved at all: of a jump they are a third, of
/// |x|^(1/2) a twelfth.
const ERRATIC: f64 = 0.1;

/// Places at which the source is looked at between the nodes, by the golden ratio: nothing wider than 1/200 of the interval
/// is missed, and 16 unknowns take 30 µs instead of 20.
const PROBES: usize = 200;
const GOLDEN: f64 = 0.618_033_988_749_895;

/// From this condition number on, I − A is examined by its singular values.
const SUSPICIOUS: f64 = 1e4;

impl<T: Scalar> Attempt<T> {
    pub(crate) fn new(
        product: &Product<'_, '_, T>,
        panels: Panels,
        tolerance: f64,
    ) -> Result<Self, EquationError> {
        let coarse = Discrete::assemble(product, &panels, &COARSE)?;
        let fine = Discrete::assemble(product, &panels, &FINE)?;
        let source = sampled(product, &panels.nodes(&COARSE))?;
        let fine_source = sampled(product, &panels.nodes(&FINE))?;
        let system = SecondKind::new(coarse.n, &coarse.a);
        let m = product.equation().components();

        let mut attempt = Self {
            values: Vec::new(),
            error: f64::INFINITY,
            floor: 0.0,
            scale: 0.0,
            contributions: vec![1.0; panels.len()],
            condition: system.condition(),
            depth: coarse.depth.max(fine.depth),
            singular: None,
            status: None,
            panels,
        };
        attempt.values = system.solve(&source);
        if system.condition() < SUSPICIOUS {
            attempt.judge(&fine, &fine_source, system.inverse_norm(), |r| system.solve(r));
        } else if let Some(singular) = examine(product, &attempt.panels, &coarse, &fine, &system)? {
            attempt.contributions.clone_from(&singular.contributions);
            if singular.resolved() {
                let weights = |reference| attempt.panels.weights(reference, product.change()).repeat(m);
                let (weights, fine_weights) = (weights(&COARSE), weights(&FINE));
                let bordered = singular.bordered(&coarse.a, &weights);
                attempt.values = solved(&bordered, &source);
                attempt.judge(&fine, &fine_source, bordered.inverse_norm(), |r| solved(&bordered, r));
                attempt.verdict(singular, &fine_source, &fine_weights, tolerance);
            }
        }
        if attempt.error.is_finite() {
            attempt.look_between(product, &fine_source);
        }
        Ok(attempt)
    }

    /// Looks at the source once more, between all nodes: where it is not what they say, the panel must be cut.
    fn look_between(&mut self, product: &Product<'_, '_, T>, source: &[T]) {
        let (equation, change) = (product.equation(), product.change());
        let (from, to) = change.range();
        for probe in 0..PROBES {
            let t = from + (to - from) * (0.5 + GOLDEN * probe as f64).fract();
            let (panel, xi) = self.panels.locate(t);
            for a in 0..equation.components() {
                let part = &source[(a * self.panels.len() + panel) * FINE.len()..][..FINE.len()];
                let missed = (equation.source(a, change.point(t)) - FINE.interpolate(part, xi)).modulus();
                if missed > 1e3 * (FINE.unresolved(part) + f64::EPSILON * largest(part) + self.floor) {
                    self.error = f64::INFINITY;
                    self.contributions.fill(0.0);
                    self.contributions[panel] = missed;
                    return;
                }
            }
        }
    }

    /// The error of f + A φ_n: with r = f + A φ_n − φ_n it is (I − A)⁻¹ A r.
    fn judge(&mut self, fine: &Discrete<T>, source: &[T], inverse_norm: f64, solve: impl Fn(&[T]) -> Vec<T>) {
        let phi = refined(&self.values);
        let iterated: Vec<T> = source.iter().zip(fine.apply(&phi)).map(|(f, a_phi)| *f + a_phi).collect();
        let residual: Vec<T> = iterated.iter().zip(&phi).map(|(new, old)| *new - *old).collect();
        let transported = fine.apply(&residual);
        let correction = solve(&coarsened(&transported));

        let norms = fine.panel_norms(self.panels.len(), &FINE);
        let norm: f64 = norms.iter().sum();
        self.scale = largest(&iterated);
        let error = largest(&transported).max(largest(&correction));
        let rounding = 2.0 * f64::EPSILON * (1.0 + norm) * self.scale;
        // What the residual's polynomials leave out of it is not in the correction. A polynomial K does not see it either,
        // unless it is a jump or a spike, whose coefficients do not decay and are not right themselves.
        let beyond = |part: &[T]| (FINE.unresolved(part) - rounding).max(0.0);
        let erratic = |part: &[T]| {
            let tail = beyond(part);
            if tail > ERRATIC * largest(part) { tail } else { 0.0 }
        };
        let smooth: f64 = self.by_panel(&residual, &fine.ragged, beyond).iter().sum();
        let unseen = smooth + self.by_panel(&residual, &norms, erratic).iter().sum::<f64>();
        let quadrature: f64 = self.by_panel(&phi, &fine.errors, largest).iter().sum();
        self.floor = (rounding + quadrature) * inverse_norm.max(1.0);
        self.error = SAFETY * error + unseen * inverse_norm.max(1.0) + self.floor;
        if self.error.is_nan() {
            self.error = f64::INFINITY;
        }
        self.contributions = self.by_panel(&residual, &norms, largest);
    }

    /// For each panel, the largest `size` of its parts of a function, times the panel's factor.
    fn by_panel(&self, values: &[T], factors: &[f64], size: impl Fn(&[T]) -> f64) -> Vec<f64> {
        let mut sizes = vec![0.0; self.panels.len()];
        for (k, part) in values.chunks(FINE.len()).enumerate() {
            let panel = k % self.panels.len();
            sizes[panel] = f64::max(sizes[panel], size(part) * factors[panel]);
        }
        sizes
    }

    /// Fredholm's alternative, its second case: a solution only where f is orthogonal to the adjoint's null functions.
    fn verdict(&mut self, mut singular: Singular<T>, source: &[T], weights: &[f64], tolerance: f64) {
        if singular.nullity() > 0 {
            match singular.test(source, weights, tolerance) {
                Some(true) => self.status = Some(Status::NotUnique),
                Some(false) => self.status = Some(Status::NoSolution),
                // The source is not yet resolved well enough to tell.
                None => {
                    self.error = f64::INFINITY;
                    let ones = vec![1.0; self.panels.len()];
                    self.contributions = self.by_panel(source, &ones, |part| FINE.unresolved(part));
                }
            }
        }
        self.singular = Some(singular);
    }

    /// The number of unknowns.
    pub(crate) fn unknowns(&self) -> usize {
        self.values.len()
    }

    pub(crate) fn meets(&self, tolerance: f64) -> bool {
        self.error <= tolerance * self.scale || self.error == 0.0
    }
}

/// u with (I − A) u = f of a bordered system, without the multipliers of the border.
fn solved<T: Scalar>(bordered: &SecondKind<T>, f: &[T]) -> Vec<T> {
    let mut right = f.to_vec();
    right.resize(bordered.len(), T::ZERO);
    let mut u = bordered.solve(&right);
    u.truncate(f.len());
    u
}

/// f at these t, component after component.
pub(super) fn sampled<T: Scalar>(
    product: &Product<'_, '_, T>,
    nodes: &[f64],
) -> Result<Vec<T>, EquationError> {
    let equation = product.equation();
    let components = 0..equation.components();
    let points = components.flat_map(|a| nodes.iter().map(move |t| (a, product.change().point(*t))));
    points
        .map(|(a, x)| match equation.source(a, x) {
            value if value.finite() => Ok(value),
            value => Err(EquationError::SourceNotFinite { x, value: format!("{value:?}") }),
        })
        .collect()
}

/// max |z|; NaN when one is NaN, so that it cannot hide.
pub(crate) fn largest<T: Scalar>(numbers: &[T]) -> f64 {
    numbers.iter().map(|z| z.modulus()).fold(0.0, |m: f64, x| if x > m || x.is_nan() { x } else { m })
}
