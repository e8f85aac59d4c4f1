//! The links of the patches of one cluster: a dense matrix, a column for each cluster that they gather from.

use fredholm::operator::hierarchical::Cluster;
use fredholm::value::Value;
use prefetch_index::prefetch_index;
use std::ops::Range;
use wide::f64x8;

/// F_iC for the patches i of a cluster and the clusters C of its cut.
#[derive(Clone, Copy, Debug)]
pub(super) struct Block<'a> {
    receiver: Cluster,
    patches: usize,
    senders: &'a [Cluster],
    /// Column by column: of all patches from the first sender, then from the next.
    factors: &'a [f32],
    rays: u64,
}

/// The blocks of receivers near each other, without a gap: an action reads them at nine tenths of the memory's bandwidth, and takes a
/// tenth longer where each is in a place of its own.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Blocks {
    spans: Vec<Span>,
    senders: Vec<Cluster>,
    factors: Vec<f32>,
}

/// A block, by where its senders and factors end.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Span {
    receiver: Cluster,
    patches: u32,
    senders: usize,
    factors: usize,
    rays: u64,
}

impl Blocks {
    /// Adds a column to the block that is being made, unless nothing comes from there.
    pub fn add(&mut self, sender: Cluster, factors: &[f64]) {
        let narrow = factors.iter().map(|factor| *factor as f32);
        if narrow.clone().any(|factor| factor != 0.0) {
            self.senders.push(sender);
            self.factors.extend(narrow);
        }
    }

    /// Ends the block that is being made, for the patches of a cluster, so many, at the cost of so many rays.
    pub fn close(&mut self, receiver: Cluster, patches: usize, rays: u64) {
        let (senders, factors) = (self.senders.len(), self.factors.len());
        self.spans.push(Span { receiver, patches: patches as u32, senders, factors, rays });
    }

    /// Gives back memory that there is no use for.
    pub fn shrink(&mut self) {
        self.senders.shrink_to_fit();
        self.factors.shrink_to_fit();
    }

    /// How many blocks there are.
    pub fn len(&self) -> usize {
        self.spans.len()
    }

    /// A block, by its number.
    pub fn get(&self, k: usize) -> Block<'_> {
        let (first, factor) =
            k.checked_sub(1).map_or((0, 0), |k| (self.spans[k].senders, self.spans[k].factors));
        let Span { receiver, patches, senders, factors, rays } = self.spans[k];
        Block {
            receiver,
            patches: patches as usize,
            senders: &self.senders[first..senders],
            factors: &self.factors[factor..factors],
            rays,
        }
    }

    /// One after the other.
    pub fn iter(&self) -> impl Iterator<Item = Block<'_>> {
        (0..self.len()).map(|k| self.get(k))
    }

    /// How many factors are not 0.
    pub fn links(&self) -> u64 {
        self.factors.iter().filter(|factor| **factor != 0.0).count() as u64
    }

    /// Rays cast for them.
    pub fn rays(&self) -> u64 {
        self.spans.iter().map(|span| span.rays).sum()
    }

    /// Bytes that they take.
    pub fn bytes(&self) -> u64 {
        (size_of_val(&*self.spans) + size_of_val(&*self.senders) + size_of_val(&*self.factors)) as u64
    }
}

impl<'a> Block<'a> {
    /// The cluster of its patches.
    pub fn receiver(&self) -> Cluster {
        self.receiver
    }

    /// How many patches that has.
    pub fn patches(&self) -> usize {
        self.patches
    }

    /// Rays cast for it.
    pub fn rays(&self) -> u64 {
        self.rays
    }

    /// Each sender, with the factors of all patches.
    pub fn columns(&self) -> impl Iterator<Item = (Cluster, &'a [f32])> + use<'a> {
        self.senders.iter().copied().zip(self.factors.chunks_exact(self.patches))
    }

    /// The factors of all patches from a sender, by its number.
    pub fn column(&self, k: usize) -> &'a [f32] {
        &self.factors[k * self.patches..(k + 1) * self.patches]
    }

