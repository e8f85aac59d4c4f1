//! The rows of all large blocks, or their columns, by strips: what of them is in a strip lies one after another in memory, in the order
//! in which the action goes through it.
//!
//! An action of a million unknowns takes a quarter less time than where each block is in a place of its own: a piece
//! of a few kilobytes ends when reading has just become fast.

use super::kernels::add_tiles;
use super::piece::Piece;
use super::strips::Strips;
use rayon::prelude::*;
use std::ops::Range;

/// One factor of each large block, by strips.
#[derive(Clone, Debug)]
pub(super) struct Side {
    stacks: Vec<Stack>,
    /// By strip: where the moments of its pieces begin among those of all strips; after the last one their number.
    starts: Vec<usize>,
    /// The places of each block.
    ranges: Vec<Range<usize>>,
    /// By block, one after another: which of the pieces of a strip is its own, strip by strip.
    parts: Vec<u32>,
    /// By block: where its own begin in `parts`; after the last one their number.
    firsts: Vec<usize>,
}

/// A factor as it is made: its columns one after another, of which the first `full` are to be kept in double precision.
#[derive(Clone, Copy, Debug)]
pub(super) struct Factor<'a> {
    pub(super) range: &'a Range<usize>,
    pub(super) columns: &'a [f64],
    pub(super) rank: usize,
    pub(super) full: usize,
}

/// What large blocks have in a strip.
#[derive(Clone, Debug, Default)]
struct Stack {
    full: Vec<f64>,
    packed: Vec<f32>,
    pieces: Vec<Entry>,
    /// How many moments they have.
    moments: usize,
}

/// What one block has in a strip.
#[derive(Clone, Debug)]
struct Entry {
    block: u32,
    /// Where its moments begin among those of the strip.
    moments: u32,
    /// Its numbers of double precision, and of single.
    full: Range<usize>,
    packed: Range<usize>,
}

impl Side {
    /// Of no block yet.
    pub(super) fn new(strips: &Strips) -> Self {
        Self {
            stacks: vec![Stack::default(); strips.len()],
            starts: Vec::new(),
            ranges: Vec::new(),
            parts: Vec::new(),
            firsts: vec![0],
        }
    }

