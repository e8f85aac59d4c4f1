//! G_ij = A_i F_ij = ∫_{P_i} ∫_{P_j} cosθ cosθ′ V / (π r²): the view factors of faces, each with its error.
//!
//! Stored are the exchanges G_ij = G_ji, in m², of which one triangle is enough: reciprocity A_i F_ij = A_j F_ji
//! holds by construction. An entry takes four bytes or eight ([`Storage`]) and one more for its error, so that
//! 22 272 faces fit in 1.3 GB.
//!
//! In a closed scene Σ_j F_ij = 1. That the factors computed miss it tells how good they are, so it is left as it is,
//! unless [`ViewFactors::enforce`] is asked to make it true.

mod enforce;
mod error_code;
mod grouped;
mod packed;
mod reflections;

pub use enforce::{Correction, EnforceError};
pub use packed::Storage;

use enforce::{Multipliers, corrected};
use error_code::{decode, encode};
use packed::{Values, entries, fill, index, row_start};

/// What two faces exchange, ∫∫ cosθ cosθ′ V / (π r²) over both, in m².
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Exchange {
    /// The integral, A_i F_ij = A_j F_ji, in m².
    pub value: f64,
    /// A bound of its error, or an estimate of one, in m².
    pub error: f64,
}

/// The view factors between faces: F_ij is the part of what leaves face i that arrives at face j.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewFactors {
    names: Vec<String>,
    areas: Vec<f64>,
    values: Values,
    /// Codes of the errors, as a part of the smaller of the two areas: of the larger of F_ij and F_ji.
    errors: Vec<u8>,
    /// What was done to the exchanges as they were computed.
    corrected: Option<Multipliers>,
}

/// Rows that are read together: a cache line has 16 numbers and 64 errors, and 32 rows of 22 272 take 6 MB.
const BAND: usize = 32;

/// What an `f32` rounds, relative to itself.
const SINGLE_ROUNDING: f64 = 1.0 / (1 << 24) as f64;

impl ViewFactors {
    /// Computes all exchanges on all threads; the digits do not depend on how many there are.
    ///
    /// `areas` are in m², above 0, as many as there are names. `pair(i, j)` is asked once for each i ≤ j, also for i = j:
    /// a face of several polygons may see itself. `computed` is told, from any thread, how many exchanges are new.
    ///
    /// The error that is kept is that of `pair`, with that of the storage, rounded up by 15 % at most. A value that is no
    /// number becomes 0 with an infinite error.
    pub fn assemble(
        names: Vec<String>,
        areas: Vec<f64>,
        storage: Storage,
        pair: impl Fn(usize, usize) -> Exchange + Sync,
        computed: impl Fn(usize) + Sync,
    ) -> Self {
        assert_eq!(names.len(), areas.len(), "a name for each area");
        let n = areas.len();
        let mut values = Values::zeros(storage, entries(n));
        let mut errors = vec![0; entries(n)];
        let entry = |i: usize, j: usize| coded(pair(i, j), areas[i].min(areas[j]), storage);
        fill(n, &mut values, &mut errors, entry, computed);
        Self { names, areas, values, errors, corrected: None }
    }

    /// The bytes that `n` faces take.
    pub fn bytes(n: usize, storage: Storage) -> u64 {
        entries(n) as u64 * (storage.bytes() + 1)
    }

    /// How many faces there are.
    pub fn len(&self) -> usize {
        self.areas.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.areas.is_empty()
    }

    /// The names of the faces.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// The areas of the faces, in m².
    pub fn areas(&self) -> &[f64] {
        &self.areas
    }

    /// In which numbers a file keeps all that is known of the factors: as they are kept here, but in `f64` where the
    /// closure was enforced, which `f32` would undo.
    pub fn precision(&self) -> Storage {
        if self.corrected.is_some() { Storage::Double } else { self.values.storage() }
    }

    /// G_ij and the bound of its error, in m².
    pub fn exchange(&self, i: usize, j: usize) -> Exchange {
        self.entry(index(self.len(), i, j), i, j)
    }

    /// F_ij, from i to j.
    pub fn factor(&self, i: usize, j: usize) -> f64 {
        self.exchange(i, j).value / self.areas[i]
    }

    /// The error of F_ij.
    pub fn error(&self, i: usize, j: usize) -> f64 {
        self.exchange(i, j).error / self.areas[i]
    }

