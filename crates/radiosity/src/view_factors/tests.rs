//! The container, filled with numbers made up for it.

use super::*;

/// Areas that differ, so that a factor taken for its reciprocal shows.
fn areas(n: usize) -> Vec<f64> {
    (0..n).map(|i| 1.0 + 0.37 * i as f64).collect()
}

/// An exchange that no other pair has, and an error that is 0 for every fifth pair.
fn made_up(i: usize, j: usize) -> Exchange {
    let (i, j) = (i.min(j), i.max(j));
    let value = if i == j { 0.0 } else { 1.0 / (3 + i + 7 * j) as f64 };
    let error = if (i + j).is_multiple_of(5) { 0.0 } else { 1e-7 * (1 + i * j) as f64 };
    Exchange { value, error }
}

fn factors(n: usize, storage: Storage) -> ViewFactors {
    let names = (0..n).map(|i| format!("face {i}")).collect();
    ViewFactors::assemble(names, areas(n), storage, made_up, |_| ())
}

#[test]
fn factors_come_back_within_the_error_that_is_told() {
    let n = 12;
    for storage in [Storage::Single, Storage::Double] {
        let factors = factors(n, storage);
        for (i, a) in areas(n).into_iter().enumerate() {
            for j in 0..n {
                let (truth, told) = (made_up(i, j), factors.exchange(i, j));
                let missed = (told.value - truth.value).abs();
                // Two roundings of f32, and a step of the code.
                let most = 1.15 * (truth.error + 1.2e-7 * truth.value) + 1e-15 * a;
                assert!(truth.error + missed <= told.error && told.error <= most, "{storage:?} {i} {j}");
                // A file in f32 rounds once more.
                let in_file = match storage {
                    Storage::Single => f64::from(factors.factor(i, j) as f32),
                    Storage::Double => factors.factor(i, j),
                };
                assert!((in_file - truth.value / a).abs() <= factors.error(i, j), "{storage:?} {i} {j}");
                assert_eq!(factors.factor(i, j), told.value / a);
                assert_eq!(factors.error(i, j), told.error / a);
            }
            assert_eq!(factors.row(i).collect::<Vec<_>>()[3], factors.factor(i, 3));
            assert_eq!(factors.row_errors(i).len(), n);
        }
        // More rows than a band.
        let many = self::factors(75, storage);
        assert!(many.rows().zip(0..).all(|(row, i)| many.row(i).eq(row)) && many.rows().count() == 75);
        assert!(many.rows_of_errors().zip(0..).all(|(row, i)| many.row_errors(i).eq(row)));
        assert!(factors.reciprocity_defect() <= 2.0 * f64::EPSILON);
    }
}

#[test]
fn what_is_exactly_nothing_stays_so_and_what_is_no_number_is_told() {
    let pair = |i: usize, j: usize| match (i, j) {
        (0, 1) => Exchange { value: f64::NAN, error: 0.0 },
        (0, 2) => Exchange { value: 0.0, error: 1e-9 },
        (1, 2) => Exchange { value: 0.25, error: f64::NAN },
        _ => Exchange::default(),
    };
    let factors = ViewFactors::assemble(vec![String::new(); 4], areas(4), Storage::Single, pair, |_| ());
    assert_eq!(factors.exchange(0, 3), Exchange::default());
    assert_eq!(factors.exchange(0, 1), Exchange { value: 0.0, error: f64::INFINITY });
    assert!(factors.exchange(0, 2).error >= 1e-9 && factors.factor(0, 2) == 0.0);
    assert_eq!(factors.error(1, 2), f64::INFINITY);
    assert_eq!(factors.largest_error(), Some((f64::INFINITY, [0, 1])));
    assert_eq!(factors.seen_pairs(), 1);
}

#[test]
fn sums_and_worst_errors_are_those_of_the_rows() {
    let n = 12;
    let factors = factors(n, Storage::Double);
    let sums = factors.row_sums();
    for (i, sum) in sums.iter().enumerate() {
        let by_hand: f64 = (0..n).map(|j| made_up(i, j).value).sum::<f64>() / areas(n)[i];
        assert!((sum.value - by_hand).abs() < 1e-15);
        assert!((sum.error - factors.row_errors(i).sum::<f64>()).abs() < 1e-15);
    }
    let defect = sums.iter().map(|sum| (sum.value - 1.0).abs()).fold(0.0, f64::max);
    assert_eq!(factors.closure_defect(), defect);
    let (worst, [i, j]) = factors.largest_error().unwrap();
    assert!((0..n).all(|i| factors.row_errors(i).all(|error| error <= worst * (1.0 + 1e-15))));
    assert!((factors.error(i, j) / worst - 1.0).abs() < 1e-14);
}

