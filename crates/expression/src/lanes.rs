//! One operation on a block of lanes: loops of fixed length, which the compiler turns into vector instructions.

use crate::complex;
use crate::fuse::Outer;
use crate::operation::{Binary, Unary, power, select};
use num_complex::Complex;
use std::ops::{Add, Div, Mul, Sub};

/// Lanes of a register: 512 bytes, so that the registers of a usual formula stay in the first cache.
pub(crate) const LANES: usize = 64;

/// A register, on lines of the cache of its own.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(crate) struct Block<T>(pub [T; LANES]);

type C = Complex<f64>;

/// f of the first N lanes: for what takes less time than to ask how many lanes are in use.
#[inline(always)]
fn map<const N: usize, A: Copy, O>(out: &mut Block<O>, a: &Block<A>, f: impl Fn(A) -> O) {
    for lane in 0..N {
        out.0[lane] = f(a.0[lane]);
    }
}

/// f of two, of the first N lanes.
#[inline(always)]
fn map2<const N: usize, A: Copy, B: Copy, O>(
    out: &mut Block<O>,
    a: &Block<A>,
    b: &Block<B>,
    f: impl Fn(A, B) -> O,
) {
    for lane in 0..N {
        out.0[lane] = f(a.0[lane], b.0[lane]);
    }
}

/// f of the first lanes; of one lane, for all.
#[inline(always)]
fn first<const N: usize, O: Copy>(out: &mut Block<O>, lanes: usize, f: impl Fn(usize) -> O) {
    if lanes == 1 {
        let value = f(0);
        out.0[..N].fill(value);
    } else {
        out.0[..lanes].iter_mut().enumerate().for_each(|(lane, out)| *out = f(lane));
    }
}

/// A real operation of one argument.
#[inline(always)]
pub(crate) fn unary<const N: usize>(operation: Unary, out: &mut Block<f64>, a: &Block<f64>, lanes: usize) {
    macro_rules! run {
        (quick: $($quick:ident),*; slow: $($slow:ident),*) => {
            match operation {
                $(Unary::$quick => map::<N, _, _>(out, a, |x| Unary::$quick.at(x)),)*
                $(Unary::$slow => first::<N, _>(out, lanes, |lane| Unary::$slow.at(a.0[lane])),)*
                other => first::<N, _>(out, lanes, |lane| other.at(a.0[lane])),
            }
        };
    }
    run!(quick: Neg, Not, Abs, Sqrt; slow: Exp, Ln)
}

/// A real operation of two arguments.
#[inline(always)]
pub(crate) fn binary<const N: usize>(
    operation: Binary,
    out: &mut Block<f64>,
    a: &Block<f64>,
    b: &Block<f64>,
    lanes: usize,
) {
    macro_rules! run {
        ($($quick:ident),*) => {
            match operation {
                $(Binary::$quick => map2::<N, _, _, _>(out, a, b, |x, y| Binary::$quick.at(x, y)),)*
                other => first::<N, _>(out, lanes, |lane| other.at(a.0[lane], b.0[lane])),
            }
        };
    }
    run!(Add, Sub, Mul, Div, Min, Max, Less, LessEqual, Equal, NotEqual, And, Or)
}

/// `second` of c and of what `first` makes of a and b.
#[inline(always)]
pub(crate) fn fused<const N: usize>(
    first: Binary,
    second: Outer,
    out: &mut Block<f64>,
    arguments: [&Block<f64>; 3],
) {
    macro_rules! run {
        ($($first:ident),*) => {
            match first {
                $(Binary::$first => then::<N>(second, out, arguments, |a, b| Binary::$first.at(a, b)),)*
                other => then::<N>(second, out, arguments, |a, b| other.at(a, b)),
            }
        };
    }
    run!(Add, Sub, Mul, Div, Min, Max)
}

#[inline(always)]
fn then<const N: usize>(
    second: Outer,
    out: &mut Block<f64>,
    arguments: [&Block<f64>; 3],
    first: impl Fn(f64, f64) -> f64,
) {
    match second {
        Outer::Add => map3::<N>(out, arguments, |a, b, c| first(a, b) + c),
        Outer::Sub => map3::<N>(out, arguments, |a, b, c| first(a, b) - c),
        Outer::SubFrom => map3::<N>(out, arguments, |a, b, c| c - first(a, b)),
        Outer::Mul => map3::<N>(out, arguments, |a, b, c| first(a, b) * c),
        Outer::Div => map3::<N>(out, arguments, |a, b, c| first(a, b) / c),
        Outer::DivInto => map3::<N>(out, arguments, |a, b, c| c / first(a, b)),
        Outer::Square => map3::<N>(out, arguments, |a, b, _| power(first(a, b), 2)),
        Outer::Abs => map3::<N>(out, arguments, |a, b, _| first(a, b).abs()),
        Outer::Neg => map3::<N>(out, arguments, |a, b, _| -first(a, b)),
    }
}

