//! Rooms and random numbers for the tests and benchmarks of visibility.
#![allow(dead_code, missing_docs)]

use glam::DVec3;
use radiosity::polygon::Polygon;

/// Steele, Lea and Flood's SplitMix64: reproducible, and enough for sampling.
pub struct Random(pub u64);

impl Random {
    /// Uniform in [0, 1).
    pub fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn below(&mut self, n: usize) -> usize {
        (self.number() * n as f64) as usize
    }

    /// Uniform in [−1, 1)³.
    pub fn vector(&mut self) -> DVec3 {
        DVec3::from_array(std::array::from_fn(|_| 2.0 * self.number() - 1.0))
    }

    pub fn direction(&mut self) -> DVec3 {
        loop {
            let v = self.vector();
            if (1e-4..1.0).contains(&v.length_squared()) {
                return v.normalize();
            }
        }
    }

    /// A point on a polygon.
    pub fn on(&mut self, polygon: &Polygon) -> DVec3 {
        polygon.point(self.number(), self.number())
    }

    /// A point on one of the polygons, each as likely.
    pub fn on_any(&mut self, polygons: &[Polygon]) -> DVec3 {
        let polygon = &polygons[self.below(polygons.len())];
        self.on(polygon)
    }
}

/// Uniformly on the polygons, by area.
pub fn points(polygons: &[Polygon], count: usize, random: &mut Random) -> Vec<DVec3> {
    let sums: Vec<f64> = polygons
        .iter()
        .scan(0.0, |sum, p| {
            *sum += p.area();
            Some(*sum)
        })
        .collect();
    let total = sums[sums.len() - 1];
    (0..count)
        .map(|_| {
            let x = random.number() * total;
            random.on(&polygons[sums.partition_point(|&s| s < x).min(sums.len() - 1)])
        })
        .collect()
}

fn quadrilateral(v: [[f64; 3]; 4]) -> Polygon {
    let [a, b, c, d] = v.map(|p| 0.001 * DVec3::from_array(p));
    Polygon::quadrilateral(a, b, c, d)
}

/// The measured Cornell box, open to the viewer, with the lamp 0.1 mm below the ceiling: walls first (floor, ceiling,
/// back, right, the two halves of the left), then the lamp, the short block, the tall block.
pub fn cornell() -> Vec<Polygon> {
    let mut polygons = vec![
        quadrilateral([[552.8, 0., 0.], [0., 0., 0.], [0., 0., 559.2], [549.6, 0., 559.2]]),
        quadrilateral([[556., 548.8, 0.], [556., 548.8, 559.2], [0., 548.8, 559.2], [0., 548.8, 0.]]),
        quadrilateral([[549.6, 0., 559.2], [0., 0., 559.2], [0., 548.8, 559.2], [556., 548.8, 559.2]]),
        quadrilateral([[0., 0., 559.2], [0., 0., 0.], [0., 548.8, 0.], [0., 548.8, 559.2]]),
    ];
    // The left wall of the data is not planar.
    let left = [[552.8, 0., 0.], [549.6, 0., 559.2], [556., 548.8, 559.2], [556., 548.8, 0.]];
    let [a, b, c, d] = left.map(|p: [f64; 3]| 0.001 * DVec3::from_array(p));
    polygons.extend([Polygon::triangle(a, b, c), Polygon::triangle(a, c, d)]);
    polygons.push(quadrilateral([
        [343., 548.7, 227.],
        [343., 548.7, 332.],
        [213., 548.7, 332.],
        [213., 548.7, 227.],
    ]));
    polygons.extend(block(165., [[130., 65.], [82., 225.], [240., 272.], [290., 114.]]));
    polygons.extend(block(330., [[423., 247.], [265., 296.], [314., 456.], [472., 406.]]));
    polygons
}

/// The top and the sides of a block on the floor, from its height and the corners of its top, in millimetres.
fn block(height: f64, corners: [[f64; 2]; 4]) -> Vec<Polygon> {
    let at = |k: usize, y: f64| [corners[k % 4][0], y, corners[k % 4][1]];
    let top = std::array::from_fn(|k| at(k, height));
    let side = |k| quadrilateral([at(k + 1, 0.), at(k + 1, height), at(k, height), at(k, 0.)]);
    std::iter::once(quadrilateral(top)).chain((0..4).map(side)).collect()
}

