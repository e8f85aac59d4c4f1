//! A row or a column of F, whatever it is stored as: Σ_j F_ij u_j without the solver knowing.

use crate::value::Value;

/// One row or column of a matrix.
#[derive(Clone, Copy, Debug)]
pub enum Line<'a> {
    /// In double precision.
    Full(&'a [f64]),
    /// In single precision: half the memory, and a sweep takes half the time because memory is what it waits for.
    Packed(&'a [f32]),
}

impl<'a> Line<'a> {
    /// Entry k.
    pub fn get(self, k: usize) -> f64 {
        match self {
            Self::Full(line) => line[k],
            Self::Packed(line) => f64::from(line[k]),
        }
    }

    /// The entries, in order.
    pub fn iter(self) -> impl Iterator<Item = f64> + use<'a> {
        let (full, packed): (&[f64], &[f32]) = match self {
            Self::Full(line) => (line, &[]),
            Self::Packed(line) => (&[], line),
        };
        full.iter().copied().chain(packed.iter().map(|&entry| f64::from(entry)))
    }

    /// Σ_k line_k u_k, in double precision and always in the same order.
    pub fn dot<V: Value>(self, u: &[V]) -> V {
        match self {
            Self::Full(line) => dot(line, u),
            Self::Packed(line) => dot(line, u),
        }
    }

    /// Σ_k |line_k|.
    pub fn abs_sum(self) -> f64 {
        self.iter().map(f64::abs).sum()
    }
}

/// Independent partial sums hide the latency of an addition: eight keep two vector units busy. The channels of a
/// spectrum are independent already, and eight sums of 76 channels would not stay in registers.
fn dot<V: Value, T: Copy + Into<f64>>(line: &[T], u: &[V]) -> V {
    match V::CHANNELS {
        0..8 => dot_in_lanes::<8, V, T>(line, u),
        _ => dot_in_lanes::<1, V, T>(line, u),
    }
}

fn dot_in_lanes<const LANES: usize, V: Value, T: Copy + Into<f64>>(line: &[T], u: &[V]) -> V {
    let mut sums = [V::splat(0.0); LANES];
    let (chunks, values) = (line.chunks_exact(LANES), u.chunks_exact(LANES));
    let rest = chunks.remainder().iter().zip(values.remainder());
    for (entries, values) in chunks.zip(values) {
        for lane in 0..LANES {
            sums[lane] += values[lane] * entries[lane].into();
        }
    }
    let total = rest.fold(V::splat(0.0), |sum, (entry, value)| sum + *value * (*entry).into());
    sums.iter().fold(total, |sum, lane| sum + *lane)
}
