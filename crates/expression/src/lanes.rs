//! One operation on some lanes: loops over slices of one length, which the compiler turns into vector instructions.

use crate::complex;
use crate::fuse::Outer;
use crate::operation::{Binary, Operation, Unary, by_sign, power, select};
use crate::program::{Action, Step};
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
        for (k, piece) in pieces.iter_mut().enumerate() {
            if 16 * k < lanes {
                piece.fill(value);
            }
        }
    }

    /// A value for each lane, by pieces of fixed length: to copy any length is a call.
    #[inline(always)]
    pub fn load(&mut self, values: &[T]) {
        let (pieces, rest) = values.as_chunks::<8>();
        let (whole, _) = self.0.as_chunks_mut::<8>();
        whole.iter_mut().zip(pieces).for_each(|(to, from)| *to = *from);
        self.0[8 * pieces.len()..].iter_mut().zip(rest).for_each(|(to, from)| *to = *from);
    }

    /// So many lanes.
    #[inline(always)]
    pub fn lanes(&self, lanes: usize) -> &[T] {
        &self.0[..lanes]
    }
}

type C = Complex<f64>;

/// A loop that does a step of real numbers alone.
///
/// The loops of quick operations are chosen when a program is made; to find them for each block would take as long as
/// they do.
pub(crate) type Kernel = fn(&Step, &[Block<f64>], &mut [f64]);

/// The loop of an action.
pub(crate) fn kernel(action: Action) -> Kernel {
    match action {
        Action::Two(first, second) => fused(first, second),
        Action::ChosenAndLeft(first, second) => chosen_and_left(first, second),
        Action::One(Operation::Unary(operation)) => unary(operation),
        Action::One(Operation::Binary(operation)) => binary(operation),
        Action::One(Operation::Power(n)) => powers(n),
        Action::One(Operation::Select) => {
            |step, real, out| quick(step, real, out, |[c, a, b]| select(c, a, b, f64::NAN))
        }
        Action::One(Operation::BySign) => {
            |step, real, out| quick(step, real, out, |[c, a, b]| by_sign(c, a, b))
        }
        Action::One(_) => slow,
    }
}

fn unary(operation: Unary) -> Kernel {
    macro_rules! run {
        (quick: $($quick:ident),*; slow: $($slow:ident),*) => {
            match operation {
                $(Unary::$quick => |step, real, out| quick(step, real, out, |[a]| Unary::$quick.at(a)),)*
                $(Unary::$slow => |step, real, out| {
                    map(out, real[step.arguments[0]].lanes(out.len()), |a| Unary::$slow.at(a))
                },)*
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
                $(Binary::$quick => |step, real, out| quick(step, real, out, |[a, b]| Binary::$quick.at(a, b)),)*
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
                $($quick => |step, real, out| quick(step, real, out, |[a]| power(a, $quick)),)*
                _ => slow,
            }
        };
    }
    run!(2, 3, 4, -1, -2)
}

/// The loop of a step that ends with an outer operation, whichever it is: `$value` is that operation, of the result of the
/// first one and of `c`.
macro_rules! with_outer {
    ($outer:expr, |$arguments:pat_param, $value:ident| $result:expr) => {
        with_outer!(
            $outer, |$arguments, $value| $result;
            Add => |r, c| r + c, Sub => |r, c| r - c, SubFrom => |r, c| c - r,
            Mul => |r, c| r * c, Div => |r, c| r / c, DivInto => |r, c| c / r,
            Square => |r, _| r * r, Abs => |r, _| r.abs(), Neg => |r, _| -r
        )
    };
    ($outer:expr, |$arguments:pat_param, $value:ident| $result:expr; $($name:ident => $operation:expr),*) => {
        match $outer {
            $(Outer::$name => |step, real, out| {
                quick(step, real, out, |$arguments| {
                    let $value: fn(f64, f64) -> f64 = $operation;
                    $result
                });
            },)*
        }
    };
}

/// `second` of the last argument and of what `first` makes of those before.
fn fused(first: Operation, second: Outer) -> Kernel {
    macro_rules! run {
        ($($first:ident),*) => {
            match first {
                $(Operation::Binary(Binary::$first) => {
                    with_outer!(second, |[a, b, c], value| value(Binary::$first.at(a, b), c))
                })*
                Operation::BySign => {
                    with_outer!(second, |[gap, a, b, c], value| value(by_sign(gap, a, b), c))
                }
                _ => slow,
            }
        };
    }
    run!(Add, Sub, Mul, Div, Min, Max)
}

