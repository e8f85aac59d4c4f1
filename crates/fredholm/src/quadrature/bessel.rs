//! J₀ at its zeros: J₀ = M cos φ with φ′ = 2/(πx M²), and an expansion of M² that is good to rounding from x = 26 on.

use std::array::from_fn;
use std::f64::consts::PI;

/// The coefficients of 2/(πx M²) = φ′, and of φ, in powers of x⁻², from Nicholson's 1 + Σ_k Π_{i≤k} −(2i − 1)³/(2i) (2x)⁻²ᵏ for πxM²/2.
#[derive(Clone, Debug)]
pub(super) struct Zeros {
    phase_slope: [f64; TERMS],
    phase: [f64; TERMS],
}

/// The expansion's least term at x = 26 is the 25th; twelve leave less than 1e-17 there.
const TERMS: usize = 12;

/// From this zero on, x > 26, the expansion is good; before, libm's J₀ and J₁ are cheap enough.
const FAR: usize = 9;

impl Zeros {
    pub(super) fn new() -> Self {
        let mut modulus = [1.0; TERMS];
        for k in 1..TERMS {
            let odd = 2.0 * k as f64 - 1.0;
            modulus[k] = -modulus[k - 1] * odd.powi(3) / (8.0 * k as f64);
        }
        let mut phase_slope = [1.0; TERMS];
        for k in 1..TERMS {
            phase_slope[k] = -(1..=k).map(|i| modulus[i] * phase_slope[k - i]).sum::<f64>();
        }
        let phase = from_fn(|k| -phase_slope[k] / (2.0 * k as f64 - 1.0));
        Self { phase_slope, phase }
    }

    /// The k-th zero x of J₀ (k = 1 …) and x J₁(x)², which tends to 2/π.
    pub(super) fn zero(&self, k: usize) -> (f64, f64) {
        let guess = PI * (k as f64 - 0.25);
        if k < FAR {
            // McMahon's first term is off by 1e-3 at most: Newton doubles the digits.
            let mut x = guess + 0.125 / guess;
            for _ in 0..4 {
                x += libm::j0(x) / libm::j1(x);
            }
            return (x, x * libm::j1(x).powi(2));
        }
        let mut x = guess;
        for _ in 0..2 {
            let (shift, slope) = self.phase(x);
            x -= (x + shift - guess) / slope;
        }
        (x, 2.0 / PI * self.phase(x).1)
    }

    /// (φ − x + π/4, φ′).
    fn phase(&self, x: f64) -> (f64, f64) {
        let (mut shift, mut slope) = (0.0, 0.0);
        let square = 1.0 / (x * x);
        for k in (1..TERMS).rev() {
            slope = (slope + self.phase_slope[k]) * square;
            shift = (shift + self.phase[k]) * square;
        }
        (shift * x, 1.0 + slope)
    }
}
