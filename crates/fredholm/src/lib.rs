//! Fredholm integral equations of the second kind,
//!
//! > φ(x) = f(x) + ρ(x) ∫_D K(x, y) φ(y) dy,
//!
//! solved, with the error of the answer.
//!
//! # An equation and its error
//!
//! State the equation, on an interval, with closures for K and f; ρ is part of K here. Nothing else need be chosen: the
//! kernel's class is found, and panels are cut until the error that the equation's own residual tells meets the tolerance.
//!
//! ```
//! use fredholm::automatic::{Options, solve};
//! use fredholm::equation::{Class, Equation, Interval, Status};
//!
//! // φ(x) = f(x) + ½ ∫₀¹ (x + 1) e^{−xy} φ(y) dy with the f for which φ(x) = e^{−x}.
//! let kernel = |x: f64, y: f64| (x + 1.0) * (-x * y).exp() / 2.0;
//! let source = |x: f64| (-x).exp() - 0.5 + (-(x + 1.0)).exp() / 2.0;
//! let equation = Equation::new(Interval::new(0.0, 1.0)?, kernel, source);
//!
//! let answer = solve(&equation, &Options::default())?;
//! assert_eq!((answer.status, answer.class), (Status::Converged, Some(Class::Smooth)));
//! let error = answer.at(&0.3) - (-0.3_f64).exp();
//! assert!(error.abs() <= answer.error_estimate && answer.error_estimate < 1e-13);
//! # Ok::<(), fredholm::equation::EquationError>(())
//! ```
//!
//! # A kernel that is singular on the diagonal
//!
//! K may bend or jump at x = y, or be infinite there. [`equation::ByOffset`] tells a kernel y − x exactly, also where y is
//! x to rounding. The answer is a function, which can be evaluated, integrated or drawn like any other.
//!
//! ```
//! # use fredholm::automatic::{Options, solve};
//! # use fredholm::equation::{Class, Equation, Interval};
//! use fredholm::equation::ByOffset;
//! use fredholm::quadrature::integrate;
//!
//! // φ(x) = f(x) + ∫₀¹ ln|x − y| φ(y) dy with the f for which φ = 1.
//! let x_ln = |u: f64| if u > 0.0 { u * u.ln() } else { 0.0 };
//! let source = |x: f64| 2.0 - x_ln(x) - x_ln(1.0 - x);
//! let kernel = ByOffset(|_x, _y, offset: f64| offset.abs().ln());
//! let equation = Equation::new(Interval::new(0.0, 1.0)?, kernel, source);
//!
//! let answer = solve(&equation, &Options::default())?;
//! assert_eq!(answer.class, Some(Class::Logarithmic));
//! let mean = integrate(|x| answer.at(&x), 0.0, 1.0)?;
//! assert!((mean.value - 1.0).abs() <= mean.error + answer.error_estimate);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # A system
//!
//! φ_a = f_a + Σ_b ∫ K_ab φ_b, the kernels row by row.
//!
//! ```
//! # use fredholm::automatic::{Options, solve};
//! # use fredholm::equation::{Equation, Interval};
//! let (sum, product) = (|x: f64, y: f64| (x + y) / 3.0, |x: f64, y: f64| x * y);
//! let equation = Equation::system(
//!     Interval::new(0.0, 1.0)?,
//!     vec![Box::new(sum), Box::new(sum), Box::new(product), Box::new(product)],
//!     vec![Box::new(|x| x / 18.0 + 17.0 / 36.0), Box::new(|x| x * x - 19.0 / 12.0 * x + 1.0)],
//! )?;
//! let answer = solve(&equation, &Options::default())?;
//! // φ = (x + 1, x² + 1).
//! assert!((answer.solution.component(0, &0.5) - 1.5).abs() <= answer.error_estimate);
//! assert!((answer.solution.component(1, &0.5) - 1.25).abs() <= answer.error_estimate);
//! # Ok::<(), fredholm::equation::EquationError>(())
//! ```
//!
//! # A complex one
//!
//! ```
//! # use fredholm::automatic::{Options, solve};
//! # use fredholm::equation::{Equation, Interval};
//! use fredholm::equation::Complex64;
//!
//! // φ(x) = ½ e^{ix} + ½ ∫₀¹ e^{i(x−y)} φ(y) dy: φ(x) = e^{ix}.
//! let half = |angle: f64| Complex64::from_polar(0.5, angle);
//! let equation = Equation::new(Interval::new(0.0, 1.0)?, move |x: f64, y: f64| half(x - y), half);
//! let answer = solve(&equation, &Options::default())?;
//! assert!((answer.at(&0.7) - Complex64::cis(0.7)).norm() <= answer.error_estimate);
//! # Ok::<(), fredholm::equation::EquationError>(())
//! ```
//!
//! # Fredholm's alternative
//!
//! Where I − A is singular there is no solution, or one plus any combination of null functions. The answer says which.
//!
//! ```
//! # use fredholm::automatic::{Options, solve};
//! # use fredholm::equation::{Equation, Interval, Status};
//! // K = 4xy²: A x = x, and x² is the adjoint's. A solution asks for ⟨f, x²⟩ = 0.
//! let kernel = |x: f64, y: f64| 4.0 * x * y * y;
//! let unit = Interval::new(0.0, 1.0)?;
//! let (many, none) = (Equation::new(unit, kernel, |x| 1.0 - 5.0 / 3.0 * x * x), Equation::new(unit, kernel, |_| 1.0));
//!
//! let answer = solve(&many, &Options::default())?;
//! assert_eq!((answer.status, answer.nullity()), (Status::NotUnique, 1));
//! let null = &answer.alternative.as_ref().expect("I − A is singular").null_functions[0];
//! assert!((null.at(&0.8) / null.at(&0.4) - 2.0).abs() < 1e-12);
//! assert_eq!(solve(&none, &Options::default())?.status, Status::NoSolution);
//! # Ok::<(), fredholm::equation::EquationError>(())
//! ```
//!
//! # The spectrum
//!
//! ```
//! # use fredholm::equation::{Equation, Interval};
//! use fredholm::spectrum::spectrum;
//!
//! // K = min(x, y): λ_k = 1/((k − ½)π)². The source does not matter.
//! let equation = Equation::new(Interval::new(0.0, 1.0)?, f64::min, |_| 0.0);
//! let found = spectrum(&equation, 3, 1e-12)?;
//! for (k, pair) in found.eigenpairs.iter().enumerate() {
//!     let exact = ((k as f64 + 0.5) * std::f64::consts::PI).powi(-2);
//!     assert!((pair.value - exact).norm() <= pair.error_estimate);
//! }
//! # assert_eq!(found.eigenpairs.len(), 3);
//! # Ok::<(), fredholm::equation::EquationError>(())
//! ```
//!
//! # The paper's methods by name
//!
//! Each of them with the space or rule and the n that you choose, judged by the same residual ([`methods`]).
//!
//! ```
//! # use fredholm::equation::{Equation, Interval};
//! use fredholm::methods::{self, Method, RuleKind, Setup};
//! use fredholm::space::SpaceKind;
//! # let kernel = |x: f64, y: f64| (x + 1.0) * (-x * y).exp() / 2.0;
//! # let source = |x: f64| (-x).exp() - 0.5 + (-(x + 1.0)).exp() / 2.0;
//! # let equation = Equation::new(Interval::new(0.0, 1.0)?, kernel, source);
//!
//! let (space, rule) = (SpaceKind::Piecewise(1), RuleKind::GaussLegendre);
//! let error = |method| {
//!     let setup = Setup { method, space, rule, n: Some(16), tolerance: 1e-6 };
//!     methods::solve(&equation, &setup).map(|answer| answer.error_estimate)
//! };
//! // One more application of A doubles the order.
//! assert!(error(Method::IteratedGalerkin)? < 1e-3 * error(Method::Galerkin)?);
//! # Ok::<(), fredholm::equation::EquationError>(())
//! ```
//!
//! # A domain of the plane
//!
//! ```
//! use fredholm::plane::{Domain, Options, PlaneEquation, solve};
//!
//! // On the unit disk, K = (xs + yt)/π and f = 1 + 3x/4: φ = 1 + x.
//! let kernel = |[x, y]: [f64; 2], [s, t]: [f64; 2]| (x * s + y * t) / std::f64::consts::PI;
//! let equation = PlaneEquation::new(Domain::disk([0.0, 0.0], 1.0)?, kernel, |[x, _]| 1.0 + 0.75 * x);
//! let answer = solve(&equation, &Options::default())?;
//! assert!((answer.at(&[0.3, -0.4]) - 1.3).abs() <= answer.error_estimate);
//!
//! // A kernel may be singular at p = q. With K = −ln |p − q| / 2π and f = 1, φ = J₀(r)/J₀(1).
//! let kernel = |p: [f64; 2], q: [f64; 2]| -(p[0] - q[0]).hypot(p[1] - q[1]).ln() / std::f64::consts::TAU;
//! let equation = PlaneEquation::new(Domain::disk([0.0, 0.0], 1.0)?, kernel, |_| 1.0);
//! let answer = solve(&equation, &Options::default())?;
//! assert!((answer.at(&[0.0, 0.0]) - 1.0 / 0.765_197_686_557_966_6).abs() <= answer.error_estimate);
//! # Ok::<(), fredholm::equation::EquationError>(())
//! ```
//!
//! # On any domain: a matrix, kept your way
//!
//! Underneath, for points of any kind and many unknowns, as radiosity has them, the equation is made discrete,
//! u = f + ρ ⊙ (F u). The multiplier ρ is kept apart from the kernel K. ρ and f take *values*: a number, a colour, a
//! spectrum ([`value`]). K is real, and so is F: one matrix for all channels. Nyström's method replaces the integral by a
//! rule; the unknowns are the values of φ at its nodes.
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
//! 1. [`equation`]: an equation on a line as its user states it, and the answer
//! 2. [`automatic`]: solving it without being told how; [`product`]: the rule that varies with x, whatever the kernel's
//!    class
//! 3. [`spectrum`]: eigenvalues and eigenfunctions
//! 4. [`methods`]: each of the paper's methods by name; [`space`]: what they project on
//! 5. [`quadrature`]: integrals by rules, all of the paper's chapter 4
//! 6. [`plane`]: equations on rectangles, triangles and disks
//! 7. [`value`], [`kernel`]: what φ may be where F is one matrix for all channels, and K
//! 8. [`discretize`]: what F_ij *is*: Nyström, collocation, Galerkin
//! 9. [`operator`]: how F is *kept*, and what may be asked of it; [`operator::hierarchical`]: by blocks, where unknowns are
//!    many
//! 10. [`system`]: the discrete equation, its residual, the bound of the error
//! 11. [`relax`], [`krylov`], [`direct`]: solving it; [`neumann`]: the series behind it
//!
//! The examples `01_quadrature` to `10_hierarchical` go through 1 to 9 in small steps: `cargo run --example 01_quadrature`.
//!
//! Section and equation numbers are those of G. Peyré, *Résolution numérique d'équations intégrales, exemple de la
//! radiativité*, 2001. The crate `radiosity` is this theory applied to the light in a building.

pub mod automatic;
pub mod direct;
pub mod discretize;
pub mod equation;
pub mod kernel;
pub mod krylov;
pub mod memory;
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
