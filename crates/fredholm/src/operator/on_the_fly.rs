//! F not kept at all: each entry is computed when it is asked for. Memory O(n).

use super::{Columns, Line, Matrix, Rows};
use crate::discretize::{Coupling, fill_column};

/// A coupling used as a matrix without storing it.
#[derive(Clone, Copy, Debug)]
pub struct OnTheFly<C>(pub C);

impl<C: Coupling> Matrix for OnTheFly<C> {
    fn dim(&self) -> usize {
        self.0.dim()
    }

    fn diagonal(&self, i: usize) -> f64 {
        self.0.entry(i, i)
    }
}

impl<C: Coupling> Rows for OnTheFly<C> {
    fn row<'a>(&'a self, i: usize, buffer: &'a mut Vec<f64>) -> Line<'a> {
        buffer.resize(self.dim(), 0.0);
        self.0.row(i, 0, buffer);
        Line::Full(buffer)
    }
}

impl<C: Coupling> Columns for OnTheFly<C> {
    fn column<'a>(&'a self, j: usize, buffer: &'a mut Vec<f64>) -> Line<'a> {
        buffer.resize(self.dim(), 0.0);
        fill_column(&self.0, j, buffer);
        Line::Full(buffer)
    }
}