/// The walls of the box [0, side]³, each cut into n × n squares, seen from within.
pub fn cube(side: f64, n: usize) -> Vec<Polygon> {
    let mut polygons = Vec::new();
    for (axis, far) in (0..3).flat_map(|axis| [(axis, false), (axis, true)]) {
        let point = |i: usize, j: usize| {
            let (u, v) = (side * i as f64 / n as f64, side * j as f64 / n as f64);
            let mut p = DVec3::ZERO;
            p[axis] = if far { side } else { 0.0 };
            p[(axis + 1) % 3] = if far { v } else { u };
            p[(axis + 2) % 3] = if far { u } else { v };
            p
        };
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            polygons.push(Polygon::quadrilateral(
                point(i, j),
                point(i + 1, j),
                point(i + 1, j + 1),
                point(i, j + 1),
            ));
        }
    }
    polygons
}

/// A cube of side 5 m with `balls`² bumpy balls in its air,
/// 2 · 23 · 48 = 2208 triangles each.
pub fn furnished(balls: usize) -> Vec<Polygon> {
    let mut random = Random(7);
    let mut polygons = cube(5.0, 1);
    for k in 0..balls * balls {
        let place = |x: usize| 5.0 * (x as f64 + 0.5) / balls as f64;
        let height = 0.6 + 3.5 * random.number();
        let centre = DVec3::new(place(k % balls), height, place(k / balls));
        polygons.extend(ball(centre, 0.5, 24, 48));
    }
    polygons
}

/// A closed bumpy ball of 2 · rows · columns triangles, less those that vanish at the poles.
pub fn ball(centre: DVec3, radius: f64, rows: usize, columns: usize) -> Vec<Polygon> {
    use std::f64::consts::{PI, TAU};
    let vertex = |i: usize, j: usize| {
        let (theta, phi) = (PI * i as f64 / rows as f64, TAU * (j % columns) as f64 / columns as f64);
        if i == 0 || i == rows {
            return centre + DVec3::Y * if i == 0 { radius } else { -radius };
        }
        let bump = 1.0 + 0.2 * (3.0 * phi).cos() * theta.sin().powi(2) * (4.0 * theta).sin();
        let direction = DVec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin());
        centre + radius * bump * direction
    };
    let mut triangles = Vec::new();
    for (i, j) in (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j))) {
        let (a, b, c, d) = (vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1));
        if i > 0 {
            triangles.push(Polygon::triangle(a, d, c));
        }
        if i + 1 < rows {
            triangles.push(Polygon::triangle(a, c, b));
        }
    }
    triangles
}

/// A polygon's part at column i, row j of an n × n grid.
pub fn cell(polygon: &Polygon, n: usize, i: usize, j: usize) -> Polygon {
    let at = |i: usize, j: usize| polygon.point(i as f64 / n as f64, j as f64 / n as f64);
    let corners = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
    if polygon.vertices().len() == 4 {
        let [a, b, c, d] = corners;
        Polygon::quadrilateral(a, b, c, d)
    } else {
        let [a, b, c] = std::array::from_fn(|k| polygon.vertices()[k]);
        let part = |i: usize, j: usize| a + (b - a) * (i as f64 / n as f64) + (c - a) * (j as f64 / n as f64);
        // The cells above the diagonal are folded onto the upward triangles of the rows below.
        if i + j < n {
            Polygon::triangle(part(i, j), part(i + 1, j), part(i, j + 1))
        } else {
            let (i, j) = (n - 1 - i, n - j);
            Polygon::triangle(part(i + 1, j - 1), part(i + 1, j), part(i, j))
        }
    }
}

/// Random pairs of cells of the polygons' n × n grids that are wholly in front of each other.
pub fn facing_pairs(polygons: &[Polygon], n: usize, count: usize) -> Vec<(Polygon, Polygon)> {
    let mut random = Random(3);
    let in_front = |a: &Polygon, b: &Polygon| b.vertices().iter().all(|&v| a.height_of(v) > -1e-12);
    let mut pairs = Vec::new();
    while pairs.len() < count {
        let [a, b] = std::array::from_fn(|_| {
            cell(&polygons[random.below(polygons.len())], n, random.below(n), random.below(n))
        });
        if in_front(&a, &b) && in_front(&b, &a) && a.normal().dot(b.normal()) < 1.0 - 1e-9 {
            pairs.push((a, b));
        }
    }
    pairs
}
