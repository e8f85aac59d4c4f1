//! ∫_{P_i} ∫_{P_j} cosθ cosθ′ / (π r²) dy dx between patches that nothing hides from each other.
//!
//! Patches apart: the product of two rules of 4, 7 or 16 nodes, of degrees 3, 5 and 7. Near ones, and what lies across the other's
//! plane: the contour integral, exact to the tolerance ([`super::contour`]).

use super::contour;
use crate::polygon::Polygon;
use crate::view_factors::Exchange;
use fredholm::quadrature::{Quadrature, gauss_legendre};
use glam::DVec3;
use std::f64::consts::PI;
use wide::f64x4;

/// The unoccluded exchange between any two of a set of patches.
#[derive(Debug)]
pub struct Unoccluded {
    tolerance: f64,
    /// ΣA.
    area: f64,
    diameters: Vec<f64>,
    /// 2 × 2 nodes a patch, and the distance over diameter from which their product meets the tolerance.
    few: (f64, Vec<Nodes<1>>),
    /// The same with seven nodes.
    seven: (f64, Vec<Nodes<2>>),
    /// The same with 4 × 4 nodes.
    many: (f64, Vec<Nodes<4>>),
}

/// The Gauss nodes of a patch, one a lane.
#[derive(Clone, Debug)]
struct Nodes<const GROUPS: usize> {
    x: [f64x4; GROUPS],
    y: [f64x4; GROUPS],
    z: [f64x4; GROUPS],
    weight: [f64x4; GROUPS],
}

impl Unoccluded {
    /// For these patches, with an error of about `tolerance` for each pair, relative to its exchange or, where that is
    /// less, to a tenth of what two patches of these areas exchange in the mean.
    pub fn new(patches: &[Polygon], tolerance: f64) -> Self {
        let four = gauss_legendre(4, 0.0, 1.0).squared();
        Self {
            tolerance,
            area: patches.iter().map(Polygon::area).sum(),
            diameters: patches.iter().map(Polygon::diameter).collect(),
            few: (reach(FEW, 4, tolerance), patches.iter().map(|p| Nodes::new(p, &four_points(p))).collect()),
            seven: (reach(SEVEN, 6, tolerance), patches.iter().map(Nodes::seven).collect()),
            many: (reach(MANY, 8, tolerance), patches.iter().map(|p| Nodes::new(p, &four)).collect()),
        }
    }

    /// ∫_{P_i} ∫_{P_j} cosθ cosθ′ / (π r²), in m², where both are fronts; 0 where they do not face each other.
    pub fn between(&self, patches: &[Polygon], i: usize, j: usize) -> Exchange {
        let (a, b) = (&patches[i], &patches[j]);
        Facing::new(a, b).map_or_else(Exchange::default, |facing| self.facing(patches, i, j, facing))
    }

    /// The same for two patches that are known to face each other.
    pub(super) fn facing(&self, patches: &[Polygon], i: usize, j: usize, facing: Facing) -> Exchange {
        let (a, b) = (&patches[i], &patches[j]);
        let distance = a.centroid().distance(b.centroid());
        let relative = distance / self.diameters[i].max(self.diameters[j]);
        let (few, seven, many) = (&self.few, &self.seven, &self.many);
        if facing == Facing::Partly || relative < many.0 {
            return self.near(a, b);
        }
        let head_on = a.area() * b.area() / (PI * distance * distance);
        if relative < seven.0 {
            let value = product(&many.1[i], a.normal(), &many.1[j], b.normal());
            Exchange { value, error: MANY * head_on / relative.powi(8) }
        } else if relative < few.0 {
            let value = product(&seven.1[i], a.normal(), &seven.1[j], b.normal());
            Exchange { value, error: SEVEN * head_on / relative.powi(6) }
        } else {
            let value = product(&few.1[i], a.normal(), &few.1[j], b.normal());
            Exchange { value, error: FEW * head_on / relative.powi(4) }
        }
    }