/// What `first` chooses of two arguments, times `second` of the last one and of what it leaves.
fn chosen_and_left(first: Operation, second: Outer) -> Kernel {
    match first {
        Operation::Binary(Binary::Min) => {
            with_outer!(second, |[a, b, c], value| Binary::Min.at(a, b) * value(Binary::Max.at(a, b), c))
        }
        Operation::Binary(Binary::Max) => {
            with_outer!(second, |[a, b, c], value| Binary::Max.at(a, b) * value(Binary::Min.at(a, b), c))
        }
        Operation::BySign => {
            // both products, and one choice between them, which is quicker than two choices
            with_outer!(second, |[gap, a, b, c], value| by_sign(gap, a * value(b, c), b * value(a, c)))
        }
        _ => slow,
    }
}

/// f of the arguments, in a loop that becomes vector instructions: over slices that are known to be of one length.
#[inline(always)]
fn quick<const N: usize>(step: &Step, real: &[Block<f64>], out: &mut [f64], f: impl Fn([f64; N]) -> f64) {
    let lanes = out.len();
    let arguments: [_; N] = std::array::from_fn(|k| real[step.arguments[k]].lanes(lanes));
    for lane in 0..lanes {
        out[lane] = f(arguments.map(|argument| argument[lane]));
    }
}

/// An operation of one argument or two that takes longer than to find it.
fn slow(step: &Step, real: &[Block<f64>], out: &mut [f64]) {
    let [a, b, ..] = step.arguments.map(|register| real[register].lanes(out.len()));
    match step.action {
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

/// A real step of complex arguments.
#[inline(never)]
pub(crate) fn real_of_complex(step: &Step, complex: &[Block<C>], out: &mut [f64]) {
    let [a, b, ..] = step.arguments.map(|register| complex[register].lanes(out.len()));
    match step.action {
        Action::One(Operation::Unary(operation)) => map(out, a, |a| complex::real_unary(operation, a)),
        Action::One(Operation::Binary(operation)) => {
            map2(out, a, b, |a, b| complex::compare(operation, a, b));
        }
        _ => out.fill(f64::NAN), // the others are never real
    }
}

/// A step of complex value.
#[inline(never)]
pub(crate) fn complex(step: &Step, real: &[Block<f64>], complex: &[Block<C>], out: &mut [C]) {
    let lanes = out.len();
    let [a, b, c, _] = step.arguments;
    let real = |register: usize| real[register].lanes(lanes);
    let complex = |register: usize| complex[register].lanes(lanes);
    let undefined = C::new(f64::NAN, f64::NAN);
    let Action::One(operation) = step.action else { return }; // two are always real
    match operation {
        Operation::Unary(operation) => map(out, complex(a), |a| complex::unary(operation, a)),
        Operation::Binary(Binary::Pow) => map2(out, complex(a), complex(b), complex::pow),
        Operation::Binary(operation) => match step.real_arguments {
            [true, false, ..] => arithmetic(operation, out, real(a), complex(b)),
            [false, true, ..] => arithmetic(operation, out, complex(a), real(b)),
            _ => arithmetic(operation, out, complex(a), complex(b)),
        },
        Operation::Power(n) => map(out, complex(a), |a| a.powi(n)),
        Operation::Select => {
            for (out, (c, (a, b))) in
                out.iter_mut().zip(real(a).iter().zip(complex(b).iter().zip(complex(c))))
            {
                *out = select(*c, *a, *b, undefined);
            }
        }
        Operation::Promote => promoted(out, real(a)),
        // these are no steps of complex value
        Operation::Constant(_) | Operation::Variable(_) | Operation::BySign => out.fill(undefined),
    }
}

/// + − × ÷, one argument of which may be real: by real arithmetic, without products by a zero imaginary part.
fn arithmetic<A, B>(operation: Binary, out: &mut [C], a: &[A], b: &[B])
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

/// Real numbers as complex ones.
pub(crate) fn promoted(out: &mut [C], a: &[f64]) {
    map(out, a, C::from);
}
