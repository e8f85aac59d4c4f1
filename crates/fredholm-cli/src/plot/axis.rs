//! Axes: their range, and ticks at round numbers. Logarithms are taken here: kuva's own scale ends at 1e-10.

use kuva::render::layout::TickFormat;
use std::sync::Arc;

/// How an axis runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Equal steps for equal differences.
    Linear,
    /// Equal steps for equal ratios, of powers of ten.
    Decades,
    /// Equal steps for equal ratios, of powers of two.
    Octaves,
}

/// What is below this on a logarithmic axis, zero too, is drawn at it: far less than rounding leaves of anything near 1.
const LEAST: f64 = 1e-20;

/// Ticks that fit.
const TICKS: f64 = 8.0;

impl Scale {
    /// Where a number is on the axis.
    pub fn position(self, value: f64) -> f64 {
        match self {
            Self::Linear => value,
            Self::Decades => value.max(LEAST).log10(),
            Self::Octaves => value.max(LEAST).log2(),
        }
    }

    /// The range and the step of the ticks for positions; none where the axis finds its own.
    pub fn ticks(self, positions: impl Iterator<Item = f64>) -> Option<(f64, f64, f64)> {
        if self == Self::Linear {
            return None;
        }
        let (least, most) =
            positions.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, m), p| (l.min(p), m.max(p)));
        if least > most {
            return None;
        }
        let (least, most) = (least.floor(), most.ceil().max(least.floor() + 1.0));
        let step = ((most - least) / TICKS).ceil();
        Some((most - ((most - least) / step).ceil() * step, most, step))
    }

    /// What stands at a tick.
    pub fn format(self) -> TickFormat {
        match self {
            Self::Linear => TickFormat::Auto,
            Self::Decades => TickFormat::Custom(Arc::new(power_of_ten)),
            Self::Octaves => TickFormat::Custom(Arc::new(|position| position.exp2().round().to_string())),
        }
    }
}

/// 10⁻⁸.
fn power_of_ten(position: f64) -> String {
    const SUPERSCRIPTS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let exponent = format!("{position:.0}");
    let raised = exponent.chars().map(|c| c.to_digit(10).map_or('⁻', |digit| SUPERSCRIPTS[digit as usize]));
    format!("10{}", raised.collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decades_have_whole_ticks() {
        let ticks = |values: &[f64]| Scale::Decades.ticks(values.iter().map(|v| Scale::Decades.position(*v)));
        assert_eq!(ticks(&[3e-5, 0.2]), Some((-5.0, 0.0, 1.0)));
        assert_eq!(ticks(&[2e-17, 0.2]), Some((-18.0, 0.0, 3.0)));
        assert_eq!(ticks(&[1.0]), Some((0.0, 1.0, 1.0)));
        assert_eq!(ticks(&[0.0]), Some((-20.0, -19.0, 1.0)));
        assert_eq!(ticks(&[]), None);
    }

    #[test]
    fn powers_of_ten_are_raised() {
        assert_eq!([-12.0, 0.0, 3.0].map(power_of_ten), ["10⁻¹²", "10⁰", "10³"]);
    }
}
