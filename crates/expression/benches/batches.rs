//! A formula in batches beside the closure that a programmer would write.

use divan::{Bencher, black_box, counter::ItemsCount};
use expression::{Column, Formula};

fn main() {
    divan::main();
}

/// Rows of a kernel: x is the same along a row, y runs over the nodes; 17, 25 and 41 are those of a Gauss rule with a
/// probe.
const ROW: [usize; 6] = [16, 17, 25, 41, 64, 256];

fn nodes(n: usize) -> Vec<f64> {
    (0..n).map(|k| (k as f64 + 0.5) / n as f64).collect()
}

fn closure(bencher: Bencher<'_, '_>, n: usize, kernel: impl Fn(f64, f64) -> f64 + Sync) {
    let y = nodes(n);
    let mut out = vec![0.0; n];
    bencher.counter(ItemsCount::new(n)).bench_local(|| {
        let x = black_box(0.3);
        for (out, y) in out.iter_mut().zip(black_box(&y)) {
            *out = kernel(x, *y);
        }
        black_box(&mut out);
    });
}

fn formula(bencher: Bencher<'_, '_>, n: usize, text: &str) {
    let kernel = Formula::parse(text, &["x", "y"]).expect("a formula");
    let y = nodes(n);
    let mut out = vec![0.0; n];
    let mut row = || {
        kernel.fill(&[Column::Same(black_box(0.3)), Column::Each(black_box(&y))], &mut out);
        black_box(&mut out);
    };
    row(); // the first call makes the registers
    bencher.counter(ItemsCount::new(n)).bench_local(row);
}

/// The same formula with y − x as a column more, as it is evaluated near the diagonal.
fn exact(bencher: Bencher<'_, '_>, n: usize, text: &str) {
    let kernel = Formula::with_difference(text, &["x", "y"], &[], ("y", "x")).expect("a formula");
    let y = nodes(n);
    let gaps: Vec<f64> = y.iter().map(|y| y - 0.3).collect();
    let mut out = vec![0.0; n];
    let mut row = || {
        let columns =
            [Column::Same(black_box(0.3)), Column::Each(black_box(&y)), Column::Each(black_box(&gaps))];
        kernel.fill(&columns, &mut out);
        black_box(&mut out);
    };
    row();
    bencher.counter(ItemsCount::new(n)).bench_local(row);
}

/// A kernel in a module of its own: `native` is the closure, `batch` the formula, `exact` that with the difference. A
/// sample is 200 calls: left to itself, divan may take a single one, which is less than the clock can tell.
macro_rules! kernels {
    ($($name:ident: $text:literal, $closure:expr;)*) => {$(
        mod $name {
            #[divan::bench(args = super::ROW, sample_size = 200)]
            fn native(bencher: divan::Bencher<'_, '_>, n: usize) {
                super::closure(bencher, n, $closure);
            }

            #[divan::bench(args = super::ROW, sample_size = 200)]
            fn batch(bencher: divan::Bencher<'_, '_>, n: usize) {
                super::formula(bencher, n, $text);
            }

            #[divan::bench(args = super::ROW, sample_size = 200)]
            fn exact(bencher: divan::Bencher<'_, '_>, n: usize) {
                super::exact(bencher, n, $text);
            }
        }
    )*};
}

kernels! {
    smooth: "(x+1)*exp(-x*y)/2", |x, y| (x + 1.0) * (-x * y).exp() / 2.0;
    rational: "1/(1+2*x+y)", |x, y| 1.0 / (1.0 + 2.0 * x + y);
    green: "min(x,y)*(1-max(x,y))", |x: f64, y: f64| x.min(y) * (1.0 - x.max(y));
    peaked: "(0.01/5)/(0.0001+(x-y)^2)", |x, y| (0.01 / 5.0) / (0.0001 + (x - y) * (x - y));
    logarithmic: "ln(abs(x-y))", |x: f64, y: f64| (x - y).abs().ln();
}
