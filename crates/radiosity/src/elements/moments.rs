//! M_b(x) = ∫_{P_j} K(x, y) φ_b(y) dy: what a point receives from each basis function of a patch that nothing hides.

use super::degree::{Local, MOST};
use super::near::Polar;
use super::rules::{Rules, points};
use super::space::Space;
use crate::form_factor::exchange::{Side, side_of};
use crate::form_factor::lambert::point_to_polygon;
use crate::kernel::SurfacePoint;
use crate::polygon::Polygon;
use glam::DVec3;
use std::f64::consts::PI;

/// The moments of the elements of a space.
#[derive(Debug)]
pub struct Moments<'a> {
    space: &'a Space<'a>,
    rules: Rules,
    polar: Polar,
    tolerance: f64,
}

/// The part of a patch that is in front of another's plane.
#[derive(Clone, Debug)]
pub enum Front {
    /// None of it.
    Nothing,
    /// All of it.
    Whole,
    /// Some of it, cut into convex pieces.
    Pieces(Vec<Polygon>),
}

impl Front {
    /// The part of `patch` in front of `viewer`.
    pub fn of(patch: &Polygon, viewer: &Polygon) -> Self {
        match side_of(viewer, patch) {
            Side::Behind => Self::Nothing,
            Side::Before => Self::Whole,
            Side::Across => Self::Pieces(patch.in_front_of(viewer)),
        }
    }
}

impl<'a> Moments<'a> {
    /// The moments with an error of about `tolerance`, relative to the form factor from the point to the patch.
    pub fn new(space: &'a Space<'a>, tolerance: f64) -> Self {
        Self {
            space,
            rules: Rules::new(space.degree()),
            polar: Polar::new(tolerance, space.degree().order()),
            tolerance,
        }
    }

    /// The space.
    pub fn space(&self) -> &'a Space<'a> {
        self.space
    }

    /// The error that was asked for.
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    pub(super) fn rules(&self) -> &Rules {
        &self.rules
    }

    /// The moments of element j, of which `front` is in front of the plane through x.
    ///
    /// Their sum is the form factor to rounding: it is Lambert's formula, ∫ K φ_b = φ_b(y₀) ∫ K + ∫ K (φ_b − φ_b(y₀)), and the
    /// quadrature's error is only in how it is shared out.
    pub fn at(&self, x: &SurfacePoint, j: usize, front: &Front) -> Local {
        let polygon = &self.space.polygons()[j];
        let factor = point_to_polygon(x.position, x.normal, polygon);
        // Below that the point is in the plane of the patch, or beside it, but for rounding.
        if factor <= ROUNDING || matches!(front, Front::Nothing) {
            return [0.0; MOST];
        }
        if self.space.degree().order() == 0 {
            return self.shared(j, factor, [0.0; MOST]);
        }
        let moments = match front {
            Front::Pieces(pieces) => self.near(x, j, pieces),
            _ => self.whole(x, j),
        };
        self.shared(j, factor, moments)
    }

    /// The moments with what they miss of the form factor given to the values in the middle.
    fn shared(&self, j: usize, factor: f64, mut moments: Local) -> Local {
        let middle = self.space.values(j, self.space.polygons()[j].centroid());
        let missing = factor - moments.iter().sum::<f64>();
        moments.iter_mut().zip(middle).for_each(|(moment, value)| *moment += missing * value);
        moments
    }

    fn whole(&self, x: &SurfacePoint, j: usize) -> Local {
        let polygon = &self.space.polygons()[j];
        let distance = x.position.distance(polygon.centroid()) / self.space.diameters[j];
        let Some(n) = points(distance, self.space.degree().order(), self.tolerance) else {
            return self.near(x, j, std::slice::from_ref(polygon));
        };
        let mut moments = [0.0; MOST];
        for node in self.rules.nodes(n, polygon) {
            let k = node.weight * kernel(x.normal, polygon.normal(), node.at - x.position);
            moments.iter_mut().zip(node.values).for_each(|(moment, value)| *moment += k * value);
        }
        moments
    }

    fn near(&self, x: &SurfacePoint, j: usize, pieces: &[Polygon]) -> Local {
        let reference = self.space.reference(&self.space.polygons()[j]);
        let mut moments = [0.0; MOST];
        for piece in pieces {
            self.polar.visit(x.position, piece, |from_x, weight| {
                let k = weight * kernel(x.normal, piece.normal(), from_x);
                let monomials = (reference.monomials)(self.space.place(j, x.position + from_x));
                moments.iter_mut().zip(monomials).for_each(|(moment, value)| *moment += k * value);
            });
        }
        reference.combined(&moments)
    }
}

/// A form factor that is rounding: 10⁻¹⁶ of the angles that it is made of.
const ROUNDING: f64 = 1e-15;

/// cosθ cosθ′/(π r²) between points that are in front of each other, or are behind by rounding.
pub(super) fn kernel(leaves: DVec3, arrives: DVec3, between: DVec3) -> f64 {
    let square = between.length_squared();
    -between.dot(leaves) * between.dot(arrives) / (PI * square * square)
}

/// ∫_P K(x, y) g(y) dy of any smooth g, over the part of a polygon in front of x, by the rule for near points.
///
/// `polar` has the error: it holds where g is as smooth on P as a polynomial of low degree.
pub fn integral(polar: &Polar, x: &SurfacePoint, polygon: &Polygon, g: impl Fn(DVec3) -> f64) -> f64 {
    if point_to_polygon(x.position, x.normal, polygon) <= ROUNDING {
        return 0.0;
    }
    let (u, v) = x.normal.any_orthonormal_pair();
    let plane = Polygon::triangle(x.position, x.position + u, x.position + v);
    let pieces = match Front::of(polygon, &plane) {
        Front::Nothing => return 0.0,
        Front::Whole => vec![polygon.clone()],
        Front::Pieces(pieces) => pieces,
    };
    let mut sum = 0.0;
    for piece in &pieces {
        polar.visit(x.position, piece, |from_x, weight| {
            sum += weight * kernel(x.normal, piece.normal(), from_x) * g(x.position + from_x);
        });
    }
    sum
}