    /// The contour integral of what is in front of each other's plane.
    fn near(&self, a: &Polygon, b: &Polygon) -> Exchange {
        let tolerance = self.tolerance * SMALL * a.area() * b.area() / self.area;
        let mut sum = Exchange::default();
        for part in a.in_front_of(b) {
            for other in b.in_front_of(&part) {
                let Exchange { value, error } =
                    contour::exchange(part.vertices(), other.vertices(), tolerance);
                sum.value += value;
                sum.error += error;
            }
        }
        sum
    }
}

/// A polygon as its seven nodes, for points that see it from afar.
#[derive(Clone, Debug)]
pub(crate) struct FromAfar {
    nodes: Nodes<2>,
    normal: DVec3,
}

impl FromAfar {
    /// The nodes of a polygon.
    pub fn new(polygon: &Polygon) -> Self {
        Self { nodes: Nodes::seven(polygon), normal: polygon.normal() }
    }

    /// The form factor from a point x with normal n, all of the polygon being above its horizon and x in front.
    pub fn factor(&self, x: DVec3, n: DVec3) -> f64 {
        let mut sum = f64x4::ZERO;
        for k in 0..2 {
            let Nodes { x: xs, y: ys, z: zs, weight } = &self.nodes;
            let (u, v, w) = (xs[k] - x.x, ys[k] - x.y, zs[k] - x.z);
            let leaves = u * n.x + v * n.y + w * n.z;
            let arrives = u * self.normal.x + v * self.normal.y + w * self.normal.z;
            let square = u * u + v * v + w * w;
            sum -= weight[k] * leaves * arrives / (square * square);
        }
        sum.reduce_add() / PI
    }

    /// The diameter over the distance of polygons whose factors from points have this error, relative to what they would be
    /// head-on.
    pub fn nearness(tolerance: f64) -> f64 {
        (tolerance / SEVEN).powf(1.0 / 6.0)
    }
}

/// The error of the product of 2 × 2 nodes is below FEW (diameter/distance)⁴ of the factor that the patches would have
/// head-on, that of seven below SEVEN (diameter/distance)⁶, and that of 4 × 4 below MANY (diameter/distance)⁸: 1.5, 1.4 and
/// 1.1 times the worst of the test's positions.
const FEW: f64 = 0.02;
const SEVEN: f64 = 4e-3;
const MANY: f64 = 3e-4;

/// The distance, in diameters, from which an error of `constant` / distance^`order` meets the tolerance. Nearer than 4/3
/// triangles may touch, whose corners are up to 2/3 of the diameter from their centroids.
fn reach(constant: f64, order: i32, tolerance: f64) -> f64 {
    (constant / tolerance).powf(1.0 / f64::from(order)).max(1.35)
}

/// A factor below this part of the mean one, A_j/ΣA, is not worth a relative tolerance.
pub(crate) const SMALL: f64 = 0.1;

impl<const GROUPS: usize> Nodes<GROUPS> {
    /// The nodes of a rule of 4 × GROUPS points.
    fn new(patch: &Polygon, rule: &Quadrature<[f64; 2]>) -> Self {
        Self::from_points(|k| {
            let [s, t] = rule.nodes[k];
            let (x, density) = node(patch, s, t);
            (x, density * rule.weights[k])
        })
    }

    /// From the points and weights of a patch.
    fn from_points(point: impl Fn(usize) -> (DVec3, f64)) -> Self {
        let lanes = |part: &dyn Fn((DVec3, f64)) -> f64| -> [f64x4; GROUPS] {
            std::array::from_fn(|group| f64x4::from([0, 1, 2, 3].map(|lane| part(point(4 * group + lane)))))
        };
        Self { x: lanes(&|p| p.0.x), y: lanes(&|p| p.0.y), z: lanes(&|p| p.0.z), weight: lanes(&|p| p.1) }
    }
}

