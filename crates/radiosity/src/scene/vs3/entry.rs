//! A surface of a View3D file as its lines say it: by vertices (`F 3`), or by a plane and a shape in it (`F 3a`).

use super::Vertices;
use crate::scene::error::Problem;
use crate::scene::text;
use glam::DVec3;

/// What a surface does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    /// It exchanges radiation, and is a hole in its base if it has one.
    Radiating,
    /// It takes away a part of its base.
    Null,
    /// It lies upon a part of its base, front to front.
    Mask,
    /// It only blocks.
    Obstruction,
}

/// A surface before its numbers are looked up.
#[derive(Debug)]
pub(super) struct Entry {
    pub kind: Kind,
    pub number: i64,
    pub line: usize,
    pub shape: Shape,
    /// The number of the surface that it is a part of; 0 for none.
    pub base: i64,
    /// The number of the surface that it is combined with; 0 for none.
    pub combine: i64,
    pub emittance: f64,
    pub name: String,
}

#[derive(Debug)]
pub(super) enum Shape {
    /// Numbers of vertices: three or four.
    Vertices(Vec<i64>),
    /// A plane, by a point, azimuth and tilt, and points in it; the numbers so far.
    InPlane { outline: Outline, numbers: Vec<f64> },
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Outline {
    Rectangle,
    Triangle,
    Quadrilateral,
}

pub(super) fn malformed<T>(message: String) -> Result<T, Problem> {
    Err(Problem::Malformed(message))
}

impl Entry {
    /// `S # v1 v2 v3 v4 base cmb emit name`, the letter apart.
    pub fn by_vertices(kind: Kind, line: usize, words: &[&str]) -> Result<Self, Problem> {
        let expected = "`# v1 v2 v3 v4 base cmb emit name`";
        let [number, v1, v2, v3, v4, rest @ ..] = words else {
            return malformed(format!("a surface has {} numbers here; expected {expected}", words.len()));
        };
        let mut vertices = vec![whole(v1)?, whole(v2)?, whole(v3)?];
        // The fourth vertex of a triangle is 0.
        vertices.extend(Some(whole(v4)?).filter(|&vertex| vertex != 0));
        Self { kind, number: whole(number)?, line, shape: Shape::Vertices(vertices), ..Self::blank() }
            .with_rest(rest, expected)
    }

    /// `S # shape base cmb emit name`, the letter apart; the numbers follow on lines of their own.
    pub fn in_plane(kind: Kind, line: usize, words: &[&str]) -> Result<Self, Problem> {
        let expected = "`# shape base cmb emit name`";
        let [number, shape, rest @ ..] = words else {
            return malformed(format!("a surface has {} words here; expected {expected}", words.len()));
        };
        let outline = match shape.to_ascii_uppercase().as_str() {
            "R" => Outline::Rectangle,
            "T" => Outline::Triangle,
            "Q" => Outline::Quadrilateral,
            _ => {
                return malformed(format!(
                    "`{shape}` is no shape; there are R (rectangle), T (triangle) and Q (quadrilateral)"
                ));
            }
        };
        let shape = Shape::InPlane { outline, numbers: Vec::new() };
        Self { kind, number: whole(number)?, line, shape, ..Self::blank() }.with_rest(rest, expected)
    }

    fn blank() -> Self {
        let shape = Shape::Vertices(Vec::new());
        let (number, line, base, combine, name) = Default::default();
        Self { kind: Kind::Radiating, number, line, shape, base, combine, emittance: 1.0, name }
    }

    /// Takes `base cmb emit name`; of an obstruction, for which View3D reads none of them, only the name.
    fn with_rest(mut self, rest: &[&str], expected: &str) -> Result<Self, Problem> {
        let name = rest.get(3);
        self.name = name.map_or_else(|| format!("surface {}", self.number), |&name| name.to_owned());
        if self.kind == Kind::Obstruction {
            return Ok(self);
        }
        let [base, combine, emittance, ..] = rest else {
            return malformed(format!("surface {} ends early; expected {expected}", self.number));
        };
        (self.base, self.combine, self.emittance) = (whole(base)?, whole(combine)?, text::number(emittance)?);
        if !(0.0..=1.0).contains(&self.emittance) {
            return malformed(format!(
                "the emittance of surface {} is {emittance}; it must lie between 0 and 1",
                self.number
            ));
        }
        Ok(self)
    }

