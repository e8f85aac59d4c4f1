//! ∫ K(x, y) g(y) dy = Σ_q κ_q(x) g(y_q): the quadrature rule that varies with x (paper, §1.2.3, remark).

use crate::equation::{Equation, Scalar};
use crate::quadrature::gauss_legendre;

/// The nodes y_q and weights κ_q of the rule for one x; the kernel is in the weights.
#[derive(Clone, Debug)]
pub struct Row<T> {
    /// y_q.
    pub nodes: Vec<f64>,
    /// κ_q.
    pub weights: Vec<T>,
    /// An estimate of the rule's error for |g| ≤ 1.
    pub error: f64,
}

impl<T: Scalar> Row<T> {
    /// Σ_q κ_q g(y_q).
    pub fn apply(&self, g: impl Fn(f64) -> T) -> T {
        self.nodes.iter().zip(&self.weights).map(|(y, weight)| *weight * g(*y)).sum()
    }
}

/// The rule for K_ab(x, ·), good to rounding for every g that is a polynomial of degree ≤ 15 from one of the `breaks`
/// to the next; they ascend from one end of the interval to the other.
pub fn row<T: Scalar>(equation: &Equation<'_, T>, (a, b): (usize, usize), x: f64, breaks: &[f64]) -> Row<T> {
    let mut edges: Vec<f64> = breaks.to_vec();
    edges.push(x);
    edges.sort_by(f64::total_cmp);
    let mut row = Row { nodes: Vec::new(), weights: Vec::new(), error: 0.0 };
    for piece in edges.windows(2).filter(|piece| piece[0] < piece[1]) {
        let rule = gauss_legendre(32, piece[0], piece[1]);
        let offset: Vec<f64> = rule.nodes.iter().map(|y| y - x).collect();
        let mut values = vec![T::ZERO; rule.nodes.len()];
        equation.kernel(a, b).row(x, &rule.nodes, &offset, &mut values);
        row.weights.extend(values.iter().zip(&rule.weights).map(|(k, w)| *k * *w));
        row.nodes.extend(rule.nodes);
    }
    row
}
