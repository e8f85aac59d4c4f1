//! The projection against its definition, and against a search through all that could be held at 0.

use super::*;
use crate::view_factors::{Exchange, Storage};

fn factors(areas: &[f64], pair: impl Fn(usize, usize) -> Exchange + Sync) -> ViewFactors {
    let names = (0..areas.len()).map(|i| format!("face {i}")).collect();
    ViewFactors::assemble(names, areas.to_vec(), Storage::Double, pair, |_| ())
}

/// A number in [−1, 1) that looks random, the same for (i, j) and (j, i).
fn noise(i: usize, j: usize) -> f64 {
    let (i, j) = (i.min(j) as f64, i.max(j) as f64);
    2.0 * ((12.9898 * i + 78.233 * j + 1.0).sin() * 43758.5453).rem_euclid(1.0) - 1.0
}

/// A closed scene: exchanges A_i A_j / ΣA, as between patches of a sphere, and what errors made of them.
fn sphere(n: usize, error: f64) -> ViewFactors {
    let areas: Vec<f64> = (0..n).map(|i| 1.0 + 0.5 * noise(i, 999)).collect();
    let total: f64 = areas.iter().sum();
    let pair = |i: usize, j: usize| {
        let mean = areas[i] * areas[j] / total;
        Exchange { value: (mean * (1.0 + error * noise(i, j))).max(0.0), error: error * mean }
    };
    factors(&areas, pair)
}

/// Row sums of 1, no factor below 0, and the gradient of the norm a sum λ_i + λ_j where the factor is above 0 and not
/// less than it where it is 0: the conditions of Karush, Kuhn and Tucker.
fn assert_nearest(before: &ViewFactors, after: &ViewFactors) {
    let n = before.len();
    let change = |i: usize, j: usize| {
        (after.exchange(i, j).value - before.exchange(i, j).value) / (before.areas()[i] * before.areas()[j])
    };
    let positive = |i: usize, j: usize| after.exchange(i, j).value > 0.0;
    let Multipliers(multipliers) = after.corrected.as_ref().unwrap();
    for sum in after.row_sums() {
        assert!((sum.value - 1.0).abs() < 1e-12, "{}", sum.value);
    }
    for i in 0..n {
        for j in 0..n {
            let slope = multipliers[i] + multipliers[j];
            match positive(i, j) {
                true => assert!((change(i, j) - slope).abs() < 1e-12, "{i} {j}"),
                false => {
                    let certain = before.exchange(i, j) == Exchange::default();
                    assert!(certain || change(i, j) >= slope - 1e-12, "{i} {j}");
                }
            }
        }
    }
}

