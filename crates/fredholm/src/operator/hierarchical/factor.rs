//! A matrix of m rows and k columns, kept so that its action streams memory: strip after strip, and in a strip column after
//! column.

use super::strips::Strips;
use crate::operator::Line;
use crate::value::Value;
use std::ops::Range;

/// Columns over a range of places: first those in double precision, then those for which single precision is enough.
#[derive(Clone, Debug)]
pub(super) struct Factor {
    range: Range<usize>,
    full: Vec<f64>,
    packed: Vec<f32>,
}

/// The rows of a factor that are in one strip.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece<'a> {
    full: &'a [f64],
    packed: &'a [f32],
}

impl Factor {
    /// From columns one after another, of which the first `full` are kept in double precision.
    pub(super) fn new(range: Range<usize>, columns: Vec<f64>, full: usize, strips: &Strips) -> Self {
        let m = range.len();
        if full * m == columns.len() && strips.of(range.start) == strips.of(range.end - 1) {
            return Self { range, full: columns, packed: Vec::new() };
        }
        let (first, others) = columns.split_at(full * m);
        let packed = in_strips(&range, others, strips).map(|number| number as f32).collect();
        let full = in_strips(&range, first, strips).collect();
        Self { range, full, packed }
    }

    /// The places of its rows.
    pub(super) fn range(&self) -> &Range<usize> {
        &self.range
    }

    /// Bytes of its numbers.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(self.full.as_slice()) + size_of_val(self.packed.as_slice())
    }

    /// The sum of the squares of its numbers.
    pub(super) fn norm2(&self) -> f64 {
        Line::Full(&self.full)
            .iter()
            .chain(Line::Packed(&self.packed).iter())
            .map(|number| number * number)
            .sum()
    }

    /// The rows at `places`, which are all of its own in one strip.
    pub(super) fn piece(&self, places: &Range<usize>) -> Piece<'_> {
        let (before, size, m) = (places.start - self.range.start, places.len(), self.range.len());
        let (full, packed) = (self.full.len() / m, self.packed.len() / m);
        Piece {
            full: &self.full[full * before..][..full * size],
            packed: &self.packed[packed * before..][..packed * size],
        }
    }

    /// Row `place`, written to `row` (length k).
    pub(super) fn row(&self, place: usize, strips: &Strips, row: &mut [f64]) {
        let places = strips.part(&self.range, strips.of(place));
        let Piece { full, packed } = self.piece(&places);
        let in_column = place - places.start;
        let full = full.chunks_exact(places.len()).map(|column| column[in_column]);
        let packed = packed.chunks_exact(places.len()).map(|column| f64::from(column[in_column]));
        row.iter_mut().zip(full.chain(packed)).for_each(|(entry, number)| *entry = number);
    }
}

impl Factor {
    /// Column `l` of a factor that is in one strip, written to `column`.
    pub(super) fn column(&self, l: usize, column: &mut [f64]) {
        let m = self.range.len();
        let full = self.full.len() / m;
        let line = match l < full {
            true => Line::Full(&self.full[l * m..][..m]),
            false => Line::Packed(&self.packed[(l - full) * m..][..m]),
        };
        column.iter_mut().zip(line.iter()).for_each(|(entry, number)| *entry = number);
    }
}

/// The numbers of columns over `range`, strip after strip.
fn in_strips<'a>(
    range: &Range<usize>,
    columns: &'a [f64],
    strips: &Strips,
) -> impl Iterator<Item = f64> + use<'a> {
    let (first, m) = (range.start, range.len());
    let parts: Vec<_> = strips.across(range).map(|strip| strips.part(range, strip)).collect();
    parts.into_iter().flat_map(move |part| {
        columns
            .chunks_exact(m)
            .flat_map(move |column| column[part.start - first..part.end - first].iter().copied())
    })
}

impl Piece<'_> {
    /// `image` += P x, for k values x.
    pub(super) fn spread<V: Value>(self, x: &[V], image: &mut [V]) {
        let (first, others) = x.split_at(self.full.len() / image.len());
        spread(self.full, first, image);
        spread(self.packed, others, image);
    }

    /// `sums` += Pᵀ u, for k values `sums`.
    pub(super) fn gather<V: Value>(self, u: &[V], sums: &mut [V]) {
        let (full, packed) = (self.full.chunks_exact(u.len()), self.packed.chunks_exact(u.len()));
        let lines = full.map(Line::Full).chain(packed.map(Line::Packed));
        sums.iter_mut().zip(lines).for_each(|(sum, line)| *sum += line.dot(u));
    }
}

/// Four columns at a time: the image is then read and written once for four numbers from memory.
fn spread<V: Value, T: Copy + Into<f64>>(columns: &[T], x: &[V], image: &mut [V]) {
    let m = image.len();
    let (mut quads, mut values) = (columns.chunks_exact(4 * m), x.chunks_exact(4));
    for (quad, x) in quads.by_ref().zip(values.by_ref()) {
        let (a, b) = quad.split_at(2 * m);
        let ((a, b), (c, d)) = (a.split_at(m), b.split_at(m));
        for (i, value) in image.iter_mut().enumerate() {
            let two = x[0] * a[i].into() + x[1] * b[i].into();
            *value += two + (x[2] * c[i].into() + x[3] * d[i].into());
        }
    }
    for (column, x) in quads.remainder().chunks_exact(m).zip(values.remainder()) {
        image.iter_mut().zip(column).for_each(|(value, number)| *value += *x * (*number).into());
    }
}
