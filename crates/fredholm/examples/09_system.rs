//! 9. Several unknown functions at once, and complex ones.
//!
//! Builds on `03_automatic` and `07_spectrum`. New: φ_a = f_a + Σ_b ∫ K_ab φ_b, and a complex equation as a system of real
//! ones.
#![expect(clippy::print_stdout, reason = "an example shows its numbers")]

use fredholm::automatic::{Options, solve};
use fredholm::equation::{Complex64, Equation, Interval};

pub(crate) fn main() -> Result<(), Box<dyn std::error::Error>> {
    let unit = Interval::new(0.0, 1.0)?;
    let options = Options { tolerance: 1e-12, ..Options::default() };

    // K_1b = (x + y)/3 and K_2b = xy: φ = (x + 1, x² + 1).
    let sum = |x: f64, y: f64| (x + y) / 3.0;
    let product = |x: f64, y: f64| x * y;
    let equation = Equation::system(
        unit,
        vec![Box::new(sum), Box::new(sum), Box::new(product), Box::new(product)],
        vec![Box::new(|x| x / 18.0 + 17.0 / 36.0), Box::new(|x| x * x - 19.0 / 12.0 * x + 1.0)],
    )?;
    let answer = solve(&equation, &options)?;
    println!("φ(0.3) = ({:.14}, {:.14})", answer.at(&0.3), answer.solution.component(1, &0.3));
    assert!((answer.at(&0.3) - 1.3).abs() <= answer.error_estimate);
    assert!((answer.solution.component(1, &0.3) - 1.09).abs() <= answer.error_estimate);
    assert!(answer.error_estimate < 1e-12);

    // K = ½ e^{i(x−y)}, f = ½ e^{ix}: φ = e^{ix}.
    let turn = |x: f64| Complex64::from_polar(0.5, x);
    let equation = Equation::new(unit, move |x: f64, y: f64| turn(x - y), turn);
    let complex = solve(&equation, &options)?;
    println!("φ(0.3) = {:.14}", complex.at(&0.3));
    assert!((complex.at(&0.3) - Complex64::from_polar(1.0, 0.3)).norm() <= complex.error_estimate);

    // The same in real numbers: (Re φ, Im φ) with the kernels (Re K, −Im K; Im K, Re K).
    let equation = Equation::system(
        unit,
        vec![
            Box::new(move |x: f64, y: f64| turn(x - y).re),
            Box::new(move |x: f64, y: f64| -turn(x - y).im),
            Box::new(move |x: f64, y: f64| turn(x - y).im),
            Box::new(move |x: f64, y: f64| turn(x - y).re),
        ],
        vec![Box::new(move |x| turn(x).re), Box::new(move |x| turn(x).im)],
    )?;
    let real = solve(&equation, &options)?;
    println!("unknowns: {} complex, {} real", complex.unknowns, real.unknowns);
    assert_eq!(real.unknowns, 2 * complex.unknowns);
    let (re, im) = (real.at(&0.3), real.solution.component(1, &0.3));
    assert!(
        (Complex64::new(re, im) - complex.at(&0.3)).norm() <= real.error_estimate + complex.error_estimate
    );
    Ok(())
}
