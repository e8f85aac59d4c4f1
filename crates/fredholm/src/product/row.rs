//! One row of the product rule: pieces of the interval on which K(x, ·) is resolved.

use super::change::Change;
use super::diagonal::Diagonal;
use super::reference::{COARSE, Reference, SINGULAR};
use crate::equation::{EquationError, LineKernel, Scalar};

/// What is left out of K on a piece may weigh this much, of ∫ K g with |g| ≤ 1: I − A is of size 1.
const NEGLIGIBLE: f64 = 1e-15;

/// Coefficients this small beside K itself are its rounding.
const ROUNDING: f64 = 4e-15;

/// On a part of a panel g needs fewer coefficients, and the rule has so many more for K.
const PART: f64 = 30.0;

/// Halvings of a panel; a jump is then within 2⁻⁵⁰ of the panel.
const DEPTH: u32 = 50;

/// Where a piece with the diagonal in it is looked at once more, as a part of its length. At the diagonal itself there may
/// be 0/0.
const PROBE: f64 = 1e-9;

/// A kernel as a function of t, seen from a fixed t.
pub(crate) struct Sampler<'k, T> {
    kernel: &'k dyn LineKernel<T>,
    change: Change,
    t: f64,
    x: f64,
    y: Vec<f64>,
    offset: Vec<f64>,
}

impl<'k, T: Scalar> Sampler<'k, T> {
    pub(crate) fn new(kernel: &'k dyn LineKernel<T>, change: Change, t: f64) -> Self {
        Self { kernel, change, t, x: change.point(t), y: Vec::new(), offset: Vec::new() }
    }

    /// `values[j]` = K(x(t), x(t + τ_j)) x′(t + τ_j).
    pub(crate) fn sample(&mut self, tau: &[f64], values: &mut [T]) -> Result<(), EquationError> {
        let Self { change, t, x, .. } = *self;
        self.y.clear();
        self.offset.clear();
        if let Change::Identity { .. } = change {
            self.y.extend(tau.iter().map(|tau| t + tau));
            self.offset.extend_from_slice(tau);
        } else {
            self.y.extend(tau.iter().map(|tau| change.point(t + tau)));
            self.offset.extend(tau.iter().map(|tau| change.offset(t, *tau)));
        }
        self.kernel.row(x, &self.y, &self.offset, values);
        if let Some(j) = values.iter().position(|value| !value.finite()) {
            let value = format!("{:?}", values[j]);
            return Err(EquationError::KernelNotFinite { x, y: self.y[j], value });
        }
        if !matches!(change, Change::Identity { .. }) {
            values.iter_mut().zip(tau).for_each(|(value, tau)| *value = *value * change.slope(t + tau));
        }
        Ok(())
    }
}

/// A piece of a panel with its nodes: `nodes[start..end]` of the row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    /// The panel it is of.
    pub(crate) panel: usize,
    /// Where its nodes begin.
    pub(crate) start: usize,
    /// Where its nodes end.
    pub(crate) end: usize,
    /// Whether it is the whole panel, with the panel's own nodes.
    pub(crate) whole: bool,
    /// What was left out of it, of ∫ K g with |g| ≤ 1.
    pub(crate) error: f64,
}

/// Builds a row piece by piece; all places are τ, seen from t.
pub(crate) struct RowBuilder<'k, T> {
    sampler: Sampler<'k, T>,
    diagonal: Diagonal,
    /// The nodes, as t + τ.
    pub(crate) nodes: Vec<f64>,
    /// The weights, with the kernel in them.
    pub(crate) weights: Vec<T>,
    /// The pieces, in the order of the panels.
    pub(crate) pieces: Vec<Piece>,
    /// The most halvings that a panel without a singularity needed.
    pub(crate) depth: u32,
    tau: Vec<f64>,
    values: Vec<T>,
}

impl<'k, T: Scalar> RowBuilder<'k, T> {
    pub(crate) fn new(kernel: &'k dyn LineKernel<T>, change: Change, diagonal: Diagonal, t: f64) -> Self {
        Self {
            sampler: Sampler::new(kernel, change, t),
            diagonal,
            nodes: Vec::new(),
            weights: Vec::new(),
            pieces: Vec::new(),
            depth: 0,
            tau: Vec::new(),
            values: Vec::new(),
        }
    }

    /// Adds the panel from `low` to `high`, whose own nodes are those of `own`.
    pub(crate) fn panel(
        &mut self,
        panel: usize,
        (low, high): (f64, f64),
        own: &Reference,
    ) -> Result<(), EquationError> {
        let t = self.sampler.t;
        let (from, to) = (low - t, high - t);
        match self.diagonal {
            Diagonal::Smooth => self.smooth(panel, (from, to), own),
            _ if from > 0.0 || to < 0.0 => self.smooth(panel, (from, to), own),
            Diagonal::Broken => {
                self.one_sided(panel, from)?;
                self.one_sided(panel, to)
            }
            Diagonal::Singular { power } => {
                self.towards_singularity(panel, from, power)?;
                self.towards_singularity(panel, to, power)
            }
        }
    }

    /// A panel without a break: as a whole if that resolves K, in halves otherwise.
    fn smooth(&mut self, panel: usize, (from, to): (f64, f64), own: &Reference) -> Result<(), EquationError> {
        let tail = self.sample(from, to, own)?;
        if self.is_resolved(tail, to - from) {
            self.keep(panel, to - from, own, true);
            return Ok(());
        }
        let middle = 0.5 * (from + to);
        self.halves(panel, (from, middle), f64::INFINITY, 1)?;
        self.halves(panel, (middle, to), f64::INFINITY, 1)
    }

