//! A polygon in the scene's own unit: where a segment cuts it, decided in f64.

use crate::polygon::Polygon;
use glam::DVec3;
use wide::f64x8;

/// How near to a plane counts as on it, in units of the scene's extent (½ to 1 in its unit).
///
/// Rounding leaves 1e-16 of the extent on a point computed on a polygon and up to 1e-11 where the scene lies
/// 10⁵ extents from the origin; a lamp hangs 1e-4 under its ceiling. 1e-9 keeps its distance from both.
pub(super) const ON_PLANE: f64 = 1e-9;

/// A multiple of the rounding error of one signed volume, so that an edge belongs to its polygon.
const ON_EDGE: f64 = 1e-15;

/// Carries metres to the unit in which the scene is centred and its longest side is between ½ and 1.
///
/// All tolerances are constants in that unit, so that millimetres and kilometres behave the same, and
/// single precision keeps its digits. The scale is a power of two, which rounds nothing.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    centre: DVec3,
    scale: f64,
}

impl Frame {
    pub(super) fn around(polygons: &[Polygon]) -> Self {
        let vertices = || polygons.iter().flat_map(|p| p.vertices());
        let low = vertices().fold(DVec3::INFINITY, |m, &v| m.min(v));
        let high = vertices().fold(DVec3::NEG_INFINITY, |m, &v| m.max(v));
        let extent = (high - low).max_element();
        if extent > 0.0 && extent.is_finite() {
            Self { centre: 0.5 * (low + high), scale: (-extent.log2().ceil()).exp2() }
        } else {
            let centre = vertices().next().copied().unwrap_or_default();
            Self { centre, scale: 1.0 }
        }
    }

    /// A point, from metres.
    pub(super) fn point(&self, point: DVec3) -> DVec3 {
        (point - self.centre) * self.scale
    }

    /// The coordinates along an axis of eight points, as [`point`](Self::point) has them.
    #[inline(always)]
    pub(super) fn along(&self, axis: usize, points: [f64; 8]) -> f64x8 {
        (f64x8::new(points) - f64x8::splat(self.centre[axis])) * f64x8::splat(self.scale)
    }

    /// A length, to metres.
    pub(super) fn metres(&self, length: f64) -> f64 {
        length / self.scale
    }
}

/// {x : normal·x = offset}, in the scene's unit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    normal: DVec3,
    pub(super) offset: f64,
}

impl Plane {
    pub(super) const NONE: Self = Self { normal: DVec3::ZERO, offset: 0.0 };

    /// The signed distance of a point, positive in front.
    #[inline(always)]
    fn height_of(&self, point: DVec3) -> f64 {
        self.normal.dot(point) - self.offset
    }

    /// Whether a point is on it, no farther than [`ON_PLANE`].
    #[inline(always)]
    pub(super) fn is_at(&self, point: DVec3) -> bool {
        self.height_of(point).abs() <= ON_PLANE
    }

    /// The heights of s and t, if these are on different sides, both farther than [`ON_PLANE`].
    #[inline(always)]
    pub(super) fn parts(&self, s: DVec3, t: DVec3) -> Option<[f64; 2]> {
        let (above, below) = (self.height_of(s), self.height_of(t));
        let apart = above.abs() > ON_PLANE && below.abs() > ON_PLANE && (above > 0.0) != (below > 0.0);
        apart.then_some([above, below])
    }
}

/// A [`Polygon`] in the scene's unit, with its plane {x : normal·x = offset}.
#[derive(Clone, Debug)]
pub(super) struct Facet {
    vertices: [DVec3; 4],
    sides: usize,
    pub(super) normal: DVec3,
    pub(super) offset: f64,
}

impl Facet {
    pub(super) fn new(polygon: &Polygon, frame: &Frame) -> Self {
        let corners = polygon.vertices();
        let vertices = std::array::from_fn(|k| frame.point(corners[k.min(corners.len() - 1)]));
        let (sides, normal) = (corners.len(), polygon.normal());
        // The mean over the vertices halves what a quadrilateral from a file is off its plane.
        let offset = normal.dot(vertices[..sides].iter().sum::<DVec3>()) / sides as f64;
        Self { vertices, sides, normal, offset }
    }

    /// Four vertices: a triangle repeats its last.
    pub(super) fn corners(&self) -> &[DVec3; 4] {
        &self.vertices
    }

    pub(super) fn vertices(&self) -> &[DVec3] {
        &self.vertices[..self.sides]
    }

    pub(super) fn centroid(&self) -> DVec3 {
        self.vertices().iter().sum::<DVec3>() / self.sides as f64
    }

    pub(super) fn plane(&self) -> Plane {
        Plane { normal: self.normal, offset: self.offset }
    }

    /// The signed distance of a point to the plane, positive in front.
    pub(super) fn height_of(&self, point: DVec3) -> f64 {
        self.plane().height_of(point)
    }

    /// The parameter in (0, 1) at which the segment from s to t goes through the polygon, edges included.
    ///
    /// Its plane must have s and t on different sides, both farther than [`ON_PLANE`]: so a polygon neither
    /// blocks a segment that ends on it nor one that runs in its plane, at whatever angle.
    pub(super) fn cut(&self, s: DVec3, t: DVec3) -> Option<f64> {
        let [above, below] = self.plane().parts(s, t)?;
        self.encloses(s, (s - t) * above.signum()).then(|| above / (above - below))
    }

    /// Whether it cuts every segment between a point of a and one of b.
    pub(super) fn separates(&self, a: &[DVec3], b: &[DVec3]) -> bool {
        a.iter().all(|&s| b.iter().all(|&t| self.cut(s, t).is_some()))
    }

    /// Whether the line through s along `up` passes all edges on the inner side.
    ///
    /// The signed volume up·(a × b) changes its sign exactly when a and b change places, so a line between two
    /// polygons that share an edge is inside of one of them whatever the rounding.
    fn encloses(&self, s: DVec3, up: DVec3) -> bool {
        let corners = self.vertices.map(|v| v - s);
        let reach = corners.iter().fold(0.0, |m: f64, v| m.max(v.length_squared()));
        let error = ON_EDGE * reach * up.abs().element_sum();
        (0..self.sides).all(|k| {
            let next = if k + 1 == self.sides { 0 } else { k + 1 };
            up.dot(corners[k].cross(corners[next])) >= -error
        })
    }
}
