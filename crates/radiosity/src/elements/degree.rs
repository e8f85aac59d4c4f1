//! P_k on the triangle, Q_k on the square: nodes, weights and the basis φ_b(y_a) = δ_ab (paper, §3.2).

use fredholm::quadrature::{Quadrature, gauss_legendre};

/// The degree k of the polynomials on each element.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Degree {
    /// P0, Q0: one value an element.
    Constant,
    /// P1, Q1: three values on a triangle, four on a quadrilateral.
    Linear,
    /// P2, Q2: six values on a triangle, nine on a quadrilateral.
    Quadratic,
}

/// The most basis functions of an element: Q2.
pub const MOST: usize = 9;

/// A number for each basis function of an element, the rest unused.
pub type Local = [f64; MOST];

impl Degree {
    /// k.
    pub fn order(self) -> usize {
        match self {
            Self::Constant => 0,
            Self::Linear => 1,
            Self::Quadratic => 2,
        }
    }
}

/// The reference element: the triangle (0,0) (1,0) (0,1), or the unit square.
#[derive(Clone, Debug)]
pub(crate) struct Reference {
    /// The nodes y_a.
    pub nodes: Vec<[f64; 2]>,
    /// Their weights, which add up to 1.
    pub weights: Vec<f64>,
    /// φ_a = Σ_m `coefficients[a][m]` × monomial m.
    coefficients: Vec<Local>,
    /// The monomials at a point, as many as there are basis functions, then zeros.
    pub monomials: fn([f64; 2]) -> Local,
}

impl Reference {
    pub fn triangle(degree: Degree) -> Self {
        Self::new(triangle_nodes(degree), |[s, t]| [1.0, s, t, s * s, s * t, t * t, 0.0, 0.0, 0.0])
    }

    pub fn square(degree: Degree) -> Self {
        let rule = gauss_legendre(degree.order() + 1, 0.0, 1.0).squared();
        let monomials: fn([f64; 2]) -> Local = match degree {
            Degree::Quadratic => {
                |[s, t]| [1.0, s, t, s * t, s * s, t * t, s * s * t, s * t * t, s * s * t * t]
            }
            // The first of Q2's, in whose order those of Q0 and Q1 come first.
            _ => |[s, t]| [1.0, s, t, s * t, 0.0, 0.0, 0.0, 0.0, 0.0],
        };
        Self::new(rule, monomials)
    }

    /// The rule integrates products of two basis functions exactly, so polynomials p_l that are orthonormal in its sum
    /// are so in the integral, and φ_a = w_a Σ_l p_l(y_a) p_l is 1 at y_a and 0 at the other nodes.
    fn new(rule: Quadrature<[f64; 2]>, monomials: fn([f64; 2]) -> Local) -> Self {
        let Quadrature { nodes, weights } = rule;
        let at_nodes: Vec<Local> = nodes.iter().map(|&node| monomials(node)).collect();
        let orthonormal = orthonormalised(&at_nodes, &weights);
        let coefficient = |a: usize, m: usize| {
            let terms = orthonormal.iter().map(|p| dot(p, &at_nodes[a]) * p[m]);
            weights[a] * terms.sum::<f64>()
        };
        let coefficients = (0..nodes.len()).map(|a| std::array::from_fn(|m| coefficient(a, m))).collect();
        Self { nodes, weights, coefficients, monomials }
    }

    /// φ_b at a point of the reference element, for all b.
    pub fn values(&self, at: [f64; 2]) -> Local {
        self.combined(&(self.monomials)(at))
    }

    /// What a linear functional is of the φ_b, from what it is of the monomials.
    pub fn combined(&self, of_monomials: &Local) -> Local {
        let mut values = [0.0; MOST];
        values.iter_mut().zip(&self.coefficients).for_each(|(value, c)| *value = dot(c, of_monomials));
        values
    }
}

fn dot(a: &Local, b: &Local) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The coefficients of polynomials p_l with Σ_a w_a p_l(y_a) p_m(y_a) = δ_lm, from the monomials at the nodes: Gram and
/// Schmidt, twice over, which takes away what rounding left the first time.
fn orthonormalised(at_nodes: &[Local], weights: &[f64]) -> Vec<Local> {
    let inner = |p: &Local, q: &Local| -> f64 {
        at_nodes.iter().zip(weights).map(|(m, w)| w * dot(p, m) * dot(q, m)).sum()
    };
    let mut basis: Vec<Local> = Vec::new();
    for l in 0..at_nodes.len() {
        let mut p: Local = std::array::from_fn(|m| if m == l { 1.0 } else { 0.0 });
        for q in basis.iter().chain(&basis) {
            let part = inner(&p, q);
            p.iter_mut().zip(q).for_each(|(p, q)| *p -= part * q);
        }
        let norm = inner(&p, &p).sqrt();
        basis.push(p.map(|c| c / norm));
    }
    basis
}

/// Symmetric rules with as many points as P_k has dimensions that are exact for degree 2k: the centroid; the barycentric
/// nodes of P1 pulled half-way to it; two orbits of three (Strang & Fix 1973), which stand where the corners and the
/// middles of the edges do, pulled inside.
fn triangle_nodes(degree: Degree) -> Quadrature<[f64; 2]> {
    let orbit = |a: f64| [[a, a], [1.0 - 2.0 * a, a], [a, 1.0 - 2.0 * a]];
    match degree {
        Degree::Constant => Quadrature { nodes: vec![[1.0 / 3.0; 2]], weights: vec![1.0] },
        Degree::Linear => Quadrature { nodes: orbit(1.0 / 6.0).to_vec(), weights: vec![1.0 / 3.0; 3] },
        Degree::Quadratic => {
            let (ten, inner) = (10_f64.sqrt(), (38.0 - 44.0 * 0.4_f64.sqrt()).sqrt());
            let root = (213_125.0 - 53_320.0 * ten).sqrt();
            let corners = orbit((8.0 - ten - inner) / 18.0);
            let middles = orbit((8.0 - ten + inner) / 18.0);
            let weights = [(620.0 - root) / 3720.0, (620.0 + root) / 3720.0];
            Quadrature {
                nodes: corners.into_iter().chain(middles).collect(),
                weights: weights.into_iter().flat_map(|w| [w; 3]).collect(),
            }
        }
    }
}
