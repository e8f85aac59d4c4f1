//! Planar convex polygons of three or four vertices: what scenes, patches and occluders are made of.

use glam::DVec3;

/// A planar convex triangle or quadrilateral, in metres.
///
/// It has a front: the side from which its vertices run counter-clockwise. Only the front emits and reflects;
/// both sides block light.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    vertices: [DVec3; 4],
    sides: u8,
    normal: DVec3,
    area: f64,
    centroid: DVec3,
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
        Self { vertices, sides, normal, area: 0.5 * doubled.length(), centroid }
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

    /// The largest distance between two vertices.
    pub fn diameter(&self) -> f64 {
        let v = self.vertices();
        (0..v.len()).flat_map(|i| (0..i).map(move |j| v[i].distance(v[j]))).fold(0.0, f64::max)
    }

    /// The point at (s, t) ∈ [0,1]²: bilinear on a quadrilateral, the unit square folded onto a triangle
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

    /// The triangles that it is made of: one or two.
    pub fn triangles(&self) -> impl Iterator<Item = [DVec3; 3]> + use<> {
        let [a, b, c, d] = self.vertices;
        [[a, b, c], [a, c, d]].into_iter().take(usize::from(self.sides) - 2)
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
