//! Σ_k w(x_k) w_k g(x_k) for ∫ g w: a weight on a rule so fine that its recurrence is that of the weight (Stieltjes, 1884).

use super::double_exponential::Interval;
use super::orthogonal::Recurrence;
use super::{Quadrature, QuadratureError};

/// The finest step is 2^-14, some 200 000 nodes: a weight without a jump or pole inside needs a thousandth of them.
const FINEST: usize = 1 << 14;

/// A change between two refinements that counts as rounding: the sums have thousands of terms.
const SETTLED: f64 = 1e-13;

/// The recurrence of `weight` on (a, b), with the step halved until it stands.
pub(super) fn discretized(
    n: usize,
    weight: impl Fn(f64) -> f64,
    a: f64,
    b: f64,
) -> Result<Recurrence, QuadratureError> {
    let interval = Interval::new(a, b)?;
    // A polynomial of degree 2n turns n times: start with some nodes for each turn.
    let mut per_unit = (n / 4).next_power_of_two().clamp(8, FINEST / 2);
    let mut coarse = sampled(interval, &weight, per_unit).map(|rule| Recurrence::of_rule(n, &rule))?;
    loop {
        per_unit *= 2;
        let rule = sampled(interval, &weight, per_unit)?;
        let fine = Recurrence::of_rule(n, &rule);
        let change = distance(&coarse, &fine).max(left_out(&rule, fine.mass));
        if change <= SETTLED {
            return Ok(fine);
        }
        if per_unit >= FINEST {
            return Err(QuadratureError::Moments { change, nodes: rule.nodes.len() });
        }
        coarse = fine;
    }
}

/// The rule with the weight in its weights, without nodes that weigh nothing.
fn sampled(
    interval: Interval,
    weight: &impl Fn(f64) -> f64,
    per_unit: usize,
) -> Result<Quadrature<f64>, QuadratureError> {
    let rule = interval.rule(per_unit);
    let mut sampled = Quadrature { nodes: Vec::new(), weights: Vec::new() };
    for (at, w) in rule.nodes.into_iter().zip(rule.weights) {
        let value = weight(at);
        if !value.is_finite() {
            return Err(QuadratureError::NotFinite { what: "weight", at, value });
        }
        if value < 0.0 {
            return Err(QuadratureError::Weight { at, value });
        }
        if value * w > 0.0 {
            sampled.nodes.push(at);
            sampled.weights.push(value * w);
        }
    }
    match sampled.nodes.first() {
        Some(_) => Ok(sampled),
        None => Err(QuadratureError::Weight { at: 0.0, value: 0.0 }),
    }
}

/// What the outermost nodes weigh: about what is left out beyond them, in parts of the whole, beyond rounding.
fn left_out(rule: &Quadrature<f64>, mass: f64) -> f64 {
    let ends = [rule.weights.first(), rule.weights.last()];
    let most = ends.into_iter().flatten().fold(0.0, |most: f64, w| most.max(*w));
    most / mass
}

/// The largest relative difference; λ is measured by the spread that μ gives.
fn distance(one: &Recurrence, other: &Recurrence) -> f64 {
    let spread = other.beside.iter().fold(0.0, |most: f64, b| most.max(*b)).sqrt();
    let size = other.diagonal.iter().fold(spread, |most: f64, d| most.max(d.abs()));
    let pairs = |a: &[f64], b: &[f64], size: f64| {
        a.iter().zip(b).map(|(a, b)| (a - b).abs() / size).fold(0.0, f64::max)
    };
    if one.degree() != other.degree() || one.mass.is_nan() || other.mass.is_nan() {
        return f64::INFINITY;
    }
    let mass = (one.mass / other.mass - 1.0).abs();
    mass.max(pairs(&one.diagonal, &other.diagonal, size)).max(pairs(&one.beside, &other.beside, size * size))
}
