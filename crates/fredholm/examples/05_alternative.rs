//! 5. Fredholm's alternative: one solution, or none, or many, and the answer says which (paper, §1.1.4, th. 1.5).
//!
//! Builds on `03_automatic`. New: equations that most programs answer as if nothing were the matter.
#![expect(clippy::print_stdout, reason = "an example shows its numbers")]

use fredholm::automatic::{Options, solve};
use fredholm::equation::{Equation, Interval, Status};
use std::f64::consts::PI;

pub(crate) fn main() -> Result<(), Box<dyn std::error::Error>> {
    let interval = Interval::new(0.0, PI)?;
    let kernel = |scale: f64| move |x: f64, y: f64| scale * 2.0 / PI * (x - y).cos();

    // A cos = cos/2 and A sin = sin/2: I − A can be inverted, and there is one solution.
    let one = Equation::new(interval, kernel(0.5), f64::cos);
    let answer = solve(&one, &Options::default())?;
    println!("½ cos(x − y) 2/π, f = cos x    {:?}, φ(1) = {:.6}", answer.status, answer.at(&1.0));
    assert_eq!((answer.status, answer.nullity()), (Status::Converged, 0));
    assert!((answer.at(&1.0) - 2.0 * 1_f64.cos()).abs() <= answer.error_estimate);

    // Twice that kernel: I − A annuls cos and sin, and so does its adjoint. f = 3 has a part along sin.
    let none = Equation::new(interval, kernel(1.0), |_: f64| 3.0);
    let answer = solve(&none, &Options::default())?;
    let told = answer.alternative.as_ref().ok_or("1 is an eigenvalue")?;
    let defect = told.solvability.iter().map(|inner| inner * inner).sum::<f64>().sqrt();
    println!("cos(x − y) 2/π, f = 3          {:?}, |⟨f, ψ⟩| = {defect:.6}", answer.status);
    assert_eq!((answer.status, answer.nullity()), (Status::NoSolution, 2));
    // ⟨3, sin⟩ = 6, and ‖sin‖² = π/2.
    assert!((defect - 6.0 / (PI / 2.0).sqrt()).abs() < 1e-12);

    // f = cos 3x has none: φ = cos 3x + a cos x + b sin x for any a and b. The shortest is given.
    let many = Equation::new(interval, kernel(1.0), |x: f64| (3.0 * x).cos());
    let answer = solve(&many, &Options::default())?;
    let told = answer.alternative.as_ref().ok_or("1 is an eigenvalue")?;
    println!("cos(x − y) 2/π, f = cos 3x     {:?}, {} null functions", answer.status, answer.nullity());
    assert_eq!((answer.status, answer.nullity()), (Status::NotUnique, 2));
    assert!((answer.at(&1.0) - 3_f64.cos()).abs() <= answer.error_estimate);
    for null in &told.null_functions {
        // a cos + b sin, with a and b from its values at 0 and π/2.
        let expected = null.at(&0.0) * 1_f64.cos() + null.at(&(PI / 2.0)) * 1_f64.sin();
        assert!((null.at(&1.0) - expected).abs() < 1e-12);
    }

    // K = 10 e₁(x) e₂(y) with orthonormal e₁ = 1, e₂ = √3 (2x − 1): of norm 10, but A² = 0, so I − A is inverted by I + A.
    let e2 = |x: f64| 3_f64.sqrt() * (2.0 * x - 1.0);
    let large = Equation::new(Interval::new(0.0, 1.0)?, move |_: f64, y: f64| 10.0 * e2(y), e2);
    let answer = solve(&large, &Options::default())?;
    println!("10 e₁(x) e₂(y), f = e₂         {:?}, condition {:.0}", answer.status, answer.condition);
    assert_eq!(answer.status, Status::Converged);
    assert!((answer.at(&0.2) - e2(0.2) - 10.0).abs() <= answer.error_estimate);
    Ok(())
}
