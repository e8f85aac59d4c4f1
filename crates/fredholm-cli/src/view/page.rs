//! The page, built from `viewer/` and kept here, so that a user needs nothing but this program.

/// The page itself.
pub const HTML: &str = include_str!("page/index.html");
/// What it does.
pub const SCRIPT: &str = include_str!("page/viewer.js");
/// What it looks like.
pub const STYLE: &str = include_str!("page/viewer.css");