    /// The senders that have places of the tree among their own that are in `here`, with the factors of all patches.
    pub fn columns_within(
        &self,
        range: impl Fn(Cluster) -> Range<usize>,
        here: &Range<usize>,
    ) -> impl Iterator<Item = (Cluster, &[f32])> {
        let first = self.senders.partition_point(|sender| range(*sender).end <= here.start);
        let end = here.end;
        let within = (first..self.senders.len()).take_while(move |k| range(self.senders[*k]).start < end);
        within.map(|k| (self.senders[k], self.column(k)))
    }

    /// The sender that has a place of the tree among its own, with the factors of all patches; senders ascend in the tree.
    pub fn column_with(
        &self,
        range: impl Fn(Cluster) -> Range<usize>,
        place: usize,
    ) -> Option<(Cluster, &'a [f32])> {
        let k = self.senders.partition_point(|sender| range(*sender).end <= place);
        let sender = *self.senders.get(k).filter(|sender| range(**sender).contains(&place))?;
        Some((sender, self.column(k)))
    }

    /// What each patch gathers, from the means over all clusters.
    pub fn gather<V: Value>(&self, means: &[V], sums: &mut [V]) {
        if self.patches < LANES || self.patches > 2 * LANES {
            return self.gather_few(means, sums);
        }
        let mut channel = 0;
        while channel < V::CHANNELS {
            channel += match V::CHANNELS - channel {
                1 => self.gather_channels::<1, V>(means, channel, sums),
                2 => self.gather_channels::<2, V>(means, channel, sums),
                _ => self.gather_channels::<3, V>(means, channel, sums),
            };
        }
    }

    /// The same of some channels, whose sums stay in registers: of the first eight patches and of the last, which some of the first
    /// may be among. Returns how many.
    fn gather_channels<const C: usize, V: Value>(
        &self,
        means: &[V],
        channel: usize,
        sums: &mut [V],
    ) -> usize {
        let mut tiles = [[f64x8::ZERO; 2]; C];
        for (k, (sender, column)) in self.columns().enumerate() {
            prefetch_index(self.factors, k * self.patches + AHEAD);
            if let Some(later) = self.senders.get(k + MEANS_AHEAD) {
                prefetch_index(means, later.index());
            }
            let mean = &means[sender.index()].channels()[channel..channel + C];
            let (Some(first), Some(last)) = (column.first_chunk::<LANES>(), column.last_chunk::<LANES>())
            else {
                continue;
            };
            let factors = [widened(first), widened(last)];
            for (tiles, mean) in tiles.iter_mut().zip(mean) {
                for (tile, factors) in tiles.iter_mut().zip(&factors) {
                    *tile = factors.mul_add(f64x8::splat(*mean), *tile);
                }
            }
        }
        for (c, [first, last]) in tiles.iter().enumerate() {
            let end = sums.len() - LANES;
            let mut write = |from: usize, tile: &f64x8| {
                let to = sums[from..].iter_mut().zip(tile.to_array());
                to.for_each(|(value, sum)| value.channels_mut()[channel + c] = sum);
            };
            write(0, first);
            write(end, last);
        }
        C
    }

    fn gather_few<V: Value>(&self, means: &[V], sums: &mut [V]) {
        sums.fill(V::splat(0.0));
        for (sender, column) in self.columns() {
            let mean = means[sender.index()];
            sums.iter_mut().zip(column).for_each(|(sum, factor)| *sum += mean * f64::from(*factor));
        }
    }
}

/// In a vector register, in double precision: by a loop, as a call of `map` is not always inlined.
#[inline(always)]
fn widened(factors: &[f32; LANES]) -> f64x8 {
    let mut wide = [0.0; LANES];
    wide.iter_mut().zip(factors).for_each(|(wide, factor)| *wide = f64::from(*factor));
    f64x8::new(wide)
}

/// Factors are asked for so far ahead, four kilobytes, and so in the blocks that follow too: by itself a core has no more than one
/// on its way, and an action took a third longer, one of colours two fifths.
const AHEAD: usize = 1024;

/// The same of means, in columns.
const MEANS_AHEAD: usize = 8;

/// Patches whose sums are one or two vectors: a block has twice as many at most, and mostly more than that.
const LANES: usize = 8;
