//! p_n = (x − λ_n) p_{n−1} − μ_n p_{n−2}: the orthogonal polynomials of any weight (paper, §4.3.1, (4.14)–(4.16)).

use super::{Quadrature, QuadratureError};
use crate::quadrature::discretized::discretized;
use std::f64::consts::PI;

/// The recurrence of the monic polynomials p_0 … p_n that are orthogonal for a weight, ∫ p_i p_j w = 0.
///
/// Entry k of the vectors belongs to p_{k+1}, whose λ and μ the paper calls λ_{k+1}, μ_{k+1}.
#[derive(Clone, Debug, PartialEq)]
pub struct Recurrence {
    /// λ: ⟨x p, p⟩/‖p‖² (4.15), one for each polynomial from p_1 on.
    pub diagonal: Vec<f64>,
    /// μ: ‖p_{k}‖²/‖p_{k−1}‖² (4.16), as many; the first, which multiplies nothing, is 0.
    pub beside: Vec<f64>,
    /// ∫ w, the square of ‖p_0‖.
    pub mass: f64,
}

impl Recurrence {
    fn new(n: usize, mass: f64, diagonal: impl Fn(f64) -> f64, beside: impl Fn(f64) -> f64) -> Self {
        Self {
            diagonal: (0..n).map(|k| diagonal(k as f64)).collect(),
            beside: (0..n).map(|k| if k == 0 { 0.0 } else { beside(k as f64) }).collect(),
            mass,
        }
    }

    /// Up to the `n`-th Legendre polynomial: the weight 1 on [−1, 1].
    pub fn legendre(n: usize) -> Self {
        Self::new(n, 2.0, |_| 0.0, |k| k * k / (4.0 * k * k - 1.0))
    }

    /// Chebyshev's polynomials T: the weight 1/√(1 − x²).
    pub fn chebyshev_1(n: usize) -> Self {
        Self::new(n, PI, |_| 0.0, |k| if k == 1.0 { 0.5 } else { 0.25 })
    }

    /// Chebyshev's polynomials U: the weight √(1 − x²).
    pub fn chebyshev_2(n: usize) -> Self {
        Self::new(n, 0.5 * PI, |_| 0.0, |_| 0.25)
    }

    /// Jacobi's polynomials: the weight (1 − x)^α (1 + x)^β on [−1, 1], α and β above −1.
    pub fn jacobi(n: usize, alpha: f64, beta: f64) -> Self {
        let sum = alpha + beta;
        let diagonal = |k: f64| match k {
            0.0 => (beta - alpha) / (sum + 2.0),
            _ => (beta - alpha) * sum / ((2.0 * k + sum) * (2.0 * k + sum + 2.0)),
        };
        let beside = |k: f64| {
            let s = 2.0 * k + sum;
            // For k = 1 the factor k + α + β cancels, which is 0/0 when α + β = −1.
            let ratio = if k == 1.0 { 1.0 / (s + 1.0) } else { (k + sum) / ((s + 1.0) * (s - 1.0)) };
            4.0 * k * (k + alpha) * (k + beta) * ratio / (s * s)
        };
        let gamma = libm::lgamma;
        let mass = match alpha.max(beta) < 50.0 {
            true => {
                libm::tgamma(alpha + 1.0) * libm::tgamma(beta + 1.0) / libm::tgamma(sum + 2.0)
                    * (sum + 1.0).exp2()
            }
            false => {
                (gamma(alpha + 1.0) + gamma(beta + 1.0) - gamma(sum + 2.0) + (sum + 1.0) * 2_f64.ln()).exp()
            }
        };
        Self::new(n, mass, diagonal, beside)
    }

    /// Laguerre's polynomials: the weight x^α e^{−x} on [0, ∞), α above −1.
    pub fn laguerre(n: usize, alpha: f64) -> Self {
        Self::new(n, libm::tgamma(alpha + 1.0), |k| 2.0 * k + alpha + 1.0, |k| k * (k + alpha))
    }

    /// Hermite's polynomials: the weight e^{−x²} on the real line.
    pub fn hermite(n: usize) -> Self {
        Self::new(n, PI.sqrt(), |_| 0.0, |k| 0.5 * k)
    }

    /// A weight of one's own on [a, b], where a may be −∞ and b ∞: Stieltjes' procedure on a double exponential rule that
    /// is refined until the recurrence stands to rounding. The weight may be singular at the ends, best where they are 0:
    /// next to 1 the numbers are 1e-16 apart, which leaves out 1e-8 of the mass of 1/√(1 − x).
    ///
    /// # Errors
    ///
    /// When the weight is negative or not finite somewhere inside, zero everywhere, or not to be integrated to rounding.
    pub fn of_weight(n: usize, weight: impl Fn(f64) -> f64, a: f64, b: f64) -> Result<Self, QuadratureError> {
        discretized(n, weight, a, b)
    }

    /// The polynomials orthogonal for Σ_k w_k g(x_k), a fine rule with weights that are positive or zero: Stieltjes'
    /// procedure (4.15), (4.16). There are at most as many as nodes; more are not asked for than `n`.
    pub fn of_rule(n: usize, rule: &Quadrature<f64>) -> Self {
        let mass: f64 = rule.weights.iter().sum();
        let n = n.min(rule.nodes.len());
        let mut recurrence = Self { diagonal: Vec::with_capacity(n), beside: Vec::with_capacity(n), mass };
        // √w p/‖p‖ instead of p: neither over- nor underflows.
        let mut p: Vec<f64> = rule.weights.iter().map(|w| (w / mass).sqrt()).collect();
        let mut before = vec![0.0; p.len()];
        let mut beside: f64 = 0.0;
        for _ in 0..n {
            let diagonal: f64 = p.iter().zip(&rule.nodes).map(|(p, x)| p * p * x).sum();
            recurrence.diagonal.push(diagonal);
            recurrence.beside.push(beside * beside);
            let next: Vec<f64> =
                (0..p.len()).map(|k| (rule.nodes[k] - diagonal) * p[k] - beside * before[k]).collect();
            beside = next.iter().map(|p| p * p).sum::<f64>().sqrt();
            before = std::mem::replace(&mut p, next.iter().map(|p| p / beside).collect());
        }
        recurrence
    }

    /// How many polynomials there are after p_0.
    pub fn degree(&self) -> usize {
        self.diagonal.len()
    }

    /// The monic polynomials p_0(x) … p_n(x) by (4.14).
    pub fn monic(&self, x: f64) -> Vec<f64> {
        let mut values = vec![1.0];
        let mut before = 0.0;
        for (diagonal, beside) in self.diagonal.iter().zip(&self.beside) {
            let p = values[values.len() - 1];
            values.push((x - diagonal) * p - beside * before);
            before = p;
        }
        values
    }

    /// The orthonormal polynomials p_0(x)/‖p_0‖ … p_{n−1}(x)/‖p_{n−1}‖, times `factor`: a small factor keeps them numbers
    /// where they would overflow.
    pub fn orthonormal(&self, x: f64, factor: f64) -> Vec<f64> {
        let mut values = Vec::with_capacity(self.degree());
        let (mut before, mut p) = (0.0, factor / self.mass.sqrt());
        for k in 0..self.degree() {
            values.push(p);
            let next = self.beside.get(k + 1).map_or(1.0, |beside| beside.sqrt());
            (before, p) = (p, ((x - self.diagonal[k]) * p - self.beside[k].sqrt() * before) / next);
        }
        values
    }
}
