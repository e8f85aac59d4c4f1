//! Polynomials of degree < n on [a, b], by their values at Chebyshev's or Gauss's nodes (paper, §1.3.2).

use super::Basis;
use super::barycentric::Barycentric;
use std::f64::consts::PI;

/// The polynomials of degree < n.
#[derive(Clone, Debug)]
pub struct Polynomial {
    reference: Barycentric,
    middle: f64,
    half: f64,
    nodes: Vec<f64>,
    breaks: Vec<f64>,
}

impl Polynomial {
    /// Dimension n on [a, b], interpolated at the roots of Chebyshev's polynomial T_n.
    pub fn chebyshev(a: f64, b: f64, n: usize) -> Self {
        Self::new(a, b, Barycentric::chebyshev(n))
    }

    /// Dimension n on [a, b], interpolated at the nodes of Gauss's rule: an orthogonal basis, ⟨u_i, u_j⟩ = λ_j δ_ij.
    pub fn legendre(a: f64, b: f64, n: usize) -> Self {
        Self::new(a, b, Barycentric::legendre(n))
    }

    fn new(a: f64, b: f64, reference: Barycentric) -> Self {
        let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
        let nodes = reference.nodes.iter().map(|t| middle + half * t).collect();
        let pieces = pieces(reference.nodes.len());
        let edge = |k: usize| match k {
            0 => a,
            k if k == pieces => b,
            k => middle - half * (PI * k as f64 / pieces as f64).cos(),
        };
        Self { nodes, breaks: (0..=pieces).map(edge).collect(), reference, middle, half }
    }
}

/// How many pieces, equal in the angle θ of x = cos θ, make cos nθ a polynomial of degree 15 on each, to rounding.
///
/// On a piece nθ varies by ±c, c = nπ/(2 pieces), and the Chebyshev coefficients of cos(ct) fall like (c/2)^k/k!: at k = 16
/// they are 5e-14 for c = 2 and 5e-16 for c = 3/2.
fn pieces(n: usize) -> usize {
    if n <= 16 { 1 } else { (n as f64 * PI / 3.0).ceil() as usize }
}

impl Basis for Polynomial {
    fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    fn values(&self, x: f64, values: &mut Vec<f64>) -> usize {
        // At a node the interpolated value is returned as it is, whatever the rounding of the change of variable.
        match self.nodes.iter().position(|node| *node == x) {
            Some(node) => self.reference.values(self.reference.nodes[node], values),
            None => self.reference.values((x - self.middle) / self.half, values),
        }
        0
    }
}
