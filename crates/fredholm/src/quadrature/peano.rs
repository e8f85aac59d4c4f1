//! K_N(t) = E(x ↦ (x − t)₊^N), E(f) = 1/N! ∫ K_N f^{(N+1)}: the order of a rule, its Peano kernel, its error constant
//! (paper, §4.1, definitions 4.1 and 4.2, (4.6), (4.7)).

use super::orthogonal::Recurrence;
use super::{Quadrature, QuadratureError, gauss_legendre};

/// A moment of p_k above (k + 16) times this, in parts of Σ|w_j| |p_k(x_j)|, is an error of the rule and not of the rounding
/// of its nodes, which the slope of p_k multiplies. Composite Simpson's with 1000 panels is told from a better rule.
const ROUNDING: f64 = 2e-15;

impl Recurrence {
    /// The order N of a rule for this recurrence's weight (definition 4.1): it integrates all polynomials of degree N, not
    /// all of degree N + 1. `None` if it does not even integrate constants, or as far as this recurrence goes.
    ///
    /// The test functions are the orthogonal polynomials, for which nothing cancels: on an interval, a Gauss rule of order 3999
    /// is told from one of order 4001. Where the error itself is rounding, an order too high is found, or none: for
    /// composite rules of a thousand panels, and for Gauss–Hermite and –Laguerre from 40 and 20 nodes on.
    pub fn order(&self, rule: &Quadrature<f64>) -> Option<usize> {
        let wrong = |(k, [defect, size]): (usize, &[f64; 2])| {
            defect.is_nan() || defect.abs() > ROUNDING * (k as f64 + 16.0) * size
        };
        self.defects(rule).iter().enumerate().position(wrong)?.checked_sub(1)
    }

    /// [E(p_k), Σ_j |w_j| |p_k(x_j)|] for the orthonormal p_k, the sum not below the bound √mass of ∫|p_k| w.
    fn defects(&self, rule: &Quadrature<f64>) -> Vec<[f64; 2]> {
        let mut defects = vec![[0.0, self.mass.sqrt()]; self.degree()];
        for (x, w) in rule.nodes.iter().zip(&rule.weights) {
            let root = w.abs().sqrt();
            for (sum, p) in defects.iter_mut().zip(self.orthonormal(*x, root)) {
                let term = w.signum() * root * p;
                *sum = [sum[0] - term, sum[1] + term.abs()];
            }
        }
        if let Some(constant) = defects.first_mut() {
            constant[0] += self.mass.sqrt();
        }
        defects
    }

    /// E(x^{N+1})/(N+1)! for a rule of order N: what (4.6) gives for f^{(N+1)} = 1. `None` as in [`Self::order`].
    pub fn error_constant(&self, rule: &Quadrature<f64>) -> Option<f64> {
        let order = self.order(rule)?;
        let [defect, _] = *self.defects(rule).get(order + 1)?;
        // x^{N+1} is ‖p‖ times the orthonormal p of that degree, and polynomials that the rule integrates.
        let norm = |k: usize| if k == 0 { self.mass } else { self.beside[k] };
        Some((0..=order + 1).fold(defect, |value, k| value * norm(k).sqrt() / (k as f64).max(1.0)))
    }
}

/// A rule on an interval, for the weight 1, with its order and its Peano kernel.
#[derive(Clone, Debug)]
pub struct Peano<'a> {
    rule: &'a Quadrature<f64>,
    a: f64,
    b: f64,
    order: usize,
    constant: f64,
}

impl<'a> Peano<'a> {
    /// The kernel of `rule` for ∫_a^b; the order looked for is at most `most`, 2n or so for n nodes.
    ///
    /// # Errors
    ///
    /// When the rule does not integrate constants over [a, b], or is exact beyond degree `most`.
    pub fn new(rule: &'a Quadrature<f64>, a: f64, b: f64, most: usize) -> Result<Self, QuadratureError> {
        let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
        let reference = rule.map(|x, w| ((x - middle) / half, w / half));
        let legendre = Recurrence::legendre(most + 2);
        match (legendre.order(&reference), legendre.error_constant(&reference)) {
            (Some(order), Some(constant)) => {
                Ok(Self { rule, a, b, order, constant: constant * half.powi(order as i32 + 2) })
            }
            _ => Err(QuadratureError::Order { length: b - a, weights: rule.weights.iter().sum(), most }),
        }
    }