#[test]
fn groups_add_up_exchanges_errors_and_areas() {
    let n = 9;
    let factors = factors(n, Storage::Double);
    let group_of = [0, 1, 0, 2, 1, 1, 2, 0, 1];
    let grouped = factors.grouped(&group_of, ["a", "b", "c"].map(String::from).to_vec());
    let members = |a: usize| (0..n).filter(move |&i| group_of[i] == a);
    for a in 0..3 {
        let area: f64 = members(a).map(|i| factors.areas()[i]).sum();
        assert!((grouped.areas()[a] - area).abs() < 1e-14);
        for b in 0..3 {
            // Every ordered pair of a face of a and a face of b, once.
            let pairs = || members(a).flat_map(|i| members(b).map(move |j| (i, j)));
            let value: f64 = pairs().map(|(i, j)| factors.exchange(i, j).value).sum();
            let error: f64 = pairs().map(|(i, j)| factors.exchange(i, j).error).sum();
            assert!((grouped.factor(a, b) - value / area).abs() < 1e-15, "{a} {b}");
            let told = grouped.error(a, b);
            assert!(told >= error / area && told < 1.15 * error / area + 1e-14, "{a} {b}");
        }
    }
    assert!(grouped.factor(0, 0) > 0.0, "a group sees itself");
    // Row sums are means of the rows, weighted by area.
    let sums = factors.row_sums();
    let mean: f64 = members(1).map(|i| factors.areas()[i] * sums[i].value).sum::<f64>() / grouped.areas()[1];
    assert!((grouped.row_sums()[1].value - mean).abs() < 1e-14);
}

#[test]
fn the_digits_do_not_depend_on_the_number_of_threads() {
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| factors(60, Storage::Single))
    };
    assert_eq!(with(1), with(3));
}

#[test]
fn the_memory_is_as_told() {
    assert_eq!(ViewFactors::bytes(3, Storage::Single), 6 * 5);
    assert_eq!(ViewFactors::bytes(3, Storage::Double), 6 * 9);
    assert!(ViewFactors::bytes(22_272, Storage::Single) < 1_300_000_000);
    assert_eq!(
        (Storage::for_tolerance(1e-6), Storage::for_tolerance(9e-7)),
        (Storage::Single, Storage::Double)
    );
    assert!(
        ViewFactors::assemble(vec![], vec![], Storage::Single, made_up, |_| ()).largest_error().is_none()
    );
}

/// What n grey faces exchange, with every bounce followed, is script F; and what errors of the factors make of it is within
/// what is told.
#[test]
fn reflections_are_all_bounces_and_errors_go_with_them() {
    let n = 7;
    let emittances: Vec<f64> = (0..n).map(|i| [0.9, 0.2, 1.0, 0.05][i % 4]).collect();
    let script = |factors: &ViewFactors, emittances: &[f64]| {
        // ε_i (F + Fρ F + …)_ij ε_j, bounce by bounce.
        let mut bounce: Vec<Vec<f64>> = factors.rows().collect();
        let mut sum = bounce.clone();
        for _ in 0..3000 {
            let next = |i: usize, j: usize| {
                (0..n).map(|k| bounce[i][k] * (1.0 - emittances[k]) * factors.factor(k, j)).sum()
            };
            bounce = (0..n).map(|i| (0..n).map(|j| next(i, j)).collect()).collect();
            (0..n).for_each(|i| (0..n).for_each(|j| sum[i][j] += bounce[i][j]));
        }
        (0..n).for_each(|i| (0..n).for_each(|j| sum[i][j] *= emittances[i] * emittances[j]));
        sum
    };
    let factors = factors(n, Storage::Double);
    let (found, expected) = (factors.with_reflections(&emittances), script(&factors, &emittances));
    for (i, row) in expected.iter().enumerate() {
        assert!(found.row(i).zip(row).all(|(found, expected)| (found - expected).abs() < 1e-12), "{i}");
    }
    assert!(found.reciprocity_defect() < 1e-15);
    assert_eq!(
        factors.with_reflections(&vec![1.0; n]).row(3).collect::<Vec<_>>(),
        factors.row(3).collect::<Vec<_>>()
    );
    // The factors at the ends of their errors, by turns and all one way: all one way reaches what is told.
    for sign in [|_, _| 1.0, |i: usize, j: usize| if (i * j).is_multiple_of(2) { 1.0 } else { -1.0 }] {
        let names = (0..n).map(|i| i.to_string()).collect();
        let off =
            |i, j| Exchange { value: made_up(i, j).value + sign(i, j) * made_up(i, j).error, error: 0.0 };
        let moved = ViewFactors::assemble(names, areas(n), Storage::Double, off, |_| ())
            .with_reflections(&emittances);
        for i in 0..n {
            for j in 0..n {
                let change = (moved.factor(i, j) - found.factor(i, j)).abs();
                assert!(change <= found.error(i, j), "{i} {j}: {change:e} {:e}", found.error(i, j));
                assert!(sign(1, 1) < 0.0 || change > 0.8 * found.error(i, j), "{i} {j}: {change:e}");
            }
        }
    }
}