/// f of three, of the first N lanes.
#[inline(always)]
fn map3<const N: usize>(
    out: &mut Block<f64>,
    [a, b, c]: [&Block<f64>; 3],
    f: impl Fn(f64, f64, f64) -> f64,
) {
    for lane in 0..N {
        out.0[lane] = f(a.0[lane], b.0[lane], c.0[lane]);
    }
}

/// xⁿ.
#[inline(always)]
pub(crate) fn powers<const N: usize>(n: i32, out: &mut Block<f64>, a: &Block<f64>, lanes: usize) {
    match n {
        2 => map::<N, _, _>(out, a, |x| power(x, 2)),
        3 => map::<N, _, _>(out, a, |x| power(x, 3)),
        4 => map::<N, _, _>(out, a, |x| power(x, 4)),
        -1 => map::<N, _, _>(out, a, |x| power(x, -1)),
        -2 => map::<N, _, _>(out, a, |x| power(x, -2)),
        n => first::<N, _>(out, lanes, |lane| power(a.0[lane], n)),
    }
}

/// The second where the first is not zero, else the third.
#[inline(always)]
pub(crate) fn selection<const N: usize, T: Copy>(
    out: &mut Block<T>,
    condition: &Block<f64>,
    a: &Block<T>,
    b: &Block<T>,
    undefined: T,
) {
    for lane in 0..N {
        out.0[lane] = select(condition.0[lane], a.0[lane], b.0[lane], undefined);
    }
}

/// A complex operation of one argument.
pub(crate) fn complex_unary<const N: usize>(
    operation: Unary,
    out: &mut Block<C>,
    a: &Block<C>,
    lanes: usize,
) {
    first::<N, _>(out, lanes, |lane| complex::unary(operation, a.0[lane]));
}

/// An operation of one complex argument whose value is real.
pub(crate) fn real_of_complex<const N: usize>(
    operation: Unary,
    out: &mut Block<f64>,
    a: &Block<C>,
    lanes: usize,
) {
    first::<N, _>(out, lanes, |lane| complex::real_unary(operation, a.0[lane]));
}

/// A complex operation of two arguments.
pub(crate) fn complex_binary<const N: usize>(
    operation: Binary,
    out: &mut Block<C>,
    a: &Block<C>,
    b: &Block<C>,
    lanes: usize,
) {
    match operation {
        Binary::Pow => first::<N, _>(out, lanes, |lane| complex::pow(a.0[lane], b.0[lane])),
        other => arithmetic::<N, _, _>(other, out, a, b),
    }
}

/// + − × ÷, one argument of which may be real: by real arithmetic, without products by a zero imaginary part.
pub(crate) fn arithmetic<const N: usize, A, B>(
    operation: Binary,
    out: &mut Block<C>,
    a: &Block<A>,
    b: &Block<B>,
) where
    A: Copy + Add<B, Output = C> + Sub<B, Output = C> + Mul<B, Output = C> + Div<B, Output = C>,
    B: Copy,
{
    match operation {
        Binary::Add => map2::<N, _, _, _>(out, a, b, |a, b| a + b),
        Binary::Sub => map2::<N, _, _, _>(out, a, b, |a, b| a - b),
        Binary::Mul => map2::<N, _, _, _>(out, a, b, |a, b| a * b),
        _ => map2::<N, _, _, _>(out, a, b, |a, b| a / b),
    }
}

/// Whether two complex numbers are equal, or not.
pub(crate) fn comparison<const N: usize>(
    operation: Binary,
    out: &mut Block<f64>,
    a: &Block<C>,
    b: &Block<C>,
) {
    map2::<N, _, _, _>(out, a, b, |a, b| complex::compare(operation, a, b));
}

/// zⁿ.
pub(crate) fn complex_powers<const N: usize>(n: i32, out: &mut Block<C>, a: &Block<C>, lanes: usize) {
    first::<N, _>(out, lanes, |lane| a.0[lane].powi(n));
}

/// Real numbers as complex ones.
pub(crate) fn promoted<const N: usize>(out: &mut Block<C>, a: &Block<f64>) {
    map::<N, _, _>(out, a, C::from);
}
