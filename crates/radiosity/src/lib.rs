//! Radiosity as a Fredholm equation of the second kind, B = E + ρ ∫ K B, solved by the general theory.
//!
//! A scene becomes light in eight rooms, and a program that walks through them is as long as the list:
//!
//! ```
//! use radiosity::patches::Patches;
//! use radiosity::scene::cornell_box;
//! use radiosity::solve::{Options, Unobserved, solve};
//! use radiosity::visibility::Visibility;
//!
//! let scene = cornell_box(); //                                                 1 the scene
//! let patches = Patches::new(&scene, 0.15)?; //                                 2 its patches, up to 15 cm
//! let visibility = Visibility::new(&scene.polygons()); //                       3 who sees whom
//! //  4 the kernel, 5 the form factors, 6 the relaxation:
//! let solution = solve(&patches, &visibility, &Options::default(), &mut Unobserved)?;
//!
//! // No patch is further from the discrete solution than this, in W/m²:
//! assert!(solution.error_bound.is_some_and(|bound| bound < 1e-3));
//! // The red wall is red.
//! let left = scene.surfaces.iter().position(|s| s.name == "left").ok_or("no left wall")?;
//! let patch = patches.surface.iter().position(|&s| s as usize == left).ok_or("no patch")?;
//! let [red, green, _] = solution.radiosity[patch].0;
//! assert!(red > 5.0 * green);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | room | module | |
//! |---|---|---|
//! | 1 | [`scene`] | surfaces with materials, from files, in metres |
//! | 2 | [`patches`] | the mesh of the domain |
//! | 3 | [`visibility`] | V(x, y): may two points see each other? |
//! | 4 | [`kernel`] | K(x, y) = cosθ cosθ′ V / (π r²) |
//! | 5 | [`form_factor`] | F_ij: Nyström, collocation, Galerkin |
//! | | [`lights`], [`sky`] | what points, suns and a sky around the scene send to surfaces: f = E + ρ H |
//! | | [`elements`] | the same on P_k and Q_k: coefficients for each patch |
//! | 6 | [`solve`](mod@solve) | u = f + ρ ⊙ (F u), by the crate `fredholm`; [`closure`] checks it |
//! | 2–7 | [`adaptive`] | all of it to an accuracy that is asked for; [`linked`] on very many faces |
//! | | [`view_factors`] | the F_ij of faces for other programs, each with its error |
//! | 7 | [`reconstruct`] | from patches to the light at any point |
//! | 8 | [`render`], [`bake`], [`export`] | pictures, light laid around the surfaces, files |
//!
//! The same equation with temperatures for light is heat by radiation: [`thermal`].
//!
//! All lengths are metres, all radiosities W/m², or lm/m² where a scene is photometric ([`scene::Units`]). Surfaces are
//! diffuse; a polygon emits and reflects from its front and blocks from both sides.

pub mod adaptive;
pub mod bake;
pub mod closure;
pub mod elements;
pub mod export;
pub mod form_factor;
pub mod hierarchical;
pub mod kernel;
pub mod lights;
pub mod linked;
pub mod patches;
pub mod polygon;
pub mod reconstruct;
pub mod render;
pub mod scene;
pub mod sky;
pub mod solve;
pub mod thermal;
pub mod view_factors;
pub mod visibility;