impl Nodes<2> {
    /// Radon's seven nodes, of degree 5 on a triangle and on a parallelogram, and one of no weight.
    fn seven(patch: &Polygon) -> Self {
        if let [a, b, c] = *patch.vertices() {
            let root = 15_f64.sqrt();
            let orbits = [
                ((6.0 - root) / 21.0, (155.0 - root) / 1200.0),
                ((6.0 + root) / 21.0, (155.0 + root) / 1200.0),
            ];
            return Self::from_points(|k| {
                let (near, weight) =
                    if k < 6 { orbits[k / 3] } else { (1.0 / 3.0, if k == 6 { 0.225 } else { 0.0 }) };
                let [u, v, w]: [f64; 3] =
                    std::array::from_fn(|m| if m == k % 3 { 1.0 - 2.0 * near } else { near });
                (a * u + b * v + c * w, weight * patch.area())
            });
        }
        let (r, s, t) = (0.6_f64.sqrt(), (1.0_f64 / 3.0).sqrt(), (14.0_f64 / 15.0).sqrt());
        let corner = 5.0 / 36.0;
        let rule = [
            ([0.0, 0.0], 2.0 / 7.0),
            ([0.0, t], 5.0 / 63.0),
            ([0.0, -t], 5.0 / 63.0),
            ([r, s], corner),
            ([r, -s], corner),
            ([-r, s], corner),
            ([-r, -s], corner),
            ([0.0, 0.0], 0.0),
        ];
        Self::from_points(|k| {
            let ([s, t], weight) = rule[k];
            let (x, density) = node(patch, 0.5 + 0.5 * s, 0.5 + 0.5 * t);
            (x, weight * density)
        })
    }
}

/// The point of a patch at (s, t) of the unit square and the density dA/(ds dt) there, smooth in s and t:
/// the square is collapsed onto the first vertex of a triangle.
fn node(patch: &Polygon, s: f64, t: f64) -> (DVec3, f64) {
    if patch.vertices().len() == 4 {
        (patch.point(s, t), patch.density(s, t))
    } else {
        (patch.point(s * s, t), 2.0 * s * patch.area())
    }
}

/// Four points for [`node`], exact for cubic polynomials on a parallelogram and on a triangle: there the density s
/// is the weight of Gauss's rule in s (Gauss–Jacobi), and is taken out of the weights again.
fn four_points(patch: &Polygon) -> Quadrature<[f64; 2]> {
    let across = gauss_legendre(2, 0.0, 1.0);
    if patch.vertices().len() == 4 {
        return across.squared();
    }
    let root = 6_f64.sqrt();
    let along = [((6.0 - root) / 10.0, (9.0 - root) / 36.0), ((6.0 + root) / 10.0, (9.0 + root) / 36.0)];
    let pairs = || {
        along.iter().flat_map(|&(s, w)| {
            across.nodes.iter().zip(&across.weights).map(move |(t, v)| ([s, *t], w / s * v))
        })
    };
    let (nodes, weights) = pairs().unzip();
    Quadrature { nodes, weights }
}

/// Σ_p Σ_q w_p w_q K(x_p, y_q), four nodes of b at a time.
fn product<const GROUPS: usize>(
    a: &Nodes<GROUPS>,
    normal_a: DVec3,
    b: &Nodes<GROUPS>,
    normal_b: DVec3,
) -> f64 {
    let mut sum = f64x4::ZERO;
    for p in 0..GROUPS {
        let (xs, ys, zs, weights) =
            (a.x[p].to_array(), a.y[p].to_array(), a.z[p].to_array(), a.weight[p].to_array());
        for lane in 0..4 {
            for q in 0..GROUPS {
                let (x, y, z) = (b.x[q] - xs[lane], b.y[q] - ys[lane], b.z[q] - zs[lane]);
                let leaves = x * normal_a.x + y * normal_a.y + z * normal_a.z;
                let arrives = x * normal_b.x + y * normal_b.y + z * normal_b.z;
                let square = x * x + y * y + z * z;
                sum -= b.weight[q] * weights[lane] * leaves * arrives / (square * square);
            }
        }
    }
    sum.reduce_add() / PI
}

/// Where a polygon lies in respect to the plane of another.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Side {
    Before,
    Behind,
    Across,
}

