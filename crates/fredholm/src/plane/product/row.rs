//! κ_j(p) = ∫ K(p, q) u_j(q) dq on the elements near p: cells that are small beside their distance from p are integrated by their
//! own Gauss nodes, and those with p in a corner in triangles that shrink to it (M. Duffy, 1982), as (1.29) of the paper asks.

use super::chart::{Chart, distance};
use super::element::{Cell, Elements, NODES, places};
use crate::equation::{EquationError, Scalar};
use crate::plane::PlaneEquation;
use crate::product::{COARSE, POINTS, SINGULAR};
use crate::quadrature::Quadrature;

type Point = [f64; 2];

/// How closely rows are integrated.
#[derive(Clone, Debug)]
pub(super) struct Rule {
    /// Cells are left whole that are so many of their radii away, from their centre.
    separation: f64,
    /// Whether elements are cut first.
    cut: bool,
    /// From 0, where K is singular, to 1.
    radial: Quadrature<f64>,
}

impl Rule {
    /// For a kernel like |p − q|^exponent, good to rounding on elements where K is smooth but at p.
    pub(super) fn new(exponent: f64) -> Self {
        Self { separation: 2.0, cut: false, radial: radial(exponent, 1) }
    }

    /// A finer one: what they differ by is the error of the first.
    pub(super) fn finer(exponent: f64) -> Self {
        Self { separation: 2.5, cut: true, radial: radial(exponent, 2) }
    }
}

/// Gauss's rule on [½, 1], [¼, ½] … and in s on the last interval, where σ = s^power: σ^(1 + exponent) dσ and σ ln σ dσ are at least as
/// smooth in s as s⁵ ln s, which 40 nodes do to rounding.
fn radial(exponent: f64, levels: i32) -> Quadrature<f64> {
    let power = (6.0 / (2.0 + exponent.min(0.0))).ceil();
    let mut rule = Quadrature { nodes: Vec::new(), weights: Vec::new() };
    for level in 1..=levels {
        let low = 0.5_f64.powi(level);
        rule.nodes.extend(COARSE.nodes.iter().map(|xi| low * (1.5 + 0.5 * xi)));
        rule.weights.extend(COARSE.weights.iter().map(|w| 0.5 * low * w));
    }
    let core = 0.5_f64.powi(levels);
    for (xi, w) in SINGULAR.nodes.iter().zip(&SINGULAR.weights) {
        let s = 0.5 * (1.0 + xi);
        rule.nodes.push(core * s.powf(power));
        rule.weights.push(0.5 * w * core * power * s.powf(power - 1.0));
    }
    rule
}

/// Where a row belongs to.
#[derive(Clone, Copy, Debug)]
pub(super) struct Target {
    pub(super) p: Point,
    /// Its chart and place there; none outside of the domain.
    pub(super) place: Option<(usize, Point)>,
}

/// A cell's side along u and v is no longer than this part of the other where triangles begin.
const ASPECT: f64 = 2.0;

/// How far the middle of a side may be from where it would be if the map were affine, as a part of the distance from p to the sides
/// across, where triangles begin.
const BENT: f64 = 0.15;

/// A triangle's base is cut that is longer than this part of its distance from p; 16 nodes do the rest to rounding.
const BASE: f64 = 1.2;

/// Halvings of an element: what is left then is of no size.
const DEPTH: u32 = 60;

/// Builds rows; all places are in the plane.
pub(super) struct RowBuilder<'k, 'a, T> {
    equation: &'k PlaneEquation<'a, T>,
    elements: &'k Elements,
    rule: &'k Rule,
    target: Target,
    points: Vec<Point>,
    areas: Vec<f64>,
    values: Vec<T>,
}

/// An element as a cell is seen from it.
struct Frame<'f> {
    chart: &'f Chart,
    cell: Cell,
}

/// Half of a cell with p in a corner: p, and the opposite side along u or along v.
struct Triangle {
    apex: Point,
    across: Point,
    along_u: bool,
}

impl Triangle {
    /// Sigma of the way from p to a place on the base, a part of the way along that.
    fn at(&self, sigma: f64, part: f64) -> Point {
        let parts = if self.along_u { [sigma * part, sigma] } else { [sigma, sigma * part] };
        [0, 1].map(|k| self.apex[k] + parts[k] * (self.across[k] - self.apex[k]))
    }

    /// Twice its area in (u, v).
    fn area(&self) -> f64 {
        ((self.across[0] - self.apex[0]) * (self.across[1] - self.apex[1])).abs()
    }
}

