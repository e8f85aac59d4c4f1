//! |T|⁻¹ ∫_T g ≈ Σ_orbits w Σ g: rules on a triangle that do not change when its corners are renamed.
//!
//! The orbits stand in `triangle.txt`: one point (the centroid), three (a, a, 1 − 2a) or six (a, b, 1 − a − b). All weights are
//! positive and all points inside. They were found for this crate by least squares from random beginnings and made exact in 50
//! digits.

use super::plane::{area, barycentric};
use super::{Quadrature, QuadratureError};

const TABLE: &str = include_str!("triangle.txt");

/// The highest degree of [`triangle`].
pub const MOST_SYMMETRIC: usize = 20;

/// The symmetric rule on the triangle with these corners that is exact for polynomials of `degree` and, of those in
/// the table, has the fewest points: 1, 3, 6, 6, 7, 12, 15, 16, 19, 25, … for degree 1, 2, 3, …
///
/// # Errors
///
/// Beyond degree 20; see [`super::conical`] for those.
pub fn triangle(degree: usize, corners: [[f64; 2]; 3]) -> Result<Quadrature<[f64; 2]>, QuadratureError> {
    let size = area(corners);
    let mut rule = Quadrature { nodes: Vec::new(), weights: Vec::new() };
    for orbit in orbits(degree)? {
        let weight = orbit[0];
        for point in points(&orbit[1..]) {
            rule.nodes.push(barycentric(corners, point));
            rule.weights.push(weight * size);
        }
    }
    Ok(rule)
}

/// The lines of the first rule in the table whose degree suffices: a weight, and none, one or two coordinates.
fn orbits(degree: usize) -> Result<Vec<Vec<f64>>, QuadratureError> {
    let title = |line: &str| line.strip_prefix("degree ").and_then(|degree| degree.parse::<usize>().ok());
    let mut lines = TABLE.lines().skip_while(|line| title(line).is_none_or(|found| found < degree));
    if lines.next().is_none() {
        return Err(QuadratureError::Degree { degree, most: MOST_SYMMETRIC });
    }
    let numbers = |line: &str| line.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    Ok(lines.take_while(|line| title(line).is_none()).map(numbers).collect())
}

/// The barycentric coordinates of an orbit's points.
fn points(coordinates: &[f64]) -> Vec<[f64; 3]> {
    match *coordinates {
        [a] => {
            let c = 1.0 - 2.0 * a;
            vec![[a, a, c], [a, c, a], [c, a, a]]
        }
        [a, b] => {
            let c = 1.0 - a - b;
            vec![[a, b, c], [b, c, a], [c, a, b], [b, a, c], [a, c, b], [c, b, a]]
        }
        _ => vec![[1.0 / 3.0; 3]],
    }
}