/// Where b lies as seen from a. What is within rounding of the plane counts for either side.
pub(crate) fn side_of(a: &Polygon, b: &Polygon) -> Side {
    let origin = a.vertices()[0];
    let (mut low, mut high, mut reach) = (f64::INFINITY, f64::NEG_INFINITY, 0.0_f64);
    for v in b.vertices() {
        let from = *v - origin;
        let height = from.dot(a.normal());
        low = low.min(height);
        high = high.max(height);
        reach = reach.max(from.length_squared());
    }
    let rounding = PLANE * reach.sqrt();
    match () {
        () if high <= rounding => Side::Behind,
        () if low >= -rounding => Side::Before,
        () => Side::Across,
    }
}

/// How two polygons face each other of which neither is wholly behind the other's plane.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Facing {
    Wholly,
    Partly,
}

impl Facing {
    pub fn new(a: &Polygon, b: &Polygon) -> Option<Self> {
        match (side_of(a, b), side_of(b, a)) {
            (Side::Behind, _) | (_, Side::Behind) => None,
            (Side::Before, Side::Before) => Some(Self::Wholly),
            _ => Some(Self::Partly),
        }
    }
}

/// Whether some of a may face some of b: neither lies wholly behind the other's plane.
pub fn may_see(a: &Polygon, b: &Polygon) -> bool {
    Facing::new(a, b).is_some()
}

/// Part of the distance within which a point counts as on a plane: far above the rounding of a patch's corners
/// (10⁻¹⁶ of the scene), far below what a factor of 10⁻⁷ would notice.
const PLANE: f64 = 1e-12;

#[cfg(test)]
mod tests {
    use super::*;

    fn p(x: f64, y: f64, z: f64) -> DVec3 {
        DVec3::new(x, y, z)
    }

    /// The factor from the first polygon to the second.
    fn factor(a: &Polygon, b: &Polygon, tolerance: f64) -> f64 {
        let patches = [a.clone(), b.clone()];
        Unoccluded::new(&patches, tolerance).between(&patches, 0, 1).value / a.area()
    }

    #[track_caller]
    fn assert_close(got: f64, expected: f64, absolute: f64) {
        assert!((got - expected).abs() <= absolute, "{got} is not {expected}, by {:e}", got - expected);
    }

    /// [0, a] × [0, b] at height z, facing up or down.
    fn rectangle(x: [f64; 2], y: [f64; 2], z: f64, up: bool) -> Polygon {
        let [a, b, c, d] = [p(x[0], y[0], z), p(x[1], y[0], z), p(x[1], y[1], z), p(x[0], y[1], z)];
        if up { Polygon::quadrilateral(a, b, c, d) } else { Polygon::quadrilateral(a, d, c, b) }
    }

    #[test]
    fn parallel_rectangles_have_their_closed_forms() {
        let cases = [
            ([1.0, 1.0, 1.0], 0.199824895698),
            ([2.0, 1.0, 1.0], 0.285875384851),
            ([1.0, 1.0, 0.1], 0.826994522397),
            ([10.0, 10.0, 1.0], 0.826994522397),
        ];
        for ([a, b, c], expected) in cases {
            let (floor, ceiling) =
                (rectangle([0.0, a], [0.0, b], 0.0, true), rectangle([0.0, a], [0.0, b], c, false));
            for (tolerance, error) in [(1e-4, 1e-4), (1e-7, 1e-7), (1e-11, 1e-11)] {
                assert_close(factor(&floor, &ceiling, tolerance), expected, error * expected);
            }
        }
        let unit = rectangle([0.0, 1.0], [0.0, 1.0], 0.0, true);
        let offset = rectangle([1.0, 3.0], [0.5, 1.5], 1.0, false);
        assert_close(factor(&unit, &offset, 1e-9), 0.085530552987, 1e-10);
        let beside = rectangle([1.0, 2.0], [0.0, 1.0], 1.0, false);
        assert_close(factor(&unit, &beside, 1e-9), 0.086050489152, 1e-10);
    }

