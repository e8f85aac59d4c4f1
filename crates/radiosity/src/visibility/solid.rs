//! Convex bodies: from a point outside the outline is made of the ridges between a side seen from its front and one that
//! is not, and all that is inside of it and behind the body is hidden.

use glam::DVec3;

/// {x : normal·x = offset}, where the normal has length 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plane {
    pub normal: DVec3,
    pub offset: f64,
}

impl Plane {
    pub fn height_of(&self, x: DVec3) -> f64 {
        self.normal.dot(x) - self.offset
    }
}

/// A convex body.
#[derive(Clone, Debug)]
pub(crate) struct Solid {
    /// Those of its sides, with the fronts outside.
    pub planes: Vec<Plane>,
    pub ridges: Vec<Ridge>,
    pub vertices: Vec<DVec3>,
}

impl Solid {
    /// A bit for each side that has a point more than `touch` in front of it: none for a point in the body or under it.
    pub fn in_front(&self, x: DVec3, touch: f64) -> u128 {
        let bits = self.planes.iter().enumerate();
        bits.fold(0, |bits, (k, plane)| bits | u128::from(plane.height_of(x) > touch) << k)
    }
}

/// Where two sides meet.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ridge {
    /// In the order in which they come around the first side.
    pub ends: [DVec3; 2],
    pub sides: [u32; 2],
}

impl Ridge {
    /// The ends so that the body is on the left, for an eye that is in front of some sides; none off the outline.
    pub fn on_outline(&self, in_front: impl Fn(u32) -> bool) -> Option<[DVec3; 2]> {
        let [p, q] = self.ends;
        match self.sides.map(in_front) {
            [true, false] => Some([p, q]),
            [false, true] => Some([q, p]),
            _ => None,
        }
    }
}
