//! An input polygon in patches of one size: s × t of a quadrilateral, k² of a triangle.

use super::Strip;
use crate::polygon::Polygon;
use glam::{DVec2, DVec3};

/// How an input polygon is cut: a quadrilateral in s × t, a triangle into k² similar ones.
#[derive(Clone, Copy, Debug)]
pub(super) enum Divisions {
    Quadrilateral(usize, usize),
    Triangle(usize),
}

impl Divisions {
    pub fn of(polygon: &Polygon, size: f64) -> Self {
        // An edge a rounding error longer than a whole number of sizes is not worth another row.
        let pieces = |length: f64| ((length / size - 1e-9).ceil()).max(1.0) as usize;
        match *polygon.vertices() {
            [a, b, c, d] => Self::Quadrilateral(
                pieces(a.distance(b).max(c.distance(d))),
                pieces(b.distance(c).max(d.distance(a))),
            ),
            _ => Self::Triangle(pieces(polygon.diameter())),
        }
    }

    pub fn count(self) -> f64 {
        match self {
            Self::Quadrilateral(s, t) => s as f64 * t as f64,
            Self::Triangle(k) => (k as f64).powi(2),
        }
    }
}

/// One input polygon and its patches, numbered from `first` row by row.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    pub first: usize,
    pub divisions: Divisions,
    pub whole: Polygon,
}

impl Grid {
    pub fn patches(&self) -> Vec<Polygon> {
        match self.divisions {
            Divisions::Quadrilateral(ns, nt) => {
                let at = |i: usize, j: usize| self.whole.point(i as f64 / ns as f64, j as f64 / nt as f64);
                (0..nt)
                    .flat_map(|j| (0..ns).map(move |i| (i, j)))
                    .map(|(i, j)| {
                        Polygon::quadrilateral(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1))
                    })
                    .collect()
            }
            Divisions::Triangle(k) => {
                let at = |i: usize, j: usize| self.lattice_point(i, j, k);
                let mut patches = Vec::with_capacity(k * k);
                for j in 0..k {
                    for i in 0..k - j {
                        patches.push(Polygon::triangle(at(i, j), at(i + 1, j), at(i, j + 1)));
                        if i + j + 1 < k {
                            patches.push(Polygon::triangle(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)));
                        }
                    }
                }
                patches
            }
        }
    }

    /// The rows of patches, cut to eight patches at most.
    pub fn strips(&self) -> Vec<Strip> {
        let mut first = self.first;
        let mut strip = |corners: [DVec3; 4], patches: usize| {
            let [a, b, c, d] = corners;
            let polygon =
                if c == d { Polygon::triangle(a, b, c) } else { Polygon::quadrilateral(a, b, c, d) };
            first += patches;
            Strip { patches: first - patches..first, polygon }
        };
        let mut strips = Vec::new();
        match self.divisions {
            Divisions::Quadrilateral(ns, nt) => {
                let at = |i: usize, j: usize| self.whole.point(i as f64 / ns as f64, j as f64 / nt as f64);
                for (j, i) in (0..nt).flat_map(|j| (0..ns).step_by(8).map(move |i| (j, i))) {
                    let end = (i + 8).min(ns);
                    strips.push(strip([at(i, j), at(end, j), at(end, j + 1), at(i, j + 1)], end - i));
                }
            }
            Divisions::Triangle(k) => {
                let at = |i: usize, j: usize| self.lattice_point(i, j, k);
                for (j, i) in (0..k).flat_map(|j| (0..k - j).step_by(4).map(move |i| (j, i))) {
                    // Upright and hanging triangles by turns; the last of a row stands upright.
                    let end = (i + 4).min(k - j);
                    let last = end == k - j;
                    let top = if last { end - 1 } else { end };
                    let corners = [at(i, j), at(end, j), at(top, j + 1), at(i, j + 1)];
                    strips.push(strip(corners, 2 * (end - i) - usize::from(last)));
                }
            }
        }
        strips
    }

    /// Point (i, j) of the lattice that cuts a triangle's edges in k.
    fn lattice_point(&self, i: usize, j: usize, k: usize) -> DVec3 {
        let v = self.whole.vertices();
        v[0] + (v[1] - v[0]) * (i as f64 / k as f64) + (v[2] - v[0]) * (j as f64 / k as f64)
    }

    pub fn patch_at(&self, point: DVec3) -> usize {
        match self.divisions {
            Divisions::Quadrilateral(ns, nt) => {
                let st = inverse_bilinear(&self.whole, point);
                self.first + cell(st.y, nt) * ns + cell(st.x, ns)
            }
            Divisions::Triangle(k) => {
                let st = barycentric(&self.whole, point);
                let j = cell(st.y, k);
                let i = cell(st.x, k).min(k - 1 - j);
                let upper = st.x * k as f64 - i as f64 + st.y * k as f64 - j as f64 > 1.0 && i + j + 1 < k;
                // Row j' has 2(k − j') − 1 triangles; the rows before j have j(2k − j).
                self.first + j * (2 * k - j) + 2 * i + usize::from(upper)
            }
        }
    }
}

/// Which of `n` equal cells of [0,1] holds x; the nearest for an x outside.
fn cell(x: f64, n: usize) -> usize {
    ((x * n as f64).max(0.0) as usize).min(n - 1)
}

/// Two orthonormal directions in the plane of a polygon.
fn plane_axes(polygon: &Polygon) -> (DVec3, DVec3) {
    let s = (polygon.vertices()[1] - polygon.vertices()[0]).normalize();
    (s, polygon.normal().cross(s))
}

/// (s, t) with point = a + s (b − a) + t (c − a).
fn barycentric(triangle: &Polygon, point: DVec3) -> DVec2 {
    let v = triangle.vertices();
    let doubled = 2.0 * triangle.area();
    let share = |p: DVec3, q: DVec3| p.cross(q).dot(triangle.normal()) / doubled;
    DVec2::new(share(point - v[0], v[2] - v[0]), share(v[1] - v[0], point - v[0]))
}

/// (s, t) with point = bilinear(s, t) on a planar quadrilateral, by Newton's method in its plane: the map is
/// affine up to the twist a − b + c − d, so few steps reach rounding on any convex quadrilateral.
pub(crate) fn inverse_bilinear(quadrilateral: &Polygon, point: DVec3) -> DVec2 {
    let &[a, b, c, d] = quadrilateral.vertices() else { return barycentric(quadrilateral, point) };
    let (x, y) = plane_axes(quadrilateral);
    let flat = |p: DVec3| DVec2::new((p - a).dot(x), (p - a).dot(y));
    let (p, along, across, twist) = (flat(point), flat(b), flat(d), flat(c) - flat(b) - flat(d));
    let mut st = DVec2::splat(0.5);
    for _ in 0..6 {
        let residual = p - (along * st.x + across * st.y + twist * (st.x * st.y));
        let (ds, dt) = (along + twist * st.y, across + twist * st.x);
        let determinant = ds.perp_dot(dt);
        let step = DVec2::new(residual.perp_dot(dt), ds.perp_dot(residual)) / determinant;
        st += step;
        // A parallelogram has no twist: its first step arrives.
        if step.length_squared() * twist.length_squared() < 1e-28 * determinant.abs() {
            break;
        }
    }
    st
}
