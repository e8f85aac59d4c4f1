//! ∫_a^b f to a tolerance: the panel with the largest error is halved, again and again; panels at a singularity are
//! integrated double exponentially, and infinite ends are brought to 0 by x = 1/v.

use super::double_exponential::Interval;
use super::kronrod::gauss_kronrod;
use super::{Integral, IntegrateError, Quadrature, QuadratureError};
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::sync::OnceLock;

/// How exactly to integrate, and how long to try.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adaptive {
    /// The error that is allowed, as such.
    pub absolute: f64,
    /// The error that is allowed, in parts of the integral; the larger of the two counts.
    pub relative: f64,
    /// The most evaluations of f.
    pub evaluations: usize,
}

impl Default for Adaptive {
    /// Close to rounding: 1e-13 of the integral, in at most a million evaluations.
    fn default() -> Self {
        Self { absolute: 0.0, relative: 1e-13, evaluations: 1_000_000 }
    }
}

/// Errors of this many roundings of ∫|f| are as good as none: what nobody can compute is not waited for.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// A panel halved this often since the beginning sits at a singularity, or at a peak that six halvings more resolve.
const DEEP: u32 = 6;

/// A panel halved this often is as small as rounding; what its error is then, it remains.
const DEEPEST: u32 = 64;

/// ∫_a^b f to 1e-13, by [`Adaptive`]; a and b may be infinite.
///
/// # Errors
///
/// As [`Adaptive::integrate`].
pub fn integrate(f: impl FnMut(f64) -> f64, a: f64, b: f64) -> Result<Integral, IntegrateError> {
    Adaptive::default().integrate(f, a, b)
}

impl Adaptive {
    /// ∫_a^b f; a and b may be infinite, and b below a. Singularities at a and b are integrated as what they are, best when
    /// they are at 0; one inside should be made an end. A peak that no node meets is not seen.
    ///
    /// # Errors
    ///
    /// When f is not a finite number at a node, and when the tolerance is not met: the best value comes with the error.
    pub fn integrate(&self, f: impl FnMut(f64) -> f64, a: f64, b: f64) -> Result<Integral, IntegrateError> {
        if a == b {
            return Ok(Integral { value: 0.0, error: 0.0, evaluations: 0 });
        }
        if b < a {
            let Integral { value, error, evaluations } = self.integrate(f, b, a)?;
            return Ok(Integral { value: -value, error, evaluations });
        }
        let pieces = pieces(Interval::new(a, b)?);
        Search { f: Counted { f, evaluations: 0 }, panels: BinaryHeap::new(), settled: Vec::new() }
            .run(self, &pieces)
    }
}

/// Where x comes from: v itself, or end + sign/v, which puts infinity at v = 0.
#[derive(Clone, Copy, Debug)]
enum Variable {
    Plain,
    Reciprocal(f64, f64),
}

type Piece = (Variable, f64, f64);

fn pieces(interval: Interval) -> Vec<Piece> {
    use Variable::{Plain, Reciprocal};
    match interval {
        // Two, so that a kink in the middle is met.
        Interval::Finite(a, b) => vec![(Plain, a, 0.5 * a + 0.5 * b), (Plain, 0.5 * a + 0.5 * b, b)],
        Interval::Half(a, sign) => {
            let near = if sign > 0.0 { (Plain, a, a + 1.0) } else { (Plain, a - 1.0, a) };
            vec![near, (Reciprocal(a, sign), 0.0, 1.0)]
        }
        Interval::Line => vec![
            (Reciprocal(0.0, -1.0), 0.0, 1.0),
            (Plain, -1.0, 0.0),
            (Plain, 0.0, 1.0),
            (Reciprocal(0.0, 1.0), 0.0, 1.0),
        ],
    }
}

/// The integrand, counting.
struct Counted<F> {
    f: F,
    evaluations: usize,
}

