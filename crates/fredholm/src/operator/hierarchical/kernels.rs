//! y += M x and s += Mᵀ u for a matrix M of m rows and k columns in *tiles*: sixteen rows at a time, and of these column after
//! column, so that memory is read from one end to the other while sixteen sums stay in registers.

use crate::operator::Entry;
use crate::value::Value;
use std::ops::Range;
use wide::f64x8;

/// Rows of a tile, two vectors of sums; the last one has what is left.
const TILE: usize = 16;

/// Puts some rows of a matrix given column after column, m numbers each, after other tiles.
pub(super) fn add_tiles<T>(
    tiles: &mut Vec<T>,
    (columns, m): (&[f64], usize),
    rows: Range<usize>,
    as_kept: impl Fn(f64) -> T,
) {
    for first in rows.clone().step_by(TILE) {
        let tile = first..(first + TILE).min(rows.end);
        let columns = columns.chunks_exact(m);
        columns.for_each(|column| tiles.extend(column[tile.clone()].iter().map(|number| as_kept(*number))));
    }
}

/// Row i of m rows of k numbers.
pub(super) fn row<T>(numbers: &[T], i: usize, (m, k): (usize, usize)) -> impl Iterator<Item = &T> {
    let first = i - i % TILE;
    let height = TILE.min(m - first);
    (0..k).map(move |l| &numbers[first * k + l * height + i % TILE])
}

/// Column l of m rows of k numbers.
pub(super) fn column<T>(numbers: &[T], l: usize, (m, k): (usize, usize)) -> impl Iterator<Item = &T> {
    numbers.chunks((TILE * k).max(1)).enumerate().flat_map(move |(tile, numbers)| {
        let height = TILE.min(m - tile * TILE);
        &numbers[l * height..][..height]
    })
}

/// A column of a tile, in two parts that are a vector each.
type Column<T> = [[T; TILE / 2]; 2];

/// All whole columns of numbers.
fn columns<T>(numbers: &[T]) -> &[Column<T>] {
    numbers.as_chunks().0.as_chunks().0
}

/// In vector registers, in double precision.
#[inline(always)]
fn lanes<T: Entry>([first, second]: &Column<T>) -> [f64x8; 2] {
    [widened(first), widened(second)]
}

/// By a loop, which becomes one instruction: a call of `map` is not always inlined, and then goes through memory.
#[inline(always)]
fn widened<T: Entry>(numbers: &[T; TILE / 2]) -> f64x8 {
    let mut wide = [0.0; TILE / 2];
    wide.iter_mut().zip(numbers).for_each(|(wide, number)| *wide = (*number).into());
    f64x8::new(wide)
}

/// `image` += M x.
pub(super) fn spread<V: Value, T: Entry>(numbers: &[T], x: &[V], image: &mut [V]) {
    if x.is_empty() {
        return;
    }
    let (mut numbers, mut image) = (numbers, image);
    if let Some(x) = V::numbers(x) {
        let (tiles, rest) = numbers.split_at(image.len() / TILE * TILE * x.len());
        let (whole, last) = std::mem::take(&mut image).split_at_mut(tiles.len() / x.len());
        let values = V::numbers_mut(whole).unwrap_or_default();
        let values = values.as_chunks_mut().0.as_chunks_mut().0;
        columns(tiles)
            .chunks_exact(x.len())
            .zip(values)
            .for_each(|(tile, values)| spread_tile(tile, x, values));
        (numbers, image) = (rest, last);
    }
    for (tile, image) in numbers.chunks(TILE * x.len()).zip(image.chunks_mut(TILE)) {
        for (column, x) in tile.chunks_exact(image.len()).zip(x) {
            image.iter_mut().zip(column).for_each(|(value, number)| *value += *x * (*number).into());
        }
    }
}

fn spread_tile<T: Entry>(tile: &[Column<T>], x: &[f64], values: &mut Column<f64>) {
    let [mut first, mut second] = lanes(values);
    for (column, x) in tile.iter().zip(x) {
        let ([a, b], x) = (lanes(column), f64x8::splat(*x));
        first = a.mul_add(x, first);
        second = b.mul_add(x, second);
    }
    *values = [first.to_array(), second.to_array()];
}

