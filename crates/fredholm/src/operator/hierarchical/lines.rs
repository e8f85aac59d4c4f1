//! F̃_ij for one i or one j: a row of the blocks' factors times the others.

use super::Hierarchical;
use super::action::Way;
use super::block::Block;
use super::factor::Factor;
use crate::operator::{Columns, Line, Matrix, Rows};
use crate::value::Value;

impl Hierarchical {
    /// Row or column `number`, written to `line`.
    fn line(&self, way: Way, number: usize, line: &mut Vec<f64>) {
        let place = self.place[number];
        let mut entries = vec![0.0; self.order.len()];
        let side = if way == Way::Forward { &self.rows } else { &self.columns };
        for block in side.blocks(self.strips.of(place)).map(|number| &self.blocks[number]) {
            let range = if way == Way::Forward { block.rows() } else { block.columns() };
            if range.contains(&place) {
                self.add_block(way, block, place, &mut entries);
            }
        }
        line.clear();
        line.extend(self.place.iter().map(|place| entries[*place]));
    }

    /// Adds what one block has of a row or column.
    fn add_block(&self, way: Way, block: &Block, place: usize, entries: &mut [f64]) {
        match (block, way) {
            (Block::Dense { entries: own, columns }, Way::Forward) => {
                own.row(place, &self.strips, &mut entries[columns.clone()]);
            }
            (Block::Dense { entries: own, columns }, Way::Transposed) => {
                own.column(place - columns.start, &mut entries[own.range().clone()]);
            }
            (Block::LowRank { left, values, right }, Way::Forward) => {
                self.add_product(left, values, right, place, entries);
            }
            (Block::LowRank { left, values, right }, Way::Transposed) => {
                self.add_product(right, values, left, place, entries);
            }
        }
    }

    /// Σ_l (row of `one`)_l σ_l (column l of `other`).
    fn add_product(&self, one: &Factor, values: &[f64], other: &Factor, place: usize, entries: &mut [f64]) {
        let mut row = vec![0.0; values.len()];
        one.row(place, &self.strips, &mut row);
        row.iter_mut().zip(values).for_each(|(entry, value)| *entry *= value);
        for strip in self.strips.across(other.range()) {
            let places = self.strips.part(other.range(), strip);
            other.piece(&places).spread(&row, &mut entries[places]);
        }
    }
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
