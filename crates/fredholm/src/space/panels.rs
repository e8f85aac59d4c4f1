//! φ(x) = Σ_j φ(x_j) u_j(x) on panels of degree 15 cut until that is true to rounding: a function that can be integrated.

use super::Basis;
use super::piecewise::piece;
use crate::equation::{Function, Scalar};
use crate::product::{COARSE, POINTS};
use rayon::prelude::*;

/// Nodes of a panel: polynomials of degree 15, which is what [`crate::product::Product::row`] integrates to rounding.
pub(crate) const PER_PANEL: usize = POINTS;

/// Polynomials of degree 15 on each panel, which owns its coefficients, with Gauss's nodes.
#[derive(Clone, Debug)]
pub(crate) struct Panels {
    nodes: Vec<f64>,
    breaks: Vec<f64>,
}

impl Panels {
    pub fn new(breaks: Vec<f64>) -> Self {
        let nodes = breaks.windows(2).flat_map(|edge| mapped(edge[0], edge[1])).collect();
        Self { nodes, breaks }
    }
}

fn mapped(a: f64, b: f64) -> Vec<f64> {
    COARSE.nodes.iter().map(|t| 0.5 * (a + b) + 0.5 * (b - a) * t).collect()
}

impl Basis for Panels {
    fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    fn values(&self, x: f64, values: &mut Vec<f64>) -> usize {
        let panel = piece(&self.breaks, x);
        let (a, b) = (self.breaks[panel], self.breaks[panel + 1]);
        values.clear();
        values.resize(PER_PANEL, 0.0);
        COARSE.spread(((x - a) - (b - x)) / (b - a), 1.0, values);
        panel * PER_PANEL
    }
}

/// A function known by its values on panels that resolve it.
#[derive(Clone, Debug)]
pub(crate) struct Resolved<T> {
    pub panels: Panels,
    /// At the panels' nodes, component by component.
    pub values: Vec<T>,
    /// How far interpolation is from the function, weighted by the lengths of the panels.
    pub defect: f64,
    /// The largest modulus met.
    pub scale: f64,
}

impl<T> Resolved<T> {
    pub fn breaks(&self) -> &[f64] {
        &self.panels.breaks
    }
}

/// Where interpolation is compared with the function, between the nodes: near the ends of a panel, where a singular
/// function shows first, and inside.
const PROBES: [f64; 4] = [-0.9992, -0.3, 0.1, 0.9991];

/// A panel is resolved when interpolation errs by no more than this part of the function's size.
const RESOLVED: f64 = 1e-14;

struct Panel<T> {
    edges: (f64, f64),
    values: Vec<Vec<T>>,
    defect: f64,
    scale: f64,
}

/// Cuts the panels between `breaks` in halves until they resolve the function, or `more` have been added.
pub(crate) fn resolve<T: Scalar>(
    function: &Function<'_, f64, T>,
    breaks: &[f64],
    more: usize,
) -> Resolved<T> {
    let length = breaks[breaks.len() - 1] - breaks[0];
    let most = breaks.len() - 1 + more;
    let mut pending: Vec<(f64, f64)> = breaks.windows(2).map(|edge| (edge[0], edge[1])).collect();
    let (mut done, mut scale) = (Vec::new(), 0.0_f64);
    while !pending.is_empty() {
        let level: Vec<_> = pending.par_iter().map(|edges| sample(function, *edges)).collect();
        scale = level.iter().fold(scale, |scale, panel| scale.max(panel.scale));
        // NaN is neither resolved nor worth cutting: it stays, and the residual tells.
        let fine = |panel: &Panel<T>| {
            let share = (panel.edges.1 - panel.edges.0) / length;
            !(panel.defect > RESOLVED * scale && panel.defect * share > 0.1 * RESOLVED * scale)
        };
        let (mut good, bad): (Vec<_>, Vec<_>) = level.into_iter().partition(fine);
        done.append(&mut good);
        pending.clear();
        if done.len() + 2 * bad.len() > most {
            done.extend(bad);
        } else {
            pending.extend(bad.iter().flat_map(|panel| halves(panel.edges)));
        }
    }
    assembled(done, function.components(), scale)
}

fn halves((a, b): (f64, f64)) -> [(f64, f64); 2] {
    let middle = 0.5 * (a + b);
    [(a, middle), (middle, b)]
}

fn sample<T: Scalar>(function: &Function<'_, f64, T>, edges: (f64, f64)) -> Panel<T> {
    let (a, b) = edges;
    let nodes = mapped(a, b);
    let components = 0..function.components();
    let values: Vec<Vec<T>> =
        components.map(|c| nodes.iter().map(|x| function.component(c, x)).collect()).collect();
    let scale = values.iter().flatten().map(|value| value.modulus()).fold(0.0, f64::max);
    let mut defect = 0.0_f64;
    for t in PROBES {
        let x = 0.5 * (a + b) + 0.5 * (b - a) * t;
        for (c, values) in values.iter().enumerate() {
            defect = defect.max((COARSE.interpolate(values, t) - function.component(c, &x)).modulus());
        }
    }
    Panel { edges, values, defect, scale }
}

fn assembled<T: Scalar>(mut panels: Vec<Panel<T>>, components: usize, scale: f64) -> Resolved<T> {
    panels.sort_by(|p, q| p.edges.0.total_cmp(&q.edges.0));
    let mut breaks: Vec<f64> = panels.iter().map(|panel| panel.edges.0).collect();
    breaks.extend(panels.last().map(|panel| panel.edges.1));
    let length = breaks[breaks.len() - 1] - breaks[0];
    let share = |panel: &Panel<T>| (panel.edges.1 - panel.edges.0) / length;
    let defect = panels.iter().map(|panel| panel.defect * share(panel)).sum();
    let values =
        (0..components).flat_map(|c| panels.iter().flat_map(move |panel| panel.values[c].iter().copied()));
    Resolved { values: values.collect(), panels: Panels::new(breaks), defect, scale }
}
