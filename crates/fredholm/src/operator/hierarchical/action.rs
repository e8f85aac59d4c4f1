//! F̃ u: t_b = Σ_l q_lᵀ u and then Σ_l σ_l p_l t_b, block by block; each number of F̃ is read once.
//!
//! A task is a strip of the image. It goes through the blocks that it has places in, in their order in memory; of large blocks,
//! which more strips share, all t_b are found before. Nothing is written by two tasks, and all sums have their order whatever
//! the number of threads.

use super::Hierarchical;
use super::block::{Kept, Small};
use crate::value::Value;
use rayon::prelude::*;

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

    /// σ_l q_lᵀ u of the large blocks, one after another.
    fn moments<V: Value>(&self, way: Way, u: &[V]) -> Vec<V> {
        let from = self.large.sides(way).0;
        let mut parts = vec![V::splat(0.0); from.moments()];
        from.split(&mut parts).into_par_iter().enumerate().with_max_len(1).for_each(|(strip, mut sums)| {
            for (block, piece) in from.pieces(strip) {
                let places = self.strips.part(from.range(block), strip);
                let (own, rest) = sums.split_at_mut(self.large.span(block).len());
                piece.gather(&u[places], own);
                sums = rest;
            }
        });
        let values = self.large.values();
        let mut moments = vec![V::splat(0.0); values.len()];
        for block in 0..self.large.len() {
            let own = &mut moments[self.large.span(block)];
            for part in from.parts(block, &self.strips) {
                own.iter_mut().zip(&parts[part..]).for_each(|(sum, part)| *sum += *part);
            }
        }
        moments.iter_mut().zip(values).for_each(|(moment, value)| *moment = *moment * *value);
        moments
    }

    /// Adds to the values of a strip what all its blocks bring.
    fn receive<V: Value>(&self, way: Way, strip: usize, (u, moments): (&[V], &[V]), image: &mut [V]) {
        let first = self.strips.range(strip).start;
        let to = self.large.sides(way).1;
        for (block, piece) in to.pieces(strip) {
            let places = self.strips.part(to.range(block), strip);
            piece.spread(
                &moments[self.large.span(block)],
                &mut image[places.start - first..places.end - first],
            );
        }
        let mut scratch = Vec::new();
        let mut add = |block: Small<'_>| {
            let (from, to) =
                if way == Way::Forward { (block.columns, block.rows) } else { (block.rows, block.columns) };
            act(
                way,
                block.kept,
                &u[from.clone()],
                &mut image[to.start - first..to.end - first],
                &mut scratch,
            );
        };
        match way {
            Way::Forward => self.shelves[strip].blocks().for_each(&mut add),
            Way::Transposed => self.beside(strip).for_each(&mut add),
        }
    }
}

/// `image` += B u, or Bᵀ u.
fn act<V: Value>(way: Way, block: Kept<'_>, u: &[V], image: &mut [V], moments: &mut Vec<V>) {
    let (from, values, to) = match (block, way) {
        (Kept::Dense(entries), Way::Forward) => return entries.spread(u, image),
        (Kept::Dense(entries), Way::Transposed) => return entries.gather(u, image),
        (Kept::LowRank { left, values, right }, Way::Forward) => (right, values, left),
        (Kept::LowRank { left, values, right }, Way::Transposed) => (left, values, right),
    };
    moments.clear();
    moments.resize(values.len(), V::splat(0.0));
    from.gather(u, moments);
    moments.iter_mut().zip(values).for_each(|(moment, value)| *moment = *moment * *value);
    to.spread(moments, image);
}