    /// From the diagonal to τ = `end`, K being smooth on this side of it.
    fn one_sided(&mut self, panel: usize, end: f64) -> Result<(), EquationError> {
        if end == 0.0 { Ok(()) } else { self.halves(panel, ordered(0.0, end), f64::INFINITY, 0) }
    }

    /// A part of a panel, halved until K is resolved on each piece.
    fn halves(
        &mut self,
        panel: usize,
        (from, to): (f64, f64),
        above: f64,
        depth: u32,
    ) -> Result<(), EquationError> {
        let length = to - from;
        let tail = self.sample(from, to, &COARSE)?;
        self.depth = self.depth.max(depth);
        let resolved = self.is_resolved(tail / PART, length);
        // Where halving does not help, it is noise that is left.
        let noise = tail > 0.7 * above && tail <= 1e-12 * self.largest();
        if resolved || noise || depth >= DEPTH {
            self.keep(panel, length, &COARSE, false);
            self.left_out(match (resolved, noise) {
                (true, _) => 0.0,
                (false, true) => length * tail,
                (false, false) => length * self.largest(),
            });
            return Ok(());
        }
        let middle = 0.5 * (from + to);
        self.halves(panel, (from, middle), tail, depth + 1)?;
        self.halves(panel, (middle, to), tail, depth + 1)
    }

    /// From a singularity on the diagonal to τ = `end`: dyadic pieces, and τ = ±core · s^power for the last one, which
    /// makes of |τ|^(−α) dτ and of ln |τ| dτ something smooth in s.
    fn towards_singularity(&mut self, panel: usize, end: f64, power: i32) -> Result<(), EquationError> {
        if end == 0.0 {
            return Ok(());
        }
        // g is a polynomial in τ; in s its degree is `power` times as high, unless the core is small beside the panel.
        let levels = 2 + (power as u32).ilog2().saturating_sub(2);
        let mut core = end;
        for depth in 0..DEPTH {
            if depth >= levels {
                let tail = self.sample_core(core, power)?;
                let resolved = self.is_resolved(tail, 1.0);
                if resolved || depth + 1 == DEPTH {
                    let rounding = self.rounding_of_core();
                    self.keep_core(panel);
                    self.left_out(rounding + if resolved { 0.0 } else { tail });
                    return Ok(());
                }
            }
            self.halves(panel, ordered(0.5 * core, core), f64::INFINITY, 0)?;
            core *= 0.5;
        }
        Ok(())
    }

    /// Samples K at the rule's nodes; what is returned is large where they do not resolve it.
    fn sample(&mut self, from: f64, to: f64, rule: &Reference) -> Result<f64, EquationError> {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        self.tau.clear();
        self.tau.extend(rule.nodes.iter().map(|xi| middle + half * xi));
        // A peak on the diagonal that is much thinner than the piece is between its nodes.
        let probe = (from <= 0.0 && to >= 0.0).then_some(if to > 0.0 { PROBE * to } else { PROBE * from });
        self.tau.extend(probe);
        self.values.resize(self.tau.len(), T::ZERO);
        self.sampler.sample(&self.tau, &mut self.values)?;
        let seen = probe.map(|tau| (tau, self.values[rule.len()]));
        self.tau.truncate(rule.len());
        self.values.truncate(rule.len());
        let tail = rule.unresolved(&self.values);
        Ok(match seen {
            Some((tau, value)) => {
                let missed = (value - rule.interpolate(&self.values, (tau - middle) / half)).modulus();
                let explained = 1e3 * (tail + f64::EPSILON * self.largest().max(value.modulus()));
                if missed > explained { missed } else { tail }
            }
            None => tail,
        })
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
    fn rounding_of_core(&self) -> f64 {
        if self.sampler.kernel.takes_offset() {
            return 0.0;
        }
        let grain = 0.5 * f64::EPSILON * self.sampler.x.abs();
        let steepest = match self.diagonal {
            Diagonal::Singular { power } => 1.0 - 5.0 / f64::from(power),
            _ => 0.0,
        };
        let terms = self.values.iter().zip(&SINGULAR.weights).zip(&self.sampler.offset);
        terms
            .map(|((k, w), offset)| {
                // d ln K / d ln u is the exponent, or 1 / ln u.
                let slope = steepest.max(1.0 / offset.abs().ln().abs().max(1.0));
                k.modulus() * w * slope * (grain / offset.abs()).min(1.0)
            })
            .sum()
    }

    fn largest(&self) -> f64 {
        self.values.iter().map(|value| value.modulus()).fold(0.0, f64::max)
    }

    fn is_resolved(&self, tail: f64, length: f64) -> bool {
        tail * length <= NEGLIGIBLE || tail <= ROUNDING * self.largest()
    }

    fn keep(&mut self, panel: usize, length: f64, rule: &Reference, whole: bool) {
        self.weights.extend(self.values.iter().zip(&rule.weights).map(|(k, w)| *k * (0.5 * length * w)));
        self.keep_nodes(panel, whole);
    }

    fn keep_core(&mut self, panel: usize) {
        self.weights.extend(self.values.iter().zip(&SINGULAR.weights).map(|(k, w)| *k * *w));
        self.keep_nodes(panel, false);
    }

    fn keep_nodes(&mut self, panel: usize, whole: bool) {
        let start = self.nodes.len();
        let t = self.sampler.t;
        self.nodes.extend(self.tau.iter().map(|tau| t + tau));
        self.pieces.push(Piece { panel, start, end: self.nodes.len(), whole, error: 0.0 });
    }

    /// Says what the newest piece leaves out.
    fn left_out(&mut self, error: f64) {
        if let Some(piece) = self.pieces.last_mut() {
            piece.error = error;
        }
    }
}

fn ordered(a: f64, b: f64) -> (f64, f64) {
    if a < b { (a, b) } else { (b, a) }
}