    /// Whether numbers of its shape are still to come, and how many in all.
    pub fn missing(&self) -> Option<usize> {
        match &self.shape {
            Shape::Vertices(_) => None,
            Shape::InPlane { outline, numbers } => Some(outline.numbers()).filter(|&all| numbers.len() < all),
        }
    }

    pub fn add_numbers(&mut self, words: &[&str]) -> Result<(), Problem> {
        let Shape::InPlane { outline, numbers } = &mut self.shape else { return Ok(()) };
        for word in words {
            numbers.push(text::coordinate(word)?);
        }
        let (given, all) = (numbers.len(), outline.numbers());
        if given > all {
            return malformed(format!("surface {} has {given} numbers; its shape takes {all}", self.number));
        }
        Ok(())
    }

    /// The corners, in metres.
    pub fn corners(&self, vertices: &Vertices, metres: f64) -> Result<Vec<DVec3>, Problem> {
        match &self.shape {
            Shape::Vertices(numbers) => numbers.iter().map(|number| self.vertex(*number, vertices)).collect(),
            Shape::InPlane { outline, numbers } => {
                Ok(outline.corners(numbers).map(|corner| corner * metres).collect())
            }
        }
    }

    fn vertex(&self, number: i64, vertices: &Vertices) -> Result<DVec3, Problem> {
        vertices.get(&number).copied().ok_or_else(|| {
            let (owner, count) = (self.number, vertices.len());
            let problem = format!(
                "surface {owner} has a vertex {number}, which does not exist: the file has {count} vertices; \
                 correct the number, or add a line `V {number} x y z`"
            );
            Problem::Malformed(problem)
        })
    }
}

impl Outline {
    /// Point, azimuth and tilt; then width and height, or two coordinates for each corner.
    fn numbers(self) -> usize {
        match self {
            Self::Rectangle => 5 + 2,
            Self::Triangle => 5 + 6,
            Self::Quadrilateral => 5 + 8,
        }
    }

    /// The corners, counter-clockwise. The front faces the azimuth, clockwise from y, and is tilted from upwards (0)
    /// over vertical (90) to downwards (180); seen from the front u runs to the right and v upwards.
    fn corners(self, numbers: &[f64]) -> impl Iterator<Item = DVec3> {
        let number = |k: usize| numbers.get(k).copied().unwrap_or_default();
        let origin = DVec3::new(number(0), number(1), number(2));
        let ((sin_a, cos_a), (sin_t, cos_t)) = (sin_cos_degrees(number(3)), sin_cos_degrees(number(4)));
        let normal = DVec3::new(sin_t * sin_a, sin_t * cos_a, cos_t);
        let u = DVec3::new(-cos_a, sin_a, 0.0);
        let v = normal.cross(u);
        let points = match self {
            Self::Rectangle => {
                let (width, height) = (number(5), number(6));
                vec![(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)]
            }
            _ => (5..self.numbers()).step_by(2).map(|k| (number(k), number(k + 1))).collect(),
        };
        points.into_iter().map(move |(x, y)| origin + x * u + y * v)
    }
}

/// Sine and cosine of an angle in degrees, exact for right angles, so that walls meet without a crack.
fn sin_cos_degrees(degrees: f64) -> (f64, f64) {
    let turn = degrees.rem_euclid(360.0);
    match [0.0, 90.0, 180.0, 270.0].iter().position(|&right| right == turn) {
        Some(quarter) => [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)][quarter],
        None => turn.to_radians().sin_cos(),
    }
}

pub(super) fn whole(word: &str) -> Result<i64, Problem> {
    word.parse()
        .map_err(|_| Problem::Malformed(format!("`{word}` is not a whole number; expected one like 12")))
}
