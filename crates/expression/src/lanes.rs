//! One operation on some lanes: loops over slices of one length, which the compiler turns into vector instructions.

use crate::complex;
use crate::fuse::Outer;
use crate::operation::{Binary, Operation, Unary, by_sign, power, select};
use crate::program::Action;
use num_complex::Complex;
use std::ops::{Add, Div, Mul, Sub};

/// Lanes of a register: 512 bytes, so that the registers of a usual formula stay in the first cache.
pub(crate) const LANES: usize = 64;

/// A register, on lines of the cache of its own.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(crate) struct Block<T>(pub [T; LANES]);

impl<T: Copy> Block<T> {
    /// A value in so many lanes, or in some more: by pieces of fixed length, which are a few instructions each.
    #[inline(always)]
    pub fn spread(&mut self, value: T, lanes: usize) {
        let (pieces, _) = self.0.as_chunks_mut::<16>();
        pieces.iter_mut().take(lanes.div_ceil(16)).for_each(|piece| piece.fill(value));
    }
}

type C = Complex<f64>;

/// A loop that does an action of real numbers alone: out of three arguments, of which it may need fewer.
///
/// The loops of quick operations are chosen when a program is made; to find them for each block would take as long as
/// they do.
pub(crate) type Kernel = fn(&Action, &mut [f64], [&[f64]; 3]);

/// The loop of an action.
pub(crate) fn kernel(action: Action) -> Kernel {
    match action {
        Action::Two(first, second) => fused(first, second),
        Action::One(Operation::Unary(operation)) => unary(operation),
        Action::One(Operation::Binary(operation)) => binary(operation),
        Action::One(Operation::Power(n)) => powers(n),
        Action::One(Operation::Select) => {
            |_, out, arguments| quick(out, arguments, |c, a, b| select(c, a, b, f64::NAN))
        }
        Action::One(Operation::BySign) => |_, out, arguments| quick(out, arguments, by_sign),
        Action::One(_) => slow,
    }
}

fn unary(operation: Unary) -> Kernel {
    macro_rules! run {
        (quick: $($quick:ident),*; slow: $($slow:ident),*) => {
            match operation {
                $(Unary::$quick => |_, out, arguments| quick(out, arguments, |a, _, _| Unary::$quick.at(a)),)*
                $(Unary::$slow => |_, out, [a, ..]| map(out, a, |a| Unary::$slow.at(a)),)*
                _ => slow,
            }
        };
    }
    run!(quick: Neg, Not, Abs, Sqrt; slow: Exp, Ln)
}

fn binary(operation: Binary) -> Kernel {
    macro_rules! run {
        ($($quick:ident),*) => {
            match operation {
                $(Binary::$quick => |_, out, arguments| quick(out, arguments, |a, b, _| Binary::$quick.at(a, b)),)*
                _ => slow,
            }
        };
    }
    run!(Add, Sub, Mul, Div, Min, Max, Less, LessEqual, Equal, NotEqual, And, Or)
}

/// xⁿ.
fn powers(n: i32) -> Kernel {
    macro_rules! run {
        ($($quick:literal),*) => {
            match n {
                $($quick => |_, out, arguments| quick(out, arguments, |a, _, _| power(a, $quick)),)*
                _ => slow,
            }
        };
    }
    run!(2, 3, 4, -1, -2)
}

/// `second` of c and of what `first` makes of a and b.
fn fused(first: Binary, second: Outer) -> Kernel {
    macro_rules! then {
        ($first:ident: $($second:ident => $value:expr),*) => {
            match second {
                $(Outer::$second => |_, out, arguments| {
                    quick(out, arguments, |a, b, c| {
                        let value: fn(f64, f64) -> f64 = $value;
                        value(Binary::$first.at(a, b), c)
                    })
                },)*
            }
        };
    }
    macro_rules! run {
        ($($first:ident),*) => {
            match first {
                $(Binary::$first => then!(
                    $first:
                    Add => |r, c| r + c, Sub => |r, c| r - c, SubFrom => |r, c| c - r,
                    Mul => |r, c| r * c, Div => |r, c| r / c, DivInto => |r, c| c / r,
                    Square => |r, _| r * r, Abs => |r, _| r.abs(), Neg => |r, _| -r
                ),)*
                _ => slow,
            }
        };
    }
    run!(Add, Sub, Mul, Div, Min, Max)
}

