//! What an unknown may be: a number, a colour, a spectrum. ρ and f take values; the kernel K stays real.

use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, Mul, Sub, SubAssign};

/// A vector of independent channels, added and multiplied channel by channel.
///
/// The discrete equation u = f + ρ ⊙ (F u) has one real matrix F for all channels, so whatever is written
/// for a `Value` is written once for numbers ([`f64`]), colours ([`Rgb`]) and spectra ([`Spectrum`]).
pub trait Value:
    Copy
    + Debug
    + PartialEq
    + Send
    + Sync
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Mul<f64, Output = Self>
    + AddAssign
    + SubAssign
    + 'static
{
    /// How many channels a value has.
    const CHANNELS: usize;

    /// The value with the same number in every channel.
    fn splat(number: f64) -> Self;

    /// The channels, in order.
    fn channels(&self) -> &[f64];

    /// The channels, in order, to be written.
    fn channels_mut(&mut self) -> &mut [f64];

    /// The largest absolute value of a channel; NaN when a channel is NaN, so that it cannot hide.
    fn magnitude(&self) -> f64 {
        self.channels().iter().fold(0.0, |m: f64, c| if c.abs() > m || c.is_nan() { c.abs() } else { m })
    }

    /// The sum of the squares of the channels.
    fn square(&self) -> f64 {
        self.channels().iter().map(|c| c * c).sum()
    }

    /// `function` of each channel.
    fn map(mut self, function: impl Fn(f64) -> f64) -> Self {
        self.channels_mut().iter_mut().for_each(|c| *c = function(*c));
        self
    }

    /// `function` of each channel and the same channel of `other`.
    fn zip(mut self, other: Self, function: impl Fn(f64, f64) -> f64) -> Self {
        self.channels_mut().iter_mut().zip(other.channels()).for_each(|(c, o)| *c = function(*c, *o));
        self
    }

    /// Values as the numbers that they are, if they are numbers: there is vector code for these.
    fn numbers(_values: &[Self]) -> Option<&[f64]> {
        None
    }

    /// Values as the numbers that they are, to be written.
    fn numbers_mut(_values: &mut [Self]) -> Option<&mut [f64]> {
        None
    }

    /// Whether no channel is infinite or NaN.
    fn all_finite(&self) -> bool {
        self.channels().iter().all(|c| c.is_finite())
    }
}

impl Value for f64 {
    const CHANNELS: usize = 1;

    fn splat(number: f64) -> Self {
        number
    }
    fn channels(&self) -> &[f64] {
        std::slice::from_ref(self)
    }
    fn channels_mut(&mut self) -> &mut [f64] {
        std::slice::from_mut(self)
    }
    fn numbers(values: &[Self]) -> Option<&[f64]> {
        Some(values)
    }
    fn numbers_mut(values: &mut [Self]) -> Option<&mut [f64]> {
        Some(values)
    }
}

/// `N` channels: the bands of a spectrum, or with `N = 3` a colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spectrum<const N: usize>(pub [f64; N]);

/// Red, green and blue, linear.
pub type Rgb = Spectrum<3>;

impl<const N: usize> Value for Spectrum<N> {
    const CHANNELS: usize = N;

    fn splat(number: f64) -> Self {
        Self([number; N])
    }
    fn channels(&self) -> &[f64] {
        &self.0
    }
    fn channels_mut(&mut self) -> &mut [f64] {
        &mut self.0
    }
}

macro_rules! by_channel {
    ($($operator:ident $method:ident $assign:tt),*) => {$(
        impl<const N: usize> $operator for Spectrum<N> {
            type Output = Self;
            fn $method(mut self, other: Self) -> Self {
                for (mine, its) in self.0.iter_mut().zip(other.0) {
                    *mine $assign its;
                }
                self
            }
        }
    )*};
}
by_channel!(Add add +=, Sub sub -=, Mul mul *=, Div div /=);

impl<const N: usize> Mul<f64> for Spectrum<N> {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        self.map(|c| c * factor)
    }
}

impl<const N: usize> AddAssign for Spectrum<N> {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<const N: usize> SubAssign for Spectrum<N> {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

/// max_i ‖v_i‖∞ over the entries and their channels; NaN when an entry has one.
pub fn max_norm<V: Value>(values: &[V]) -> f64 {
    values.iter().map(Value::magnitude).fold(0.0, |m: f64, x| if x > m || x.is_nan() { x } else { m })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arithmetic_goes_channel_by_channel() {
        let (a, b) = (Spectrum([1.0, -6.0, 3.0]), Spectrum([2.0, 3.0, 0.5]));
        assert_eq!(a + b, Spectrum([3.0, -3.0, 3.5]));
        assert_eq!(a - b, Spectrum([-1.0, -9.0, 2.5]));
        assert_eq!(a * b, Spectrum([2.0, -18.0, 1.5]));
        assert_eq!(a / b, Spectrum([0.5, -2.0, 6.0]));
        assert_eq!(a * 2.0, Spectrum([2.0, -12.0, 6.0]));
        assert_eq!(a.magnitude(), 6.0);
    }

    #[test]
    fn a_nan_never_hides_behind_a_larger_number() {
        assert!(Spectrum([1.0, f64::NAN, 9.0]).magnitude().is_nan());
        assert!(max_norm(&[1.0, f64::NAN, 2.0]).is_nan());
    }
}