/// `sums` += Mᵀ u.
pub(super) fn gather<V: Value, T: Entry>(numbers: &[T], u: &[V], sums: &mut [V]) {
    let k = sums.len();
    if k == 0 {
        return;
    }
    let (mut numbers, mut u) = (numbers, u);
    if let (Some(values), Some(sums)) = (V::numbers(u), V::numbers_mut(sums)) {
        let values = columns(values);
        let (tiles, rest) = numbers.split_at(values.len() * TILE * k);
        gather_tiles(columns(tiles), values, sums);
        (numbers, u) = (rest, &u[values.len() * TILE..]);
    }
    for (tile, u) in numbers.chunks(TILE * k).zip(u.chunks(TILE)) {
        for (column, sum) in tile.chunks_exact(u.len()).zip(&mut *sums) {
            column.iter().zip(u).for_each(|(number, u)| *sum += *u * (*number).into());
        }
    }
}

/// Columns whose sums are kept in vectors until the last tile.
const SOME: usize = 8;

fn gather_tiles<T: Entry>(tiles: &[Column<T>], u: &[Column<f64>], sums: &mut [f64]) {
    let k = sums.len();
    for (sums, first) in sums.chunks_mut(SOME).zip((0..).step_by(SOME)) {
        let mut partial = [f64x8::ZERO; SOME];
        for (tile, u) in tiles.chunks_exact(k).zip(u) {
            let [u, v] = lanes(u);
            for (column, sum) in tile[first..].iter().zip(&mut partial[..sums.len()]) {
                let [a, b] = lanes(column);
                *sum = a.mul_add(u, b.mul_add(v, *sum));
            }
        }
        sums.iter_mut().zip(partial).for_each(|(sum, partial)| *sum += partial.reduce_add());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::value::{Rgb, Spectrum};

    fn number(k: usize) -> f64 {
        (k as f64 * 0.7).sin()
    }

    fn check<V: Value>(m: usize, k: usize) {
        let columns: Vec<f64> = (0..m * k).map(number).collect();
        let mut tiles = Vec::new();
        add_tiles(&mut tiles, (&columns, m), 0..m, |number| number);
        let packed: Vec<f32> = tiles.iter().map(|number| *number as f32).collect();
        for i in 0..m {
            assert!(row(&tiles, i, (m, k)).copied().eq((0..k).map(|l| columns[l * m + i])));
        }
        for l in 0..k {
            assert!(column(&tiles, l, (m, k)).eq(&columns[l * m..][..m]));
        }
        let values = |count: usize| -> Vec<V> { (0..count).map(|i| V::splat(number(3 * i + 1))).collect() };
        let (x, u) = (values(k), values(m));
        let close = |found: V, terms: &mut dyn Iterator<Item = f64>, eps: f64| {
            let expected = V::splat(1.0 + terms.sum::<f64>());
            assert!((found - expected).magnitude() < eps, "{m} × {k}: {found:?} is not {expected:?}");
        };
        let (mut images, mut sums) = (
            [vec![V::splat(1.0); m], vec![V::splat(1.0); m]],
            [vec![V::splat(1.0); k], vec![V::splat(1.0); k]],
        );
        spread(&tiles, &x, &mut images[0]);
        spread(&packed, &x, &mut images[1]);
        gather(&tiles, &u, &mut sums[0]);
        gather(&packed, &u, &mut sums[1]);
        for (which, eps) in [(0, 1e-12), (1, 1e-5)] {
            for (i, found) in images[which].iter().enumerate() {
                close(*found, &mut (0..k).map(|l| columns[l * m + i] * number(3 * l + 1)), eps);
            }
            for (l, found) in sums[which].iter().enumerate() {
                close(*found, &mut (0..m).map(|i| columns[l * m + i] * number(3 * i + 1)), eps);
            }
        }
    }

    #[test]
    fn all_columns_and_rows_take_part() {
        for (m, k) in
            (1..40).step_by(3).flat_map(|m| (0..10).map(move |k| (m, k))).chain([(64, 64), (65, 13)])
        {
            check::<f64>(m, k);
            check::<Rgb>(m, k);
            check::<Spectrum<9>>(m, k);
        }
    }
}