    /// F_i0, F_i1, …
    pub fn row(&self, i: usize) -> impl ExactSizeIterator<Item = f64> + '_ {
        (0..self.len()).map(move |j| self.factor(i, j))
    }

    /// Their errors.
    pub fn row_errors(&self, i: usize) -> impl ExactSizeIterator<Item = f64> + '_ {
        (0..self.len()).map(move |j| self.error(i, j))
    }

    /// All rows of F, one after another: much faster than each by [`row`](Self::row).
    pub fn rows(&self) -> impl Iterator<Item = Vec<f64>> + '_ {
        self.bands(|entry| entry.value)
    }

    /// All rows of their errors.
    pub fn rows_of_errors(&self) -> impl Iterator<Item = Vec<f64>> + '_ {
        self.bands(|entry| entry.error)
    }

    /// Rows, some at a time: what lies before the diagonal stands in the triangle by columns, of which a band takes a
    /// piece where a row would take an entry.
    fn bands<'a>(&'a self, part: impl Fn(Exchange) -> f64 + 'a) -> impl Iterator<Item = Vec<f64>> + 'a {
        let n = self.len();
        (0..n).step_by(BAND).flat_map(move |first| {
            let numbers = first..(first + BAND).min(n);
            let mut rows = vec![Vec::with_capacity(n); numbers.len()];
            for j in 0..first {
                let start = row_start(n, j);
                for (row, i) in rows.iter_mut().zip(numbers.clone()) {
                    row.push(part(self.entry(start + i - j, i, j)) / self.areas[i]);
                }
            }
            for (row, i) in rows.iter_mut().zip(numbers) {
                let near = (first..i).map(|j| (index(n, i, j), j));
                let places = near.chain((row_start(n, i)..).zip(i..n));
                row.extend(places.map(|(place, j)| part(self.entry(place, i, j)) / self.areas[i]));
            }
            rows
        })
    }

    /// Σ_j F_ij of each row, and the sum of its errors, which bounds the error of the sum.
    pub fn row_sums(&self) -> Vec<RowSum> {
        let mut sums = vec![RowSum::default(); self.len()];
        self.for_each(|i, j, exchange| {
            sums[i].add(exchange);
            if i != j {
                sums[j].add(exchange);
            }
        });
        for (sum, area) in sums.iter_mut().zip(&self.areas) {
            sum.value /= area;
            sum.error /= area;
        }
        sums
    }

    /// max |Σ_j F_ij − 1|: in a closed scene what the factors miss, in an open one what escapes.
    pub fn closure_defect(&self) -> f64 {
        self.row_sums().iter().map(|sum| (sum.value - 1.0).abs()).fold(0.0, f64::max)
    }

    /// max |F_ij − F_ji A_j / A_i| as the factors are told: of a triangle, which has each exchange once, it is rounding.
    pub fn reciprocity_defect(&self) -> f64 {
        let mut worst = 0.0_f64;
        self.for_each(|i, j, exchange| {
            let (from_i, from_j) = (exchange.value / self.areas[i], exchange.value / self.areas[j]);
            let defect = (from_i * self.areas[i] - from_j * self.areas[j]).abs();
            worst = worst.max(defect / self.areas[i].min(self.areas[j]));
        });
        worst
    }

    /// The largest error of a factor, and the row and column where it is; `None` if there are no faces.
    pub fn largest_error(&self) -> Option<(f64, [usize; 2])> {
        let mut worst: Option<(f64, [usize; 2])> = None;
        self.for_each(|i, j, exchange| {
            // The factor from the smaller face is the larger one, and so is its error.
            let [from, to] = if self.areas[i] <= self.areas[j] { [i, j] } else { [j, i] };
            let error = exchange.error / self.areas[from];
            if worst.is_none_or(|(most, _)| error > most) {
                worst = Some((error, [from, to]));
            }
        });
        worst
    }

    /// How many pairs i < j exchange something.
    pub fn seen_pairs(&self) -> u64 {
        let mut seen = 0;
        self.for_each(|i, j, exchange| seen += u64::from(i != j && exchange.value > 0.0));
        seen
    }

    /// Each exchange once, i ≤ j, row by row.
    fn for_each(&self, mut visit: impl FnMut(usize, usize, Exchange)) {
        let n = self.len();
        let mut place = 0;
        for i in 0..n {
            for j in i..n {
                visit(i, j, self.entry(place, i, j));
                place += 1;
            }
        }
    }

    /// The entry at a place of the triangle, which is that of (i, j).
    fn entry(&self, place: usize, i: usize, j: usize) -> Exchange {
        let smaller = self.areas[i].min(self.areas[j]);
        let (value, error) = (self.values.get(place), decode(self.errors[place]) * smaller);
        let Some(Multipliers(multipliers)) = &self.corrected else { return Exchange { value, error } };
        let areas = self.areas[i] * self.areas[j];
        let new = corrected(value, error, areas, multipliers[i] + multipliers[j]);
        Exchange { value: new, error: error + (new - value).abs() }
    }
}

/// Σ_j F_ij, and a bound of its error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RowSum {
    /// The sum.
    pub value: f64,
    /// Σ_j of the errors.
    pub error: f64,
}

impl RowSum {
    fn add(&mut self, exchange: Exchange) {
        self.value += exchange.value;
        self.error += exchange.error;
    }
}

/// An exchange as it is kept: its value, and the code of its error as a part of the smaller area.
fn coded(exchange: Exchange, smaller: f64, storage: Storage) -> (f64, u8) {
    let Exchange { value, error } = exchange;
    if !value.is_finite() {
        return (0.0, encode(f64::INFINITY));
    }
    let rounding = match storage {
        // What the storage takes away, and what a file of factors in `f32` will.
        Storage::Single => (value - f64::from(value as f32)).abs() + SINGLE_ROUNDING * value.abs(),
        Storage::Double => f64::EPSILON * value.abs(),
    };
    // The last factor makes up for the rounding of this and of what is read back.
    let part = (error + rounding) / smaller * (1.0 + 8.0 * f64::EPSILON);
    (value, encode(part))
}

#[cfg(test)]
mod tests;