#[test]
fn a_closed_scene_with_errors_is_closed_by_the_least_change() {
    for n in [4, 20, 150] {
        let before = sphere(n, 1e-3);
        let mut after = before.clone();
        let correction = after.enforce(&vec![true; n]).unwrap();
        assert_nearest(&before, &after);
        assert!(correction.defect_before > 1e-5 && correction.defect <= 1e-12 && correction.rows == n);
        assert!(correction.at_zero == 0 && correction.norm < correction.error_norm);
        assert!(correction.steps <= 4, "{} steps", correction.steps);
        // What is told of it is so.
        let changes = || (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
        let change = |(i, j)| after.exchange(i, j).value - before.exchange(i, j).value;
        let largest = changes().map(|(i, j)| change((i, j)).abs() / before.areas()[i]).fold(0.0, f64::max);
        let norm: f64 =
            changes().map(|(i, j)| change((i, j)).powi(2) / (before.areas()[i] * before.areas()[j])).sum();
        assert!((correction.largest / largest - 1.0).abs() < 1e-12);
        assert!((correction.norm / norm.sqrt() - 1.0).abs() < 1e-12);
        for (i, j) in changes() {
            let grown = before.exchange(i, j).error + change((i, j)).abs();
            assert!((after.exchange(i, j).error - grown).abs() < 1e-15);
        }
    }
}

#[test]
fn what_is_closed_stays_as_it_is() {
    let mut once = sphere(40, 1e-2);
    once.enforce(&[true; 40]).unwrap();
    let mut twice = factors(once.areas(), |i, j| Exchange { error: 1e-3, ..once.exchange(i, j) });
    let correction = twice.enforce(&[true; 40]).unwrap();
    assert!(correction.largest < 1e-13 && correction.defect_before < 1e-12, "{correction:?}");
    let again = once.clone();
    once.enforce(&[true; 40]).unwrap();
    assert_eq!(once, again, "from the exchanges as they were computed");
}

/// Exchanges of five faces whose rows are too full, but for the last: what it has of the others is small, and must not
/// become negative. One pair is certainly nothing.
fn five() -> ViewFactors {
    let areas = [1.0, 1.3, 0.8, 1.1, 0.6];
    let given = [
        [0.0, 0.9, 0.3, 0.3, 0.001],
        [0.9, 0.0, 0.4, 0.3, 0.002],
        [0.3, 0.4, 0.0, 0.2, 0.6],
        [0.3, 0.3, 0.2, 0.0, 0.0],
        [0.001, 0.002, 0.6, 0.0, 0.0],
    ];
    factors(&areas, |i, j| match given[i][j] {
        0.0 => Exchange::default(),
        value => Exchange { value, error: 0.4 },
    })
}

#[test]
fn small_exchanges_are_held_at_nothing_and_not_below() {
    let before = five();
    let mut after = before.clone();
    let correction = after.enforce(&[true; 5]).unwrap();
    assert!(correction.at_zero > 0, "the case was made for it: {correction:?}");
    assert_nearest(&before, &after);
    assert_eq!(after.exchange(3, 4), Exchange::default());
    let best = search_all(&before);
    for i in 0..5 {
        for j in 0..5 {
            let (found, best) = (after.exchange(i, j).value, best[i][j]);
            assert!((found - best).abs() < 1e-10, "{i} {j}: {found} {best}");
        }
    }
}

/// The nearest by brute force: every set of pairs is held at 0 once, the rest solved for without a sign; the best of
/// those that have no negative exchange.
fn search_all(factors: &ViewFactors) -> Vec<Vec<f64>> {
    let n = factors.len();
    let free: Vec<(usize, usize)> = (0..n)
        .flat_map(|i| (i + 1..n).map(move |j| (i, j)))
        .filter(|&(i, j)| factors.exchange(i, j) != Exchange::default())
        .collect();
    let mut best = (f64::INFINITY, Vec::new());
    for held in 0_u32..1 << free.len() {
        let pairs = || free.iter().enumerate().filter(|(k, _)| held & (1 << k) == 0).map(|(_, pair)| *pair);
        let Some(exchanges) = without_sign(factors, &pairs().collect::<Vec<_>>()) else { continue };
        if exchanges.iter().flatten().any(|value| *value < -1e-12) {
            continue;
        }
        let distance: f64 = (0..n)
            .flat_map(|i| (0..n).map(move |j| (i, j)))
            .map(|(i, j)| {
                let change = exchanges[i][j] - factors.exchange(i, j).value;
                change.powi(2) / (factors.areas()[i] * factors.areas()[j])
            })
            .sum();
        if distance < best.0 {
            best = (distance, exchanges);
        }
    }
    assert!(best.0.is_finite());
    best.1
}

/// The nearest exchanges with rows A_i, of these pairs alone and of any sign: the multipliers by elimination.
fn without_sign(factors: &ViewFactors, pairs: &[(usize, usize)]) -> Option<Vec<Vec<f64>>> {
    let (n, areas) = (factors.len(), factors.areas());
    let mut rows = vec![vec![0.0; n + 1]; n];
    for (i, row) in rows.iter_mut().enumerate() {
        row[n] = areas[i];
    }
    for &(i, j) in pairs {
        let weight = areas[i] * areas[j];
        for (a, b) in [(i, j), (j, i)] {
            rows[a][a] += weight;
            rows[a][b] += weight;
            rows[a][n] -= factors.exchange(i, j).value;
        }
    }
    let multipliers = solved(rows)?;
    let mut exchanges = vec![vec![0.0; n]; n];
    for &(i, j) in pairs {
        let value = factors.exchange(i, j).value + areas[i] * areas[j] * (multipliers[i] + multipliers[j]);
        (exchanges[i][j], exchanges[j][i]) = (value, value);
    }
    Some(exchanges)
}

/// Gauss and Jordan, with pivots; `None` for a singular matrix.
fn solved(mut rows: Vec<Vec<f64>>) -> Option<Vec<f64>> {
    let n = rows.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|a, b| rows[*a][k].abs().total_cmp(&rows[*b][k].abs()))?;
        rows.swap(k, pivot);
        if rows[k][k].abs() < 1e-9 {
            return None;
        }
        let eliminating = rows[k].clone();
        for (_, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != k) {
            let times = row[k] / eliminating[k];
            row.iter_mut().zip(&eliminating).for_each(|(x, y)| *x -= times * y);
        }
    }
    Some((0..n).map(|k| rows[k][n] / rows[k][k]).collect())
}

