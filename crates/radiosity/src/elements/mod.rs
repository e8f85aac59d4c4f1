//! u = f + ρ ⊙ (F u) with polynomials on the patches: finite elements P_k and Q_k, discontinuous across edges, as light is
//! (paper, §3.1–3.3).
//!
//! | method | F_{ia,jb} | |
//! |---|---|---|
//! | collocation, paper (3.3) | ∫_{P_j} K(x_ia, y) φ_jb(y) dy | [`Elements::collocation`] |
//! | Galerkin, paper (3.5) | 1/m_ia ∫ φ_ia ∫ K φ_jb | [`Elements::galerkin`] |
//! | iterated | f + ρ K u_n at any point | [`Elements::irradiance`] |
//!
//! The paper leaves §3.2.2 empty. Here Q_k is the product of two polynomials of degree k in the coordinates (s, t) of the unit
//! square, on a parallelogram polynomials of x too, on a general quadrilateral carried there by the bilinear map; its Jacobian
//! is in the weights of [`Space`] and of every rule.
//!
//! K is as large as cosθ cosθ′/(π r²) where patches touch. A point has [`Moments`] of a patch by a rule whose error does not
//! depend on how near it is; a pair that touches or nearly does is integrated on cells cut towards the common edge, by a
//! rule that is told its tolerance. Pairs that may be partly hidden are sampled with rays, with the error of P0.
//!
//! Where u is smooth on each patch of diameter h, collocation and Galerkin have an error of order h^{k+1}. The iterated solution
//! has twice that order, h^{2k+2}, at points away from the edges of a room, also for collocation, since its nodes are those of
//! Gauss; and h^{k+3/2} in the mean square and h^{k+1} at worst, since nearer than h to an edge the kernel is not smooth at
//! the scale of an element. `tests/elements.rs` measures them on a cube, a tetrahedron and a room of trapezoids.

mod adaptive;
mod coupling;
mod degree;
mod exchange;
mod hidden;
mod moments;
mod near;
mod rules;
mod space;

pub use coupling::Elements;
pub(crate) use degree::Reference;
pub use degree::{Degree, Local, MOST};
pub use moments::{Front, Moments, integral};
pub use near::Polar;
pub use space::Space;
