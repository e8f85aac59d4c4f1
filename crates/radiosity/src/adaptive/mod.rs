//! û(x) = f(x) + ρ(x) ∫ K(x, y) û(y) dy to an accuracy that is asked for: the mesh, the form factors and the iteration are
//! found on the way, and the residual of this very equation says when to stop.
//!
//! The method is collocation at the nodes of P2 and Q2 on patches (paper, §1.3.2 and §3.2), with its iterate (1.29) for an answer
//! where light is no polynomial. Four things make it fast:
//!
//! - F(x, P) is exact, for what hides P from x is clipped away; a shadow's edge needs no rays and, in the light that comes
//!   straight from lamps, no mesh;
//! - what is far away or much alike is seen as one (`links`), so that there are far fewer factors than pairs of nodes;
//! - patches are cut where the residual between their nodes is large, and nowhere else (`refine`);
//! - what was found for a mesh is kept for the next: factors, light from lamps, and the solution to start from (`round`).
//!
//! ```
//! use radiosity::adaptive::{Domain, Request, solve};
//! use radiosity::scene::cornell_box;
//!
//! let scene = cornell_box();
//! let faces = scene.polygons();
//! let domain = Domain::new(&scene, &faces)?;
//! let field = solve(&domain, &Request { accuracy: 0.05, ..Request::default() }, |_| true);
//! // In the mean square over all surfaces, of the light that they reflect:
//! assert!(field.bound().total() <= 0.05);
//! // It is a function: here is the middle of the first polygon, the floor.
//! let [red, _, blue] = field.radiosity(0, faces[0].centroid()).0;
//! assert!(red > blue && blue > 0.0, "the lamp is yellow");
//! # Ok::<(), radiosity::adaptive::TooManyFaces>(())
//! ```

mod curved;
mod domain;
mod error;
mod field;
mod finish;
mod links;
mod refine;
mod round;
mod space;
mod tree;

pub use domain::{Domain, TooManyFaces};
pub use error::Bound;
pub use field::{Field, Part};

use fredholm::value::Value;
use refine::{marked, refined};
use round::Mesh;

/// What is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Request {
    /// The error that the radiosity may have, in the mean square over all surfaces, relative to the mean square of the light
    /// that they reflect.
    pub accuracy: f64,
    /// The most patches; where they do not do, the answer is the best one that they give.
    pub most_patches: usize,
}

impl Default for Request {
    /// A hundredth, with ten thousand patches: some gigabyte at most.
    fn default() -> Self {
        Self { accuracy: 0.01, most_patches: 10_000 }
    }
}

/// A mesh that has been solved on the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Round {
    /// How many patches it has.
    pub patches: usize,
    /// How many form factors they have.
    pub links: usize,
    /// The error of the field on it, or its residual where that alone is larger than the error may be.
    pub error: f64,
}

/// Rounds after which a mesh is not refined any further: each has more patches, or smaller errors of form factors.
const MOST_ROUNDS: usize = 40;

/// Solves the radiosity equation to an accuracy.
///
/// `observe` is told of every round and says whether to go on. [`Field::bound`] tells whether the accuracy was reached: it
/// may not be, where the patches or the patience do not do.
pub fn solve<'a, V: Value>(
    domain: &'a Domain<'a, V>,
    request: &Request,
    mut observe: impl FnMut(&Round) -> bool,
) -> Field<'a, V> {
    let mut mesh = Mesh::first(domain, request.accuracy);
    let mut rounds = 0;
    loop {
        rounds += 1;
        let mut field = mesh.solved(domain, request.accuracy);
        let residual = error::residual(&field);
        // A mesh whose residual alone is too large needs no bound.
        let is_near = residual <= request.accuracy;
        if is_near {
            field.bound = error::bound(&field);
        }
        let [patches, links] = field.size();
        let error = field.bound.total().max(residual);
        let go_on = observe(&Round { patches, links, error }) && rounds < MOST_ROUNDS;
        let marked = marked(&field, request);
        if error <= request.accuracy || !go_on || patches + refine::NEW * marked.len() > request.most_patches
        {
            if !is_near {
                field.bound = error::bound(&field);
            }
            return field;
        }
        mesh = refined(field, &marked, request.accuracy);
    }
}
