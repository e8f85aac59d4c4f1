//! The λ of least θ(λ) = ¼ Σ_ij G_ij²/(A_i A_j) − Σ_i A_i λ_i, where ∂θ/∂λ_i = Σ_j G_ij − A_i: semismooth Newton.
//!
//! The second derivative is H x = Σ_j A_i A_j (x_i + x_j) over the pairs that are not held at 0: symmetric, not
//! negative, and near its diagonal where a face sees many others, so that conjugate gradients take a few steps.

use super::pairs::{Pair, Pairs, Sums};

/// A defect of the row sums that is as small as asked.
pub(super) const ENOUGH: f64 = 1e-12;

/// A defect at which to stop: below it rounding decides, of sums of 20 000 terms too.
const ROUNDING: f64 = 1e-13;

/// Newton's steps at most. It takes two where nothing is held at 0, and one or two more each time that this changes;
/// scenes that take more than ten have not been seen, except where no solution exists.
const STEPS: usize = 50;

/// Conjugate gradients end at this part of the residual, or after so many steps: fewer than a dozen in an enclosure,
/// and as many as there are faces in a chain of them.
const LINEAR: f64 = 1e-6;
const LINEAR_STEPS: usize = 1000;

/// Halvings of a step at most: a millionth of it is none.
const HALVINGS: usize = 20;

pub(super) struct Outcome {
    pub multipliers: Vec<f64>,
    /// |Σ_j F_ij − 1| of the rows that are whole.
    pub defects: Vec<f64>,
    pub steps: usize,
}

/// Where the search stands.
struct Point {
    multipliers: Vec<f64>,
    theta: f64,
    /// ∂θ/∂λ, 0 for the rows that are free.
    gradient: Vec<f64>,
    defect: f64,
}

/// The λ that make the rows that are `whole` add up to 1, or come as near to it as they can.
pub(super) fn multipliers(pairs: &Pairs<'_>, whole: &[bool]) -> Outcome {
    let mut at = Point::new(pairs, whole, vec![0.0; whole.len()]);
    let mut steps = 0;
    while at.defect > ROUNDING && steps < STEPS {
        let direction = newton_direction(pairs, whole, &at);
        let Some(next) = search(pairs, whole, &at, &direction) else { break };
        at = next;
        steps += 1;
    }
    let defects = at.gradient.iter().zip(pairs.areas()).map(|(gradient, area)| gradient.abs() / area);
    Outcome { defects: defects.collect(), multipliers: at.multipliers, steps }
}

impl Point {
    fn new(pairs: &Pairs<'_>, whole: &[bool], multipliers: Vec<f64>) -> Self {
        let Sums { rows, total } = pairs.sums(|pair| {
            let value = shifted(pair, &multipliers).max(0.0);
            let weight = if pair.i == pair.j { 0.25 } else { 0.5 };
            (value, weight * value * (value / pair.areas))
        });
        let areas = pairs.areas();
        let gradient: Vec<f64> =
            (0..whole.len()).map(|i| if whole[i] { rows[i] - areas[i] } else { 0.0 }).collect();
        let defect = gradient.iter().zip(areas).map(|(g, a)| g.abs() / a).fold(0.0, f64::max);
        let theta = total - dot(&multipliers, areas);
        Self { multipliers, theta, gradient, defect }
    }
}

/// G_ij before it is held at 0.
fn shifted(pair: &Pair, multipliers: &[f64]) -> f64 {
    pair.value + pair.areas * (multipliers[pair.i] + multipliers[pair.j])
}

/// The first of the whole, the half, the quarter … of a step that leads to less: less θ, or half the defect, which is
/// still told from rounding when θ no longer is.
fn search(pairs: &Pairs<'_>, whole: &[bool], at: &Point, direction: &[f64]) -> Option<Point> {
    let slope = dot(&at.gradient, direction);
    let step = |k: usize| 0.5_f64.powi(k as i32);
    (0..HALVINGS).map(step).find_map(|step| {
        let moved = at.multipliers.iter().zip(direction).map(|(x, d)| x + step * d).collect();
        let next = Point::new(pairs, whole, moved);
        let is_less = next.theta < at.theta + 1e-4 * step * slope && next.defect < LEAP * at.defect;
        (is_less || next.defect <= 0.5 * at.defect).then_some(next)
    })
}

/// A step on which the defect grows more than this is not trusted, whatever it does to θ.
const LEAP: f64 = 1e3;

/// H d = −gradient over the rows that are whole, by conjugate gradients with the diagonal as preconditioner.
fn newton_direction(pairs: &Pairs<'_>, whole: &[bool], at: &Point) -> Vec<f64> {
    let weight = |pair: &Pair| if shifted(pair, &at.multipliers) >= 0.0 { pair.areas } else { 0.0 };
    let only_whole = |mut rows: Vec<f64>| {
        rows.iter_mut().zip(whole).for_each(|(row, whole)| *row *= f64::from(u8::from(*whole)));
        rows
    };
    let hessian =
        |x: &[f64]| only_whole(pairs.sums(|pair| (weight(pair) * (x[pair.i] + x[pair.j]), 0.0)).rows);
    let diagonal = pairs.sums(|pair| (weight(pair), 0.0)).rows;
    let precondition = |r: &[f64]| -> Vec<f64> {
        // A row of which all is held at 0 has no slope of its own to go by.
        r.iter().zip(&diagonal).map(|(r, d)| if *d > 0.0 { r / d } else { 0.0 }).collect()
    };
    let mut solution = vec![0.0; whole.len()];
    let mut residual: Vec<f64> = at.gradient.iter().map(|g| -g).collect();
    let mut scaled = precondition(&residual);
    let mut direction = scaled.clone();
    let mut size = dot(&residual, &scaled);
    let target = LINEAR.powi(2) * size;
    for _ in 0..LINEAR_STEPS {
        let image = hessian(&direction);
        let curvature = dot(&direction, &image);
        if size <= target || curvature <= 0.0 {
            break;
        }
        let step = size / curvature;
        for k in 0..whole.len() {
            solution[k] += step * direction[k];
            residual[k] -= step * image[k];
        }
        scaled = precondition(&residual);
        let next = dot(&residual, &scaled);
        let turn = next / size;
        size = next;
        direction.iter_mut().zip(&scaled).for_each(|(d, s)| *d = s + turn * *d);
    }
    solution
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
