//! Formulas typed by people: parsed, checked, evaluated in batches.
//!
//! # A formula and its values
//!
//! A formula is a text in variables that the caller names. It is compiled once, and evaluated at points:
//!
//! ```
//! use expression::Formula;
//!
//! let kernel = Formula::parse("(x+1)*exp(-x*y)/2", &["x", "y"])?;
//! assert_eq!(kernel.at(&[0.0, 1.0]), 0.5);
//! # Ok::<(), expression::ParseError>(())
//! ```
//!
//! or, faster by far, over batches. A column that is the same for the whole batch, as x is along a row of a matrix
//! K(x_i, y_j), is computed with once: here x + 1 and −x.
//!
//! ```
//! # use expression::Formula;
//! use expression::Column;
//! # let kernel = Formula::parse("(x+1)*exp(-x*y)/2", &["x", "y"])?;
//! let nodes = [0.1, 0.5, 0.9];
//! let mut row = [0.0; 3];
//! kernel.fill(&[Column::Same(0.5), Column::Each(&nodes)], &mut row);
//! assert_eq!(row[1], kernel.at(&[0.5, 0.5]));
//! # Ok::<(), expression::ParseError>(())
//! ```
//!
//! # The language
//!
//! | | |
//! |---|---|
//! | numbers | `1`, `.5`, `1e-3`; `2i` and `2*i` for 2√−1 |
//! | constants | `pi`, `e`, `i`, unless the caller has a variable or parameter of that name |
//! | arithmetic | `+ - * / ^`; `-x^2` is −(x²), `2^3^2` is 2^(3²), `2^-1` is ½; `**` is `^` |
//! | conditions | `< <= > >= == != && \|\| !`, with the values 1 and 0; `if(c,a,b)` |
//! | functions | [`functions`] lists them with their meaning |
//!
//! A value that does not exist, as ln(−1), is NaN. NaN spreads through everything, `min` and comparisons too, but not
//! out of the branch of an `if` that is not taken:
//!
//! ```
//! # use expression::Formula;
//! let entropy = Formula::parse("if(x > 0, x*ln(x), 0)", &["x"])?;
//! assert_eq!(entropy.at(&[0.0]), 0.0);
//! # Ok::<(), expression::ParseError>(())
//! ```
//!
//! Nothing is guessed. A slip is told where it is, with what may have been meant:
//!
//! ```
//! # use expression::Formula;
//! let error = Formula::parse("2x + sine(y)", &["x", "y"]).unwrap_err();
//! let told = "\
//! an operator is missing; to multiply, write `2*x`
//!   1 | 2x + sine(y)
//!     | ^^";
//! assert_eq!(error.to_string(), told);
//! ```
//!
//! # Complex numbers
//!
//! A formula with the unit `i` in it is one of complex numbers: there √−1 = i, where it is NaN in all others. The special
//! functions and comparisons take real arguments, and refuse one that may be complex when they are parsed.
//!
//! ```
//! # use expression::Formula;
//! let wave = Formula::parse("exp(i*(x-y))/2", &["x", "y"])?;
//! assert!(wave.is_complex());
//! assert!((wave.at_complex(&[1.0, 0.0]).im - 1_f64.sin() / 2.0).abs() < 1e-16);
//! // What is real in the end is real.
//! assert!(!Formula::parse("abs(exp(i*x))", &["x"])?.is_complex());
//! # Ok::<(), expression::ParseError>(())
//! ```
//!
//! # Close to the diagonal
//!
//! A singular kernel is wanted so near to its singularity that x and y are the same double. Compiled
//! [with the exact difference](Formula::with_difference) y − x as a column more, it has all its digits there:
//!
//! ```
//! # use expression::Formula;
//! let kernel = Formula::with_difference("ln(abs(x-y))", &["x", "y"], &[], ("y", "x"))?;
//! assert_eq!(kernel.at(&[0.3, 0.3, 1e-30]), 1e-30_f64.ln());
//! # Ok::<(), expression::ParseError>(())
//! ```
//!
//! # How it works
//!
//! text → tokens → a graph without repetition, folded and simplified as it is built → steps over blocks of 64 lanes.
//! The results are those of the operations one by one, to the last bit the same in a batch and at a point.

mod complex;
mod difference;
mod error;
mod evaluate;
mod formula;
mod functions;
mod fuse;
mod graph;
mod lanes;
mod names;
mod operation;
mod parse;
mod program;
mod simplify;
mod special;
mod token;

pub use error::{ErrorKind, ParseError};
pub use evaluate::Column;
pub use formula::Formula;
pub use functions::functions;
