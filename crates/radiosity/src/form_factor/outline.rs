//! Convex polygons as they are clipped: up to twelve vertices, coordinate by coordinate, in place.

use super::lambert;
use glam::DVec3;
use wide::f64x4;

/// Most vertices of an [`Outline`].
pub(super) const MOST: usize = 12;

/// Room for the vertices, for the first one again behind the last, and for whole groups of four.
const ROOM: usize = 16;

/// A convex polygon that is cut by planes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Outline {
    x: [f64; ROOM],
    y: [f64; ROOM],
    z: [f64; ROOM],
    count: usize,
}

/// What of an outline is inside of something.
pub(crate) enum Inside<'a> {
    Nothing,
    Part(&'a Outline),
    All,
}

impl Default for Outline {
    fn default() -> Self {
        Self::EMPTY
    }
}

impl Outline {
    pub const EMPTY: Self = Self { x: [0.0; ROOM], y: [0.0; ROOM], z: [0.0; ROOM], count: 0 };

    /// Of at most twelve vertices.
    pub fn new(vertices: &[DVec3]) -> Self {
        let mut outline = Self::EMPTY;
        vertices.iter().for_each(|v| outline.push(*v));
        outline.close();
        outline
    }

    /// A triangle or a quadrilateral as it is seen from a point.
    pub fn from_point(vertices: &[DVec3], point: DVec3) -> Self {
        let mut outline = Self::EMPTY;
        vertices.iter().for_each(|v| outline.push(*v - point));
        outline.close();
        outline
    }

    /// Puts the first vertex behind the last again.
    #[inline(always)]
    fn close(&mut self) {
        (self.x[self.count], self.y[self.count], self.z[self.count]) = (self.x[0], self.y[0], self.z[0]);
    }

    pub fn vertex(&self, k: usize) -> DVec3 {
        DVec3::new(self.x[k], self.y[k], self.z[k])
    }

    pub fn vertices(&self) -> impl Iterator<Item = DVec3> + Clone {
        (0..self.count).map(|k| self.vertex(k))
    }

    /// Its edges, from vertex to vertex.
    pub fn edges(&self) -> impl Iterator<Item = (DVec3, DVec3)> + Clone {
        (0..self.count).map(|k| (self.vertex(k), self.vertex(k + 1)))
    }

    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether nothing is left of it.
    pub fn is_empty(&self) -> bool {
        self.count < 3
    }

    #[inline(always)]
    fn push(&mut self, v: DVec3) {
        // A cut adds one vertex at most, and crowded outlines are halved before they are cut further.
        if self.count < MOST {
            let k = self.count;
            (self.x[k], self.y[k], self.z[k]) = (v.x, v.y, v.z);
            self.count += 1;
        }
    }

    /// Its vertices as they are seen from a point.
    pub fn seen_from(&self, point: DVec3) -> Self {
        // One array at a time: copied as a whole and then moved it would go through memory twice.
        Self {
            x: self.x.map(|x| x - point.x),
            y: self.y.map(|y| y - point.y),
            z: self.z.map(|z| z - point.z),
            count: self.count,
        }
    }

    /// Lambert's form factor from the origin, which is in front of it and below no vertex, for the normal n there.
    pub fn form_factor(&self, n: DVec3) -> f64 {
        lambert::of_ring(n, [&self.x, &self.y, &self.z], self.count)
    }

    /// The heights of the vertices over the plane through the origin with a normal; bits for those above, and below.
    #[inline(always)]
    fn sides(&self, plane: DVec3) -> (u32, u32) {
        self.bits(0.0, |from| {
            let lanes = |c: &[f64; ROOM]| f64x4::new([c[from], c[from + 1], c[from + 2], c[from + 3]]);
            lanes(&self.x) * plane.x + (lanes(&self.y) * plane.y + lanes(&self.z) * plane.z)
        })
    }

    /// Bits for the vertices of more than a `limit` of height, and of less than minus that; `heights` are those of four.
    #[inline(always)]
    fn bits(&self, limit: f64, heights: impl Fn(usize) -> f64x4) -> (u32, u32) {
        let limit = f64x4::splat(limit);
        let (mut above, mut below) = (0, 0);
        for from in [0, 4, 8] {
            if self.count > from {
                let h = heights(from);
                above |= h.simd_gt(limit).to_bitmask() << from;
                below |= h.simd_lt(-limit).to_bitmask() << from;
            }
        }
        let used = (1 << self.count) - 1;
        (above & used, below & used)
    }