/// f of three, in a loop that becomes vector instructions: out of slices that are known to be of one length.
#[inline(always)]
fn quick(out: &mut [f64], [a, b, c]: [&[f64]; 3], f: impl Fn(f64, f64, f64) -> f64) {
    let lanes = out.len();
    let (a, b, c) = (&a[..lanes], &b[..lanes], &c[..lanes]);
    for lane in 0..lanes {
        out[lane] = f(a[lane], b[lane], c[lane]);
    }
}

/// An operation of one argument or two that takes longer than to find it.
fn slow(action: &Action, out: &mut [f64], [a, b, _]: [&[f64]; 3]) {
    match *action {
        Action::One(Operation::Unary(operation)) => map(out, a, |a| operation.at(a)),
        Action::One(Operation::Binary(operation)) => map2(out, a, b, |a, b| operation.at(a, b)),
        Action::One(Operation::Power(n)) => map(out, a, |a| power(a, n)),
        _ => out.fill(f64::NAN), // the rest is no step, or quick
    }
}

/// f of one.
#[inline(always)]
fn map<A: Copy, O>(out: &mut [O], a: &[A], f: impl Fn(A) -> O) {
    out.iter_mut().zip(a).for_each(|(out, a)| *out = f(*a));
}

/// f of two.
#[inline(always)]
fn map2<A: Copy, B: Copy, O>(out: &mut [O], a: &[A], b: &[B], f: impl Fn(A, B) -> O) {
    out.iter_mut().zip(a.iter().zip(b)).for_each(|(out, (a, b))| *out = f(*a, *b));
}

/// The second where the first is not zero, else the third.
pub(crate) fn complex_selection(out: &mut [C], condition: &[f64], a: &[C], b: &[C], undefined: C) {
    for ((out, c), (a, b)) in out.iter_mut().zip(condition).zip(a.iter().zip(b)) {
        *out = select(*c, *a, *b, undefined);
    }
}

/// A complex operation of one argument.
pub(crate) fn complex_unary(operation: Unary, out: &mut [C], a: &[C]) {
    map(out, a, |a| complex::unary(operation, a));
}

/// An operation of one complex argument whose value is real.
pub(crate) fn real_of_complex(operation: Unary, out: &mut [f64], a: &[C]) {
    map(out, a, |a| complex::real_unary(operation, a));
}

/// A complex operation of two arguments.
pub(crate) fn complex_binary(operation: Binary, out: &mut [C], a: &[C], b: &[C]) {
    match operation {
        Binary::Pow => map2(out, a, b, complex::pow),
        other => arithmetic(other, out, a, b),
    }
}

/// + − × ÷, one argument of which may be real: by real arithmetic, without products by a zero imaginary part.
pub(crate) fn arithmetic<A, B>(operation: Binary, out: &mut [C], a: &[A], b: &[B])
where
    A: Copy + Add<B, Output = C> + Sub<B, Output = C> + Mul<B, Output = C> + Div<B, Output = C>,
    B: Copy,
{
    match operation {
        Binary::Add => map2(out, a, b, |a, b| a + b),
        Binary::Sub => map2(out, a, b, |a, b| a - b),
        Binary::Mul => map2(out, a, b, |a, b| a * b),
        _ => map2(out, a, b, |a, b| a / b),
    }
}

/// Whether two complex numbers are equal, or not.
pub(crate) fn comparison(operation: Binary, out: &mut [f64], a: &[C], b: &[C]) {
    map2(out, a, b, |a, b| complex::compare(operation, a, b));
}

/// zⁿ.
pub(crate) fn complex_powers(n: i32, out: &mut [C], a: &[C]) {
    map(out, a, |a| a.powi(n));
}

/// Real numbers as complex ones.
pub(crate) fn promoted(out: &mut [C], a: &[f64]) {
    map(out, a, C::from);
}
