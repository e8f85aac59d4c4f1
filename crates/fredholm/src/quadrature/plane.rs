//! ∫∫ over rectangles, triangles and disks by products of rules: Σ_ij v_i w_j g(x_i, y_j).

use super::{Quadrature, QuadratureError, gauss_jacobi, gauss_legendre, periodic_trapezoid};
use std::f64::consts::TAU;

impl Quadrature<f64> {
    /// The tensor product: this rule for x, the other for y, on the rectangle.
    pub fn times(&self, other: &Self) -> Quadrature<[f64; 2]> {
        let pairs = || {
            self.nodes
                .iter()
                .zip(&self.weights)
                .flat_map(|one| other.nodes.iter().zip(&other.weights).map(move |two| (one, two)))
        };
        Quadrature {
            nodes: pairs().map(|((x, _), (y, _))| [*x, *y]).collect(),
            weights: pairs().map(|((_, v), (_, w))| v * w).collect(),
        }
    }

    /// The tensor product of the rule with itself: from an interval to a square.
    pub fn squared(&self) -> Quadrature<[f64; 2]> {
        self.times(self)
    }
}

/// The rule on the rectangle [x₀, x₁] × [y₀, y₁] that is exact for xⁱyʲ with i and j up to `degree`: Gauss by Gauss.
pub fn rectangle(degree: usize, x: [f64; 2], y: [f64; 2]) -> Quadrature<[f64; 2]> {
    let n = degree / 2 + 1;
    gauss_legendre(n, x[0], x[1]).times(&gauss_legendre(n, y[0], y[1]))
}

/// The conical rule of any `degree` on a triangle: the square folded onto it (W. Duffy), Gauss's rule across and Jacobi's,
/// which takes the fold's Jacobian for a weight, along. (degree/2 + 1)² nodes inside, denser at the first corner.
///
/// # Errors
///
/// None for any degree; the signature is that of the rule it uses.
pub fn conical(degree: usize, corners: [[f64; 2]; 3]) -> Result<Quadrature<[f64; 2]>, QuadratureError> {
    let n = degree / 2 + 1;
    let (along, across) = (gauss_jacobi(n, 0.0, 1.0, 0.0, 1.0)?, gauss_legendre(n, 0.0, 1.0));
    // ∫∫ g dA = 2|T| ∫₀¹ s ∫₀¹ g(corner + s (…)) dr ds.
    let twice = 2.0 * area(corners);
    Ok(along
        .times(&across)
        .map(|[s, r], w| (barycentric(corners, [1.0 - s, s * (1.0 - r), s * r]), twice * w)))
}

/// The rule on a disk that is exact for polynomials of `degree`: Gauss's in r², equal weights in the angle.
///
/// # Errors
///
/// When the radius is not a positive number.
pub fn disk(degree: usize, centre: [f64; 2], radius: f64) -> Result<Quadrature<[f64; 2]>, QuadratureError> {
    if !(radius > 0.0 && radius.is_finite()) {
        let expected = "give a positive number";
        return Err(QuadratureError::Domain { what: "the disk's radius", given: radius, expected });
    }
    // r dr = ½ d(r²), and an even power r^{2k} is a k-th power of r².
    let squares = gauss_legendre(degree / 4 + 1, 0.0, 1.0);
    let angles = periodic_trapezoid(degree + 1, 0.0, TAU);
    let scale = 0.5 * radius * radius;
    Ok(squares.times(&angles).map(|[square, angle], w| {
        let r = radius * square.sqrt();
        ([centre[0] + r * angle.cos(), centre[1] + r * angle.sin()], scale * w)
    }))
}

/// The area of a triangle, whichever way round.
pub(super) fn area([p, q, r]: [[f64; 2]; 3]) -> f64 {
    0.5 * ((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])).abs()
}

/// The point with these barycentric coordinates.
pub(super) fn barycentric(corners: [[f64; 2]; 3], at: [f64; 3]) -> [f64; 2] {
    [0, 1].map(|axis| (0..3).map(|k| at[k] * corners[k][axis]).sum())
}