impl<'k, 'a, T: Scalar> RowBuilder<'k, 'a, T> {
    pub(super) fn new(
        equation: &'k PlaneEquation<'a, T>,
        elements: &'k Elements,
        rule: &'k Rule,
        target: Target,
    ) -> Self {
        let (points, areas, values) = (Vec::new(), Vec::new(), Vec::new());
        Self { equation, elements, rule, target, points, areas, values }
    }

    /// κ_j for all j.
    pub(super) fn row(&mut self, row: &mut [T]) -> Result<(), EquationError> {
        row.fill(T::ZERO);
        (0..self.elements.all.len())
            .zip(row.chunks_mut(NODES))
            .try_for_each(|(k, part)| self.element(k, part))
    }

    /// Whether an element is too near to be left whole.
    pub(super) fn is_near(&self, k: usize) -> bool {
        let element = &self.elements.all[k];
        let here =
            self.target.place.is_some_and(|(chart, uv)| chart == element.chart && element.cell.contains(uv));
        let extent = Extent::new(self.elements.chart(element), &element.cell);
        here || !extent.is_far(self.target.p, self.rule.separation)
    }

    /// Adds to `row` the weights of an element.
    pub(super) fn element(&mut self, k: usize, row: &mut [T]) -> Result<(), EquationError> {
        let elements = self.elements;
        let element = &elements.all[k];
        let frame = Frame { chart: elements.chart(element), cell: element.cell };
        let cells = element.cell.cut([self.rule.cut; 2]);
        for cell in cells {
            match self.target.place {
                Some((chart, uv)) if chart == element.chart && cell.contains(uv) => {
                    self.around(&frame, &cell, uv, row)?;
                }
                _ => self.beside(&frame, &cell, 0, row)?,
            }
        }
        Ok(())
    }

    /// A cell with p inside or on its rim: four with p in a corner.
    fn around(
        &mut self,
        frame: &Frame<'_>,
        cell: &Cell,
        [u, v]: Point,
        row: &mut [T],
    ) -> Result<(), EquationError> {
        for end in cell.u.into_iter().filter(|end| *end != u) {
            for other in cell.v.into_iter().filter(|other| *other != v) {
                self.corner(frame, [u, v], [end, other], row)?;
            }
        }
        Ok(())
    }

    /// A cell with p in a corner, (u, v), and another corner across: cut until it is about a square.
    fn corner(
        &mut self,
        frame: &Frame<'_>,
        apex: Point,
        across: Point,
        row: &mut [T],
    ) -> Result<(), EquationError> {
        let mut across = across;
        for _ in 0..DEPTH {
            let at =
                |parts: Point| frame.chart.point([0, 1].map(|k| apex[k] + parts[k] * (across[k] - apex[k])));
            let ends = [at([1.0, 0.0]), at([0.0, 1.0])];
            let sides = ends.map(|end| distance(self.target.p, end));
            let halves = [at([0.5, 0.0]), at([0.0, 0.5])].map(|half| distance(self.target.p, half));
            let opposite = at([1.0, 1.0]);
            let height = ends
                .map(|end| height(self.target.p, [end, opposite]))
                .into_iter()
                .fold(f64::INFINITY, f64::min);
            let is_cut = [0, 1].map(|k| {
                (halves[k] - 0.5 * sides[k]).abs() > BENT * height || sides[k] > ASPECT * sides[1 - k]
            });
            if is_cut == [false; 2] {
                break;
            }
            let far = [0, 1].map(|k| if is_cut[k] { 0.5 * (apex[k] + across[k]) } else { across[k] });
            // What is cut off: beyond half of u, and beyond half of v.
            if is_cut[0] {
                self.beside(frame, &spanned([far[0], apex[1]], across), 0, row)?;
            }
            if is_cut[1] {
                self.beside(frame, &spanned([apex[0], far[1]], [far[0], across[1]]), 0, row)?;
            }
            across = far;
        }
        for along_u in [false, true] {
            let triangle = Triangle { apex, across, along_u };
            self.triangle(frame, &triangle, [0.0, 1.0], row)?;
        }
        Ok(())
    }

