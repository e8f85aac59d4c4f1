//! y += M x and s += Mᵀ u for a matrix M of m rows and k columns in *tiles*: sixteen rows at a time, and of these column after
//! column, so that memory is read from one end to the other while sixteen sums stay in registers.

use crate::operator::{Entry, Line};
use crate::value::Value;
use wide::f64x4;

/// Rows of a tile; the last one has what is left. Four vectors of sums hide the latency of an addition.
const TILE: usize = 16;

/// The numbers of a matrix given column after column, in tiles.
pub(super) fn in_tiles(columns: &[f64], m: usize) -> impl Iterator<Item = f64> + use<'_> {
    let firsts = (0..m).step_by(TILE);
    firsts.flat_map(move |first| {
        let columns = columns.chunks_exact(m);
        columns.flat_map(move |column| column[first..(first + TILE).min(m)].iter().copied())
    })
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

/// `image` += M x.
pub(super) fn spread<V: Value, T: Entry>(numbers: &[T], x: &[V], image: &mut [V]) {
    if x.is_empty() {
        return;
    }
    for (tile, image) in numbers.chunks(TILE * x.len()).zip(image.chunks_mut(TILE)) {
        match (V::numbers(x), V::numbers_mut(image).and_then(|image| image.try_into().ok())) {
            (Some(x), Some::<&mut [f64; TILE]>(image)) => {
                by_columns(tile, |first, columns| spread_tile(columns, &x[first..], &mut *image));
            }
            _ => {
                for (column, x) in tile.chunks_exact(image.len()).zip(x) {
                    image.iter_mut().zip(column).for_each(|(value, number)| *value += *x * (*number).into());
                }
            }
        }
    }
}

/// `sums` += Mᵀ u.
pub(super) fn gather<V: Value, T: Entry>(numbers: &[T], u: &[V], sums: &mut [V]) {
    if sums.is_empty() {
        return;
    }
    for (tile, u) in numbers.chunks(TILE * sums.len()).zip(u.chunks(TILE)) {
        match (V::numbers(u).and_then(|u| u.try_into().ok()), V::numbers_mut(sums)) {
            (Some(u), Some(sums)) => {
                by_columns(tile, |first, columns| gather_tile(columns, u, &mut sums[first..]));
            }
            _ => {
                for (column, sum) in tile.chunks_exact(u.len()).zip(&mut *sums) {
                    column.iter().zip(u).for_each(|(number, u)| *sum += *u * (*number).into());
                }
            }
        }
    }
}

/// Columns of a tile that are brought to double precision at once.
const SOME: usize = 8;

/// Calls `act` with the number of the first column and the columns from there on, all of a tile or some.
fn by_columns<T: Entry>(tile: &[T], mut act: impl FnMut(usize, &[[f64; TILE]])) {
    match T::line(tile) {
        Line::Full(numbers) => act(0, numbers.as_chunks().0),
        Line::Packed(numbers) => {
            let mut buffer = [0.0; SOME * TILE];
            for (k, numbers) in numbers.chunks(SOME * TILE).enumerate() {
                let columns = &mut buffer[..numbers.len()];
                columns.iter_mut().zip(numbers).for_each(|(wide, number)| *wide = f64::from(*number));
                act(SOME * k, columns.as_chunks().0);
            }
        }
    }
}

/// Sixteen numbers in vector registers.
type Lanes = [f64x4; TILE / 4];

fn lanes(numbers: &[f64; TILE]) -> Lanes {
    std::array::from_fn(|k| {
        f64x4::new([numbers[4 * k], numbers[4 * k + 1], numbers[4 * k + 2], numbers[4 * k + 3]])
    })
}

fn spread_tile(columns: &[[f64; TILE]], x: &[f64], image: &mut [f64; TILE]) {
    let mut sums = lanes(image);
    for (column, x) in columns.iter().zip(x) {
        let (column, x) = (lanes(column), f64x4::splat(*x));
        sums.iter_mut().zip(column).for_each(|(sum, numbers)| *sum += numbers * x);
    }
    image.as_chunks_mut().0.iter_mut().zip(sums).for_each(|(values, sum)| *values = sum.to_array());
}

fn gather_tile(columns: &[[f64; TILE]], u: &[f64; TILE], sums: &mut [f64]) {
    let u = lanes(u);
    for (column, sum) in columns.iter().zip(sums) {
        let [a, b, c, d] = lanes(column);
        *sum += ((a * u[0] + b * u[1]) + (c * u[2] + d * u[3])).reduce_add();
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
        let tiles: Vec<f64> = in_tiles(&columns, m).collect();
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
