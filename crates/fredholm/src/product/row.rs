//! κ_j(x) = ∫ K(x, y) u_j(y) dy on a panel: the interval is cut until K(x, ·) is resolved on every piece, and what the
//! pieces find is gathered at the panel's nodes, by the transposed of the interpolation from there (paper, §1.2.3, remark).

use super::change::Change;
use super::diagonal::{Core, Diagonal};
use super::reference::{COARSE, POINTS, Reference, SINGULAR};
use crate::equation::{EquationError, LineKernel, Scalar};

/// What is left out of K on a piece may weigh this much, of ∫ K g with |g| ≤ 1: I − A is of size 1.
const NEGLIGIBLE: f64 = 1e-15;

/// Coefficients this small beside K itself are its rounding.
const ROUNDING: f64 = 4e-15;

/// On a part of a panel g needs fewer coefficients, and the rule has so many more for K.
const PART: f64 = 30.0;

/// Halvings of a panel; a jump is then within 2⁻⁵⁰ of the panel.
const DEPTH: u32 = 50;

/// Where a piece is looked at once more: so far from its ends, and from the diagonal, as a part of its length. At the
/// diagonal itself there may be 0/0; at an end of the half-line a peak of width 1 at x = 10⁶ is 10⁻¹² wide.
const PROBE: f64 = 1e-13;

/// Samples of halves of panels, in a row, after which pieces are taken as they are, with their errors. A singularity within a peak
/// takes 3000.
const BUDGET: usize = 100_000;

/// A kernel as a function of t, seen from a fixed t.
pub(crate) struct Seen<'k, T> {
    kernel: &'k dyn LineKernel<T>,
    change: Change,
    t: f64,
    x: f64,
}

impl<'k, T: Scalar> Seen<'k, T> {
    pub(crate) fn new(kernel: &'k dyn LineKernel<T>, change: Change, t: f64) -> Self {
        Self { kernel, change, t, x: change.point(t) }
    }

    /// `values[j]` = K(x(t), x(t + τ_j)) x′(t + τ_j), where `y` and `offset` have room for as many numbers.
    pub(crate) fn sample(
        &self,
        tau: &[f64],
        (y, offset): (&mut [f64], &mut [f64]),
        values: &mut [T],
    ) -> Result<(), EquationError> {
        let Self { kernel, change, t, x } = *self;
        if let Change::Identity { .. } = change {
            y.iter_mut().zip(tau).for_each(|(y, tau)| *y = t + tau);
            offset.copy_from_slice(tau);
        } else {
            y.iter_mut().zip(tau).for_each(|(y, tau)| *y = change.point(t + tau));
            offset.iter_mut().zip(tau).for_each(|(offset, tau)| *offset = change.offset(t, *tau));
        }
        if !kernel.takes_offset() {
            let points = y.iter_mut().zip(&*offset);
            points
                .filter(|(y, offset)| **y == x && **offset != 0.0)
                .for_each(|(y, offset)| *y = beside(x, *offset));
        }
        kernel.row(x, y, offset, values);
        if let Some(j) = values.iter().position(|value| !value.finite()) {
            let value = format!("{:?}", values[j]);
            return Err(EquationError::KernelNotFinite { x, y: y[j], value });
        }
        if !matches!(change, Change::Identity { .. }) {
            values.iter_mut().zip(tau).for_each(|(value, tau)| *value = *value * change.slope(t + tau));
        }
        Ok(())
    }
}

/// The same for samples of any number, one after another.
pub(crate) struct Sampler<'k, T> {
    seen: Seen<'k, T>,
    y: Vec<f64>,
    offset: Vec<f64>,
}

impl<'k, T: Scalar> Sampler<'k, T> {
    pub(crate) fn new(kernel: &'k dyn LineKernel<T>, change: Change, t: f64) -> Self {
        Self { seen: Seen::new(kernel, change, t), y: Vec::new(), offset: Vec::new() }
    }

    /// `values[j]` = K(x(t), x(t + τ_j)) x′(t + τ_j).
    pub(crate) fn sample(&mut self, tau: &[f64], values: &mut [T]) -> Result<(), EquationError> {
        self.y.resize(tau.len(), 0.0);
        self.offset.resize(tau.len(), 0.0);
        self.seen.sample(tau, (&mut self.y, &mut self.offset), values)
    }
}

/// The double next to x on the side of the offset: there no kernel is singular.
fn beside(x: f64, offset: f64) -> f64 {
    if offset > 0.0 { x.next_up() } else { x.next_down() }
}

/// What was found on a panel besides its weights.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OnPanel {
    /// What was left out, of ∫ K g with |g| ≤ 1.
    pub(crate) error: f64,
    /// How often the panel was halved; 0 where its own nodes resolve K.
    pub(crate) depth: u32,
}

/// Builds a row panel by panel; all places are τ, seen from t.
pub(crate) struct RowBuilder<'k, T> {
    sampler: Sampler<'k, T>,
    diagonal: &'k Diagonal,
    depth: u32,
    spent: usize,
    tau: Vec<f64>,
    values: Vec<T>,
}