    /// The part of a triangle from one place on its base to another: in halves while that is long beside its distance from p, as
    /// then |p − q| is not smooth along it.
    fn triangle(
        &mut self,
        frame: &Frame<'_>,
        triangle: &Triangle,
        base: [f64; 2],
        row: &mut [T],
    ) -> Result<(), EquationError> {
        let ends = base.map(|part| frame.chart.point(triangle.at(1.0, part)));
        let length = distance(ends[0], ends[1]);
        let height = height(self.target.p, ends);
        if length > BASE * height && height > self.grain() {
            let middle = 0.5 * (base[0] + base[1]);
            self.triangle(frame, triangle, [base[0], middle], row)?;
            return self.triangle(frame, triangle, [middle, base[1]], row);
        }
        let radial = &self.rule.radial;
        let along = |xi: f64| 0.5 * (base[0] + base[1] + (base[1] - base[0]) * xi);
        self.clear();
        for (sigma, w) in radial.nodes.iter().zip(&radial.weights) {
            let weight = 0.5 * w * sigma * triangle.area() * (base[1] - base[0]);
            for (xi, v) in COARSE.nodes.iter().zip(&COARSE.weights) {
                self.add(frame.chart, triangle.at(*sigma, along(*xi)), weight * v);
            }
        }
        self.sample()?;
        // One of u and v is the same for all places as far from p as sigma.
        let (moving, still) = if triangle.along_u { (0, 1) } else { (1, 0) };
        for (sigma, values) in radial.nodes.iter().zip(self.values.chunks(POINTS)) {
            let mut across = [T::ZERO; POINTS];
            for (xi, value) in COARSE.nodes.iter().zip(values) {
                let local = frame.cell.local(triangle.at(*sigma, along(*xi)));
                COARSE.spread(local[moving], *value, &mut across);
            }
            let mut basis = [0.0; POINTS];
            COARSE.spread(frame.cell.local(triangle.at(*sigma, 0.5))[still], 1.0, &mut basis);
            for (j, l) in basis.iter().enumerate() {
                for (k, value) in across.iter().enumerate() {
                    row[if triangle.along_u { POINTS * k + j } else { POINTS * j + k }] += *value * *l;
                }
            }
        }
        Ok(())
    }

    /// A cell without p: as a whole if it is far enough, in halves otherwise.
    fn beside(
        &mut self,
        frame: &Frame<'_>,
        cell: &Cell,
        depth: u32,
        row: &mut [T],
    ) -> Result<(), EquationError> {
        let extent = Extent::new(frame.chart, cell);
        // Places that rounding makes one are never far from each other.
        let is_least = depth == DEPTH || extent.radius <= self.grain();
        if is_least || extent.is_far(self.target.p, self.rule.separation) {
            return self.whole(frame, cell, row);
        }
        let [u, v] = extent.lengths;
        cell.cut([u >= v, u < v]).iter().try_for_each(|half| self.beside(frame, half, depth + 1, row))
    }

    /// A cell by its own nodes.
    fn whole(&mut self, frame: &Frame<'_>, cell: &Cell, row: &mut [T]) -> Result<(), EquationError> {
        self.clear();
        for (at, w) in places() {
            self.add(frame.chart, cell.at(at), w * cell.quarter());
        }
        self.sample()?;
        if cell.u == frame.cell.u && cell.v == frame.cell.v {
            row.iter_mut().zip(&self.values).for_each(|(entry, value)| *entry += *value);
            return Ok(());
        }
        // By the basis polynomials at the cell's ξ, and then at its η.
        let basis = [(cell.u, frame.cell.u), (cell.v, frame.cell.v)].map(|(own, element)| {
            let ends = own.map(|u| (2.0 * u - element[0] - element[1]) / (element[1] - element[0]));
            let at = |xi: &f64| 0.5 * (ends[0] + ends[1] + (ends[1] - ends[0]) * xi);
            COARSE.basis_at_all(&COARSE.nodes.iter().map(at).collect::<Vec<_>>())
        });
        let mut half = [T::ZERO; NODES];
        for (values, basis) in self.values.chunks(POINTS).zip(basis[0].chunks(POINTS)) {
            for (half, l) in half.chunks_mut(POINTS).zip(basis) {
                half.iter_mut().zip(values).for_each(|(entry, value)| *entry += *value * *l);
            }
        }
        for (row, half) in row.chunks_mut(POINTS).zip(half.chunks(POINTS)) {
            for (value, basis) in half.iter().zip(basis[1].chunks(POINTS)) {
                row.iter_mut().zip(basis).for_each(|(entry, l)| *entry += *value * *l);
            }
        }
        Ok(())
    }

    /// Distances of this size are rounding.
    fn grain(&self) -> f64 {
        let [x, y] = self.target.p;
        16.0 * f64::EPSILON * x.abs().max(y.abs())
    }

    fn clear(&mut self) {
        self.points.clear();
        self.areas.clear();
    }

    fn add(&mut self, chart: &Chart, uv: Point, weight: f64) {
        self.points.push(chart.point(uv));
        self.areas.push(weight * chart.area(uv));
    }

    /// `values` = K(p, q) w at what was added. A q that is rounded to p itself stands for less than its rounding, and is left out.
    fn sample(&mut self) -> Result<(), EquationError> {
        let p = self.target.p;
        self.values.resize(self.points.len(), T::ZERO);
        self.equation.kernel.row(p, &self.points, &mut self.values);
        for ((value, q), area) in self.values.iter_mut().zip(&self.points).zip(&self.areas) {
            *value = match value.finite() {
                true => *value * *area,
                false if *q == p => T::ZERO,
                false => {
                    let value = format!("{value:?}");
                    return Err(EquationError::PlaneKernelNotFinite { p, q: *q, value });
                }
            };
        }
        Ok(())
    }
}

