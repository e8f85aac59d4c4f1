//! What somebody wrote, and where: an error names the place.

use anyhow::{Result, anyhow};
use std::fmt::Display;
use std::str::FromStr;

/// A text with its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Said {
    /// What was written.
    pub text: String,
    /// Where: `--kernel`, or `problem.toml:3: kernel`.
    pub place: String,
}

impl Said {
    /// On the command line, as an option.
    pub fn option(name: &str, text: &str) -> Self {
        Self { text: text.to_owned(), place: format!("--{name}") }
    }

    /// What is wrong with it.
    pub fn error(&self, problem: impl Display) -> anyhow::Error {
        anyhow!("{}: {problem}", self.place)
    }

    /// Its meaning, for texts that are the names of something.
    pub fn parse<T: FromStr<Err: Display>>(&self) -> Result<T> {
        self.text.parse().map_err(|error| self.error(error))
    }
}
