//! (R, G, B) = M ∫ (x̄, ȳ, z̄)(λ) u(λ) dλ: what a value looks like on a screen.

use fredholm::value::{Rgb, Spectrum};
use glam::{DMat3, DVec3};
use std::sync::LazyLock;

/// A value that can be shown as a colour.
pub trait Colour: fredholm::value::Value {
    /// Linear red, green and blue with the primaries of Rec. 709 and sRGB, in the unit of the value.
    ///
    /// The value with the same number in every channel is the grey of that number, whatever its channels are,
    /// so that luminances stay comparable in W. A spectrum may lie outside what a screen shows: a channel is
    /// negative then.
    fn to_rgb(&self) -> Rgb;
}

/// A number is grey.
impl Colour for f64 {
    fn to_rgb(&self) -> Rgb {
        Spectrum([*self; 3])
    }
}

/// A colour is itself.
impl Colour for Rgb {
    fn to_rgb(&self) -> Rgb {
        *self
    }
}

/// The bands of the measured Cornell box: 400, 404 … 700 nm.
const BANDS: usize = 76;

/// The spectrum at 400, 404 … 700 nm as the CIE 1931 2° observer sees it, adapted to equal energy as white.
impl Colour for Spectrum<BANDS> {
    fn to_rgb(&self) -> Rgb {
        let mut rgb = [0.0; 3];
        for (band, weights) in self.0.iter().zip(BAND_COLOURS.iter()) {
            for (sum, weight) in rgb.iter_mut().zip(weights) {
                *sum += band * weight;
            }
        }
        Spectrum(rgb)
    }
}

/// How bright a colour is: Y of CIE 1931, in the unit of the colour.
pub fn luminance(rgb: Rgb) -> f64 {
    let [r, g, b] = rgb.0;
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// The colour of a unit in each band.
static BAND_COLOURS: LazyLock<[[f64; 3]; BANDS]> = LazyLock::new(|| {
    let observer: [DVec3; BANDS] = std::array::from_fn(|k| observer_1931(400.0 + 4.0 * k as f64));
    // Cut at 400 and 700 nm, the areas under the three curves are some per cent apart; equal energy is to be grey.
    let area: DVec3 = observer.iter().sum();
    let to_rgb = xyz_to_rgb() * adaptation(DVec3::ONE, d65());
    observer.map(|xyz| (to_rgb * (xyz / area)).to_array())
});

/// x̄, ȳ, z̄ of the CIE 1931 2° observer at a wavelength in nm: the multi-lobe fit of Wyman, Sloan and Shirley,
/// Journal of Computer Graphics Techniques 2(2), 2013, within 0.02 of the tables.
fn observer_1931(wavelength: f64) -> DVec3 {
    let lobe = |height: f64, peak: f64, below: f64, above: f64| {
        let t = (wavelength - peak) * if wavelength < peak { below } else { above };
        height * (-0.5 * t * t).exp()
    };
    DVec3::new(
        lobe(0.362, 442.0, 0.0624, 0.0374)
            + lobe(1.056, 599.8, 0.0264, 0.0323)
            + lobe(-0.065, 501.1, 0.0490, 0.0382),
        lobe(0.821, 568.8, 0.0213, 0.0247) + lobe(0.286, 530.9, 0.0613, 0.0322),
        lobe(1.217, 437.0, 0.0845, 0.0278) + lobe(0.681, 459.0, 0.0385, 0.0725),
    )
}

/// The white of sRGB, (x, y) = (0.3127, 0.3290), with Y = 1.
fn d65() -> DVec3 {
    xyz(0.3127, 0.3290)
}

/// X, Y, Z of the chromaticity (x, y) with Y = 1.
fn xyz(x: f64, y: f64) -> DVec3 {
    DVec3::new(x / y, 1.0, (1.0 - x - y) / y)
}

/// From X, Y, Z to linear Rec. 709: the inverse of the primaries, each as bright as makes their sum the white.
fn xyz_to_rgb() -> DMat3 {
    let primaries = DMat3::from_cols(xyz(0.64, 0.33), xyz(0.30, 0.60), xyz(0.15, 0.06));
    let shares = primaries.inverse() * d65();
    (primaries * DMat3::from_diagonal(shares)).inverse()
}

/// Bradford's chromatic adaptation: what is white under the first light becomes white under the second.
fn adaptation(from: DVec3, to: DVec3) -> DMat3 {
    let cones =
        DMat3::from_cols_array(&[0.8951, -0.7502, 0.0389, 0.2664, 1.7135, -0.0685, -0.1614, 0.0367, 1.0296]);
    cones.inverse() * DMat3::from_diagonal((cones * to) / (cones * from)) * cones
}

#[cfg(test)]
mod tests {
    use super::*;
    use fredholm::value::Value;

    #[test]
    fn the_observer_has_the_area_and_the_white_of_the_tables() {
        let sum: DVec3 = (0..4000).map(|k| observer_1931(360.0 + 0.1 * f64::from(k)) * 0.1).sum();
        assert!((sum.y - 106.86).abs() < 0.3, "{sum}");
        let total = sum.element_sum();
        assert!(
            (sum.x / total - 1.0 / 3.0).abs() < 2e-3 && (sum.y / total - 1.0 / 3.0).abs() < 2e-3,
            "{sum}"
        );
    }

    #[test]
    fn the_matrix_is_that_of_srgb() {
        let red = xyz_to_rgb().row(0);
        assert!(red.distance(DVec3::new(3.2405, -1.5371, -0.4985)) < 2e-3, "{red}");
    }

    #[test]
    fn equal_channels_are_the_same_grey_in_every_kind_of_value() {
        let grey = Spectrum::<76>::splat(0.7).to_rgb();
        assert!((grey - 0.7.to_rgb()).magnitude() < 1e-4, "{grey:?}");
        assert!((luminance(grey) - 0.7).abs() < 1e-4);
    }

    #[test]
    fn long_waves_are_red_and_short_ones_blue() {
        let band = |k: usize| {
            let mut spectrum = Spectrum::<76>::splat(0.0);
            spectrum.0[k] = 76.0;
            spectrum.to_rgb().0
        };
        let ([r, g, b], [r2, g2, b2]) = (band(60), band(12));
        assert!(r > 1.0 && g < 0.1 && b < 0.1, "{r} {g} {b}");
        assert!(b2 > 1.0 && b2 > 3.0 * r2 && b2 > 3.0 * g2, "{r2} {g2} {b2}");
    }
}
