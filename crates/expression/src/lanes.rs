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

impl<T> Block<T> {
    /// The first N ≤ 64 lanes.
    #[inline(always)]
    pub fn first<const N: usize>(&self) -> &[T; N] {
        self.0.first_chunk().expect("a window is no longer than a register")
    }

    /// The first N ≤ 64 lanes.
    #[inline(always)]
    pub fn first_mut<const N: usize>(&mut self) -> &mut [T; N] {
        self.0.first_chunk_mut().expect("a window is no longer than a register")
    }
}

type C = Complex<f64>;

/// f of the first N lanes: for what takes less time than to ask how many lanes are in use.
#[inline(always)]
fn map<const N: usize, A: Copy, O>(out: &mut [O; N], a: &[A; N], f: impl Fn(A) -> O) {
    for lane in 0..N {
        out[lane] = f(a[lane]);
    }
}

/// f of two, of the first N lanes.
#[inline(always)]
fn map2<const N: usize, A: Copy, B: Copy, O>(
    out: &mut [O; N],
    a: &[A; N],
    b: &[B; N],
    f: impl Fn(A, B) -> O,
) {
    for lane in 0..N {
        out[lane] = f(a[lane], b[lane]);
    }
}

/// f of the first lanes; of one lane, for all.
#[inline(always)]
fn first<const N: usize, O: Copy>(out: &mut [O; N], lanes: usize, f: impl Fn(usize) -> O) {
    if lanes == 1 {
        let value = f(0);
        out.fill(value);
    } else {
        out[..lanes].iter_mut().enumerate().for_each(|(lane, out)| *out = f(lane));
    }
}

/// A real operation of one argument.
#[inline(always)]
pub(crate) fn unary<const N: usize>(operation: Unary, out: &mut [f64; N], a: &[f64; N], lanes: usize) {
    macro_rules! run {
        (quick: $($quick:ident),*; slow: $($slow:ident),*) => {
            match operation {
                $(Unary::$quick => map::<N, _, _>(out, a, |x| Unary::$quick.at(x)),)*
                $(Unary::$slow => first::<N, _>(out, lanes, |lane| Unary::$slow.at(a[lane])),)*
                other => first::<N, _>(out, lanes, |lane| other.at(a[lane])),
            }
        };
    }
    run!(quick: Neg, Not, Abs, Sqrt; slow: Exp, Ln);
}

/// A real operation of two arguments.
#[inline(always)]
pub(crate) fn binary<const N: usize>(
    operation: Binary,
    out: &mut [f64; N],
    a: &[f64; N],
    b: &[f64; N],
    lanes: usize,
) {
    macro_rules! run {
        ($($quick:ident),*) => {
            match operation {
                $(Binary::$quick => map2::<N, _, _, _>(out, a, b, |x, y| Binary::$quick.at(x, y)),)*
                other => first::<N, _>(out, lanes, |lane| other.at(a[lane], b[lane])),
            }
        };
    }
    run!(Add, Sub, Mul, Div, Min, Max, Less, LessEqual, Equal, NotEqual, And, Or);
}

/// `second` of c and of what `first` makes of a and b.
#[inline(always)]
pub(crate) fn fused<const N: usize>(
    first: Binary,
    second: Outer,
    out: &mut [f64; N],
    arguments: [&[f64; N]; 3],
) {
    macro_rules! run {
        ($($first:ident),*) => {
            match first {
                $(Binary::$first => then::<N>(second, out, arguments, |a, b| Binary::$first.at(a, b)),)*
                other => then::<N>(second, out, arguments, |a, b| other.at(a, b)),
            }
        };
    }
    run!(Add, Sub, Mul, Div, Min, Max);
}

#[inline(always)]
fn then<const N: usize>(
    second: Outer,
    out: &mut [f64; N],
    arguments: [&[f64; N]; 3],
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
fn map3<const N: usize>(out: &mut [f64; N], [a, b, c]: [&[f64; N]; 3], f: impl Fn(f64, f64, f64) -> f64) {
    for lane in 0..N {
        out[lane] = f(a[lane], b[lane], c[lane]);
    }
}

/// xⁿ.
#[inline(always)]
pub(crate) fn powers<const N: usize>(n: i32, out: &mut [f64; N], a: &[f64; N], lanes: usize) {
    match n {
        2 => map::<N, _, _>(out, a, |x| power(x, 2)),
        3 => map::<N, _, _>(out, a, |x| power(x, 3)),
        4 => map::<N, _, _>(out, a, |x| power(x, 4)),
        -1 => map::<N, _, _>(out, a, |x| power(x, -1)),
        -2 => map::<N, _, _>(out, a, |x| power(x, -2)),
        n => first::<N, _>(out, lanes, |lane| power(a[lane], n)),
    }
}

/// The second where the first is not zero, else the third.
#[inline(always)]
pub(crate) fn selection<const N: usize, T: Copy>(
    out: &mut [T; N],
    condition: &[f64; N],
    a: &[T; N],
    b: &[T; N],
    undefined: T,
) {
    for lane in 0..N {
        out[lane] = select(condition[lane], a[lane], b[lane], undefined);
    }
}

/// A complex operation of one argument.
pub(crate) fn complex_unary<const N: usize>(operation: Unary, out: &mut [C; N], a: &[C; N], lanes: usize) {
    first::<N, _>(out, lanes, |lane| complex::unary(operation, a[lane]));
}

/// An operation of one complex argument whose value is real.
pub(crate) fn real_of_complex<const N: usize>(
    operation: Unary,
    out: &mut [f64; N],
    a: &[C; N],
    lanes: usize,
) {
    first::<N, _>(out, lanes, |lane| complex::real_unary(operation, a[lane]));
}

/// A complex operation of two arguments.
pub(crate) fn complex_binary<const N: usize>(
    operation: Binary,
    out: &mut [C; N],
    a: &[C; N],
    b: &[C; N],
    lanes: usize,
) {
    match operation {
        Binary::Pow => first::<N, _>(out, lanes, |lane| complex::pow(a[lane], b[lane])),
        other => arithmetic::<N, _, _>(other, out, a, b),
    }
}

/// + − × ÷, one argument of which may be real: by real arithmetic, without products by a zero imaginary part.
pub(crate) fn arithmetic<const N: usize, A, B>(operation: Binary, out: &mut [C; N], a: &[A; N], b: &[B; N])
where
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
pub(crate) fn comparison<const N: usize>(operation: Binary, out: &mut [f64; N], a: &[C; N], b: &[C; N]) {
    map2::<N, _, _, _>(out, a, b, |a, b| complex::compare(operation, a, b));
}

/// zⁿ.
pub(crate) fn complex_powers<const N: usize>(n: i32, out: &mut [C; N], a: &[C; N], lanes: usize) {
    first::<N, _>(out, lanes, |lane| a[lane].powi(n));
}

/// Real numbers as complex ones.
pub(crate) fn promoted<const N: usize>(out: &mut [C; N], a: &[f64; N]) {
    map::<N, _, _>(out, a, C::from);
}
