//! Fredholm integral equations of the second kind,
//!
//! > φ(x) = f(x) + ρ(x) ∫_D K(x, y) φ(y) dy,
//!
//! made discrete, u = f + ρ ⊙ (F u), and solved, with the error of the answer.
//!
//! The multiplier ρ is kept apart from the kernel K. ρ and f take *values*: a number, a colour, a spectrum
//! ([`value`]). K is real, and so is F: one matrix for all channels.
//!
//! # A first equation
//!
//! φ(x) = f(x) + ½ ∫₀¹ (x + 1) e^{−xy} φ(y) dy with the f for which φ(x) = e^{−x}. Nyström's method replaces the integral
//! by a rule; the unknowns are the values of φ at its nodes.
//!
//! ```
//! use fredholm::discretize::Nystrom;
//! use fredholm::operator::Dense;
//! use fredholm::quadrature::gauss_legendre;
//! use fredholm::system::System;
//!
//! let kernel = |x: &f64, y: &f64| (x + 1.0) * (-x * y).exp();
//! let f = |x: f64| (-x).exp() - 0.5 + (-(x + 1.0)).exp() / 2.0;
//!
//! let nystrom = Nystrom::new(kernel, gauss_legendre(10, 0.0, 1.0)); //  what F_ij is
//! let matrix = Dense::<f64>::assemble(&nystrom, |_| ())?; //            how F is kept
//! let source: Vec<f64> = nystrom.nodes().iter().map(|x| f(*x)).collect();
//! let coefficient = vec![0.5; source.len()];
//! let system = System::new(&source, &coefficient, &matrix)?;
//!
//! let u = fredholm::direct::solve(system);
//! for (x, u) in nystrom.nodes().iter().zip(&u) {
//!     assert!((u - (-x).exp()).abs() < 1e-14);
//! }
//! // Between the nodes: Nyström's interpolant, f + ρ Σ_j K(x, x_j) w_j u_j.
//! let between = f(0.3) + 0.5 * nystrom.apply_at(&0.3, &u);
//! assert!((between - (-0.3_f64).exp()).abs() < 1e-14);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Iterating, with the error
//!
//! A relaxation improves u sweep by sweep and asks F only for what it needs: its action, its rows or its columns
//! ([`operator`]). When ‖ρF‖∞ < 1 the residual bounds the error.
//!
//! ```
//! # use fredholm::discretize::Nystrom;
//! # use fredholm::operator::Dense;
//! # use fredholm::quadrature::gauss_legendre;
//! use fredholm::relax::{GaussSeidel, Outcome, Relaxation, Stop, relax};
//! use fredholm::system::{System, error_bound, norm_bound, row_sums};
//! use fredholm::value::Spectrum;
//! # let kernel = |x: &f64, y: &f64| (x + 1.0) * (-x * y).exp();
//! # let nystrom = Nystrom::new(kernel, gauss_legendre(10, 0.0, 1.0));
//! # let matrix = Dense::<f64>::assemble(&nystrom, |_| ())?;
//!
//! // Three equations at once, with the one matrix: f = 1 and three multipliers.
//! let source = vec![Spectrum([1.0; 3]); 10];
//! let coefficient = vec![Spectrum([0.1, 0.3, 0.5]); 10];
//! let system = System::new(&source, &coefficient, &matrix)?;
//!
//! let mut gauss_seidel = GaussSeidel::new(system);
//! let stop = Stop { residual: 1e-10, sweeps: 100 };
//! let report = relax(&mut gauss_seidel, stop, |sweep, norm, _| {
//!     println!("sweep {sweep}: residual {norm:.1e}");
//!     true // go on
//! });
//! assert_eq!(report.outcome, Outcome::Converged);
//!
//! let norm = norm_bound(&coefficient, &row_sums(&matrix, &(0..10).collect::<Vec<_>>()));
//! let bound = error_bound(report.residual, norm).expect("‖ρF‖ < 1 here");
//! let exact = fredholm::direct::solve(system);
//! let error = gauss_seidel.solution()[4].0[2] - exact[4].0[2];
//! assert!(error.abs() <= bound);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # The modules, in reading order
//!
//! 1. [`value`], [`kernel`]: what φ may be, and K
//! 2. [`quadrature`], [`space`]: integrals by rules, elements
//! 3. [`discretize`]: what F_ij *is*: Nyström, collocation, Galerkin
//! 4. [`operator`]: how F is *kept*, and what may be asked of it
//! 5. [`system`]: the equation, its residual, the bound of the error
//! 6. [`relax`], [`krylov`], [`direct`]: solving it; [`neumann`]: the series behind it
//! 7. [`equation`], [`methods`]: equations on a line, and each of the paper's methods on them
//!
//! Section and equation numbers are those of G. Peyré, *Résolution numérique d'équations intégrales, exemple de la
//! radiativité*, 2001. The crate `radiosity` is this theory applied to the light in a building.

pub mod automatic;
pub mod direct;
pub mod discretize;
pub mod equation;
pub mod kernel;
pub mod krylov;
pub mod methods;
pub mod neumann;
pub mod operator;
pub mod plane;
pub mod product;
pub mod quadrature;
pub mod relax;
mod second_kind;
pub mod space;
pub mod spectrum;
pub mod system;
pub mod value;
