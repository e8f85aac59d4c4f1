//! An error in one byte: its logarithm, rounded up, so that what is read back is never less than what was put in.
//!
//! | code | error, as a part of the largest that can be |
//! |---|---|
//! | 0 | exactly 0 |
//! | 1 … 254 | 2^((code − 249)/5): from 1.2·10⁻¹⁵ to 2, each 15 % above the one before |
//! | 255 | infinite: more than 2, or unknown |

use std::sync::LazyLock;

/// Codes to a doubling. Five make a step of 15 %, and 50 doublings: from what rounding in f64 leaves to all there is.
const STEPS: f64 = 5.0;

/// The code of 1.
const ONE: f64 = 249.0;

/// The error of each code.
static ERRORS: LazyLock<[f64; 256]> = LazyLock::new(|| {
    std::array::from_fn(|code| match code {
        0 => 0.0,
        255 => f64::INFINITY,
        _ => ((code as f64 - ONE) / STEPS).exp2(),
    })
});

/// The least code whose error is not below this one; what is no number is infinite.
pub(super) fn encode(error: f64) -> u8 {
    if error == 0.0 {
        return 0;
    }
    let errors = &*ERRORS;
    // From the code of the power of two that is not above it; what is no number is above all.
    let octave = (error.to_bits() >> 52) as i64 - 1023;
    let mut code = (ONE as i64 + STEPS as i64 * octave).clamp(1, 255) as usize;
    while code < 255 && !matches!(error.partial_cmp(&errors[code]), Some(o) if o.is_le()) {
        code += 1;
    }
    code as u8
}

/// The error that a code stands for.
pub(super) fn decode(code: u8) -> f64 {
    ERRORS[usize::from(code)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_comes_back_larger_by_less_than_a_step() {
        let step = (1.0 / STEPS).exp2();
        for k in 0..4000 {
            let error = 1.3e-15 * 1.0088_f64.powi(k);
            if error > 2.0 {
                break;
            }
            let back = decode(encode(error));
            assert!(back >= error && back < error * step * (1.0 + 1e-12), "{error:e} {back:e}");
        }
    }

    #[test]
    fn every_code_is_its_own_and_the_ends_are_as_told() {
        for code in 0..=255 {
            assert_eq!(encode(decode(code)), code);
        }
        assert_eq!((encode(0.0), encode(1e-300), encode(5e-324)), (0, 1, 1));
        assert!((decode(1) / 1.2e-15 - 1.0).abs() < 0.05 && decode(249) == 1.0 && decode(254) == 2.0);
        for much in [2.1, 1e300, f64::INFINITY, f64::NAN, -f64::NAN] {
            assert_eq!(encode(much), 255, "{much}");
        }
    }
}