    /// The order N.
    pub fn order(&self) -> usize {
        self.order
    }

    /// C = 1/N! ∫ K_N, by which E(f) = C f^{(N+1)}(ξ) when K_N has one sign; computed without cancellation. Simpson's rule
    /// on [−1, 1]: −1/90.
    pub fn constant(&self) -> f64 {
        self.constant
    }

    /// K_N(t) with the paper's N, the order; 0 outside of [a, b]. The error is some 1e-16 (b − a)^{N+1}, so that the kernels
    /// of high order drown in it.
    pub fn at(&self, t: f64) -> f64 {
        self.of_degree(self.order, t)
    }

    /// K_d(t) for a degree d ≤ N, with which E(f) = 1/d! ∫ K_d f^{(d+1)} for f that are only so smooth.
    pub fn of_degree(&self, degree: usize, t: f64) -> f64 {
        if t <= self.a || t >= self.b {
            return 0.0;
        }
        let power = degree as i32;
        // E of the other truncated power, (−1)^{d+1} (t − x)₊^d, is the same: take the one with the shorter support.
        let (sign, end) = match 2.0 * t < self.a + self.b {
            true => (-1.0_f64, self.a),
            false => (1.0, self.b),
        };
        let above = |x: f64| ((x - t) * sign).max(0.0);
        // 0⁰ is 0 here: K_0 jumps at a node.
        let truncated = |x: f64| if above(x) > 0.0 { above(x).powi(power) } else { 0.0 };
        let exact = above(end).powi(power + 1) / (degree as f64 + 1.0);
        let sum: f64 = self.rule.nodes.iter().zip(&self.rule.weights).map(|(x, w)| w * truncated(*x)).sum();
        sign.powi(power + 1) * (exact - sum)
    }

    /// 1/N! ∫ |K_N|, the constant of |E(f)| ≤ C ‖f^{(N+1)}‖_∞, which holds for kernels with changes of sign too. `None` when
    /// the kernel is lost in rounding, as from N = 15 or so.
    pub fn bound(&self) -> Option<f64> {
        let factorial: f64 = (1..=self.order).map(|k| k as f64).product();
        let length = self.b - self.a;
        let noise = f64::EPSILON * length.abs().powi(self.order as i32 + 2) / factorial;
        let mut edges = vec![self.a];
        edges.extend(self.rule.nodes.iter().filter(|x| self.a < **x && **x < self.b));
        edges.push(self.b);
        edges.sort_unstable_by(f64::total_cmp);
        let total: f64 = edges.windows(2).map(|edge| self.absolute(edge[0], edge[1])).sum();
        let bound = total / factorial;
        (bound > 1e6 * noise).then(|| bound.max(self.constant.abs()))
    }

    /// ∫ |K_N| between two nodes, where K_N is a polynomial of degree N + 1: cut where it changes sign.
    fn absolute(&self, from: f64, to: f64) -> f64 {
        // A polynomial between two nodes has few roots there; eight parts tell them apart for the rules in use.
        const PARTS: usize = 8;
        let edge = |k: usize| from + (to - from) * (k as f64 / PARTS as f64);
        let integral =
            |a: f64, b: f64| gauss_legendre(self.order / 2 + 2, a, b).integrate(|t| self.at(*t)).abs();
        (0..PARTS)
            .map(|k| match self.root(edge(k), edge(k + 1)) {
                Some(root) => integral(edge(k), root) + integral(root, edge(k + 1)),
                None => integral(edge(k), edge(k + 1)),
            })
            .sum()
    }

    /// Where the kernel changes sign between a and b, by bisection.
    fn root(&self, mut a: f64, mut b: f64) -> Option<f64> {
        let sign = |t: f64| self.at(t) > 0.0;
        // A hair inside, for at the ends of the interval and at nodes the kernel may be 0 or jump.
        let hair = 1e-9 * (b - a);
        (a, b) = (a + hair, b - hair);
        let left = sign(a);
        if left == sign(b) {
            return None;
        }
        for _ in 0..50 {
            let middle = 0.5 * (a + b);
            if sign(middle) == left { a = middle } else { b = middle }
        }
        Some(0.5 * (a + b))
    }
}
