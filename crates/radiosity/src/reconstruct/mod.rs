//! Room 7: from a value per patch to a field, u(x) = f(x) + ρ(x) ∫ K(x, y) u(y) dy: Nyström's interpolant (1.29),
//! known in computer graphics as the final gather.
//!
//! The integral is split by what it sees. Light straight from lamps makes the sharp shadows: it is Lambert's exact
//! form factor times the share of the lamp that is not hidden ([`Lamps`]), and of points,
//! suns and skies what [`crate::lights`] says. Light that patches reflect is smooth:
//! rays in a cosine distribution find it ([`Gather`]).
//!
//! Where a polygon stands for a piece of a curved surface both are found about the normal of that, for pictures alone.

mod curved;
mod direct;
mod gather;
mod lattice;

pub(crate) use curved::on_surface;
pub use direct::Lamps;
pub use gather::{Gather, Gathered};
pub use lattice::{Rays, Rotation};
pub(crate) use lattice::{lattice, scattered};

use crate::polygon::Polygon;
use crate::scene::Light;
use glam::DVec3;

/// A solved field that knows the light at any point of any face, as a picture shows it.
pub trait Lit<V>: Sync {
    /// The radiosity and the irradiance at points of faces, in W/m²; about the smooth normal where a face stands for a piece of a
    /// curved surface ([`Polygon::with_normals`](crate::polygon::Polygon::with_normals)).
    fn seen(&self, points: &mut dyn Iterator<Item = (u32, DVec3)>) -> Vec<[V; 2]>;

    /// Whether a point of a face is under something that stands on it, where no light comes.
    fn is_covered(&self, face: u32, point: DVec3) -> bool;

    /// Parts of the faces, of the mesh that the field was solved on, on which light is about linear between corners and middles
    /// where it has no edges.
    fn cells(&self) -> Vec<(u32, Polygon)>;

    /// The root of the mean square of the light that surfaces reflect, in W/m².
    fn scale(&self) -> f64;

    /// What shines on the faces and is none of them.
    fn lights(&self) -> &[Light<V>];
}

/// A point of a surface from which light is looked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Site {
    /// The point, in metres, just off the surface so that its rays do not start inside it.
    pub point: DVec3,
    /// The unit normal of the front, or of the curved surface there.
    pub normal: DVec3,
    /// How the sample pattern is rotated here.
    pub rotation: Rotation,
}
