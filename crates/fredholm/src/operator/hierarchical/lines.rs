//! F̃_ij for one i or one j: a row of the blocks' factors times the others.

use super::Hierarchical;
use super::action::Way;
use super::block::{Kept, Small};
use crate::operator::{Columns, Line, Matrix, Rows};
use crate::value::Value;

impl Hierarchical {
    /// Row or column `number`, written to `line`.
    fn line(&self, way: Way, number: usize, line: &mut Vec<f64>) {
        let place = self.place[number];
        let strip = self.strips.of(place);
        let mut entries = vec![0.0; self.order.len()];
        let small: Vec<Small<'_>> = match way {
            Way::Forward => self.shelves[strip].blocks().collect(),
            Way::Transposed => self.beside(strip).collect(),
        };
        for (block, _) in self.large.sides(way).1.pieces(strip) {
            self.add_large(way, block, place, &mut entries);
        }
        for block in small {
            add_small(way, block, place, &mut entries);
        }
        line.clear();
        line.extend(self.place.iter().map(|place| entries[*place]));
    }

    /// Adds what a large block has of a row or column.
    fn add_large(&self, way: Way, block: usize, place: usize, entries: &mut [f64]) {
        let (other, own) = self.large.sides(way);
        if !own.range(block).contains(&place) {
            return;
        }
        let values = &self.large.values()[self.large.span(block)];
        let mut row = vec![0.0; values.len()];
        own.row(block, place, &self.strips, &mut row);
        row.iter_mut().zip(values).for_each(|(entry, value)| *entry *= value);
        for (strip, piece) in other.across(block, &self.strips) {
            piece.spread(&row, &mut entries[self.strips.part(other.range(block), strip)]);
        }
    }
}

/// Adds what a small block has of a row or column.
fn add_small(way: Way, block: Small<'_>, place: usize, entries: &mut [f64]) {
    let (own, other) = match way {
        Way::Forward => (block.rows, block.columns),
        Way::Transposed => (block.columns, block.rows),
    };
    if !own.contains(&place) {
        return;
    }
    let (k, entries) = (place - own.start, &mut entries[other.clone()]);
    let (from, values, to) = match (block.kept, way) {
        (Kept::Dense(numbers), Way::Forward) => return numbers.row(k, own.len(), entries),
        (Kept::Dense(numbers), Way::Transposed) => return numbers.column(k, entries),
        (Kept::LowRank { left, values, right }, Way::Forward) => (left, values, right),
        (Kept::LowRank { left, values, right }, Way::Transposed) => (right, values, left),
    };
    let mut row = vec![0.0; values.len()];
    from.row(k, own.len(), &mut row);
    row.iter_mut().zip(values).for_each(|(entry, value)| *entry *= value);
    to.spread(&row, entries);
}

impl Matrix for Hierarchical {
    fn dim(&self) -> usize {
        self.order.len()
    }

    fn diagonal(&self, i: usize) -> f64 {
        self.diagonal[i]
    }
}

impl Rows for Hierarchical {
    /// Computed from the factors: some ten or twenty times n operations.
    fn row<'a>(&'a self, i: usize, buffer: &'a mut Vec<f64>) -> Line<'a> {
        self.line(Way::Forward, i, buffer);
        Line::Full(buffer)
    }

    fn act<V: Value>(&self, u: &[V], out: &mut [V]) {
        Self::act(self, Way::Forward, u, out);
    }
}

impl Columns for Hierarchical {
    /// Computed from the factors: some ten or twenty times n operations.
    fn column<'a>(&'a self, j: usize, buffer: &'a mut Vec<f64>) -> Line<'a> {
        self.line(Way::Transposed, j, buffer);
        Line::Full(buffer)
    }

    fn act_transposed<V: Value>(&self, u: &[V], out: &mut [V]) {
        Self::act(self, Way::Transposed, u, out);
    }
}