/// ∫ K g over a piece, for a g given at the nodes of [`COARSE`] there.
struct Part<T> {
    weights: [T; POINTS],
    error: f64,
}

impl<'k, T: Scalar> RowBuilder<'k, T> {
    pub(crate) fn new(kernel: &'k dyn LineKernel<T>, change: Change, diagonal: &'k Diagonal, t: f64) -> Self {
        let sampler = Sampler::new(kernel, change, t);
        Self { sampler, diagonal, depth: 0, spent: 0, tau: Vec::new(), values: Vec::new() }
    }

    /// Adds to `row` the weights of the panel from `low` to `high` at the nodes of `own`.
    pub(crate) fn panel(
        &mut self,
        (low, high): (f64, f64),
        own: &Reference,
        row: &mut [T],
    ) -> Result<OnPanel, EquationError> {
        let t = self.sampler.seen.t;
        let ends = (low - t, high - t);
        self.depth = 0;
        let error = match self.diagonal {
            Diagonal::Smooth => self.smooth(ends, own, row)?,
            _ if ends.0 > 0.0 || ends.1 < 0.0 => self.smooth(ends, own, row)?,
            _ => self.divided(ends, own, row)?,
        };
        Ok(OnPanel { error, depth: self.depth })
    }

    /// A panel without a break: as a whole if that resolves K, in halves otherwise.
    fn smooth(
        &mut self,
        (from, to): (f64, f64),
        own: &Reference,
        row: &mut [T],
    ) -> Result<f64, EquationError> {
        let length = to - from;
        let tail = self.sample(from, to, own)?;
        if self.is_resolved(tail, length) {
            let weights = self.values.iter().zip(&own.weights);
            row.iter_mut().zip(weights).for_each(|(entry, (k, w))| *entry += *k * (0.5 * length * w));
            return Ok(0.0);
        }
        let middle = 0.5 * (from + to);
        let left = self.halves((from, middle), f64::INFINITY, 1)?;
        let right = self.halves((middle, to), f64::INFINITY, 1)?;
        own.gather(&left.weights, &right.weights, row);
        Ok(left.error + right.error)
    }

    /// A panel with the diagonal in it or at its end, on one side and then the other.
    fn divided(
        &mut self,
        (from, to): (f64, f64),
        own: &Reference,
        row: &mut [T],
    ) -> Result<f64, EquationError> {
        let mut error = 0.0;
        for end in [from, to].into_iter().filter(|end| *end != 0.0) {
            self.depth = self.depth.max(1);
            let part = match self.diagonal {
                Diagonal::Singular(core) => self.singular(end, core, 0)?,
                _ => self.halves(ordered(0.0, end), f64::INFINITY, 1)?,
            };
            let (near, far) = ordered(0.0, end);
            for (xi, weight) in COARSE.nodes.iter().zip(&part.weights) {
                let tau = 0.5 * ((far + near) + (far - near) * xi);
                own.spread(((tau - from) - (to - tau)) / (to - from), *weight, row);
            }
            error += part.error;
        }
        Ok(error)
    }

    /// A part of a panel, halved until K is resolved on each piece.
    fn halves(&mut self, (from, to): (f64, f64), above: f64, depth: u32) -> Result<Part<T>, EquationError> {
        let length = to - from;
        let tail = self.sample(from, to, &COARSE)?;
        self.spent += self.tau.len();
        self.depth = self.depth.max(depth);
        let resolved = self.is_resolved(tail / PART, length);
        // Where halving does not help, it is noise that is left.
        let largest = self.largest();
        let noise = tail <= self.noise() || tail > 0.7 * above && tail <= 1e-12 * largest;
        if resolved || noise || depth >= DEPTH || self.spent > BUDGET {
            let mut weights = [T::ZERO; POINTS];
            let terms = self.values.iter().zip(&COARSE.weights);
            weights.iter_mut().zip(terms).for_each(|(weight, (k, w))| *weight = *k * (0.5 * length * w));
            let error = match (resolved, noise) {
                (true, _) => 0.0,
                (false, true) => length * tail,
                (false, false) => length * largest.min(10.0 * tail),
            };
            return Ok(Part { weights, error });
        }
        let middle = 0.5 * (from + to);
        let left = self.halves((from, middle), tail, depth + 1)?;
        let right = self.halves((middle, to), tail, depth + 1)?;
        Ok(joined(&left, &right))
    }

    /// From a singularity on the diagonal to τ = `end`: dyadic pieces, and τ = ±core · s^power for the last one, which
    /// makes of |τ|^(−α) dτ and of ln |τ| dτ something smooth in s.
    fn singular(&mut self, end: f64, core: &Core, depth: u32) -> Result<Part<T>, EquationError> {
        if depth >= core.levels() {
            let tail = self.sample_core(end, core.power)?;
            let rounding = self.rounding_of_core(core.power);
            let resolved = tail <= rounding || self.is_resolved(tail, 1.0);
            if resolved || depth >= DEPTH || self.spent > BUDGET {
                let error = rounding + if resolved { 0.0 } else { tail };
                return Ok(Part { weights: core.gather(&self.values, end < 0.0), error });
            }
        }
        let far = self.halves(ordered(0.5 * end, end), f64::INFINITY, 1)?;
        let near = self.singular(0.5 * end, core, depth + 1)?;
        Ok(if end > 0.0 { joined(&near, &far) } else { joined(&far, &near) })
    }

