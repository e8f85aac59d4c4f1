//! 1. A rule replaces an integral by a sum: how good it is, and how to choose one (paper, chapter 4).
#![expect(clippy::print_stdout, reason = "an example shows its numbers")]

use fredholm::quadrature::{
    Peano, QuadratureError, Recurrence, boole, gauss_legendre, integrate, romberg, simpson, trapezoid,
};

pub(crate) fn main() -> Result<(), Box<dyn std::error::Error>> {
    let f = |x: f64| x.exp();
    let exact = 1_f64.exp() - 1.0;

    println!("∫₀¹ eˣ dx by 17 nodes, and the rules' order and error constant on one panel");
    for (name, rule, panel) in rules()? {
        let peano = Peano::new(&panel, 0.0, 1.0, 40)?;
        let error = rule.integrate(|x| f(*x)) - exact;
        println!(
            "{name:<16} error {error:>9.1e}   order {:>2}   constant {:>9.2e}",
            peano.order(),
            peano.constant()
        );
    }

    let extrapolated = romberg(f, 0.0, 1.0, 1e-14)?;
    println!("Romberg: error {:.1e} with {} nodes", extrapolated.value - exact, extrapolated.evaluations);

    // A singularity known beforehand belongs into the weight, ∫₀¹ −ln x cos x dx = Si(1); one that is not, to the method
    // that adapts.
    let rule = Recurrence::of_weight(6, |x| -x.ln(), 0.0, 1.0)?.gauss();
    let weighted = rule.integrate(|x| x.cos());
    let adapted = integrate(|x| -x.ln() * x.cos(), 0.0, 1.0)?;
    println!("−ln x in the weight: 6 nodes; by halving: {} evaluations", adapted.evaluations);

    let si = 0.946_083_070_367_183_f64;
    assert!((extrapolated.value - exact).abs() <= extrapolated.error);
    assert!((weighted - si).abs() < 1e-14 && (adapted.value - si).abs() <= adapted.error);
    // Simpson's rule: −(b − a)⁵/2880 f⁗ for a panel, and a sixteenth of the error with twice the panels.
    let error = |panels| Ok::<_, QuadratureError>(simpson(0.0, 1.0, panels)?.integrate(|x| f(*x)) - exact);
    assert!((error(8)? / error(16)? - 16.0).abs() < 0.01);
    assert!((gauss_legendre(17, 0.0, 1.0).integrate(|x| f(*x)) - exact).abs() < 1e-15);
    Ok(())
}

type Rule = fredholm::quadrature::Quadrature<f64>;

/// (name, the rule with 17 nodes, the same on one panel).
fn rules() -> Result<[(&'static str, Rule, Rule); 4], QuadratureError> {
    Ok([
        ("trapezoid", trapezoid(0.0, 1.0, 16)?, trapezoid(0.0, 1.0, 1)?),
        ("Simpson", simpson(0.0, 1.0, 8)?, simpson(0.0, 1.0, 1)?),
        ("Boole", boole(0.0, 1.0, 4)?, boole(0.0, 1.0, 1)?),
        ("Gauss–Legendre", gauss_legendre(17, 0.0, 1.0), gauss_legendre(17, 0.0, 1.0)),
    ])
}
