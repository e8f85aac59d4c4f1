//! H(x) = ∫ L(ω) V(x, ω) cosθ dω over the half space above the horizon: what a sky around the scene sends to its surfaces.
//!
//! L is a luminance that a standard gives ([`Model`]). It is approximated once ([`Dome`]), by a + b·ω on each of a few thousand
//! spherical triangles that are cut until it is right to 2·10⁻³ *in every direction*; so what comes of it is as right, whatever
//! hides parts of it. What hides is clipped away, as seen from the point itself (`cover`, `view`), and a + b·ω is integrated over
//! the rest in closed form (`moments`): no rays are cast, and there is neither noise nor a band in the picture.
//!
//! Below the horizon nothing shines: a scene in which the ground is seen must have one.

pub(crate) mod cover;
mod dome;
mod model;
mod moments;
mod rays;
mod view;

pub use dome::Dome;
pub use model::{Kind, Model};
pub(crate) use rays::received_by_rays;
pub(crate) use view::received;

/// Polygons up to which what they hide of a sky is clipped away.
pub const FEW: usize = 64;
