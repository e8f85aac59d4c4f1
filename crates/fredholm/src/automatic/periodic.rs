//! K(x, a) = K(x, b), f(a) = f(b), and their slopes: whether an equation goes round a circle, as §1.3.3 asks of trigonometric
//! interpolation.

use crate::equation::{Equation, Scalar};

/// Whether source and kernels go on at b as they began at a, as far as their values and slopes there tell.
pub(crate) fn is_periodic<T: Scalar>(equation: &Equation<'_, T>) -> bool {
    let interval = equation.interval();
    let (a, length) = (interval.a(), interval.b() - interval.a());
    let places = [0.1317, 0.5413, 0.9073].map(|place| a + length * place);
    let m = equation.components();
    interval.is_finite()
        && (0..m).all(|c| closes(&interval_ends(interval.a(), interval.b()), |x| equation.source(c, x)))
        && (0..m * m).all(|k| {
            let kernel = |x: f64, y: f64| {
                let mut value = [T::ZERO];
                equation.kernel(k / m, k % m).row(x, &[y], &[y - x], &mut value);
                value[0]
            };
            let ends = interval_ends(interval.a(), interval.b());
            places.iter().all(|x| closes(&ends, |y| kernel(*x, y)) && closes(&ends, |y| kernel(y, *x)))
        })
}

/// a, a + h, b − h, b.
fn interval_ends(a: f64, b: f64) -> [f64; 4] {
    let h = 1e-5 * (b - a);
    [a, a + h, b - h, b]
}

fn closes<T: Scalar>(ends: &[f64; 4], function: impl Fn(f64) -> T) -> bool {
    let [first, second, third, last] = ends.map(function);
    let gap = (last - first).modulus();
    let size = first.modulus().max(last.modulus());
    let bend = ((second - first) - (last - third)).modulus();
    // Steps of 10⁻⁵ leave a bend of 10⁻¹⁰ to a curvature of 1; NaN is not less than anything.
    gap <= 1e-12 * size && bend <= 1e-8 * size
}
