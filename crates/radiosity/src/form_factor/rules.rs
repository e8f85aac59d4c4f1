//! Rules on triangles in pairs, whose difference tells their error, with their nodes eight at a time.

use super::bundle::Lanes;
use super::piece::Cell;
use fredholm::quadrature::triangle;
use wide::f64x8;

/// A rule on a triangle with another of lower degree, whose difference is taken for its error.
#[derive(Clone, Debug)]
pub(super) struct Pair {
    pub nodes: Vec<Node>,
    /// The same nodes, eight at a time; the last is there again with no weight until there are eight.
    pub eights: Vec<Eight>,
    /// A rule of higher degree, for where the error is too large.
    pub higher: Vec<Eight>,
}

/// Barycentric coordinates, the weight, and that of the lower rule.
pub(super) type Node = ([f64; 3], f64, f64);

/// Eight nodes side by side.
#[derive(Clone, Debug)]
pub(super) struct Eight {
    coordinates: Lanes,
    pub weight: f64x8,
    pub lower: f64x8,
}

impl Eight {
    fn new(nodes: &[Node]) -> Self {
        let lanes = |part: &dyn Fn(&Node) -> f64| {
            f64x8::new(std::array::from_fn(|k| part(&nodes[k.min(nodes.len() - 1)])))
        };
        let weights =
            |part: &dyn Fn(&Node) -> f64| f64x8::new(std::array::from_fn(|k| nodes.get(k).map_or(0.0, part)));
        Self {
            coordinates: std::array::from_fn(|axis| lanes(&|node| node.0[axis])),
            weight: weights(&|node| node.1),
            lower: weights(&|node| node.2),
        }
    }

    /// The nodes in a cell.
    pub fn points(&self, [a, b, c]: &Cell) -> Lanes {
        let [u, v, w] = self.coordinates;
        std::array::from_fn(|axis| u * a[axis] + v * b[axis] + w * c[axis])
    }
}

impl Pair {
    /// For a relative tolerance.
    pub fn new(tolerance: f64) -> Self {
        let (nodes, higher) = match () {
            () if tolerance > 1e-5 => (embedded(), of_degree(8)),
            () if tolerance > 1e-8 => (of_degrees(8, 5), of_degree(14)),
            () => (of_degrees(14, 10), of_degree(20)),
        };
        let eights = |nodes: &[Node]| nodes.chunks(8).map(Eight::new).collect();
        Self { eights: eights(&nodes), higher: eights(&higher), nodes }
    }
}

/// Radon's seven points of degree 5, and the centroid with the three nearer to the corners: degree 2.
fn embedded() -> Vec<Node> {
    let mut nodes = of_degrees(5, 1);
    nodes.retain(|node| node.1 != 0.0);
    let nearer = |node: &[f64; 3]| node.iter().any(|x| *x > 0.7);
    let square = nodes.iter().find(|(x, ..)| nearer(x)).map_or(1.0, |(x, ..)| x.iter().map(|x| x * x).sum());
    // w + 3v = 1 and w/9 + v Σλ² = 1/6.
    let outer = (1.0 / 6.0 - 1.0 / 9.0) / (square - 1.0 / 3.0);
    for (x, _, lower) in &mut nodes {
        let central = x.iter().all(|x| (x - 1.0 / 3.0).abs() < 1e-9);
        *lower = if central {
            1.0 - 3.0 * outer
        } else if nearer(x) {
            outer
        } else {
            0.0
        };
    }
    nodes
}

fn of_degrees(high: usize, low: usize) -> Vec<Node> {
    let mut nodes = of_degree(high);
    nodes.extend(of_degree(low).into_iter().map(|(x, w, _)| (x, 0.0, w)));
    nodes
}

fn of_degree(degree: usize) -> Vec<Node> {
    // Degrees up to 20 are in the table.
    let rule = triangle(degree, [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
    let points = rule.into_iter().flat_map(|rule| rule.nodes.into_iter().zip(rule.weights));
    points.map(|([s, t], weight)| ([1.0 - s - t, s, t], 2.0 * weight, 0.0)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_rules_of_a_pair_integrate_what_they_say() {
        for (tolerance, high, low) in [(1e-4, 5, 2), (1e-6, 8, 5), (1e-9, 14, 10)] {
            let pair = Pair::new(tolerance);
            // ∫ s^d over the triangle is 2/((d + 1)(d + 2)) of its area, of one barycentric coordinate s.
            let missed = |degree: i32, weight: &dyn Fn(&Node) -> f64| {
                let sum: f64 = pair.nodes.iter().map(|node| weight(node) * node.0[0].powi(degree)).sum();
                (sum - 2.0 / f64::from((degree + 1) * (degree + 2))).abs()
            };
            assert!((0..=high).all(|degree| missed(degree, &|node| node.1) < 1e-14), "{tolerance:e}");
            assert!((0..=low).all(|degree| missed(degree, &|node| node.2) < 1e-14), "{tolerance:e}");
            assert!(missed(high + 1, &|node| node.1) > 1e-11 && missed(low + 1, &|node| node.2) > 1e-11);
            let weight: f64 = pair.eights.iter().map(|eight| eight.weight.reduce_add()).sum();
            assert!((weight - 1.0).abs() < 1e-14);
        }
    }
}