    /// Samples K at the rule's nodes; what is returned is large where they do not resolve it.
    fn sample(&mut self, from: f64, to: f64, rule: &Reference) -> Result<f64, EquationError> {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        self.tau.clear();
        self.tau.extend(rule.nodes.iter().map(|xi| middle + half * xi));
        // A peak on the diagonal that is much thinner than the piece is between its nodes, and so is a break close to an end.
        self.tau.extend(probes(from, to));
        self.values.resize(self.tau.len(), T::ZERO);
        self.sampler.sample(&self.tau, &mut self.values)?;
        let mut seen = [T::ZERO; 3];
        let count = self.values.len() - rule.len();
        seen[..count].copy_from_slice(&self.values[rule.len()..]);
        self.tau.truncate(rule.len());
        self.values.truncate(rule.len());
        let [left, right] = rule.at_ends(&self.values);
        let diagonal = if count == 3 { rule.interpolate(&self.values, -middle / half) } else { T::ZERO };
        let tail = rule.unresolved(&self.values);
        let largest = self.largest();
        let missed = seen.iter().zip([left, right, diagonal]).map(|(value, expected)| {
            let missed = (*value - expected).modulus();
            let explained = 1e3 * (tail + f64::EPSILON * largest.max(value.modulus()));
            if missed > explained { missed } else { 0.0 }
        });
        Ok(missed.fold(tail, f64::max))
    }

    /// Samples K dτ/ds at τ = core · s^power; the tail is that of K dτ/ds as a function of s.
    fn sample_core(&mut self, core: f64, power: i32) -> Result<f64, EquationError> {
        self.tau.clear();
        self.tau.extend(SINGULAR.nodes.iter().map(|xi| core * (0.5 * (1.0 + xi)).powi(power)));
        self.values.resize(SINGULAR.len(), T::ZERO);
        self.sampler.sample(&self.tau, &mut self.values)?;
        for (value, xi) in self.values.iter_mut().zip(&SINGULAR.nodes) {
            *value = *value * (0.5 * f64::from(power) * core.abs() * (0.5 * (1.0 + xi)).powi(power - 1));
        }
        Ok(SINGULAR.unresolved(&self.values))
    }

    /// What a kernel that is not told y − x makes of the rounding of y, which is x + τ: the closer to a singularity the more.
    fn rounding_of_core(&self, power: i32) -> f64 {
        if self.sampler.seen.kernel.takes_offset() {
            return 0.0;
        }
        let grain = self.grain();
        let steepest = 1.0 - 5.0 / f64::from(power);
        let terms = self.values.iter().zip(&SINGULAR.weights).zip(&self.sampler.offset);
        terms
            .map(|((k, w), offset)| {
                // d ln K / d ln u is the exponent, or 1 / ln u.
                let slope = steepest.max(1.0 / offset.abs().ln().abs().max(1.0));
                k.modulus() * w * slope * (grain / offset.abs()).min(1.0)
            })
            .sum()
    }

    /// What is lost of an offset, at most, by a kernel that computes it from x and y: half a unit in the last place of
    /// either; and as much again, because the errors of neighbours are not independent (3.6 times half a unit was seen).
    fn grain(&self) -> f64 {
        4.0 * f64::EPSILON * self.sampler.seen.x.abs()
    }

    /// What a kernel that is not told y − x has of rounding, on the piece that was sampled last: its slope times the grain.
    fn noise(&self) -> f64 {
        if self.sampler.seen.kernel.takes_offset() {
            return 0.0;
        }
        let neighbours = self.values.windows(2).zip(self.sampler.offset.windows(2));
        let slopes = neighbours.map(|(k, u)| (k[1] - k[0]).modulus() / (u[1] - u[0]).abs());
        self.grain() * slopes.fold(0.0, f64::max)
    }

    fn largest(&self) -> f64 {
        self.values.iter().map(|value| value.modulus()).fold(0.0, f64::max)
    }

    fn is_resolved(&self, tail: f64, length: f64) -> bool {
        tail * length <= NEGLIGIBLE || tail <= ROUNDING * self.largest()
    }
}

/// Two halves as one.
fn joined<T: Scalar>(left: &Part<T>, right: &Part<T>) -> Part<T> {
    let mut weights = [T::ZERO; POINTS];
    COARSE.gather(&left.weights, &right.weights, &mut weights);
    Part { weights, error: left.error + right.error }
}

/// Just inside either end of a piece, and beside the diagonal if it is within.
fn probes(from: f64, to: f64) -> impl Iterator<Item = f64> {
    let inside = PROBE * (to - from);
    let diagonal = (from < 0.0 && to > 0.0).then_some(inside);
    [from + inside, to - inside].into_iter().chain(diagonal)
}

fn ordered(a: f64, b: f64) -> (f64, f64) {
    if a < b { (a, b) } else { (b, a) }
}