    /// Adds factors of the next blocks.
    pub(super) fn extend(&mut self, factors: &[Factor<'_>], strips: &Strips) {
        let first = self.ranges.len();
        for factor in factors {
            let block = self.ranges.len() as u32;
            for strip in strips.across(factor.range) {
                let (stack, m) = (&mut self.stacks[strip], strips.part(factor.range, strip).len());
                self.parts.push(stack.pieces.len() as u32);
                let (full, packed) = stack.ends();
                stack.pieces.push(Entry {
                    block,
                    moments: stack.moments as u32,
                    full: full..full + m * factor.full,
                    packed: packed..packed + m * (factor.rank - factor.full),
                });
                stack.moments += factor.rank;
            }
            self.ranges.push(factor.range.clone());
            self.firsts.push(self.parts.len());
        }
        // The numbers by all cores: most of the time goes with memory that is new.
        self.stacks.par_iter_mut().enumerate().for_each(|(strip, stack)| {
            let (full, packed) = stack.ends();
            reserve(&mut stack.full, full);
            reserve(&mut stack.packed, packed);
            let begin = stack.pieces.partition_point(|entry| (entry.block as usize) < first);
            for entry in &stack.pieces[begin..] {
                let Factor { range, columns, full, .. } = factors[entry.block as usize - first];
                let (m, places) = (range.len(), strips.part(range, strip));
                let rows = places.start - range.start..places.end - range.start;
                let (double, single) = columns.split_at(full * m);
                add_tiles(&mut stack.full, (double, m), rows.clone(), |number| number);
                add_tiles(&mut stack.packed, (single, m), rows, |number| number as f32);
            }
        });
    }

    /// Gives back what was taken for blocks that did not come.
    pub(super) fn close(&mut self) {
        self.starts = vec![0];
        for stack in &mut self.stacks {
            stack.full.shrink_to_fit();
            stack.packed.shrink_to_fit();
            stack.pieces.shrink_to_fit();
            self.starts.push(self.starts[self.starts.len() - 1] + stack.moments);
        }
    }

    /// The places of a block.
    pub(super) fn range(&self, block: usize) -> &Range<usize> {
        &self.ranges[block]
    }

    /// The blocks with places in a strip, and what they have there.
    pub(super) fn pieces(&self, strip: usize) -> impl Iterator<Item = (usize, Piece<'_>)> {
        let stack = &self.stacks[strip];
        stack.pieces.iter().map(|entry| (entry.block as usize, stack.piece(entry)))
    }

    /// The strips that a block has places in, and what it has there.
    pub(super) fn across(&self, block: usize, strips: &Strips) -> impl Iterator<Item = (usize, Piece<'_>)> {
        self.entries(block, strips).map(|(strip, entry)| (strip, self.stacks[strip].piece(entry)))
    }

    fn entries(&self, block: usize, strips: &Strips) -> impl Iterator<Item = (usize, &Entry)> {
        let parts = &self.parts[self.firsts[block]..self.firsts[block + 1]];
        let across = strips.across(&self.ranges[block]);
        across.zip(parts).map(|(strip, part)| (strip, &self.stacks[strip].pieces[*part as usize]))
    }

    /// Row `place` of a block's factor, written to `row` (length k).
    pub(super) fn row(&self, block: usize, place: usize, strips: &Strips, row: &mut [f64]) {
        let (strip, range) = (strips.of(place), &self.ranges[block]);
        let places = strips.part(range, strip);
        let part = self.parts[self.firsts[block] + strip - strips.of(range.start)];
        let stack = &self.stacks[strip];
        stack.piece(&stack.pieces[part as usize]).row(place - places.start, places.len(), row);
    }

    /// How many moments there are.
    pub(super) fn moments(&self) -> usize {
        self.starts[self.starts.len() - 1]
    }

    /// All moments, a slice for each strip.
    pub(super) fn split<'a, V>(&self, mut moments: &'a mut [V]) -> Vec<&'a mut [V]> {
        let cut = |ends: &[usize]| {
            let (part, rest) = std::mem::take(&mut moments).split_at_mut(ends[1] - ends[0]);
            moments = rest;
            part
        };
        self.starts.windows(2).map(cut).collect()
    }

    /// Where the moments of a block's parts begin, strip by strip.
    pub(super) fn parts(&self, block: usize, strips: &Strips) -> impl Iterator<Item = usize> {
        self.entries(block, strips).map(|(strip, entry)| self.starts[strip] + entry.moments as usize)
    }

    /// Bytes.
    pub(super) fn bytes(&self) -> usize {
        let stack = |stack: &Stack| {
            size_of_val(&*stack.full) + size_of_val(&*stack.packed) + size_of_val(&*stack.pieces)
        };
        let lists = size_of_val(&*self.starts) + size_of_val(&*self.ranges) + size_of_val(&*self.firsts);
        self.stacks.iter().map(stack).sum::<usize>() + lists + size_of_val(&*self.parts)
    }
}

/// Makes room up to `end`, for a quarter more at least: as vectors double by themselves, a million unknowns of 3.7 GB took 4.2 at the
/// peak, and so 3.9.
fn reserve<T>(numbers: &mut Vec<T>, end: usize) {
    if numbers.capacity() < end {
        numbers.reserve_exact((end - numbers.len()).max(numbers.len() / 4));
    }
}

impl Stack {
    /// Where its numbers end, of double precision and of single.
    fn ends(&self) -> (usize, usize) {
        self.pieces.last().map_or((0, 0), |last| (last.full.end, last.packed.end))
    }

    fn piece(&self, Entry { full, packed, .. }: &Entry) -> Piece<'_> {
        Piece { full: &self.full[full.clone()], packed: &self.packed[packed.clone()] }
    }
}