    #[test]
    fn touching_polygons_have_their_closed_forms() {
        let floor = |w: f64, l: f64| rectangle([0.0, l], [0.0, w], 0.0, true);
        let wall = |h: f64, l: f64| {
            Polygon::quadrilateral(p(0.0, 0.0, 0.0), p(0.0, 0.0, h), p(l, 0.0, h), p(l, 0.0, 0.0))
        };
        let wall = |h, l| {
            let w = wall(h, l);
            assert_eq!(w.normal(), DVec3::Y);
            w
        };
        for (w, h, l, expected) in [
            (1.0, 1.0, 1.0, 0.200043776075),
            (1.0, 2.0, 1.0, 0.232852602795),
            (1.0, 0.5, 3.0, 0.174626978343),
        ] {
            assert_close(factor(&floor(w, l), &wall(h, l), 1e-7), expected, 1e-7);
            assert_close(factor(&floor(w, l), &wall(h, l), 1e-4), expected, 1e-4 * expected);
        }
        // Right triangles that share an edge at 90° (corner tetrahedron); faces of the regular tetrahedron.
        let (x, y, z, o) = (p(1.0, 0.0, 0.0), p(0.0, 1.0, 0.0), p(0.0, 0.0, 1.0), DVec3::ZERO);
        assert_close(
            factor(&Polygon::triangle(o, x, y), &Polygon::triangle(o, z, x), 1e-7),
            0.211324865405,
            1e-6,
        );
        let [a, b, c, d] = [p(1.0, 1.0, 1.0), p(1.0, -1.0, -1.0), p(-1.0, 1.0, -1.0), p(-1.0, -1.0, 1.0)];
        let inward = |f: Polygon| {
            assert!(f.height_of(DVec3::ZERO) > 0.0);
            f
        };
        let (first, second) = (inward(Polygon::triangle(a, c, b)), inward(Polygon::triangle(a, b, d)));
        assert_close(factor(&first, &second, 1e-7), 1.0 / 3.0, 1e-6);
        // Unit squares hinged at 60°.
        let (sin, cos) = (60_f64.to_radians().sin(), 60_f64.to_radians().cos());
        let lid = Polygon::quadrilateral(o, p(0.0, cos, sin), p(1.0, cos, sin), x);
        assert_close(factor(&floor(1.0, 1.0), &lid, 1e-7), 0.370905321150, 1e-6);
    }

    #[test]
    fn neighbours_whose_shared_edge_is_off_by_rounding_take_no_longer_than_others() {
        // Neighbours on a sphere of 16 × 32 trapezoids: a corner of the one is some 10⁻¹⁷ behind the other's plane.
        let at = |i: f64, j: f64| {
            let ((sin, cos), (y, x)) = ((PI * i / 16.0).sin_cos(), (PI * j / 16.0).sin_cos());
            p(sin * x, sin * y, cos)
        };
        let cell = |i: f64, j: f64| {
            Polygon::quadrilateral(at(i, j), at(i, j + 1.0), at(i + 1.0, j + 1.0), at(i + 1.0, j))
        };
        let cells: Vec<Polygon> = (0..32).map(|j| cell(2.0, f64::from(j))).collect();
        let exchange = Unoccluded::new(&cells, 1e-4);
        let between: Vec<f64> = (1..32).map(|j| exchange.between(&cells, j - 1, j).value).collect();
        assert!(between.iter().all(|e| (e / between[0] - 1.0).abs() < 2e-4), "{between:?}");
    }

    #[test]
    fn a_polygon_across_the_plane_of_another_counts_only_in_front() {
        let floor = rectangle([0.0, 1.0], [0.0, 1.0], 0.0, true);
        let wall = |low: f64| {
            Polygon::quadrilateral(p(0.0, 0.0, low), p(0.0, 0.0, 1.0), p(1.0, 0.0, 1.0), p(1.0, 0.0, low))
        };
        assert_close(factor(&floor, &wall(-0.7), 1e-7), 0.200043776075, 1e-6);
        // Both across each other's planes: a floor that goes on behind the wall.
        let longer = rectangle([0.0, 1.0], [-2.0, 1.0], 0.0, true);
        assert_close(3.0 * factor(&longer, &wall(-0.7), 1e-7), 0.200043776075, 1e-6);
        assert_eq!(factor(&rectangle([0.0, 1.0], [0.0, 1.0], 0.0, false), &wall(0.0), 1e-7), 0.0);
        assert_eq!(factor(&floor, &rectangle([1.0, 2.0], [0.0, 1.0], 0.0, true), 1e-7), 0.0);
    }

