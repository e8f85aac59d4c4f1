//! The numbers of photometric files, each with its line.

use crate::scene::error::{Error, Place, Problem};
use std::path::Path;

/// What is wrong with a file, on a line that counts from 1.
#[derive(Debug)]
pub(super) struct Fault {
    pub line: usize,
    pub what: String,
}

impl Fault {
    pub fn new(line: usize, what: impl Into<String>) -> Self {
        Self { line, what: what.into() }
    }

    pub fn of(self, file: &Path) -> Error {
        Problem::Malformed(self.what).at(Place::line(file, self.line.max(1)))
    }
}

/// A number of a line, finite, and named in the message if it is none.
pub(super) fn number(line: usize, word: &str, name: &str) -> Result<f64, Fault> {
    // Some programs write the comma of their country.
    let parsed = word.trim().replace(',', ".").parse::<f64>().ok().filter(|number| number.is_finite());
    parsed.ok_or_else(|| {
        let word: String = word.trim().chars().filter(|c| !c.is_control()).take(40).collect();
        Fault::new(line, format!("`{word}` is no number; expected {name}"))
    })
}

/// A number that may not be negative.
pub(super) fn positive(line: usize, word: &str, name: &str) -> Result<f64, Fault> {
    let value = number(line, word, name)?;
    if value >= 0.0 {
        Ok(value)
    } else {
        Err(Fault::new(line, format!("{name} is {value}; it may not be negative")))
    }
}

/// The most angles of a kind: one every hundredth of a degree.
const MOST: usize = 36_001;

/// A whole number of things, from 1 on.
pub(super) fn count(line: usize, word: &str, name: &str) -> Result<usize, Fault> {
    let value = number(line, word, name)?;
    if value.fract() == 0.0 && (1.0..=MOST as f64).contains(&value) {
        Ok(value as usize)
    } else {
        Err(Fault::new(line, format!("{name} is {value}; it must be a whole number from 1 to {MOST}")))
    }
}

/// That angles grow, from one to the next, between two limits; in degrees.
pub(super) fn check_angles(angles: &[(usize, f64)], name: &str, limits: [f64; 2]) -> Result<(), Fault> {
    for (k, &(line, angle)) in angles.iter().enumerate() {
        if !(limits[0]..=limits[1]).contains(&angle) {
            let [low, high] = limits;
            return Err(Fault::new(
                line,
                format!("the {name} angle {angle} is not from {low} to {high} degrees"),
            ));
        }
        if k > 0 && angle <= angles[k - 1].1 {
            let before = angles[k - 1].1;
            return Err(Fault::new(
                line,
                format!("the {name} angle {angle} follows {before}; angles must grow"),
            ));
        }
    }
    Ok(())
}
