//! D in φ(p) = f(p) + ∫_D K(p, q) φ(q) dq: where an equation in the plane holds (paper, §1.1.3).

use crate::equation::EquationError;
use std::f64::consts::PI;
use std::fmt;
use std::str::FromStr;

/// A rectangle, a triangle or a disk of the plane, of finite and positive area.
///
/// The constructors check that; [`super::solve`] checks what was made without them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Domain {
    /// [x0, x1] × [y0, y1].
    Rectangle {
        /// Its left side.
        x0: f64,
        /// Its right side.
        x1: f64,
        /// Its lower side.
        y0: f64,
        /// Its upper side.
        y1: f64,
    },
    /// The triangle with these corners, in either order.
    Triangle([[f64; 2]; 3]),
    /// The disk.
    Disk {
        /// Its centre.
        centre: [f64; 2],
        /// Its radius.
        radius: f64,
    },
}

/// A triangle whose area is a smaller part of its longest side's square than this is a segment, but for the rounding
/// of its corners: theirs is 1e-16, and a triangle a millionth as high as it is long has 5e-7.
const FLAT: f64 = 1e-13;

impl Domain {
    /// [x0, x1] × [y0, y1], with x0 < x1 and y0 < y1.
    pub fn rectangle(x0: f64, x1: f64, y0: f64, y1: f64) -> Result<Self, EquationError> {
        Self::Rectangle { x0, x1, y0, y1 }.checked()
    }

    /// The triangle with these corners, which must not lie on a line.
    pub fn triangle(corners: [[f64; 2]; 3]) -> Result<Self, EquationError> {
        Self::Triangle(corners).checked()
    }

    /// The disk around `centre`, with a positive radius.
    pub fn disk(centre: [f64; 2], radius: f64) -> Result<Self, EquationError> {
        Self::Disk { centre, radius }.checked()
    }

    /// Its area.
    pub fn area(&self) -> f64 {
        match *self {
            Self::Rectangle { x0, x1, y0, y1 } => (x1 - x0) * (y1 - y0),
            Self::Triangle(corners) => triangle_area(&corners),
            Self::Disk { radius, .. } => PI * radius * radius,
        }
    }

    /// How many times a triangle is as long as it is high; 1 of the others, whose sides are at right angles.
    pub(super) fn slenderness(&self) -> f64 {
        match self {
            Self::Triangle(corners) => 0.5 * longest_side(corners).powi(2) / triangle_area(corners),
            _ => 1.0,
        }
    }

    /// Its size, and how far it is from the origin at most: what rounding makes of differences of its points.
    pub(super) fn extent(&self) -> (f64, f64) {
        let points = match *self {
            Self::Rectangle { x0, x1, y0, y1 } => vec![[x0, y0], [x1, y1]],
            Self::Triangle(corners) => corners.to_vec(),
            Self::Disk { centre: [x, y], radius } => vec![[x - radius, y - radius], [x + radius, y + radius]],
        };
        let far = |p: &[f64; 2]| p[0].abs().max(p[1].abs());
        (self.area().sqrt(), points.iter().map(far).fold(0.0, f64::max))
    }

    /// The domain itself, if it is one.
    pub(super) fn checked(self) -> Result<Self, EquationError> {
        let proper = match self {
            Self::Rectangle { x0, x1, y0, y1 } => x0 < x1 && y0 < y1,
            Self::Triangle(corners) => triangle_area(&corners) > FLAT * longest_side(&corners).powi(2),
            Self::Disk { centre, radius } => radius > 0.0 && centre.iter().all(|c| c.is_finite()),
        };
        let area = self.area();
        let is_domain = proper && area > 0.0 && area.is_finite();
        if is_domain { Ok(self) } else { Err(EquationError::EmptyDomain { domain: self.to_string() }) }
    }
}

/// Half of |(b − a) × (c − a)|.
pub(super) fn triangle_area([a, b, c]: &[[f64; 2]; 3]) -> f64 {
    0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs()
}

fn longest_side([a, b, c]: &[[f64; 2]; 3]) -> f64 {
    let length = |p: &[f64; 2], q: &[f64; 2]| (p[0] - q[0]).hypot(p[1] - q[1]);
    length(a, b).max(length(b, c)).max(length(c, a))
}

/// As it is written on a command line: "rectangle 0 1 0 1".
impl fmt::Display for Domain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Rectangle { x0, x1, y0, y1 } => write!(f, "rectangle {x0} {x1} {y0} {y1}"),
            Self::Triangle([a, b, c]) => {
                write!(f, "triangle {} {} {} {} {} {}", a[0], a[1], b[0], b[1], c[0], c[1])
            }
            Self::Disk { centre: [x, y], radius } => write!(f, "disk {x} {y} {radius}"),
        }
    }
}

impl FromStr for Domain {
    type Err = EquationError;

    /// "rectangle x0 x1 y0 y1", "triangle x1 y1 x2 y2 x3 y3" or "disk cx cy r".
    fn from_str(text: &str) -> Result<Self, EquationError> {
        let unknown = |why: String| EquationError::UnknownDomain { text: text.to_owned(), why };
        let mut words = text.split_whitespace();
        let name = words.next().unwrap_or_default();
        let number = |word: &str| word.parse().map_err(|_| unknown(format!("\"{word}\" is no number")));
        let numbers = words.map(number).collect::<Result<Vec<f64>, _>>()?;
        match (name, numbers.as_slice()) {
            ("rectangle", &[x0, x1, y0, y1]) => Self::rectangle(x0, x1, y0, y1),
            ("triangle", &[x1, y1, x2, y2, x3, y3]) => Self::triangle([[x1, y1], [x2, y2], [x3, y3]]),
            ("disk", &[x, y, radius]) => Self::disk([x, y], radius),
            ("rectangle" | "triangle" | "disk", _) => {
                Err(unknown(format!("{} numbers are not as many as a {name} has", numbers.len())))
            }
            _ => Err(unknown(format!("\"{name}\" is no domain"))),
        }
    }
}