    /// Whether all of it is above planes through the origin, given by their normals, or, because all of it is below one of
    /// them, nothing is.
    #[inline(always)]
    pub fn lies(&self, planes: &[DVec3]) -> Option<bool> {
        let mut all = true;
        for plane in planes {
            let (above, below) = self.sides(*plane);
            if above == 0 {
                return Some(false);
            }
            all &= below == 0;
        }
        all.then_some(true)
    }

    /// Bits for the vertices that are more than `rounding` above the plane through a point with a normal, and below.
    #[inline(always)]
    pub fn sides_from(&self, point: DVec3, plane: DVec3, rounding: f64) -> (u32, u32) {
        self.bits(rounding, |from| {
            let lanes =
                |c: &[f64; ROOM], x: f64| f64x4::new([c[from], c[from + 1], c[from + 2], c[from + 3]]) - x;
            let (x, y, z) = (lanes(&self.x, point.x), lanes(&self.y, point.y), lanes(&self.z, point.z));
            x * plane.x + (y * plane.y + z * plane.z)
        })
    }

    /// What planes through the origin, given by their normals, have above all of them; a part is made in `room`.
    ///
    /// That one of them has nothing above it is found before anything is cut.
    #[inline(always)]
    pub fn inside<'a>(&self, planes: &[DVec3], room: &'a mut [Self; 2]) -> Inside<'a> {
        let mut cutting = 0_u32;
        for (k, plane) in planes.iter().enumerate() {
            let (above, below) = self.sides(*plane);
            if above == 0 {
                return Inside::Nothing;
            }
            cutting |= u32::from(below != 0) << k;
        }
        if cutting == 0 {
            return Inside::All;
        }
        let [part, next] = room;
        let mut uncut = true;
        for (k, plane) in planes.iter().enumerate() {
            if cutting >> k & 1 == 1 {
                let source = if uncut { self } else { &*part };
                source.cut(1.0, |v| plane.dot(v), next);
                std::mem::swap(part, next);
                uncut = false;
            }
        }
        if part.is_empty() { Inside::Nothing } else { Inside::Part(part) }
    }

    /// The part where `sign` times the height is not negative, into `part`.
    #[inline(always)]
    fn cut(&self, sign: f64, height: impl Fn(DVec3) -> f64, part: &mut Self) {
        part.count = 0;
        if self.is_empty() {
            return;
        }
        let mut v = self.vertex(self.count - 1);
        let mut h = sign * height(v);
        for w in self.vertices() {
            let g = sign * height(w);
            if (h < 0.0) != (g < 0.0) {
                part.push((v * g - w * h) / (g - h));
            }
            if g >= 0.0 {
                part.push(w);
            }
            (v, h) = (w, g);
        }
        part.close();
    }

    fn part(&self, sign: f64, height: impl Fn(DVec3) -> f64) -> Self {
        let mut part = Self::EMPTY;
        self.cut(sign, height, &mut part);
        part
    }

    /// Cuts off what lies below a plane, over which a point has this `height`.
    pub fn keep_above(&mut self, height: impl Fn(DVec3) -> f64) {
        if self.vertices().any(|v| height(v) < 0.0) {
            *self = self.part(1.0, height);
        }
    }

    /// The part above a plane through the origin and the part below.
    pub fn divided(&self, plane: DVec3) -> [Self; 2] {
        match self.sides(plane) {
            (_, 0) => [*self, Self::EMPTY],
            (0, _) => [Self::EMPTY, *self],
            _ => [1.0, -1.0].map(|sign| self.part(sign, |v| plane.dot(v))),
        }
    }

    /// Itself, or its halves on two sides of a diagonal if it has no room for the vertices of many more cuts.
    pub fn uncrowded(self) -> [Self; 2] {
        if self.count <= MOST / 2 {
            return [self, Self::EMPTY];
        }
        let middle = self.count / 2;
        let part = |range: std::ops::RangeInclusive<usize>| {
            let mut part = Self::EMPTY;
            range.for_each(|k| part.push(self.vertex(k % self.count)));
            part.close();
            part
        };
        [part(0..=middle), part(middle..=self.count)]
    }
}