    /// The largest error, over a patch's factor head-on, of the product rules at `reach` diameters, for 100 positions
    /// of two equal patches of side 1.
    fn worst_product_error(triangle: bool, reach: f64, product: impl Fn(&Polygon, &Polygon) -> f64) -> f64 {
        let a = if triangle {
            Polygon::triangle(p(0.0, 0.0, 0.0), p(1.0, 0.0, 0.0), p(0.3, 1.0, 0.0))
        } else {
            rectangle([0.0, 1.0], [0.0, 1.0], 0.0, true)
        };
        let error = |k: u32| {
            let angle = |m: f64| (f64::from(k) * m).fract();
            let (polar, turn) = (1.5 * angle(0.618), std::f64::consts::TAU * angle(0.7548));
            let direction = p(polar.sin() * turn.cos(), polar.sin() * turn.sin(), polar.cos());
            let rotation =
                glam::DQuat::from_euler(glam::EulerRot::XYZ, 3.0 * angle(0.4) + 1.5, angle(0.3), angle(0.9));
            let moved =
                |v: &DVec3| a.centroid() + rotation * (v - a.centroid()) + direction * a.diameter() * reach;
            let v: Vec<DVec3> = a.vertices().iter().map(moved).collect();
            let b = match v[..] {
                [p, q, r] => Polygon::triangle(p, q, r),
                [p, q, r, s] => Polygon::quadrilateral(p, q, r, s),
                _ => unreachable!(),
            };
            // A pair that each see all of the other, or the product is not used.
            let apart = side_of(&a, &b) == Side::Before && side_of(&b, &a) == Side::Before;
            let head_on = a.area() * b.area() / (PI * (a.diameter() * reach).powi(2));
            if apart { (product(&a, &b) - factor(&a, &b, 1e-10) * a.area()).abs() / head_on } else { 0.0 }
        };
        (0..100).map(error).fold(0.0, f64::max)
    }

    #[test]
    fn the_product_rules_err_no_more_than_they_say() {
        let four = gauss_legendre(4, 0.0, 1.0).squared();
        for (triangle, reach) in
            [false, true].into_iter().flat_map(|t| [1.2, 2.0, 4.0].map(|reach| (t, reach)))
        {
            let few = worst_product_error(triangle, reach, |a, b| {
                let nodes = |p| Nodes::<1>::new(p, &four_points(p));
                product(&nodes(a), a.normal(), &nodes(b), b.normal())
            });
            let seven = worst_product_error(triangle, reach, |a, b| {
                product(&Nodes::seven(a), a.normal(), &Nodes::seven(b), b.normal())
            });
            let many = worst_product_error(triangle, reach, |a, b| {
                let nodes = |p| Nodes::<4>::new(p, &four);
                product(&nodes(a), a.normal(), &nodes(b), b.normal())
            });
            // No more than they say, and not so much less that pairs go to a dearer rule for nothing.
            let (few, many) = (few * reach.powi(4) / FEW, many * reach.powi(8) / MANY);
            let seven = seven * reach.powi(6) / SEVEN;
            assert!(
                (0.3..1.0).contains(&few),
                "2 × 2: {few} of what is said, at {reach}, triangle {triangle}"
            );
            assert!(
                (0.1..1.0).contains(&seven),
                "7 nodes: {seven} of what is said, at {reach}, triangle {triangle}"
            );
            assert!(
                (0.03..1.0).contains(&many),
                "4 × 4: {many} of what is said, at {reach}, triangle {triangle}"
            );
        }
    }

    #[test]
    fn the_tolerance_is_kept_at_every_distance() {
        for tolerance in [1e-3, 1e-4, 1e-6] {
            for reach in [1.05, 1.3, 2.0, 3.0, 5.0, 12.0] {
                let between = |a: &Polygon, b: &Polygon| factor(a, b, tolerance) * a.area();
                let error = worst_product_error(false, reach, between);
                assert!(error < tolerance, "{error:e} for {tolerance:e} at {reach}");
            }
        }
    }
}
