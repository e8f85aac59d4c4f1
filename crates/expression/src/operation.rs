//! The operations of a formula, and what each does to real numbers.

use crate::special;
use num_complex::Complex;

/// What a node of a formula does with its arguments.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Operation {
    Constant(Number),
    /// The k-th column.
    Variable(usize),
    Unary(Unary),
    Binary(Binary),
    /// zⁿ by multiplications.
    Power(i32),
    /// The second argument where the first is not zero, else the third.
    Select,
    /// Of real numbers, the second argument where the first is negative, else the third.
    BySign,
    /// A real number as a complex one.
    Promote,
}

/// A number by its bits, so that equal constants are found equal: real part, imaginary part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Number(u64, u64);

impl From<Complex<f64>> for Number {
    fn from(z: Complex<f64>) -> Self {
        Number(z.re.to_bits(), z.im.to_bits())
    }
}

impl From<Number> for Complex<f64> {
    fn from(number: Number) -> Self {
        Complex::new(f64::from_bits(number.0), f64::from_bits(number.1))
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Unary {
    Neg,
    Not,
    Abs,
    Sign,
    Floor,
    Ceil,
    Exp,
    Ln,
    Log10,
    Sqrt,
    Cbrt,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Asinh,
    Acosh,
    Atanh,
    Erf,
    Erfc,
    Gamma,
    LnGamma,
    Ei,
    EllipK,
    EllipE,
    Li2,
    Real,
    Imag,
    Conj,
    Arg,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Binary {
    Add,
    Sub,
    Mul,
    Div,
    Pow,
    Mod,
    Atan2,
    Min,
    Max,
    Less,
    LessEqual,
    Equal,
    NotEqual,
    And,
    Or,
    BesselJ,
    BesselY,
    BesselI,
    BesselK,
    ExpInt,
}

impl Unary {
    /// The value at a real `x`; NaN where there is none that is real.
    #[inline(always)]
    pub fn at(self, x: f64) -> f64 {
        match self {
            Unary::Neg => -x,
            Unary::Not => truth(x == 0.0, x.is_nan()),
            Unary::Abs => x.abs(),
            Unary::Sign => {
                if x == 0.0 || x.is_nan() {
                    x
                } else {
                    1_f64.copysign(x)
                }
            }
            Unary::Floor => x.floor(),
            Unary::Ceil => x.ceil(),
            Unary::Exp => x.exp(),
            Unary::Ln => x.ln(),
            Unary::Log10 => x.log10(),
            Unary::Sqrt => x.sqrt(),
            Unary::Cbrt => x.cbrt(),
            Unary::Sin => x.sin(),
            Unary::Cos => x.cos(),
            Unary::Tan => x.tan(),
            Unary::Asin => x.asin(),
            Unary::Acos => x.acos(),
            Unary::Atan => x.atan(),
            Unary::Sinh => x.sinh(),
            Unary::Cosh => x.cosh(),
            Unary::Tanh => x.tanh(),
            // the inverse hyperbolic functions of std lose digits near 0 and 1
            Unary::Asinh => libm::asinh(x),
            Unary::Acosh => libm::acosh(x),
            Unary::Atanh => libm::atanh(x),
            Unary::Erf => libm::erf(x),
            Unary::Erfc => libm::erfc(x),
            Unary::Gamma => libm::tgamma(x),
            Unary::LnGamma => libm::lgamma(x),
            Unary::Ei => special::ei(x),
            Unary::EllipK => special::ellip_k(x),
            Unary::EllipE => special::ellip_e(x),
            Unary::Li2 => special::li2(x),
            Unary::Real | Unary::Conj => x,
            Unary::Imag => 0.0,
            Unary::Arg => 0_f64.atan2(x),
        }
    }

    /// Whether the operation takes complex arguments.
    pub fn takes_complex(self) -> bool {
        use Unary::*;
        !matches!(
            self,
            Not | Sign | Floor | Ceil | Cbrt | Erf | Erfc | Gamma | LnGamma | Ei | EllipK | EllipE | Li2
        )
    }

    /// Whether the value is real whatever the argument.
    pub fn yields_real(self) -> bool {
        matches!(self, Unary::Abs | Unary::Real | Unary::Imag | Unary::Arg)
    }

    /// Whether the value at a real argument may be complex, if complex numbers are meant at all.
    pub fn leaves_reals(self, non_negative: bool) -> bool {
        match self {
            Unary::Sqrt | Unary::Ln | Unary::Log10 => !non_negative,
            Unary::Asin | Unary::Acos | Unary::Acosh | Unary::Atanh => true,
            _ => false,
        }
    }

    /// Whether the value at a real argument is never negative.
    pub fn is_non_negative(self) -> bool {
        matches!(self, Unary::Abs | Unary::Exp | Unary::Sqrt | Unary::Cosh | Unary::Erfc | Unary::EllipE)
    }
}

impl Binary {
    /// The value at real `a`, `b`. NaN spreads, also through comparisons: an undefined condition decides nothing.
    #[inline(always)]
    pub fn at(self, a: f64, b: f64) -> f64 {
        match self {
            Binary::Add => a + b,
            Binary::Sub => a - b,
            Binary::Mul => a * b,
            Binary::Div => a / b,
            Binary::Pow => a.powf(b),
            Binary::Mod => modulo(a, b),
            Binary::Atan2 => a.atan2(b),
            // f64::min would hide a NaN; so written, they are three vector instructions
            Binary::Min => defined(if a < b { a } else { b }, a.is_nan() | b.is_nan()),
            Binary::Max => defined(if a > b { a } else { b }, a.is_nan() | b.is_nan()),
            Binary::Less => truth(a < b, a.is_nan() | b.is_nan()),
            Binary::LessEqual => truth(a <= b, a.is_nan() | b.is_nan()),
            Binary::Equal => truth(a == b, a.is_nan() | b.is_nan()),
            Binary::NotEqual => truth(a != b, a.is_nan() | b.is_nan()),
            Binary::And => {
                if a == 0.0 {
                    0.0
                } else {
                    truth(b != 0.0, a.is_nan() | b.is_nan())
                }
            }
            Binary::Or => {
                if a != 0.0 && !a.is_nan() {
                    1.0
                } else {
                    truth(b != 0.0, a.is_nan() | b.is_nan())
                }
            }
            Binary::BesselJ => special::bessel_j(a, b),
            Binary::BesselY => special::bessel_y(a, b),
            Binary::BesselI => special::bessel_i(a, b),
            Binary::BesselK => special::bessel_k(a, b),
            Binary::ExpInt => special::expint(a, b),
        }
    }

    /// Whether the operation takes complex arguments.
    pub fn takes_complex(self) -> bool {
        use Binary::*;
        matches!(self, Add | Sub | Mul | Div | Pow | Equal | NotEqual)
    }

    /// Whether the order of the arguments does not matter.
    pub fn commutes(self) -> bool {
        matches!(self, Binary::Add | Binary::Mul | Binary::Equal | Binary::NotEqual)
    }

    /// Whether the value is 0 or 1.
    pub fn is_condition(self) -> bool {
        use Binary::*;
        matches!(self, Less | LessEqual | Equal | NotEqual | And | Or)
    }
}

/// xⁿ by multiplications; the small powers, which kernels have, without a loop.
#[inline(always)]
pub(crate) fn power(x: f64, n: i32) -> f64 {
    match n {
        2 => x * x,
        3 => x * x * x,
        4 => (x * x) * (x * x),
        -1 => 1.0 / x,
        -2 => 1.0 / (x * x),
        _ => x.powi(n),
    }
}

/// `a` where the condition `c` is not zero, else `b`; undefined where the condition is.
#[inline(always)]
pub(crate) fn select<T: Copy>(c: f64, a: T, b: T, undefined: T) -> T {
    if c.is_nan() {
        undefined
    } else if c != 0.0 {
        a
    } else {
        b
    }
}

/// `a` where `c` is negative, else `b`; undefined where `c` is.
#[inline(always)]
pub(crate) fn by_sign(c: f64, a: f64, b: f64) -> f64 {
    if c < 0.0 {
        a
    } else if c >= 0.0 {
        b
    } else {
        c
    }
}

#[inline(always)]
fn truth(condition: bool, undefined: bool) -> f64 {
    defined(f64::from(u8::from(condition)), undefined)
}

#[inline(always)]
fn defined(value: f64, undefined: bool) -> f64 {
    if undefined { f64::NAN } else { value }
}

/// a − b ⌊a/b⌋, with the sign of b.
fn modulo(a: f64, b: f64) -> f64 {
    let rest = a % b;
    if rest != 0.0 && (rest < 0.0) != (b < 0.0) { rest + b } else { rest }
}