impl<F: FnMut(f64) -> f64> Counted<F> {
    /// f(x) dx/dv at v.
    fn at(&mut self, variable: Variable, v: f64) -> Result<f64, QuadratureError> {
        let x = match variable {
            Variable::Plain => v,
            Variable::Reciprocal(end, sign) => end + sign / v,
        };
        self.evaluations += 1;
        match ((self.f)(x), variable) {
            // A function that has died away stays dead, and v² may be no number where v is.
            (0.0, _) => Ok(0.0),
            (value, Variable::Plain) if value.is_finite() => Ok(value),
            (value, Variable::Reciprocal(..)) if value.is_finite() => Ok(value / v / v),
            (value, _) => Err(QuadratureError::NotFinite { what: "integrand", at: x, value }),
        }
    }
}

/// A part of the interval, with its integral.
#[derive(Clone, Copy, Debug)]
struct Panel {
    variable: Variable,
    a: f64,
    b: f64,
    value: f64,
    error: f64,
    /// ∫ |f|.
    size: f64,
    depth: u32,
}

impl PartialEq for Panel {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}
impl Eq for Panel {}
impl PartialOrd for Panel {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Panel {
    fn cmp(&self, other: &Self) -> Ordering {
        self.error.total_cmp(&other.error)
    }
}

struct Search<F> {
    f: Counted<F>,
    /// Those that may be improved.
    panels: BinaryHeap<Panel>,
    /// Those that are as they are.
    settled: Vec<Panel>,
}

impl<F: FnMut(f64) -> f64> Search<F> {
    fn run(mut self, wanted: &Adaptive, pieces: &[Piece]) -> Result<Integral, IntegrateError> {
        for (variable, a, b) in pieces {
            let panel = self.kronrod(*variable, *a, *b, 0)?;
            self.panels.push(panel);
        }
        // The sums are made anew whenever the number of panels has grown by a quarter: in between they would only drift.
        let mut sums = self.sums();
        let mut renew = 0;
        loop {
            let goal = wanted.absolute.max(wanted.relative * sums.value.abs());
            if sums.error <= goal.max(ROUNDING * sums.size) {
                sums = self.sums();
                if sums.error <= goal.max(ROUNDING * sums.size) {
                    return Ok(sums.integral(self.f.evaluations));
                }
            }
            let worst = if self.spent(wanted, goal) { None } else { self.panels.pop() };
            let Some(worst) = worst else {
                let best = self.sums().integral(self.f.evaluations);
                return Err(IntegrateError::NotConverged { best, tolerance: goal });
            };
            sums.add(&worst, -1.0);
            for panel in self.improved(worst)? {
                sums.add(&panel, 1.0);
            }
            renew += 1;
            if renew > self.panels.len() / 4 {
                (sums, renew) = (self.sums(), 0);
            }
        }
    }

    /// Whether to give up: all evaluations are used, or what is settled with too large an error cannot be made good elsewhere.
    fn spent(&self, wanted: &Adaptive, goal: f64) -> bool {
        let lost: f64 = self.settled.iter().map(|panel| panel.error).sum();
        let left = self.panels.peek().map_or(0.0, |worst| worst.error);
        self.f.evaluations >= wanted.evaluations || (lost > goal && left < 1e-3 * lost)
    }

    /// Puts back what `worst` has become, and returns it.
    fn improved(&mut self, worst: Panel) -> Result<Vec<Panel>, QuadratureError> {
        let middle = 0.5 * worst.a + 0.5 * worst.b;
        if middle <= worst.a || middle >= worst.b || worst.depth == DEEPEST {
            self.settled.push(worst);
            return Ok(vec![worst]);
        }
        if worst.depth == DEEP {
            let again = self.double_exponential(&worst)?;
            if again.error < 1e-3 * worst.error {
                self.settled.push(again);
                return Ok(vec![again]);
            }
        }
        let halves = [
            self.kronrod(worst.variable, worst.a, middle, worst.depth + 1)?,
            self.kronrod(worst.variable, middle, worst.b, worst.depth + 1)?,
        ];
        self.panels.extend(halves);
        Ok(halves.to_vec())
    }

