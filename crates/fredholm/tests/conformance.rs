//! One suite that every operator passes: what it stores, what it gathers and what it shoots are the same matrix.

use fredholm::discretize::Coupling;
use fredholm::operator::hierarchical::{Hierarchical, HierarchicalError, Options, Plan};
use fredholm::operator::{Columns, Dense, NotFinite, OnTheFly, Operator, Rows, TransposedOperator};
use fredholm::value::{Rgb, Spectrum};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Neither symmetric nor zero on the diagonal: a transposed column and a forgotten diagonal show.
#[derive(Clone)]
struct Lopsided(usize);

impl Coupling for Lopsided {
    fn dim(&self) -> usize {
        self.0
    }
    fn entry(&self, i: usize, j: usize) -> f64 {
        (1.0 + i as f64) / (3.0 + 2.0 * i as f64 + 7.0 * j as f64) / self.0 as f64
    }
}

/// Self-adjoint for unequal weights: a forgotten weight shows.
struct Reciprocal(Vec<f64>);

impl Coupling for Reciprocal {
    fn dim(&self) -> usize {
        self.0.len()
    }
    fn entry(&self, i: usize, j: usize) -> f64 {
        let symmetric = 1.0 / (1.0 + (i * j) as f64 + (i + j) as f64 / 3.0);
        symmetric / self.0[i]
    }
    fn reciprocity(&self) -> Option<&[f64]> {
        Some(&self.0)
    }
}

fn reciprocal(n: usize) -> Reciprocal {
    Reciprocal((0..n).map(|i| 1.0 + (i % 7) as f64).collect())
}

/// Holds for any operator that keeps `coupling`, to the relative precision `eps` of what it stores.
fn conforms(operator: &(impl Rows + Columns), coupling: &impl Coupling, eps: f64) {
    let n = coupling.dim();
    assert_eq!(operator.dim(), n);
    let close = |a: f64, b: f64| (a - b).abs() <= eps * b.abs();
    let (mut first, mut second) = (Vec::new(), Vec::new());
    for i in 0..n {
        assert!(close(operator.diagonal(i), coupling.entry(i, i)), "diagonal {i}");
        let (row, column) = (operator.row(i, &mut first), operator.column(i, &mut second));
        assert_eq!((row.iter().count(), column.iter().count()), (n, n));
        for j in 0..n {
            assert!(close(row.get(j), coupling.entry(i, j)), "row {i}, entry {j}");
            assert!(close(column.get(j), coupling.entry(j, i)), "column {i}, entry {j}");
        }
        assert!(row.iter().enumerate().all(|(j, entry)| entry == row.get(j)));
        assert!(close(row.abs_sum(), row.iter().map(f64::abs).sum()));
    }
    let u: Vec<Rgb> = (0..n).map(|j| Spectrum([1.0, j as f64, -2.0 + (j % 3) as f64])).collect();
    let mut image = vec![Spectrum([f64::NAN; 3]); n];
    operator.apply(&u, &mut image);
    acts(&u, &image, |i, j| coupling.entry(i, j), eps);
    operator.apply_transposed(&u, &mut image);
    acts(&u, &image, |i, j| coupling.entry(j, i), eps);
}

/// Holds where `image` is what the matrix of these entries makes of u, to the relative precision `eps`.
fn acts(u: &[Rgb], image: &[Rgb], entry: impl Fn(usize, usize) -> f64, eps: f64) {
    for (i, image) in image.iter().enumerate() {
        for channel in 0..3 {
            let terms = u.iter().enumerate().map(|(j, u)| entry(i, j) * u.0[channel]);
            let (sum, size) = terms.fold((0.0, 0.0), |(s, a), t: f64| (s + t, a + t.abs()));
            assert!((image.0[channel] - sum).abs() <= (eps + 1e-14) * size, "row {i}, channel {channel}");
        }
    }
}

/// Kept hierarchically, with the numbers of the unknowns for their places, in the order of their last digits.
fn hierarchical(coupling: &impl Coupling) -> Result<Hierarchical, HierarchicalError> {
    let points: Vec<[f64; 1]> = (0..coupling.dim()).map(|i| [((i % 7) * 1000 + i) as f64]).collect();
    let options = Options { tolerance: 1e-14, leaf: 8, ..Options::default() };
    Plan::new(coupling, &points, options)?.assemble(|_| ())
}

#[test]
fn every_operator_keeps_what_the_coupling_says() {
    // Sizes around the lanes of a dot product and the bands of the mirror: 0, 1, not a multiple, several bands and parts of a column.
    for n in [0, 1, 7, 8, 64, 65, 300] {
        let lopsided = Lopsided(n);
        conforms(&Dense::<f64>::assemble(&lopsided, |_| ()).unwrap(), &lopsided, 1e-15);
        conforms(&Dense::<f32>::assemble(&lopsided, |_| ()).unwrap(), &lopsided, 6e-8);
        conforms(&OnTheFly(lopsided.clone()), &lopsided, 1e-15);
        conforms(&hierarchical(&lopsided).unwrap(), &lopsided, 1e-11);
        let reciprocal = reciprocal(n);
        conforms(&Dense::<f64>::assemble(&reciprocal, |_| ()).unwrap(), &reciprocal, 1e-14);
        conforms(&Dense::<f32>::assemble(&reciprocal, |_| ()).unwrap(), &reciprocal, 2e-7);
        conforms(&OnTheFly(&reciprocal), &reciprocal, 1e-14);
        conforms(&hierarchical(&reciprocal).unwrap(), &reciprocal, 1e-11);
    }
}

fn entries_computed(coupling: &impl Coupling) -> usize {
    let total = AtomicUsize::new(0);
    let counted = Dense::<f64>::assemble(coupling, |n| {
        total.fetch_add(n, Ordering::Relaxed);
    });
    assert!(counted.is_ok());
    total.into_inner()
}

#[test]
fn reciprocity_halves_the_work() {
    assert_eq!(entries_computed(&Lopsided(100)), 100 * 100);
    assert_eq!(entries_computed(&reciprocal(100)), 100 * 101 / 2);
}

#[test]
fn a_singular_kernel_is_told_with_its_place() {
    struct Singular;
    impl Coupling for Singular {
        fn dim(&self) -> usize {
            5
        }
        fn entry(&self, i: usize, j: usize) -> f64 {
            if (i, j) == (3, 4) { 1.0 / 0.0 } else { 1.0 }
        }
    }
    let told = Dense::<f64>::assemble(&Singular, |_| ()).unwrap_err();
    assert_eq!(told, NotFinite { row: 3, column: 4, value: f64::INFINITY });
    assert_eq!(hierarchical(&Singular).unwrap_err(), HierarchicalError::Entry(told));
}

#[test]
fn the_same_digits_for_any_number_of_threads() {
    let images = [1, 2, 5].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let matrix = Dense::<f32>::assemble(&reciprocal(1500), |_| ()).unwrap();
            let blocks = hierarchical(&reciprocal(1500)).unwrap();
            let u: Vec<f64> = (0..1500).map(|j| (j as f64).sin()).collect();
            let mut images = vec![0.0; 3 * 1500];
            matrix.apply(&u, &mut images[..1500]);
            blocks.apply(&u, &mut images[1500..3000]);
            blocks.apply_transposed(&u, &mut images[3000..]);
            (images, *blocks.statistics())
        })
    });
    assert_eq!(images[0], images[1]);
    assert_eq!(images[0], images[2]);
}
