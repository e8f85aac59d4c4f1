//! F as it is at hand: stored, or while it is not, computed row by row.

use super::discrete::Factors;
use super::shared::Shared;
use fredholm::operator::{Columns, Dense, Line, Matrix, OnTheFly, Rows};

/// Where the form factors come from.
pub enum Kept<'a> {
    /// All of them are stored.
    Stored(&'a Dense<f32>),
    /// Each is computed when it is asked for, and columns are kept as long as there is room.
    Computed(OnTheFly<&'a Factors<'a>>, &'a Shared),
}

impl Matrix for Kept<'_> {
    fn dim(&self) -> usize {
        match self {
            Self::Stored(matrix) => matrix.dim(),
            Self::Computed(matrix, _) => matrix.dim(),
        }
    }

    fn diagonal(&self, i: usize) -> f64 {
        match self {
            Self::Stored(matrix) => matrix.diagonal(i),
            Self::Computed(matrix, _) => matrix.diagonal(i),
        }
    }
}

impl Rows for Kept<'_> {
    fn row<'a>(&'a self, i: usize, buffer: &'a mut Vec<f64>) -> Line<'a> {
        match self {
            Self::Stored(matrix) => matrix.row(i, buffer),
            Self::Computed(matrix, _) => matrix.row(i, buffer),
        }
    }
}

impl Columns for Kept<'_> {
    fn column<'a>(&'a self, j: usize, buffer: &'a mut Vec<f64>) -> Line<'a> {
        match self {
            Self::Stored(matrix) => matrix.column(j, buffer),
            Self::Computed(matrix, shared) => {
                shared.column(j, buffer, |buffer| {
                    matrix.column(j, buffer);
                });
                Line::Full(buffer)
            }
        }
    }
}
