//! Convex pieces of the polygon that is integrated over.

use glam::DVec3;

/// Most corners of a [`Piece`]; a piece that has as many is cut no further.
const MOST: usize = 12;

/// A convex polygon.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    corners: [DVec3; MOST],
    count: usize,
}

/// A triangle.
pub(super) type Cell = [DVec3; 3];

impl Piece {
    /// Of at most twelve corners.
    pub fn new(corners: &[DVec3]) -> Self {
        let mut piece = Self { corners: [DVec3::ZERO; MOST], count: 0 };
        corners.iter().for_each(|v| piece.push(*v));
        piece
    }

    fn push(&mut self, v: DVec3) {
        if self.count < MOST {
            self.corners[self.count] = v;
            self.count += 1;
        }
    }

    pub fn corners(&self) -> &[DVec3] {
        &self.corners[..self.count]
    }

    /// The parts where an affine function is not negative, and not positive; none where one would be no polygon.
    pub fn divided(&self, height: impl Fn(DVec3) -> f64) -> Option<[Self; 2]> {
        if self.count == MOST {
            return None;
        }
        let (mut above, mut below) = (Self::new(&[]), Self::new(&[]));
        let mut before = self.corners()[self.count - 1];
        let mut h = height(before);
        for &v in self.corners() {
            let g = height(v);
            if (h < 0.0 && g > 0.0) || (h > 0.0 && g < 0.0) {
                let crossing = (before * g - v * h) / (g - h);
                above.push(crossing);
                below.push(crossing);
            }
            if g >= 0.0 {
                above.push(v);
            }
            if g <= 0.0 {
                below.push(v);
            }
            (before, h) = (v, g);
        }
        (above.count > 2 && below.count > 2).then_some([above, below])
    }

    pub fn area(&self) -> f64 {
        self.triangles().map(|cell| area(&cell)).sum()
    }

    /// The triangles that it is made of.
    pub fn triangles(&self) -> impl Iterator<Item = Cell> + '_ {
        let v = self.corners();
        // Of the two ways to halve a quadrilateral the shorter cut makes the better triangles.
        let turned = usize::from(v.len() == 4 && v[0].distance_squared(v[2]) > v[1].distance_squared(v[3]));
        let at = move |k: usize| v[(k + turned) % v.len()];
        (2..v.len()).map(move |k| [at(0), at(k - 1), at(k)])
    }
}

/// The area of a triangle.
pub(super) fn area([a, b, c]: &Cell) -> f64 {
    0.5 * (*b - *a).cross(*c - *a).length()
}

/// A triangle cut across its longest side.
pub(super) fn halves(cell: &Cell) -> [Cell; 2] {
    let side = |k: usize| cell[k].distance_squared(cell[(k + 1) % 3]);
    let longest = (1..3).fold(0, |best, k| if side(k) > side(best) { k } else { best });
    let [a, b, c]: Cell = std::array::from_fn(|k| cell[(longest + k) % 3]);
    let middle = a.midpoint(b);
    [[a, middle, c], [middle, b, c]]
}
