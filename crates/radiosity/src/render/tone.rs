//! From radiance to a screen: an exposure, a shoulder for highlights, the sRGB curve, eight bits.

use crate::render::colour::luminance;
use crate::render::picture::Picture;
use fredholm::value::{Rgb, Spectrum};

/// How much radiance is white. One exposure for a sequence of frames keeps them comparable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exposure {
    /// The factor from W/(m² sr) to the linear scale of the screen, on which 1 is white.
    pub scale: f64,
}

/// The share of the lit pixels that are darker than the anchor. A lamp fills less than the other tenth of a
/// picture; the sunlit part of a room does not.
const ANCHOR_SHARE: f64 = 0.9;

/// Where the anchor is put on the screen's linear scale. At 0.6 the light beside a lamp burns out and coloured walls
/// bleach; at 0.3 shadows drown.
const ANCHOR_LEVEL: f64 = 0.45;

/// Up to here the screen is linear; above, highlights roll off towards 1 and never reach it.
const SHOULDER: f64 = 0.6;

impl Exposure {
    /// The exposure that puts the bright surfaces of a picture, though not its lamps, near the top of the scale.
    /// A picture without light is left as it is.
    pub fn automatic(picture: &Picture) -> Self {
        let lit = picture.pixels.iter().map(|&p| luminance(p)).filter(|l| *l > 0.0).collect();
        percentile(lit, ANCHOR_SHARE).map_or(Self { scale: 1.0 }, |l| Self { scale: ANCHOR_LEVEL / l })
    }

    /// The bytes of sRGB for a pixel at (x, y) with this radiance.
    pub fn to_screen(self, radiance: Rgb, x: u32, y: u32) -> [u8; 3] {
        let shown = roll_off(radiance * self.scale);
        let threshold = dither(x, y);
        shown.0.map(|c| (srgb(c) * 255.0 + threshold) as u8)
    }
}

/// The smallest number that at least `share` of the numbers do not exceed; none when there are no numbers.
pub(crate) fn percentile(mut numbers: Vec<f64>, share: f64) -> Option<f64> {
    let rank = ((share * numbers.len() as f64).ceil() as usize).max(1) - 1;
    (rank < numbers.len()).then(|| *numbers.select_nth_unstable_by(rank, f64::total_cmp).1)
}

/// A colour within the screen, of the same hue: the luminance is compressed, then what still does not fit is
/// mixed with the grey of the same luminance.
fn roll_off(colour: Rgb) -> Rgb {
    let before = luminance(colour);
    if before <= 0.0 {
        return Spectrum([0.0; 3]);
    }
    let after = compress(before);
    let colour = colour * (after / before);
    let kept = colour.0.iter().fold(1.0_f64, |kept, &c| kept.min(share_that_fits(c, after)));
    Spectrum(colour.0.map(|c| (after + (c - after) * kept).clamp(0.0, 1.0)))
}

/// How much of the way from grey to a channel stays within [0, 1].
fn share_that_fits(channel: f64, grey: f64) -> f64 {
    let limit = if channel > 1.0 { 1.0 } else { channel.max(0.0) };
    if limit == channel { 1.0 } else { (limit - grey) / (channel - grey) }
}

/// Linear up to the shoulder, then an exponential towards 1 that leaves the line without a kink.
fn compress(level: f64) -> f64 {
    let room = 1.0 - SHOULDER;
    if level <= SHOULDER { level } else { 1.0 - room * (-(level - SHOULDER) / room).exp() }
}

/// The transfer curve of sRGB (IEC 61966-2-1), on [0, 1].
pub(crate) fn srgb(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// A threshold in [0, 1) that differs from pixel to pixel, so that rounding to eight bits draws no bands:
/// interleaved gradient noise (Jimenez 2014), even in every 3 × 3 pixels.
fn dither(x: u32, y: u32) -> f64 {
    (52.982_918_9 * (0.067_110_56 * f64::from(x) + 0.005_837_15 * f64::from(y)).fract()).fract()
}

#[cfg(test)]
mod tests {
    use super::*;
    use fredholm::value::Value;

    fn picture(levels: Vec<f64>) -> Picture {
        Picture { width: levels.len(), height: 1, pixels: levels.into_iter().map(Rgb::splat).collect() }
    }

    #[test]
    fn the_percentile_is_the_number_of_that_rank() {
        let numbers = || (1..=10).rev().map(f64::from).collect::<Vec<_>>();
        assert_eq!(percentile(numbers(), 0.9), Some(9.0));
        assert_eq!(percentile(numbers(), 0.0), Some(1.0));
        assert_eq!(percentile(numbers(), 1.0), Some(10.0));
        assert_eq!(percentile(vec![], 0.5), None);
    }

    #[test]
    fn a_lamp_in_sight_does_not_dim_the_room() {
        let room = picture(vec![0.2; 100]);
        let with_lamp = picture([vec![0.2; 95], vec![900.0; 5], vec![0.0; 300]].concat());
        assert_eq!(Exposure::automatic(&room), Exposure::automatic(&with_lamp));
        assert_eq!(Exposure::automatic(&room).scale, ANCHOR_LEVEL / 0.2);
        assert_eq!(Exposure::automatic(&picture(vec![0.0])).scale, 1.0);
    }

    #[test]
    fn highlights_keep_their_order_and_white_is_not_passed() {
        let levels: Vec<f64> = (0..200).map(|k| compress(0.01 * f64::from(k))).collect();
        assert!(levels.windows(2).all(|w| w[0] < w[1] && w[1] - w[0] < 0.0101));
        assert!(compress(1e9) <= 1.0);
    }

    #[test]
    fn a_highlight_keeps_its_hue_and_its_luminance() {
        let lamp = Spectrum([17.0, 12.0, 4.0]) * 0.1;
        let shown = roll_off(lamp);
        assert!((luminance(shown) - compress(luminance(lamp))).abs() < 1e-12);
        assert!(shown.0[0] <= 1.0 && shown.0[0] > shown.0[1] && shown.0[1] > shown.0[2], "{shown:?}");
        assert!(roll_off(Spectrum([0.5, 0.4, -0.1])).0.iter().all(|c| (0.0..=1.0).contains(c)));
    }

    #[test]
    fn the_mean_of_dithered_pixels_is_the_level() {
        let exposure = Exposure { scale: 1.0 };
        let pixels = (0..4096).map(|k| exposure.to_screen(Rgb::splat(0.2), k % 64, k / 64)[0]);
        let mean = pixels.map(f64::from).sum::<f64>() / 4096.0;
        assert!((mean - srgb(0.2) * 255.0).abs() < 0.03, "{mean}");
    }
}
