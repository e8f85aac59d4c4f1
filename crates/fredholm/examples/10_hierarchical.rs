//! 10. Many unknowns: blocks of low rank, GMRES, and memory that is told before it is taken.
//!
//! Builds on `04_singular_kernels`. New: the equation made discrete by hand, entry by entry, and the matrix kept
//! hierarchically: what is far apart needs few numbers.
#![expect(clippy::print_stdout, reason = "an example shows its numbers")]

use fredholm::discretize::{Coupling, ProductNystrom};
use fredholm::equation::{ByOffset, Equation, Interval};
use fredholm::krylov::Gmres;
use fredholm::operator::hierarchical::{HierarchicalError, Options, Plan};
use fredholm::relax::{Relaxation, Stop, relax};
use fredholm::system::System;

pub(crate) fn main() -> Result<(), Box<dyn std::error::Error>> {
    // φ(x) = f(x) + ∫₀¹ ln|x − y| φ(y) dy with the f for which φ = 1.
    let x_ln = |u: f64| if u > 0.0 { u * u.ln() } else { 0.0 };
    let source = move |x: f64| 2.0 - x_ln(x) - x_ln(1.0 - x);
    let kernel = ByOffset(|_x, _y, offset: f64| offset.abs().ln());
    let equation = Equation::new(Interval::new(0.0, 1.0)?, kernel, source);

    println!("{:>8} {:>9} {:>9} {:>8} {:>9} {:>9}", "unknowns", "dense", "kept", "ranks", "error", "of φ");
    for panels in [64, 256, 1024] {
        let breaks = (0..=panels).map(|k| f64::from(k) / f64::from(panels)).collect();
        let coupling = ProductNystrom::new(&equation, breaks, None)?; //     what F_ij is
        let plan = Plan::new(&coupling, &coupling.points(), Options::default())?; // which blocks, how much memory
        let operator = plan.assemble(|_| ())?; //                            how F is kept
        let told = operator.statistics();
        assert!(told.bytes <= plan.bytes() && told.relative_error() < 1e-10);

        let f: Vec<f64> = coupling.nodes().iter().map(|x| source(*x)).collect();
        let coefficient = vec![1.0; f.len()];
        let mut gmres = Gmres::new(System::new(&f, &coefficient, &operator)?);
        relax(&mut gmres, Stop { residual: 1e-10, sweeps: 50 }, |_, _, _| true);
        let error = gmres.solution().iter().map(|u| (u - 1.0).abs()).fold(0.0, f64::max);
        println!(
            "{:>8} {:>6.0} MB {:>6.1} MB {:>8} {:>9.1e} {error:>9.1e}",
            told.unknowns,
            8e-6 * (told.unknowns as f64).powi(2),
            told.bytes as f64 / 1e6,
            format!("{}–{}", told.ranks.0, told.ranks.2),
            told.relative_error()
        );
        assert!(error < 1e-10);
    }

    // Too much is refused before it is taken. A million unknowns in the plane, each seen from all others.
    let points: Vec<[f64; 2]> = (0..1_000_000).map(|k| [f64::from(k % 1000), f64::from(k / 1000)]).collect();
    let options = Options { tolerance: 1e-4, memory: 1_000_000_000, ..Options::default() };
    let refused =
        Plan::new(&Decay(&points), &points, options)?.assemble(|_| ()).expect_err("a gigabyte is not enough");
    println!("{refused}");
    assert!(matches!(refused, HierarchicalError::Memory { .. }));
    Ok(())
}

/// 1/(1 + |x_i − x_j|).
struct Decay<'a>(&'a [[f64; 2]]);

impl Coupling for Decay<'_> {
    fn dim(&self) -> usize {
        self.0.len()
    }
    fn entry(&self, i: usize, j: usize) -> f64 {
        let ([x, y], [s, t]) = (self.0[i], self.0[j]);
        1.0 / (1.0 + (x - s).hypot(y - t))
    }
}
