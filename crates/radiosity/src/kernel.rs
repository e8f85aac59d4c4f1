//! Room 4: K(x, y) = cosθ cosθ′ V(x, y) / (π r²), the Lambertian kernel of radiosity (paper, §2.2.2).

use crate::polygon::Polygon;
use crate::visibility::{RayCount, Visibility};
use fredholm::kernel::Kernel;
use glam::DVec3;
use std::f64::consts::PI;

/// A point of a surface and the normal there: what the kernel is a function of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The point, in metres.
    pub position: DVec3,
    /// The unit normal, on the side that emits.
    pub normal: DVec3,
}

impl SurfacePoint {
    /// The centroid of a polygon.
    pub fn centroid(polygon: &Polygon) -> Self {
        Self { position: polygon.centroid(), normal: polygon.normal() }
    }
}

/// The kernel, in m⁻²; the reflectance ρ is kept apart from it.
#[derive(Debug)]
pub struct Lambertian<'a> {
    visibility: &'a Visibility,
    /// The rays cast so far.
    pub rays: RayCount,
}

impl<'a> Lambertian<'a> {
    /// The kernel with V from `visibility`.
    pub fn new(visibility: &'a Visibility) -> Self {
        Self { visibility, rays: RayCount::default() }
    }

    fn visible(&self, x: DVec3, y: DVec3) -> bool {
        if !self.visibility.hides_anything() {
            return true;
        }
        self.rays.add(1);
        self.visibility.unoccluded(x, y)
    }
}

impl Kernel<SurfacePoint> for Lambertian<'_> {
    /// 0 at x = y, where a flat surface does not see itself; infinite where surfaces touch at an angle, since no
    /// rule may sample the kernel there.
    fn at(&self, x: &SurfacePoint, y: &SurfacePoint) -> f64 {
        let geometric = unoccluded(x, y);
        if geometric > 0.0 && !self.visible(x.position, y.position) { 0.0 } else { geometric }
    }

    fn is_symmetric(&self) -> bool {
        true
    }
}

/// cosθ cosθ′ / (π r²), V left out.
pub fn unoccluded(x: &SurfacePoint, y: &SurfacePoint) -> f64 {
    let between = y.position - x.position;
    let square = between.length_squared();
    if square == 0.0 {
        return if x.normal == y.normal { 0.0 } else { f64::INFINITY };
    }
    let (leaves, arrives) = (between.dot(x.normal), -between.dot(y.normal));
    if leaves <= 0.0 || arrives <= 0.0 { 0.0 } else { leaves * arrives / (PI * square * square) }
}
