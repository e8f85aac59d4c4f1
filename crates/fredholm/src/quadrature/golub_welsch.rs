//! x_k = eigenvalues of the tridiagonal matrix of (4.14), w_k = 1/Σ_j p_j(x_k)²: Gauss's rule for any weight (§4.3.2).

use super::Quadrature;
use super::orthogonal::Recurrence;
use super::scaled::Scaled;
use super::tridiagonal::eigenvalues;
use std::array::from_fn;

/// Nodes worked on at once, as in [`super::end_form`].
const LANES: usize = 8;
const HUGE: f64 = 2.037_035_976_334_486e90;

impl Recurrence {
    /// Gauss's rule with as many nodes as there are polynomials after p_0, of order 2n − 1 for the recurrence's weight;
    /// nodes ascending.
    ///
    /// O(n²) operations. Eigenvalues as G. Golub and J. Welsch found them, then one step of Newton's method; weights by
    /// Christoffel's sum, so that small ones are as accurate as large ones. Weights below 1e-308 are 0. Where a weight is
    /// singular at an end that is not 0, the nodes there cannot say how near they are, and digits are lost with n;
    /// [`super::gauss_jacobi`] keeps them.
    pub fn gauss(&self) -> Quadrature<f64> {
        let n = self.degree();
        let beside: Vec<f64> = self.beside.iter().map(|beside| beside.sqrt()).collect();
        let (mut nodes, mut weights) = (Vec::with_capacity(n), Vec::with_capacity(n));
        for chunk in eigenvalues(&self.diagonal, &self.beside[1.min(n)..]).chunks(LANES) {
            let guess = from_fn(|k| chunk[k.min(chunk.len() - 1)]);
            let x = self.christoffel(&beside, &guess).map(|sum| sum.newton);
            let weight = self.christoffel(&beside, &x).map(|sum| sum.weight.over(0) * self.mass);
            nodes.extend_from_slice(&x[..chunk.len()]);
            weights.extend_from_slice(&weight[..chunk.len()]);
        }
        Quadrature { nodes, weights }
    }

    /// Σ_{j<n} p_j² with p_0 = 1, and Newton's step: by Christoffel and Darboux it is −p̃_n p_{n−1} / Σ, for the p̃_n
    /// that (4.14) makes of orthonormal ones.
    fn christoffel(&self, beside: &[f64], x: &[f64; LANES]) -> [Sum; LANES] {
        let (mut p, mut before, mut sum) = ([1.0; LANES], [0.0; LANES], [0.0_f64; LANES]);
        let mut exponent = [0; LANES];
        let n = self.degree();
        for j in 0..n {
            let next = if j + 1 < n { 1.0 / beside[j + 1] } else { 1.0 };
            for k in 0..LANES {
                sum[k] += p[k] * p[k];
                let after = ((x[k] - self.diagonal[j]) * p[k] - beside[j] * before[k]) * next;
                (before[k], p[k]) = (p[k], after);
            }
            for k in 0..LANES {
                if p[k].abs() > HUGE {
                    (p[k], before[k], exponent[k]) = (p[k] / HUGE, before[k] / HUGE, exponent[k] - 600);
                    sum[k] = sum[k] / HUGE / HUGE;
                }
            }
        }
        from_fn(|k| Sum {
            newton: x[k] - p[k] * before[k] / sum[k],
            weight: Scaled::new(1.0 / sum[k], exponent[k]),
        })
    }
}

struct Sum {
    newton: f64,
    weight: Scaled,
}
