//! e_b(T) = σT⁴ (F(λ_b T) − F(λ_{b−1} T)): what a black body emits in each band of wavelengths.

use super::planck::{black_body_fraction, emissive_power, fraction_slope};

/// Bands of wavelength that cover the whole spectrum: from 0 to the first limit, from there to the next, …, and from the
/// last to infinity. No limit is one band, in which surfaces are grey.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Bands {
    limits: Vec<f64>,
}

/// Limits of bands that are none.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("the limits of bands are wavelengths in µm, positive and rising, and not {0:?}")]
pub struct BandError(pub Vec<f64>);

impl Bands {
    /// One band.
    pub fn grey() -> Self {
        Self::default()
    }

    /// Bands between these wavelengths, in µm.
    pub fn new(limits: Vec<f64>) -> Result<Self, BandError> {
        let positive = limits.iter().all(|limit| *limit > 0.0 && limit.is_finite());
        if positive && limits.is_sorted_by(|a, b| a < b) {
            Ok(Self { limits })
        } else {
            Err(BandError(limits))
        }
    }

    /// How many bands there are: one more than limits.
    pub fn count(&self) -> usize {
        self.limits.len() + 1
    }

    /// The wavelengths between bands, in µm.
    pub fn limits(&self) -> &[f64] {
        &self.limits
    }

    /// Whether there is but one.
    pub fn is_grey(&self) -> bool {
        self.limits.is_empty()
    }

    /// e_b of each band at a temperature in K, in W/m². They add up to σT⁴.
    pub fn emissive_powers(&self, temperature: f64) -> Vec<f64> {
        let power = emissive_power(temperature);
        self.differences(|limit| black_body_fraction(limit * temperature), 1.0).map(|f| power * f).collect()
    }

    /// de_b/d(σT⁴) of each band. They add up to 1.
    pub(crate) fn slopes(&self, temperature: f64) -> Vec<f64> {
        let shares = self.differences(|limit| black_body_fraction(limit * temperature), 1.0);
        let moving = |limit: f64| if temperature > 0.0 { fraction_slope(limit * temperature) } else { 0.0 };
        shares.zip(self.differences(moving, 0.0)).map(|(share, slope)| share + 0.25 * slope).collect()
    }

    /// `of` the upper limit less `of` the lower one; it is 0 at the wavelength 0 and `last` at infinity.
    fn differences(&self, of: impl Fn(f64) -> f64, last: f64) -> impl Iterator<Item = f64> {
        let upper = self.limits.iter().map(|limit| of(*limit)).chain([last]);
        let ends: Vec<f64> = [0.0].into_iter().chain(upper).collect();
        (1..ends.len()).map(move |k| ends[k] - ends[k - 1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_share_the_power_of_a_black_body() {
        let bands = Bands::new(vec![2.5, 8.0, 13.0]).unwrap();
        for temperature in [0.0, 3.0, 300.0, 5800.0] {
            let (powers, slopes) = (bands.emissive_powers(temperature), bands.slopes(temperature));
            assert_eq!((powers.len(), slopes.len()), (4, 4));
            assert!(
                (powers.iter().sum::<f64>() - emissive_power(temperature)).abs()
                    <= 1e-12 * powers[0].max(1e3)
            );
            assert!((slopes.iter().sum::<f64>() - 1.0).abs() < 1e-14);
        }
        // A quarter of the power lies below the wavelength of Wien's law.
        let wien = Bands::new(vec![2_897.771_955 / 300.0]).unwrap();
        assert!((wien.emissive_powers(300.0)[0] / emissive_power(300.0) - 0.250_05).abs() < 1e-5);
    }

    #[test]
    fn slopes_are_those_of_the_powers() {
        let bands = Bands::new(vec![4.0, 9.0]).unwrap();
        let (t, step) = (420.0, 1e-3);
        let (above, below) = (bands.emissive_powers(t + step), bands.emissive_powers(t - step));
        let rise = emissive_power(t + step) - emissive_power(t - step);
        for (b, slope) in bands.slopes(t).into_iter().enumerate() {
            assert!(((above[b] - below[b]) / rise - slope).abs() < 1e-8);
        }
    }

    #[test]
    fn limits_rise() {
        for bad in
            [vec![0.0], vec![-1.0], vec![3.0, 3.0], vec![4.0, 2.0], vec![f64::NAN], vec![f64::INFINITY]]
        {
            assert!(Bands::new(bad).is_err());
        }
        assert_eq!(Bands::grey().slopes(300.0), [1.0]);
    }
}
