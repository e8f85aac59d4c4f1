//! The operations on complex numbers: principal values, cut along the negative real axis.

use crate::operation::{Binary, Unary};
use num_complex::Complex;

type C = Complex<f64>;

/// The value at `z` of an operation whose value is complex.
pub(crate) fn unary(operation: Unary, z: C) -> C {
    match operation {
        Unary::Neg => -z,
        Unary::Exp => exp(z),
        Unary::Ln => z.ln(),
        Unary::Log10 => z.ln() / std::f64::consts::LN_10,
        Unary::Sqrt => z.sqrt(),
        Unary::Sin => z.sin(),
        Unary::Cos => z.cos(),
        Unary::Tan => -turn(tanh(turn(z))),
        Unary::Asin => z.asin(),
        Unary::Acos => z.acos(),
        Unary::Atan => z.atan(),
        Unary::Sinh => z.sinh(),
        Unary::Cosh => z.cosh(),
        Unary::Tanh => tanh(z),
        Unary::Asinh => z.asinh(),
        Unary::Acosh => z.acosh(),
        Unary::Atanh => z.atanh(),
        Unary::Conj => z.conj(),
        // the rest has been refused, or is real
        _ => C::new(f64::NAN, f64::NAN),
    }
}

/// The value at `z` of an operation whose value is real.
pub(crate) fn real_unary(operation: Unary, z: C) -> f64 {
    match operation {
        Unary::Abs => z.norm(),
        Unary::Real => z.re,
        Unary::Imag => z.im,
        Unary::Arg => z.arg(),
        // the rest has been refused, or is complex
        _ => f64::NAN,
    }
}

/// a = b, or a ≠ b.
pub(crate) fn compare(operation: Binary, a: C, b: C) -> f64 {
    let equal = Binary::And.at(Binary::Equal.at(a.re, b.re), Binary::Equal.at(a.im, b.im));
    if operation == Binary::Equal { equal } else { Unary::Not.at(equal) }
}

/// a^b = exp(b ln a), with 0^b = 0 where Re b > 0.
pub(crate) fn pow(a: C, b: C) -> C {
    if a == C::ZERO {
        return match b {
            C::ZERO => C::ONE,
            b if b.re > 0.0 => C::ZERO,
            _ => C::new(f64::NAN, f64::NAN),
        };
    }
    exp(b * a.ln())
}

/// i z.
fn turn(z: C) -> C {
    C::new(-z.im, z.re)
}

/// e^z; exactly real on the real axis, also where e^x is infinite.
fn exp(z: C) -> C {
    let size = z.re.exp();
    if z.im == 0.0 {
        return C::new(size, z.im);
    }
    let (sin, cos) = z.im.sin_cos();
    C::new(size * cos, size * sin)
}

/// tanh(x + iy) = (sinh x cosh x + i sin y cos y) / (sinh² x + cos² y); ±1 where sinh² would overflow.
fn tanh(z: C) -> C {
    if z.re.abs() > 22.0 {
        let decay = (-2.0 * z.re.abs()).exp();
        return C::new(1_f64.copysign(z.re), 4.0 * decay * z.im.sin() * z.im.cos());
    }
    let (sin, cos) = z.im.sin_cos();
    let (sinh, cosh) = (z.re.sinh(), z.re.cosh());
    let size = sinh * sinh + cos * cos;
    C::new(sinh * cosh / size, sin * cos / size)
}

/// The value of `a` (op) `b`.
pub(crate) fn binary(operation: Binary, a: C, b: C) -> C {
    match operation {
        Binary::Add => a + b,
        Binary::Sub => a - b,
        Binary::Mul => a * b,
        Binary::Div => a / b,
        Binary::Pow => pow(a, b),
        Binary::Equal | Binary::NotEqual => C::new(compare(operation, a, b), 0.0),
        // the rest has been refused
        _ => C::new(f64::NAN, f64::NAN),
    }
}