/// Where a cell is.
struct Extent {
    centre: Point,
    radius: f64,
    /// Through the centre, along u and along v.
    lengths: [f64; 2],
}

impl Extent {
    fn new(chart: &Chart, cell: &Cell) -> Self {
        let at = |xi: f64, eta: f64| chart.point(cell.at([xi, eta]));
        let centre = at(0.0, 0.0);
        let ends = [at(-1.0, 0.0), at(1.0, 0.0), at(0.0, -1.0), at(0.0, 1.0)];
        let corners = [at(-1.0, -1.0), at(-1.0, 1.0), at(1.0, -1.0), at(1.0, 1.0)];
        let radius = ends.iter().chain(&corners).map(|p| distance(centre, *p)).fold(0.0, f64::max);
        Self { centre, radius, lengths: [distance(ends[0], ends[1]), distance(ends[2], ends[3])] }
    }

    /// Whether the centre is so many radii away from p.
    fn is_far(&self, p: Point, radii: f64) -> bool {
        distance(self.centre, p) >= radii * self.radius
    }
}

/// The distance of p from the segment between two points.
fn height(p: Point, [a, b]: [Point; 2]) -> f64 {
    let (along, from) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let part = (from[0] * along[0] + from[1] * along[1]) / (along[0] * along[0] + along[1] * along[1]);
    // NaN is where both ends are one point.
    let part = if part.is_nan() { 0.0 } else { part.clamp(0.0, 1.0) };
    distance(p, [0, 1].map(|k| a[k] + part * along[k]))
}

/// The cell from one corner to the one across, whichever is lower.
fn spanned(one: Point, other: Point) -> Cell {
    let ordered = |k: usize| [one[k].min(other[k]), one[k].max(other[k])];
    Cell { u: ordered(0), v: ordered(1) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::Domain;

    /// All rows of a kernel, applied to a function that no symmetry hides, by the rule and by a much finer one.
    fn worst(domain: Domain, exponent: f64, kernel: fn(f64) -> f64) -> f64 {
        let equation = PlaneEquation::new(domain, move |p: Point, q: Point| kernel(distance(p, q)), |_| 1.0);
        let elements = Elements::new(domain, exponent).cut(|k| [k % 2 == 0, k % 3 == 0]);
        let finest = Rule { separation: 5.0, cut: true, radial: radial(exponent, 4) };
        let nodes = elements.nodes();
        let wild: Vec<f64> = nodes.iter().map(|[x, y]| (3.0 * x).cos() * (2.0 * y + 1.0).sin()).collect();
        let differences = (0..nodes.len()).step_by(29).map(|i| {
            let element = &elements.all[i / NODES];
            let uv = element.cell.at([i % NODES / POINTS, i % POINTS].map(|k| COARSE.nodes[k]));
            let target = Target { p: nodes[i], place: Some((element.chart, uv)) };
            let [one, other] = [&Rule::new(exponent), &finest].map(|rule| {
                let mut row = vec![0.0; nodes.len()];
                RowBuilder::new(&equation, &elements, rule, target).row(&mut row).unwrap();
                row
            });
            let sum = |row: &[f64]| row.iter().zip(&wild).map(|(a, g)| a * g).sum::<f64>();
            (sum(&one) - sum(&other)).abs() / other.iter().map(|a| a.abs()).sum::<f64>()
        });
        differences.fold(0.0, f64::max)
    }

    #[test]
    fn rows_are_good_to_rounding_wherever_their_point_is() {
        let domains = [
            Domain::Rectangle { x0: 0.0, x1: 4.0, y0: 0.0, y1: 1.0 },
            Domain::Triangle([[0.0, 0.0], [3.0, 1.0], [-1.0, 2.0]]),
            Domain::Triangle([[0.0, 0.0], [5.0, 0.5], [5.0, -0.5]]),
            Domain::Disk { centre: [1.0, 2.0], radius: 2.0 },
        ];
        for domain in domains {
            let found =
                [worst(domain, 0.0, f64::ln), worst(domain, 0.5, f64::sqrt), worst(domain, -1.0, f64::recip)];
            assert!(found[0].max(found[1]) < 1e-12 && found[2] < 1e-9, "{domain}: {found:.1?}");
        }
        // What rounding leaves of |p − q|^−1.5.
        let strong = worst(domains[3], -1.5, |r| r.powf(-1.5));
        assert!(strong < 1e-6, "{strong:.1e}");
    }
}
