//! L(ω) ≈ a + b·ω on spherical triangles, quarters of quarters of the four between the horizon and the zenith: as many as it
//! takes to be right in every direction.

use super::model::Model;
use super::moments::Affine;
use super::rays::{self, Target};
use glam::{DMat4, DVec3, DVec4};

/// A sky as it is integrated, with the radiance of its zenith for a unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Dome {
    model: Model,
    pub(super) cells: Vec<Cell>,
    /// What rays go to.
    pub(super) targets: Vec<Target>,
    error: f64,
}

/// A spherical triangle.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Cell {
    /// Unit vectors, counter-clockwise about it.
    pub corners: [DVec3; 3],
    /// The inward normals of the planes of its edges.
    pub edges: [DVec3; 3],
    pub luminance: Affine,
    /// ∫ L ω dω, in units of the zenith's radiance: of its parts, if it has some.
    pub moment: DVec3,
    /// The first of four parts.
    pub parts: Option<usize>,
}

/// The four triangles that everything begins with.
pub(super) const ROOTS: usize = 4;

/// What a cell may be wrong by, relative to the luminance there: a tenth of what light is mostly asked to. The cells of a clear sky
/// are then some thousands, of which a point looks closer at those alone through which an edge of what hides them goes.
const TOLERANCE: f64 = 2e-3;

/// Cuts of cells about the sun, where a sky has a point; the last cells are a tenth of a degree.
const CUTS: u32 = 10;

impl Dome {
    /// From a model.
    pub fn new(model: Model) -> Self {
        let up = model.up();
        let (x, y) = up.any_orthonormal_pair();
        // So that x, y and up are right-handed.
        let y = if x.cross(y).dot(up) > 0.0 { y } else { -y };
        let around = [x, y, -x, -y];
        let roots = (0..ROOTS).map(|k| ([around[k], around[(k + 1) % ROOTS], up], 0));
        let mut waiting: Vec<([DVec3; 3], u32)> = roots.collect();
        let mut dome = Self { model, cells: Vec::new(), targets: Vec::new(), error: 0.0 };
        let mut next = 0;
        while let Some(&(corners, cuts)) = waiting.get(next) {
            next += 1;
            let luminance = fitted(&model, corners);
            let deviation = deviation(&model, corners, &luminance);
            let parts = (deviation > TOLERANCE && cuts < CUTS).then(|| {
                waiting.extend(quarters(corners).map(|part| (part, cuts + 1)));
                waiting.len() - 4
            });
            if parts.is_none() {
                dome.error = dome.error.max(deviation);
            }
            let moment = luminance.moment(corners.into_iter());
            let [a, b, c] = corners;
            let edges = [a.cross(b), b.cross(c), c.cross(a)];
            dome.cells.push(Cell { corners, edges, luminance, moment, parts });
        }
        for k in (0..dome.cells.len()).rev() {
            if let Some(first) = dome.cells[k].parts {
                dome.cells[k].moment = dome.cells[first..first + 4].iter().map(|part| part.moment).sum();
            }
        }
        dome.targets = rays::targets(&dome);
        dome
    }

    /// What it is an approximation of.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// By how much it differs from its model at the most, in any direction, as a part of the luminance there; and so the largest
    /// relative error of any irradiance from it.
    pub fn error(&self) -> f64 {
        self.error
    }

    /// In how many cells it is integrated.
    pub fn cells(&self) -> usize {
        self.cells.iter().filter(|cell| cell.parts.is_none()).count()
    }

    /// The irradiance of an unobstructed surface with a unit normal, where the zenith has a radiance of 1; in sr.
    pub fn unobstructed(&self, normal: DVec3) -> f64 {
        super::view::received(self, &super::cover::Cover::nothing(), DVec3::ZERO, normal)
    }

    /// The irradiance of the unobstructed horizontal where the zenith has a radiance of 1, in sr: π for a uniform sky.
    pub fn horizontal(&self) -> f64 {
        self.cells[..ROOTS].iter().map(|root| root.moment.dot(self.model.up())).sum()
    }
}