#[test]
fn rows_that_are_not_whole_are_left_free() {
    let n = 20;
    let mut factors = sphere(n, 1e-3);
    let mut whole = vec![true; n];
    (whole[3], whole[7]) = (false, false);
    let before = factors.clone();
    let correction = factors.enforce(&whole).unwrap();
    assert_eq!(correction.rows, n - 2);
    assert_eq!(factors.exchange(3, 7).value, before.exchange(3, 7).value);
    for (i, sum) in factors.row_sums().iter().enumerate() {
        assert_eq!((sum.value - 1.0).abs() < 1e-12, whole[i], "{i}: {}", sum.value);
    }
}

#[test]
fn two_faces_that_see_but_each_other_are_closed() {
    // The second derivative is singular here: only λ_0 + λ_1 matters.
    let mut pair = factors(&[2.0, 2.0], |i, j| match i == j {
        true => Exchange::default(),
        false => Exchange { value: 1.99, error: 0.02 },
    });
    assert!(pair.enforce(&[true; 2]).is_ok());
    assert!((pair.factor(0, 1) - 1.0).abs() < 1e-12);
}

#[test]
fn what_is_not_closed_is_refused_and_left_alone() {
    let exchange = |value: f64, error: f64| {
        move |i: usize, j: usize| if i == j { Exchange::default() } else { Exchange { value, error } }
    };
    let refused = |mut factors: ViewFactors, whole: &[bool]| {
        let before = factors.clone();
        let error = factors.enforce(whole).unwrap_err();
        assert_eq!(factors, before);
        error
    };
    let open = refused(factors(&[1.0; 3], exchange(0.4, 1e-4)), &[true; 3]);
    assert!(
        matches!(&open, EnforceError::Open { name, sum, .. } if name == "face 0" && (sum - 0.8).abs() < 1e-12)
    );
    assert!(open.to_string().contains("close the mesh"), "{open}");
    let alone = factors(&[1.0; 3], |i, j| {
        if i == 2 || j == 2 || i == j { Exchange::default() } else { Exchange { value: 1.0, error: 1e-3 } }
    });
    assert!(matches!(refused(alone, &[true; 3]), EnforceError::Alone { name } if name == "face 2"));
    // What leaves the larger of two faces cannot all arrive at the smaller.
    let lopsided = refused(factors(&[1.0, 3.0], exchange(1.0, 1.0)), &[true; 2]);
    assert!(matches!(lopsided, EnforceError::Unreachable { .. }), "{lopsided}");
    assert_eq!(refused(sphere(4, 1e-3), &[false; 4]), EnforceError::NoRows);
}

#[test]
fn the_digits_do_not_depend_on_the_number_of_threads() {
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut factors = sphere(200, 1e-3);
            factors.enforce(&[true; 200]).unwrap();
            factors
        })
    };
    assert_eq!(with(1), with(3));
}
