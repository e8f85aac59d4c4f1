//! Formulas typed by people: parsed, checked, evaluated in batches.
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
