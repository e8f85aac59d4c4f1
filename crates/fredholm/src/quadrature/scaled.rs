//! m · 2^e: numbers beyond the range of f64, as the weights of Laguerre's rule are before they are normalised.

/// mantissa · 2^exponent.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scaled {
    mantissa: f64,
    exponent: i32,
}

impl Scaled {
    pub(super) fn new(mantissa: f64, exponent: i32) -> Self {
        Self { mantissa, exponent }.tidy()
    }

    pub(super) fn times(self, other: Self) -> Self {
        Self { mantissa: self.mantissa * other.mantissa, exponent: self.exponent + other.exponent }.tidy()
    }

    /// The mantissa within 2^±300, so that a product of two is a number.
    fn tidy(mut self) -> Self {
        const STEP: f64 = 2.037_035_976_334_486e90;
        while self.mantissa.abs() > STEP {
            (self.mantissa, self.exponent) = (self.mantissa / STEP, self.exponent + 300);
        }
        while self.mantissa != 0.0 && self.mantissa.abs() < 1.0 / STEP {
            (self.mantissa, self.exponent) = (self.mantissa * STEP, self.exponent - 300);
        }
        self
    }

    /// As a number of units of 2^exponent; what is too small is 0.
    pub(super) fn over(self, exponent: i32) -> f64 {
        libm::ldexp(self.mantissa, self.exponent.saturating_sub(exponent).max(-3000))
    }
}

/// Weights proportional to `raw`, the k-th counted `count(k)` times, with the sum `total`.
pub(super) fn normalised(raw: &[Scaled], count: impl Fn(usize) -> f64, total: f64) -> Vec<f64> {
    let largest = raw.iter().map(|w| w.exponent).max().unwrap_or(0);
    let plain: Vec<f64> = raw.iter().map(|w| w.over(largest)).collect();
    let sum: f64 = plain.iter().enumerate().map(|(k, w)| count(k) * w).sum();
    plain.iter().map(|w| w * (total / sum)).collect()
}