    /// Gauss's ten nodes and Kronrod's twenty-one.
    fn kronrod(&mut self, variable: Variable, a: f64, b: f64, depth: u32) -> Result<Panel, QuadratureError> {
        let rule = rules();
        let (middle, half) = (0.5 * a + 0.5 * b, 0.5 * b - 0.5 * a);
        let mut values = [0.0; 21];
        for (value, x) in values.iter_mut().zip(&rule.kronrod.nodes) {
            *value = self.f.at(variable, middle + half * x)?;
        }
        let weigh = |g: &dyn Fn(f64) -> f64| -> f64 {
            half * values.iter().zip(&rule.kronrod.weights).map(|(value, w)| w * g(*value)).sum::<f64>()
        };
        let value = weigh(&|value| value);
        let gauss = half * (0..10).map(|k| rule.gauss[k] * values[2 * k + 1]).sum::<f64>();
        let mean = value / (2.0 * half);
        let (size, spread) = (weigh(&f64::abs), weigh(&|value| (value - mean).abs()));
        let difference = (value - gauss).abs();
        // As in QUADPACK: Kronrod's value is better than the difference by what 3n + 1 is better than 2n − 1.
        let sharp = spread * (200.0 * difference / spread).powf(1.5).min(1.0);
        let error = if spread > 0.0 { sharp } else { difference };
        Ok(Panel { variable, a, b, value, error: error.max(2.0 * f64::EPSILON * size), size, depth })
    }

    /// The panel again, for a singularity at one of its ends.
    fn double_exponential(&mut self, panel: &Panel) -> Result<Panel, QuadratureError> {
        let interval = Interval::Finite(panel.a, panel.b);
        let mut before = f64::INFINITY;
        let mut best = *panel;
        for per_unit in [4, 8, 16, 32] {
            let rule = interval.rule(per_unit);
            let (mut value, mut size, mut ends) = (0.0, 0.0, [0.0; 2]);
            for (k, (v, w)) in rule.nodes.iter().zip(&rule.weights).enumerate() {
                let term = w * self.f.at(panel.variable, *v)?;
                (value, size) = (value + term, size + term.abs());
                ends = [if k == 0 { term.abs() } else { ends[0] }, term.abs()];
            }
            // What is beyond the last nodes weighs about as much as they, times the nodes in a unit of u.
            let beyond = (ends[0] + ends[1]) * per_unit as f64;
            let error = (value - before).abs() + beyond + 4.0 * f64::EPSILON * size;
            best = Panel { value, error, size, ..*panel };
            if (value - before).abs() <= 1e-15 * size || value.is_nan() {
                break;
            }
            before = value;
        }
        Ok(best)
    }

    fn sums(&self) -> Sums {
        let mut sums = Sums::default();
        self.panels.iter().chain(&self.settled).for_each(|panel| sums.add(panel, 1.0));
        sums
    }
}

/// Value, error and ∫|f| of all panels.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    value: f64,
    error: f64,
    size: f64,
}

impl Sums {
    fn add(&mut self, panel: &Panel, sign: f64) {
        self.value += sign * panel.value;
        self.error += sign * panel.error;
        self.size += sign * panel.size;
    }

    fn integral(self, evaluations: usize) -> Integral {
        Integral { value: self.value, error: self.error, evaluations }
    }
}

/// The two rules on [−1, 1].
struct Rules {
    kronrod: Quadrature<f64>,
    /// The weights of Gauss's nodes, which are every second one of Kronrod's.
    gauss: Vec<f64>,
}

fn rules() -> &'static Rules {
    static RULES: OnceLock<Rules> = OnceLock::new();
    RULES.get_or_init(|| Rules {
        kronrod: gauss_kronrod(10),
        gauss: super::gauss_legendre(10, -1.0, 1.0).weights,
    })
}
