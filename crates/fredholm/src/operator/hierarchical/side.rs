//! Which large blocks a strip of rows or of columns has to do with, and where their moments are.

use super::large::Large;
use super::strips::Strips;
use std::ops::Range;

/// The rows of all large blocks, or their columns, by strips.
#[derive(Clone, Debug)]
pub(super) struct Side {
    /// By strip: the blocks that have places in it.
    blocks: Vec<Vec<u32>>,
    /// By strip: where the moments of its blocks begin among those of all strips; after the last one their number.
    starts: Vec<usize>,
    /// By block, one after another: where the moments of its part in each strip begin.
    parts: Vec<usize>,
    /// By block: where its own begin in `parts`; after the last one their number.
    firsts: Vec<usize>,
}

impl Side {
    pub(super) fn new(blocks: &[Large], strips: &Strips, range: impl Fn(&Large) -> &Range<usize>) -> Self {
        let mut side = Self {
            blocks: vec![Vec::new(); strips.len()],
            starts: vec![0],
            parts: Vec::new(),
            firsts: vec![0],
        };
        for (number, block) in blocks.iter().enumerate() {
            let across = strips.across(range(block));
            across.clone().for_each(|strip| side.blocks[strip].push(number as u32));
            side.firsts.push(side.firsts[number] + across.len());
        }
        side.parts = vec![0; side.firsts[blocks.len()]];
        let mut met = vec![0; blocks.len()];
        for strip in 0..strips.len() {
            let mut place = side.starts[strip];
            for number in side.blocks[strip].iter().map(|number| *number as usize) {
                side.parts[side.firsts[number] + met[number]] = place;
                met[number] += 1;
                place += blocks[number].values.len();
            }
            side.starts.push(place);
        }
        side
    }

    /// The numbers of the blocks with places in a strip, ascending.
    pub(super) fn blocks(&self, strip: usize) -> impl Iterator<Item = usize> + '_ {
        self.blocks[strip].iter().map(|number| *number as usize)
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
    pub(super) fn parts(&self, number: usize) -> &[usize] {
        &self.parts[self.firsts[number]..self.firsts[number + 1]]
    }

    /// Bytes.
    pub(super) fn bytes(&self) -> usize {
        let lists: usize = self.blocks.iter().map(|list| size_of_val(list.as_slice())).sum();
        lists + size_of::<usize>() * (self.starts.len() + self.parts.len() + self.firsts.len())
    }
}
