//! The upper triangle of a symmetric matrix, row by row with the diagonal: (0,0) (0,1) … (0,n−1) (1,1) …

use rayon::prelude::*;

/// In which numbers the exchanges are kept. Calculations are in `f64` whatever the storage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Storage {
    /// `f32`, four bytes: rounds a factor by 6·10⁻⁸ of itself.
    Single,
    /// `f64`, eight bytes.
    Double,
}

/// The tolerance of a factor down to which `f32` does: its rounding, 1.2·10⁻⁷ of a factor at most, is then an eighth of it.
const SINGLE: f64 = 1e-6;

impl Storage {
    /// The smallest that keeps factors with an error of `tolerance`.
    pub fn for_tolerance(tolerance: f64) -> Self {
        if tolerance >= SINGLE { Self::Single } else { Self::Double }
    }

    /// The bytes of a number.
    pub fn bytes(self) -> u64 {
        match self {
            Self::Single => 4,
            Self::Double => 8,
        }
    }
}

/// The numbers, of which nobody outside asks how they are kept.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Values {
    Single(Vec<f32>),
    Double(Vec<f64>),
}

impl Values {
    pub(super) fn zeros(storage: Storage, entries: usize) -> Self {
        match storage {
            Storage::Single => Self::Single(vec![0.0; entries]),
            Storage::Double => Self::Double(vec![0.0; entries]),
        }
    }

    pub(super) fn storage(&self) -> Storage {
        match self {
            Self::Single(_) => Storage::Single,
            Self::Double(_) => Storage::Double,
        }
    }

    pub(super) fn get(&self, index: usize) -> f64 {
        match self {
            Self::Single(values) => f64::from(values[index]),
            Self::Double(values) => values[index],
        }
    }
}

/// How many entries the triangle of an n × n matrix has.
pub(super) fn entries(n: usize) -> usize {
    n * (n + 1) / 2
}

/// Where row i begins, with its diagonal.
pub(super) fn row_start(n: usize, i: usize) -> usize {
    // Rows 0 … i − 1 have n, n − 1, …, n − i + 1 entries.
    i * n - i * i.saturating_sub(1) / 2
}

/// Where (i, j) or (j, i) is.
pub(super) fn index(n: usize, i: usize, j: usize) -> usize {
    let (i, j) = (i.min(j), i.max(j));
    row_start(n, i) + (j - i)
}

/// Fills values and errors row by row, each row by one thread, the long ones first; `entry(i, j)` is asked for j ≥ i.
pub(super) fn fill(
    n: usize,
    values: &mut Values,
    errors: &mut [u8],
    entry: impl Fn(usize, usize) -> (f64, u8) + Sync,
    filled: impl Fn(usize) + Sync,
) {
    match values {
        Values::Single(values) => fill_as(n, values, errors, |x| x as f32, entry, filled),
        Values::Double(values) => fill_as(n, values, errors, |x| x, entry, filled),
    }
}

fn fill_as<T: Send>(
    n: usize,
    values: &mut [T],
    errors: &mut [u8],
    stored: impl Fn(f64) -> T + Sync,
    entry: impl Fn(usize, usize) -> (f64, u8) + Sync,
    filled: impl Fn(usize) + Sync,
) {
    let rows: Vec<_> = (0..n).zip(rows_mut(n, values).zip(rows_mut(n, errors))).collect();
    rows.into_par_iter().with_max_len(1).for_each(|(i, (values, errors))| {
        for (j, (value, error)) in (i..).zip(values.iter_mut().zip(errors.iter_mut())) {
            let (number, code) = entry(i, j);
            (*value, *error) = (stored(number), code);
        }
        filled(n - i);
    });
}

/// The rows of a triangle.
fn rows_mut<T>(n: usize, mut rest: &mut [T]) -> impl Iterator<Item = &mut [T]> {
    (0..n).map(move |i| {
        let (row, after) = std::mem::take(&mut rest).split_at_mut(n - i);
        rest = after;
        row
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pair_has_a_place_of_its_own_and_rows_are_contiguous() {
        for n in [0, 1, 2, 7] {
            let places: Vec<usize> =
                (0..n).flat_map(|i| (i..n).map(move |j| (i, j))).map(|(i, j)| index(n, i, j)).collect();
            assert_eq!(places, (0..entries(n)).collect::<Vec<_>>());
            assert!((0..n).all(|i| (0..n).all(|j| index(n, i, j) == index(n, j, i))));
        }
    }

    #[test]
    fn both_storages_are_filled_with_the_same_numbers() {
        let n = 9;
        for storage in [Storage::Single, Storage::Double] {
            let mut values = Values::zeros(storage, entries(n));
            let mut errors = vec![0; entries(n)];
            fill(n, &mut values, &mut errors, |i, j| ((10 * i + j) as f64, j as u8), |_| ());
            for i in 0..n {
                for j in i..n {
                    let k = index(n, i, j);
                    assert_eq!((values.get(k), errors[k]), ((10 * i + j) as f64, j as u8));
                }
            }
        }
    }
}
