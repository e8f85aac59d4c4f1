//! Elements: parts of charts with 16 × 16 nodes each, cut where φ is not resolved.

use super::chart::{Chart, charts};
use crate::plane::Domain;
use crate::product::{COARSE, POINTS};

type Point = [f64; 2];

/// The nodes of an element.
pub(super) const NODES: usize = POINTS * POINTS;

/// [u, u′] × [v, v′] of a chart.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    pub(super) u: [f64; 2],
    pub(super) v: [f64; 2],
}

impl Cell {
    /// The point at −1 ≤ ξ, η ≤ 1.
    pub(super) fn at(&self, [xi, eta]: Point) -> Point {
        [along(self.u, xi), along(self.v, eta)]
    }

    /// (ξ, η) of a point.
    pub(super) fn local(&self, [u, v]: Point) -> Point {
        [part(self.u, u), part(self.v, v)]
    }

    pub(super) fn contains(&self, [u, v]: Point) -> bool {
        (self.u[0]..=self.u[1]).contains(&u) && (self.v[0]..=self.v[1]).contains(&v)
    }

    /// A quarter of its area in (u, v): dudv = that times dξ dη.
    pub(super) fn quarter(&self) -> f64 {
        0.25 * (self.u[1] - self.u[0]) * (self.v[1] - self.v[0])
    }

    /// Its halves along u, along v, its quarters, or itself.
    pub(super) fn cut(&self, along: [bool; 2]) -> Vec<Self> {
        let halves = |[low, high]: [f64; 2], cut: bool| {
            let middle = 0.5 * (low + high);
            if cut { vec![[low, middle], [middle, high]] } else { vec![[low, high]] }
        };
        let vs = halves(self.v, along[1]);
        halves(self.u, along[0]).into_iter().flat_map(|u| vs.iter().map(move |v| Self { u, v: *v })).collect()
    }
}

fn along([low, high]: [f64; 2], xi: f64) -> f64 {
    0.5 * ((high + low) + (high - low) * xi)
}

fn part([low, high]: [f64; 2], u: f64) -> f64 {
    ((u - low) - (high - u)) / (high - low)
}

/// A part of a chart.
#[derive(Clone, Copy, Debug)]
pub(super) struct Element {
    pub(super) chart: usize,
    pub(super) cell: Cell,
}

/// The elements of a domain; the unknowns are numbered in their order, node (k, l) of an element being its 16 k + l.
#[derive(Clone, Debug)]
pub(super) struct Elements {
    pub(super) charts: Vec<Chart>,
    pub(super) all: Vec<Element>,
}

impl Elements {
    /// One to a chart, graded for a kernel like |p − q|^exponent.
    pub(super) fn new(domain: Domain, exponent: f64) -> Self {
        let charts = charts(domain, exponent);
        let cell = Cell { u: [0.0, 1.0], v: [0.0, 1.0] };
        let all = (0..charts.len()).map(|chart| Element { chart, cell }).collect();
        Self { charts, all }
    }

    pub(super) fn unknowns(&self) -> usize {
        NODES * self.all.len()
    }

    pub(super) fn chart(&self, element: &Element) -> &Chart {
        &self.charts[element.chart]
    }

    /// q_j.
    pub(super) fn nodes(&self) -> Vec<Point> {
        let of = |element: &Element| {
            places().map(|(at, _)| self.chart(element).point(element.cell.at(at))).collect()
        };
        self.all.iter().flat_map::<Vec<_>, _>(of).collect()
    }

    /// w_j of ∫ g ≈ Σ_j w_j g(q_j).
    pub(super) fn weights(&self) -> Vec<f64> {
        let of = |element: &Element| {
            let weight = |(at, w)| w * element.cell.quarter() * self.chart(element).area(element.cell.at(at));
            places().map(weight).collect()
        };
        self.all.iter().flat_map::<Vec<_>, _>(of).collect()
    }

    /// Where a point is: an element and (u, v).
    pub(super) fn locate(&self, p: Point) -> Option<(usize, Point)> {
        let in_chart = |(chart, map): (usize, &Chart)| {
            let uv = map.locate(p)?;
            let here = |element: &Element| element.chart == chart && element.cell.contains(uv);
            Some((self.all.iter().position(here)?, uv))
        };
        self.charts.iter().enumerate().find_map(in_chart)
    }

    /// The elements cut, each as it is said.
    pub(super) fn cut(&self, along: impl Fn(usize) -> [bool; 2]) -> Self {
        let parts = |(k, element): (usize, &Element)| {
            let chart = element.chart;
            element.cell.cut(along(k)).into_iter().map(move |cell| Element { chart, cell })
        };
        Self { charts: self.charts.clone(), all: self.all.iter().enumerate().flat_map(parts).collect() }
    }
}

/// (ξ_k, ξ_l) and w_k w_l, in the order of the nodes.
pub(super) fn places() -> impl Iterator<Item = (Point, f64)> {
    let pairs = || COARSE.nodes.iter().zip(&COARSE.weights);
    pairs().flat_map(move |(xi, v)| pairs().map(move |(eta, w)| ([*xi, *eta], v * w)))
}
