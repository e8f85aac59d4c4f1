//! What hides something of a polygon from the points of another, as the edges of a cone: seen from x, hidden is what is on
//! the inner side of the planes through x and each edge.
//!
//! det[q − x, p − x, v − x], the side of v for the edge from p to q, is affine in x and in v: its signs for the corners of
//! two convex polygons are its signs for all their points. So an edge that has the whole target inside, from everywhere, is
//! left out; mostly one or two are left.

use super::outline::{MOST, Outline};
use super::sight::is_before;
use crate::visibility::solid::{Plane, Solid};
use glam::DVec3;

/// Most edges of a hider.
pub(super) const MOST_EDGES: usize = 6;

/// An edge, with what hides on its left as it is seen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    pub from: DVec3,
    pub to: DVec3,
    /// Whether there is another hider on its right, so that it is no edge of the shadow.
    pub inner: bool,
}

impl Edge {
    /// The inward normal of the plane through x and the edge.
    pub fn plane(&self, x: DVec3) -> DVec3 {
        (self.to - x).cross(self.from - x)
    }
}

/// A convex polygon, or the outline of a convex body.
#[derive(Clone, Debug)]
pub(super) struct Hider {
    edges: [Edge; MOST_EDGES],
    count: usize,
    /// A polygon that is seen from either side: its edges are as seen from the front.
    pub straddled: Option<Plane>,
    /// Whether it hides only what is behind it: it is of a body, whose other faces hide the rest.
    pub one_sided: bool,
    /// Hiders of one convex body hide no place twice.
    pub body: Option<u32>,
}

/// What of a target is on the inner side of an edge, from everywhere.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Inner {
    Nothing,
    Part,
    All,
}

/// What is seen by whom.
pub(super) struct Scene<'a> {
    /// The corners of the polygon of all x.
    pub eyes: &'a [DVec3],
    /// In front of them, with its front to them.
    pub target: &'a Outline,
    /// A length that no distance here is far above.
    pub reach: f64,
    /// A point between the eyes, and one of the target.
    middles: [DVec3; 2],
}

/// The part of the lengths' product by which a determinant may be wrong: what only touches a plane is on either side.
const ROUNDING: f64 = 1e-12;

impl<'a> Scene<'a> {
    pub fn new(eyes: &'a [DVec3], target: &'a Outline, reach: f64) -> Self {
        let middle = eyes.iter().sum::<DVec3>() / eyes.len() as f64;
        let aim = target.vertices().sum::<DVec3>() / target.len() as f64;
        Self { eyes, target, reach, middles: [middle, aim] }
    }

    /// Whether an edge has the middle of the target outside, from the middle of the eyes.
    fn excludes_middle(&self, edge: &Edge) -> bool {
        let [x, v] = self.middles;
        edge.plane(x).dot(v - x) < 0.0
    }

    fn inner(&self, edge: &Edge) -> Inner {
        let (mut above, mut below) = (0, 0);
        for &x in self.eyes {
            let plane = edge.plane(x);
            let sides = self.target.sides_from(x, plane, ROUNDING * self.reach * plane.abs().element_sum());
            (above, below) = (above | sides.0, below | sides.1);
            if above != 0 && below != 0 {
                return Inner::Part;
            }
        }
        match (above, below) {
            (0, _) => Inner::Nothing,
            (_, 0) => Inner::All,
            _ => Inner::Part,
        }
    }
}

/// A hider has more edges than there is room for, or more outlines than one.
#[derive(Debug)]
pub(super) struct TooMuch;

impl Hider {
    const EMPTY: Self = Self {
        edges: [Edge { from: DVec3::ZERO, to: DVec3::ZERO, inner: false }; MOST_EDGES],
        count: 0,
        straddled: None,
        one_sided: false,
        body: None,
    };

    /// From its edges, of which those are left out that cut nothing; `None` if it hides nothing.
    pub fn of_edges(
        edges: impl Iterator<Item = Edge> + Clone,
        scene: &Scene<'_>,
    ) -> Result<Option<Self>, TooMuch> {
        // The edge that has nothing inside is mostly the one that the middles tell of, and most pairs are in full sight.
        if edges.clone().any(|edge| scene.excludes_middle(&edge) && scene.inner(&edge) == Inner::Nothing) {
            return Ok(None);
        }
        let mut hider = Self::EMPTY;
        for edge in edges {
            match scene.inner(&edge) {
                Inner::Nothing => return Ok(None),
                Inner::All => (),
                Inner::Part if hider.count == MOST_EDGES => return Err(TooMuch),
                Inner::Part => {
                    hider.edges[hider.count] = edge;
                    hider.count += 1;
                }
            }
        }
        Ok(Some(hider))
    }

    /// A body in front of the target, of whose planes none has eyes on either side. To eyes that are before none it hides all:
    /// they are under it, on what it stands on.
    pub fn of_solid(solid: &Solid, scene: &Scene<'_>) -> Result<Option<Self>, TooMuch> {
        let mut in_front = 0_u128;
        for (k, plane) in solid.planes.iter().enumerate() {
            match is_before(scene.eyes, plane, scene.reach) {
                Some(before) => in_front |= u128::from(before) << k,
                None => return Err(TooMuch),
            }
        }
        if in_front == 0 {
            return Ok(Some(Self::EMPTY));
        }
        let outline =
            solid.ridges.iter().filter_map(|ridge| ridge.on_outline(|side| in_front >> side & 1 == 1));
        Self::of_edges(outline.map(|[from, to]| Edge { from, to, inner: false }), scene)
    }

    /// A polygon that has eyes on either side.
    pub fn straddled(edges: impl Iterator<Item = Edge>, plane: Plane) -> Self {
        let mut hider = Self { straddled: Some(plane), ..Self::EMPTY };
        for (place, edge) in hider.edges.iter_mut().zip(edges) {
            *place = edge;
            hider.count += 1;
        }
        hider
    }

    pub fn edges(&self) -> &[Edge] {
        &self.edges[..self.count]
    }

    /// Whether it hides all of the target from everywhere.
    pub fn hides_all(&self) -> bool {
        self.count == 0
    }

    /// Whether it hides nothing of the target of a scene, whose eyes are among those that it was made for.
    pub fn misses(&self, scene: &Scene<'_>) -> bool {
        self.straddled.is_none() && self.edges().iter().any(|edge| scene.inner(edge) == Inner::Nothing)
    }

    /// The inward normals of the planes through x and the edges, and how many there are; none where x is in its plane or
    /// sees a side that hides nothing.
    #[inline(always)]
    pub fn planes(&self, x: DVec3) -> Option<([DVec3; MOST], usize)> {
        let height = self.straddled.map_or(1.0, |plane| plane.height_of(x));
        if height == 0.0 || (self.one_sided && height < 0.0) {
            return None;
        }
        let mut planes = [DVec3::ZERO; MOST];
        for (plane, edge) in planes.iter_mut().zip(self.edges()) {
            *plane = edge.plane(x) * height.signum();
        }
        Some((planes, self.count))
    }
}
