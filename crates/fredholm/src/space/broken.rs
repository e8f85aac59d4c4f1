//! The broken space P0: functions constant on each element, which owns its one coefficient (paper, §3.2.1).

use crate::quadrature::Quadrature;

/// Elements that cut the domain, each with a node and a rule to integrate over it.
#[derive(Clone, Debug)]
pub struct Space<P> {
    /// The elements, one coefficient each.
    pub elements: Vec<Element<P>>,
}

/// One element of a [`Space`].
#[derive(Clone, Debug)]
pub struct Element<P> {
    /// Where a function is interpolated: the centroid.
    pub node: P,
    /// A rule on the element; its weights add up to the element's measure.
    pub quadrature: Quadrature<P>,
}

impl Space<f64> {
    /// `n` equal intervals that cut [a, b], each with the `points`-point Gauss–Legendre rule.
    pub fn on_interval(a: f64, b: f64, n: usize, points: usize) -> Self {
        let edge = |k: usize| a + (b - a) * k as f64 / n as f64;
        let element = |k: usize| Element {
            node: 0.5 * (edge(k) + edge(k + 1)),
            quadrature: crate::quadrature::gauss_legendre(points, edge(k), edge(k + 1)),
        };
        Self { elements: (0..n).map(element).collect() }
    }
}