/// The four spherical triangles between corners and middles of edges.
pub(super) fn quarters([a, b, c]: [DVec3; 3]) -> [[DVec3; 3]; 4] {
    let middle = |p: DVec3, q: DVec3| (p + q).normalize();
    let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
    [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
}

/// Directions in a triangle: n points on each side and the ones between.
fn grid([a, b, c]: [DVec3; 3], n: u32) -> impl Iterator<Item = DVec3> {
    let of = move |i: u32, j: u32| {
        let [i, j, k] = [i, j, n - i - j].map(f64::from);
        (a * i + b * j + c * k).normalize()
    };
    (0..=n).flat_map(move |i| (0..=n - i).map(move |j| of(i, j)))
}

/// The a + b·ω with the least squares of relative deviations.
fn fitted(model: &Model, corners: [DVec3; 3]) -> Affine {
    let centre = corners.iter().sum::<DVec3>().normalize();
    let radius = corners.iter().map(|corner| corner.distance(centre)).fold(0.0, f64::max);
    let (x, y) = centre.any_orthonormal_pair();
    // Of the size of 1 on the triangle, however small that is.
    let basis = |omega: DVec3| {
        DVec4::new(
            1.0,
            omega.dot(x) / radius,
            omega.dot(y) / radius,
            (1.0 - omega.dot(centre)) / (radius * radius),
        )
    };
    let (mut matrix, mut right) = (DMat4::ZERO, DVec4::ZERO);
    for omega in grid(corners, 4) {
        let (phi, luminance) = (basis(omega), model.relative(omega));
        let weighted = phi / (luminance * luminance);
        matrix += DMat4::from_cols(weighted * phi.x, weighted * phi.y, weighted * phi.z, weighted * phi.w);
        right += weighted * luminance;
    }
    let [constant, along_x, along_y, curved] = (matrix.inverse() * right).to_array();
    let curved = curved / (radius * radius);
    Affine { constant: constant + curved, slope: (x * along_x + y * along_y) / radius - centre * curved }
}

/// max |L_h/L − 1| over directions in a triangle that are not those that it is fitted to.
fn deviation(model: &Model, corners: [DVec3; 3], luminance: &Affine) -> f64 {
    let at = |omega: DVec3| {
        ((luminance.constant + luminance.slope.dot(omega)) / model.relative(omega) - 1.0).abs()
    };
    grid(corners, 7).map(at).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::super::model::Kind;
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI, TAU};

    fn dome(kind: Kind, sun: DVec3) -> Dome {
        Dome::new(Model::new(kind, DVec3::new(0.1, -0.2, 0.9).normalize(), sun.normalize()))
    }

    #[test]
    fn simple_skies_are_exact_in_four_cells() {
        for (kind, horizontal, wall) in
            [(Kind::Uniform, PI, PI / 2.0), (Kind::Overcast, 7.0 / 9.0 * PI, PI / 6.0 + 4.0 / 9.0)]
        {
            let dome = dome(kind, DVec3::X);
            assert_eq!(dome.cells(), ROOTS);
            assert!(dome.error() < 1e-14 && (dome.horizontal() / horizontal - 1.0).abs() < 1e-14);
            let side = dome.model().up().any_orthonormal_vector();
            assert!((dome.unobstructed(dome.model().up()) / horizontal - 1.0).abs() < 1e-14);
            assert!((dome.unobstructed(side) / wall - 1.0).abs() < 1e-14, "{kind:?}");
            assert!(dome.unobstructed(-dome.model().up()).abs() < 1e-14);
        }
    }

    #[test]
    fn no_direction_is_wrong_by_more_than_is_told_and_no_irradiance() {
        for number in 1..=15 {
            let sun = DVec3::new(0.5, 0.3, 0.4);
            let dome = dome(Kind::General(number), sun);
            assert!(
                dome.error() < 5e-3 && dome.cells() < 10_000,
                "{number}: {} {}",
                dome.error(),
                dome.cells()
            );
            // ∫∫ L cos Z sin Z dZ dα by a midpoint rule.
            let up = dome.model().up();
            let (x, y) = up.any_orthonormal_pair();
            let n = 600;
            let mut sum = 0.0;
            for k in 0..n * n {
                let [polar, turn] = [k / n, k % n].map(|i| (f64::from(i) + 0.5) / f64::from(n));
                let (sine, cosine) = (FRAC_PI_2 * polar).sin_cos();
                let (across, along) = (TAU * turn).sin_cos();
                let omega = (x * along + y * across) * sine + up * cosine;
                sum += dome.model().relative(omega) * cosine * sine;
            }
            let expected = sum * (FRAC_PI_2 / f64::from(n)) * (TAU / f64::from(n));
            let off = (dome.horizontal() / expected - 1.0).abs();
            assert!(off < dome.error().max(1e-5), "{number}: {off}, told {}", dome.error());
        }
    }
}
