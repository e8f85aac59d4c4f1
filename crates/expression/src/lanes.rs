//! One operation on a block of lanes: loops of fixed length, which the compiler turns into vector instructions.

use crate::complex;
use crate::operation::{Binary, Unary, power, select};
use num_complex::Complex;
use std::ops::{Add, Div, Mul, Sub};

/// Lanes of a block. A step costs about as much as four vector instructions: with fewer lanes that shows, with more a
/// short batch pays for lanes that it has not.
pub(crate) const LANES: usize = 16;

/// A register.
pub(crate) type Block<T> = [T; LANES];

type C = Complex<f64>;

/// f, lane by lane: for what takes less time than to ask how many lanes are in use.
#[inline(always)]
fn map<A: Copy, O>(a: &Block<A>, f: impl Fn(A) -> O) -> Block<O> {
    std::array::from_fn(|lane| f(a[lane]))
}

/// f of two, lane by lane.
#[inline(always)]
fn map2<A: Copy, B: Copy, O>(a: &Block<A>, b: &Block<B>, f: impl Fn(A, B) -> O) -> Block<O> {
    std::array::from_fn(|lane| f(a[lane], b[lane]))
}

/// f of the first lanes; of one lane, for all.
#[inline(always)]
fn first<O: Copy + Default>(lanes: usize, f: impl Fn(usize) -> O) -> Block<O> {
    if lanes == 1 {
        return [f(0); LANES];
    }
    let mut out = [O::default(); LANES];
    out[..lanes].iter_mut().enumerate().for_each(|(lane, out)| *out = f(lane));
    out
}

/// A real operation of one argument, on the first lanes at least.
#[inline(always)]
pub(crate) fn unary(operation: Unary, a: &Block<f64>, lanes: usize) -> Block<f64> {
    macro_rules! run {
        (quick: $($quick:ident),*; slow: $($slow:ident),*) => {
            match operation {
                $(Unary::$quick => map(a, |x| Unary::$quick.at(x)),)*
                $(Unary::$slow => first(lanes, |lane| Unary::$slow.at(a[lane])),)*
                other => first(lanes, |lane| other.at(a[lane])),
            }
        };
    }
    run!(quick: Neg, Not, Abs, Sqrt; slow: Exp, Ln)
}

/// A real operation of two arguments, on the first lanes at least.
#[inline(always)]
pub(crate) fn binary(operation: Binary, a: &Block<f64>, b: &Block<f64>, lanes: usize) -> Block<f64> {
    macro_rules! run {
        ($($quick:ident),*) => {
            match operation {
                $(Binary::$quick => map2(a, b, |x, y| Binary::$quick.at(x, y)),)*
                other => first(lanes, |lane| other.at(a[lane], b[lane])),
            }
        };
    }
    run!(Add, Sub, Mul, Div, Min, Max, Less, LessEqual, Equal, NotEqual, And, Or)
}

/// xⁿ, on the first lanes at least.
#[inline(always)]
pub(crate) fn powers(n: i32, a: &Block<f64>, lanes: usize) -> Block<f64> {
    match n {
        2 => map(a, |x| power(x, 2)),
        3 => map(a, |x| power(x, 3)),
        4 => map(a, |x| power(x, 4)),
        -1 => map(a, |x| power(x, -1)),
        -2 => map(a, |x| power(x, -2)),
        n => first(lanes, |lane| power(a[lane], n)),
    }
}

/// The second where the first is not zero, else the third.
#[inline(always)]
pub(crate) fn selection<T: Copy>(c: &Block<f64>, a: &Block<T>, b: &Block<T>, undefined: T) -> Block<T> {
    std::array::from_fn(|lane| select(c[lane], a[lane], b[lane], undefined))
}

/// A complex operation of one argument, on the first lanes at least.
pub(crate) fn complex_unary(operation: Unary, a: &Block<C>, lanes: usize) -> Block<C> {
    first(lanes, |lane| complex::unary(operation, a[lane]))
}

/// An operation of one complex argument whose value is real, on the first lanes at least.
pub(crate) fn real_of_complex(operation: Unary, a: &Block<C>, lanes: usize) -> Block<f64> {
    first(lanes, |lane| complex::real_unary(operation, a[lane]))
}

/// A complex operation of two arguments, on the first lanes at least.
pub(crate) fn complex_binary(operation: Binary, a: &Block<C>, b: &Block<C>, lanes: usize) -> Block<C> {
    match operation {
        Binary::Pow => first(lanes, |lane| complex::pow(a[lane], b[lane])),
        other => arithmetic(other, a, b),
    }
}

/// + − × ÷, one argument of which may be real: by real arithmetic, without products by a zero imaginary part.
pub(crate) fn arithmetic<A, B>(operation: Binary, a: &Block<A>, b: &Block<B>) -> Block<C>
where
    A: Copy + Add<B, Output = C> + Sub<B, Output = C> + Mul<B, Output = C> + Div<B, Output = C>,
    B: Copy,
{
    match operation {
        Binary::Add => map2(a, b, |a, b| a + b),
        Binary::Sub => map2(a, b, |a, b| a - b),
        Binary::Mul => map2(a, b, |a, b| a * b),
        _ => map2(a, b, |a, b| a / b),
    }
}

/// Whether two complex numbers are equal, or not.
pub(crate) fn comparison(operation: Binary, a: &Block<C>, b: &Block<C>) -> Block<f64> {
    map2(a, b, |a, b| complex::compare(operation, a, b))
}

/// zⁿ, on the first lanes at least.
pub(crate) fn complex_powers(n: i32, a: &Block<C>, lanes: usize) -> Block<C> {
    first(lanes, |lane| a[lane].powi(n))
}

/// Real numbers as complex ones.
pub(crate) fn promoted(a: &Block<f64>) -> Block<C> {
    map(a, C::from)
}
