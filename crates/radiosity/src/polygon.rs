//! Planar convex polygons of three or four vertices: what scenes, patches and occluders are made of.

mod normals;

pub use normals::NormalFault;

use glam::DVec3;

/// A planar convex triangle or quadrilateral, in metres.
///
/// It has a front: the side from which its vertices run counter-clockwise. Only the front emits and reflects;
/// both sides block light. In pictures it may stand for a piece of a curved surface: [`Polygon::with_normals`].
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    vertices: [DVec3; 4],
    sides: u8,
    normal: DVec3,
    area: f64,
    centroid: DVec3,
    /// Unit normals at the vertices of the curved surface that it stands for, if it does.
    normals: Option<Box<[DVec3; 4]>>,
}

impl Polygon {
    /// The triangle abc.
    pub fn triangle(a: DVec3, b: DVec3, c: DVec3) -> Self {
        Self::new([a, b, c, c], 3)
    }

    /// The quadrilateral abcd, which the caller knows to be planar and convex.
    pub fn quadrilateral(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Self {
        Self::new([a, b, c, d], 4)
    }

    fn new(vertices: [DVec3; 4], sides: u8) -> Self {
        let [a, b, c, d] = vertices;
        // The two triangles abc and acd; for a triangle d = c and the second is empty.
        let (first, second) = ((b - a).cross(c - a), (c - a).cross(d - a));
        let doubled = first + second;
        let normal = doubled.normalize_or_zero();
        let (w1, w2) = (first.dot(normal), second.dot(normal));
        let centroid = (w1 * (a + b + c) + w2 * (a + c + d)) / (3.0 * (w1 + w2));
        Self { vertices, sides, normal, area: 0.5 * doubled.length(), centroid, normals: None }
    }

    /// The vertices, counter-clockwise seen from the front.
    pub fn vertices(&self) -> &[DVec3] {
        &self.vertices[..usize::from(self.sides)]
    }

    /// The unit normal, on the side of the front; zero when the area is.
    pub fn normal(&self) -> DVec3 {
        self.normal
    }

    /// The area, in m².
    pub fn area(&self) -> f64 {
        self.area
    }

    /// The centre of mass.
    pub fn centroid(&self) -> DVec3 {
        self.centroid
    }

    /// The signed distance of a point to the plane, positive in front.
    pub fn height_of(&self, point: DVec3) -> f64 {
        (point - self.vertices[0]).dot(self.normal)
    }

    /// How far a point of its plane is beyond one of its edges, in metres; negative for a point inside.
    pub fn distance_outside(&self, point: DVec3) -> f64 {
        let v = self.vertices();
        let beyond = |k: usize| {
            let (a, b) = (v[k], v[(k + 1) % v.len()]);
            (point - a).cross(b - a).dot(self.normal) / a.distance(b)
        };
        (0..v.len()).map(beyond).fold(f64::NEG_INFINITY, f64::max)
    }

    /// The largest distance between two vertices.
    pub fn diameter(&self) -> f64 {
        let v = self.vertices();
        (0..v.len()).flat_map(|i| (0..i).map(move |j| v[i].distance(v[j]))).fold(0.0, f64::max)
    }

    /// The point at (s, t) ∈ \[0,1\]²: bilinear on a quadrilateral, the unit square folded onto a triangle
    /// (so that equal areas of the square are equal areas of the triangle).
    pub fn point(&self, s: f64, t: f64) -> DVec3 {
        let [a, b, c, d] = self.vertices;
        if self.sides == 4 {
            a * ((1.0 - s) * (1.0 - t)) + b * (s * (1.0 - t)) + c * (s * t) + d * ((1.0 - s) * t)
        } else {
            let root = s.sqrt();
            a * (1.0 - root) + b * (root * (1.0 - t)) + c * (root * t)
        }
    }

    /// dA/(ds dt) of [`Self::point`], in m²: the area that a unit of the square is stretched to.
    pub fn density(&self, s: f64, t: f64) -> f64 {
        let [a, b, c, d] = self.vertices;
        if self.sides == 3 {
            return self.area;
        }
        let along = (b - a) * (1.0 - t) + (c - d) * t;
        let across = (d - a) * (1.0 - s) + (c - b) * s;
        along.cross(across).dot(self.normal)
    }

    /// The four similar parts between its corners, the middles of its edges and, in a quadrilateral, its middle.
    pub fn quarters(&self) -> [Self; 4] {
        let [a, b, c, d] = self.vertices;
        if self.sides == 3 {
            let (ab, bc, ca) = (a.midpoint(b), b.midpoint(c), c.midpoint(a));
            return [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
                .map(|[p, q, r]| Self::triangle(p, q, r));
        }
        let (ab, bc, cd, da) = (a.midpoint(b), b.midpoint(c), c.midpoint(d), d.midpoint(a));
        let middle = ab.midpoint(cd);
        [[a, ab, middle, da], [ab, b, bc, middle], [middle, bc, c, cd], [da, middle, cd, d]]
            .map(|[p, q, r, s]| Self::quadrilateral(p, q, r, s))
    }

    /// The part in front of the plane of `other`, in pieces; the whole when no corner is behind it.
    pub fn in_front_of(&self, other: &Self) -> Vec<Self> {
        if self.vertices().iter().all(|v| other.height_of(*v) >= 0.0) {
            return vec![self.clone()];
        }
        // Triangle by triangle: the corners of a quadrilateral that is in the plane but for rounding may be before
        // and behind it by turns.
        let pieces = self.triangles().filter_map(|corners| in_front(corners, other));
        pieces.filter(|piece| piece.area > 0.0).collect()
    }

    /// The triangles that it is made of: one or two.
    pub fn triangles(&self) -> impl Iterator<Item = [DVec3; 3]> + use<> {
        let [a, b, c, d] = self.vertices;
        [[a, b, c], [a, c, d]].into_iter().take(usize::from(self.sides) - 2)
    }
}

/// The part of a triangle in front of the plane of `other`.
fn in_front(corners: [DVec3; 3], other: &Polygon) -> Option<Polygon> {
    let mut kept = [DVec3::ZERO; 4];
    let mut count = 0;
    let mut keep = |point| {
        kept[count] = point;
        count += 1;
    };
    for k in 0..3 {
        let (p, q) = (corners[k], corners[(k + 1) % 3]);
        let (h, h_next) = (other.height_of(p), other.height_of(q));
        if h >= 0.0 {
            keep(p);
        }
        if (h < 0.0 && h_next > 0.0) || (h > 0.0 && h_next < 0.0) {
            keep(p.lerp(q, h / (h - h_next)));
        }
    }
    let [a, b, c, d] = kept;
    match count {
        3 => Some(Polygon::triangle(a, b, c)),
        4 => Some(Polygon::quadrilateral(a, b, c, d)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_trapezoid_has_its_area_and_centre_of_mass() {
        // Corners (0,0) (4,0) (2,2) (0,2): area 6, centroid (14/9, 8/9).
        let p =
            Polygon::quadrilateral(DVec3::ZERO, 4.0 * DVec3::X, DVec3::new(2.0, 2.0, 0.0), 2.0 * DVec3::Y);
        assert!((p.area() - 6.0).abs() < 1e-15);
        assert!(p.centroid().distance(DVec3::new(14.0 / 9.0, 8.0 / 9.0, 0.0)) < 1e-15);
        assert_eq!(p.normal(), DVec3::Z);
        assert!((p.height_of(DVec3::new(9.0, 9.0, -2.0)) + 2.0).abs() < 1e-15);
        assert!((p.diameter() - 20_f64.sqrt()).abs() < 1e-15);
    }

    /// A trapezoid in the plane z = 0 and a triangle across it.
    fn shapes() -> [Polygon; 2] {
        let p = |x, y| DVec3::new(x, y, 0.0);
        [
            Polygon::quadrilateral(p(0.0, 0.0), p(4.0, 0.0), p(2.0, 2.0), p(0.0, 2.0)),
            Polygon::triangle(p(0.0, 0.0), p(3.0, 1.0), p(1.0, 4.0)),
        ]
    }

    #[test]
    fn the_density_integrates_to_the_area_and_the_centroid() {
        let n = 200;
        let cells = || {
            (0..n * n).map(|k| [(0.5 + f64::from(k % n)), (0.5 + f64::from(k / n))].map(|x| x / f64::from(n)))
        };
        for shape in shapes() {
            let mass = |weigh: &dyn Fn(DVec3) -> f64| -> f64 {
                cells().map(|[s, t]| weigh(shape.point(s, t)) * shape.density(s, t)).sum::<f64>()
                    / f64::from(n * n)
            };
            assert!((mass(&|_| 1.0) / shape.area() - 1.0).abs() < 1e-12);
            assert!((mass(&|x| x.x) / shape.area() - shape.centroid().x).abs() < 1e-4);
        }
    }

    #[test]
    fn quarters_cover_the_whole() {
        for shape in shapes() {
            let quarters = shape.quarters();
            assert!((quarters.iter().map(Polygon::area).sum::<f64>() - shape.area()).abs() < 1e-14);
            let moment: DVec3 = quarters.iter().map(|q| q.centroid() * q.area()).sum();
            assert!((moment / shape.area()).distance(shape.centroid()) < 1e-14);
            assert!(quarters.iter().all(|q| q.normal() == DVec3::Z));
        }
    }

    #[test]
    fn a_plane_cuts_a_polygon_in_two_that_add_up() {
        let p = |x, y, z| DVec3::new(x, y, z);
        for shape in shapes() {
            for x in [-1.0, 0.5, 1.5, 2.0, 2.5, 9.0] {
                let plane = Polygon::triangle(p(x, 0.0, 0.0), p(x, 1.0, 0.3), p(x - 0.5, 0.0, 1.0));
                let back = Polygon::triangle(p(x, 0.0, 0.0), p(x - 0.5, 0.0, 1.0), p(x, 1.0, 0.3));
                let area = |side: &Polygon| shape.in_front_of(side).iter().map(Polygon::area).sum::<f64>();
                assert!((area(&plane) + area(&back) - shape.area()).abs() < 1e-14, "at {x}");
                assert!(
                    shape.in_front_of(&plane).iter().all(|piece| plane.height_of(piece.centroid()) > 0.0)
                );
            }
        }
    }

    #[test]
    fn corners_before_and_behind_a_plane_by_turns_are_cut() {
        let p = |x, y, z| DVec3::new(x, y, z);
        let plane = Polygon::triangle(DVec3::ZERO, DVec3::X, DVec3::Y);
        for off in [1e-9, -1e-9, 1e-15] {
            let saddle = Polygon::quadrilateral(
                p(0.0, 0.0, off),
                p(1.0, 0.0, -off),
                p(1.0, 1.0, off),
                p(0.0, 1.0, -off),
            );
            let area: f64 = saddle.in_front_of(&plane).iter().map(Polygon::area).sum();
            // Each of the two triangles has one corner on the other side than its others, which cuts off a quarter.
            let expected = if off > 0.0 { 0.75 } else { 0.25 };
            assert!((area - expected).abs() < 1e-6, "{area}");
        }
    }

    #[test]
    fn a_triangle_is_sampled_uniformly() {
        let p = Polygon::triangle(DVec3::ZERO, DVec3::X, DVec3::Y);
        let n = 100;
        let mean = (0..n * n)
            .map(|k| {
                p.point((0.5 + f64::from(k % n)) / f64::from(n), (0.5 + f64::from(k / n)) / f64::from(n))
            })
            .sum::<DVec3>()
            / f64::from(n * n);
        assert!(mean.distance(p.centroid()) < 1e-4);
    }
}
