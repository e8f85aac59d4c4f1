//! F̃ u in two passes: t_b = Σ q_lᵀ u from all columns, then Σ_b σ_l p_l t_b to all rows; each number of F̃ is read once.
//!
//! In both passes a task is a strip, which goes through the blocks that it has places in: nothing is written by two tasks, and
//! all sums have their order whatever the number of threads.

use super::Hierarchical;
use super::block::Block;
use super::factor::{Factor, Piece};
use super::side::Side;
use crate::value::Value;
use rayon::prelude::*;
use std::ops::Range;

/// F̃, or its transposed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    Forward,
    Transposed,
}

impl Hierarchical {
    /// `out` = F̃ u, or F̃ᵀ u.
    pub(super) fn act<V: Value>(&self, way: Way, u: &[V], out: &mut [V]) {
        assert_eq!((u.len(), out.len()), (self.order.len(), self.order.len()), "a value for each unknown");
        let u: Vec<V> = self.order.par_iter().map(|number| u[*number]).collect();
        let moments = self.moments(way, &u);
        let mut image = vec![V::splat(0.0); u.len()];
        self.strips.split(&mut image).into_par_iter().enumerate().with_max_len(1).for_each(
            |(strip, image)| {
                self.receive(way, strip, (&u, &moments), image);
            },
        );
        out.par_iter_mut().zip(&self.place).for_each(|(value, place)| *value = image[*place]);
    }

    /// The sides that values come from and go to.
    fn sides(&self, way: Way) -> (&Side, &Side) {
        match way {
            Way::Forward => (&self.columns, &self.rows),
            Way::Transposed => (&self.rows, &self.columns),
        }
    }

    /// σ_l q_lᵀ u, block by block as `self.firsts` has it.
    fn moments<V: Value>(&self, way: Way, u: &[V]) -> Vec<V> {
        let from = self.sides(way).0;
        let mut parts = vec![V::splat(0.0); from.moments()];
        from.split(&mut parts).into_par_iter().enumerate().with_max_len(1).for_each(|(strip, sums)| {
            let mut sums = sums;
            for block in from.blocks(strip).map(|number| &self.blocks[number]) {
                let Some((factor, rank)) = source(block, way) else { continue };
                let places = self.strips.part(factor.range(), strip);
                let (own, rest) = sums.split_at_mut(rank);
                factor.piece(&places).gather(&u[places], own);
                sums = rest;
            }
        });
        let mut moments = vec![V::splat(0.0); self.firsts[self.blocks.len()]];
        for (number, block) in self.blocks.iter().enumerate() {
            let Block::LowRank { values, .. } = block else { continue };
            let own = &mut moments[self.firsts[number]..self.firsts[number + 1]];
            for part in from.parts(number) {
                own.iter_mut().zip(&parts[*part..]).for_each(|(sum, part)| *sum += *part);
            }
            own.iter_mut().zip(values).for_each(|(moment, value)| *moment = *moment * *value);
        }
        moments
    }

    /// Adds to the values of a strip what all its blocks bring.
    fn receive<V: Value>(&self, way: Way, strip: usize, (u, moments): (&[V], &[V]), image: &mut [V]) {
        let first = self.strips.range(strip).start;
        let within = |places: &Range<usize>| places.start - first..places.end - first;
        for number in self.sides(way).1.blocks(strip) {
            let block = &self.blocks[number];
            match (block, way) {
                (Block::Dense { entries, columns }, Way::Forward) => {
                    whole(entries).spread(&u[columns.clone()], &mut image[within(entries.range())]);
                }
                (Block::Dense { entries, columns }, Way::Transposed) => {
                    whole(entries).gather(&u[entries.range().clone()], &mut image[within(columns)]);
                }
                (Block::LowRank { left, right, .. }, _) => {
                    let factor = if way == Way::Forward { left } else { right };
                    let places = self.strips.part(factor.range(), strip);
                    let own = &moments[self.firsts[number]..self.firsts[number + 1]];
                    factor.piece(&places).spread(own, &mut image[within(&places)]);
                }
            }
        }
    }
}

/// The factor that values come from, and the rank; `None` for a dense block.
fn source(block: &Block, way: Way) -> Option<(&Factor, usize)> {
    match (block, way) {
        (Block::Dense { .. }, _) => None,
        (Block::LowRank { right, values, .. }, Way::Forward) => Some((right, values.len())),
        (Block::LowRank { left, values, .. }, Way::Transposed) => Some((left, values.len())),
    }
}

/// A dense block is of two leaves, and no leaf is in two strips.
fn whole(entries: &Factor) -> Piece<'_> {
    entries.piece(entries.range())
}
