//! A map of numbers: radiosity as a colour, with a scale that says which.

use crate::patches::Patches;
use crate::render::colour::{Colour, luminance};
use crate::render::palette::viridis;
use crate::render::picture::Picture;
use crate::render::tone::percentile;
use embedded_graphics::mono_font::iso_8859_1::FONT_9X15;
use embedded_graphics::mono_font::{MonoTextStyle, MonoTextStyleBuilder};
use embedded_graphics::pixelcolor::Rgb888;
use embedded_graphics::prelude::*;
use embedded_graphics::primitives::{Line, PrimitiveStyle};
use embedded_graphics::text::{Baseline, Text};
use image::RgbImage;
use std::convert::Infallible;
use std::f64::consts::PI;

/// The radiosities, in W/m², of the two ends of a palette, and where its ticks are. Pictures that share a scale
/// can be compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    step: f64,
    first: i64,
    last: i64,
    cut: bool,
}

/// The shares of the lit patches below and above the scale.
const RANGE: (f64, f64) = (0.01, 0.97);

/// A scale has at most this many steps inside its range, and so up to two more; more labels crowd a small picture.
const STEPS: f64 = 8.0;

impl Scale {
    /// The scale for a scene: round numbers round the radiosities of all but the darkest and brightest patches. Those
    /// that emit do not count, a lamp or a window has the top colour and does not flatten the room; unless all emit.
    pub fn automatic<V: Colour>(patches: &Patches<V>, radiosity: &[V]) -> Self {
        let levels: Vec<f64> = radiosity.iter().map(|b| luminance(b.to_rgb())).collect();
        let brightest = levels.iter().copied().fold(0.0, f64::max);
        let lit = |(b, e): (&f64, &V)| (*b > 0.0 && e.magnitude() == 0.0).then_some(*b);
        let dark: Vec<f64> = levels.iter().zip(&patches.emission).filter_map(lit).collect();
        Self::around(if dark.is_empty() { levels } else { dark }, brightest)
    }

    /// The scale for most of these radiosities, of a scene that has brighter ones, up to `brightest`.
    fn around(lit: Vec<f64>, brightest: f64) -> Self {
        let low = percentile(lit.clone(), RANGE.0).unwrap_or(0.0);
        let high = percentile(lit, RANGE.1).filter(|high| *high > 0.0).unwrap_or(1.0);
        Self::covering(low, high, brightest)
    }

    /// The scale from the lowest to the highest of some numbers, of any sign.
    pub fn of_values(values: impl Iterator<Item = f64> + Clone) -> Self {
        let (low, high) = values
            .filter(|value| value.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
        let (low, high) = if low <= high { (low, high) } else { (0.0, 1.0) };
        // An even map has no range of its own: it gets a hundredth of its level.
        let margin =
            if high - low < 1e-9 * high.abs().max(low.abs()) { 0.005 * high.abs().max(1e-9) } else { 0.0 };
        let step = round_step((high - low + 2.0 * margin).max(f64::MIN_POSITIVE) / STEPS);
        let first = ((low - margin) / step + 1e-9).floor() as i64;
        let last = ((high + margin) / step - 1e-9).ceil() as i64;
        Self { step, first, last: last.max(first + 1), cut: false }
    }

    fn covering(low: f64, high: f64, brightest: f64) -> Self {
        // An even picture has no range of its own: the scale starts at nothing then.
        let low = if high - low < 0.05 * high { 0.0 } else { low };
        let step = round_step((high - low) / STEPS);
        let (first, last) = ((low / step + 1e-9).floor() as i64, (high / step - 1e-9).ceil() as i64);
        Self { step, first, last, cut: brightest > last as f64 * step * (1.0 + 1e-9) }
    }

    /// The round numbers of the scale, from its lower end to its upper one.
    pub fn ticks(&self) -> impl Iterator<Item = f64> + use<> {
        let step = self.step;
        (self.first..=self.last).map(move |k| k as f64 * step)
    }

    /// Where a radiosity lies between the ends, 0 and 1; beyond them, outside.
    pub fn position(&self, radiosity: f64) -> f64 {
        (radiosity / self.step - self.first as f64) / (self.last - self.first) as f64
    }

    /// A tick in figures, as many as its step needs.
    fn label(&self, tick: f64) -> String {
        let magnitude = self.step.log10().floor() as i32;
        if !(-4..6).contains(&magnitude) {
            return format!("{tick:.1e}");
        }
        format!("{tick:.*}", (-magnitude).max(0) as usize)
    }
}

/// The smallest of 1, 2, 5 × 10ᵏ that is not below `step`.
fn round_step(step: f64) -> f64 {
    let decade = 10_f64.powf(step.log10().floor());
    let mut round = [1.0, 2.0, 5.0].into_iter().map(|m| m * decade);
    round.find(|s| *s >= step * (1.0 - 1e-9)).unwrap_or(10.0 * decade)
}

/// B = π L of the pixels, in W/m²: the luminance of the colours.
fn radiosities(picture: &Picture) -> impl Iterator<Item = f64> {
    picture.pixels.iter().map(|&pixel| PI * luminance(pixel))
}

/// Pixels right of the map for the scale, and above it for the title.
const MARGIN: (u32, u32) = (120, 28);

/// Paper, ink and what is not lit at all, in sRGB. The palette's ends are neither.
const PAPER: image::Rgb<u8> = image::Rgb([24, 24, 24]);
const INK: Rgb888 = Rgb888::new(230, 230, 230);
const UNLIT: image::Rgb<u8> = image::Rgb([0, 0, 0]);

/// The radiosity of every pixel as a colour, with a scale and a title such as "radiosity, W/m²" (in Latin-1).
/// What is brighter than the scale has its top colour, and the top tick a ≥; black is what nothing lights.
pub fn false_colour(picture: &Picture, scale: &Scale, title: &str) -> RgbImage {
    let lit = radiosities(picture).map(|radiosity| Some(radiosity).filter(|radiosity| *radiosity > 0.0));
    map_of_values(lit, (picture.width, picture.height), scale, title)
}

/// A number of every pixel, from the upper left corner row by row, as a colour; black is where there is none.
pub fn map_of_values(
    values: impl IntoIterator<Item = Option<f64>>,
    (width, height): (usize, usize),
    scale: &Scale,
    title: &str,
) -> RgbImage {
    let (width, height) = (width as u32, height as u32);
    let mut canvas = Canvas(RgbImage::from_pixel(width + MARGIN.0, height + 2 * MARGIN.1, PAPER));
    for (k, value) in values.into_iter().enumerate() {
        let colour = value.map_or(UNLIT, |value| image::Rgb(viridis(scale.position(value))));
        canvas.0.put_pixel(k as u32 % width, MARGIN.1 + k as u32 / width, colour);
    }
    let Ok(()) = draw_legend(&mut canvas, scale, title, (width, height));
    canvas.0
}

fn draw_legend(
    canvas: &mut Canvas,
    scale: &Scale,
    title: &str,
    (width, height): (u32, u32),
) -> Result<(), Infallible> {
    let style = MonoTextStyle::new(&FONT_9X15, INK);
    Text::with_baseline(title, Point::new(8, MARGIN.1 as i32 / 2), style, Baseline::Middle).draw(canvas)?;
    let (left, top, length) = (width as i32 + 16, MARGIN.1 as i32, height as i32 - 1);
    for y in 0..=length {
        let [r, g, b] = viridis(1.0 - f64::from(y) / f64::from(length.max(1)));
        let style = PrimitiveStyle::with_stroke(Rgb888::new(r, g, b), 1);
        horizontal(left, left + 19, top + y).into_styled(style).draw(canvas)?;
    }
    for tick in scale.ticks() {
        let y = top + ((1.0 - scale.position(tick)) * f64::from(length)).round() as i32;
        let style = PrimitiveStyle::with_stroke(INK, 1);
        horizontal(left + 20, left + 25, y).into_styled(style).draw(canvas)?;
        draw_label(canvas, scale, tick, Point::new(left + 30, y))?;
    }
    Ok(())
}

fn draw_label(canvas: &mut Canvas, scale: &Scale, tick: f64, mut at: Point) -> Result<(), Infallible> {
    let style = MonoTextStyle::new(&FONT_9X15, INK);
    if scale.cut && scale.ticks().last() == Some(tick) {
        // Latin-1 has no ≥; a > that is underlined is one.
        let underlined = MonoTextStyleBuilder::from(&style).underline().build();
        at = Text::with_baseline(">", at, underlined, Baseline::Middle).draw(canvas)?;
    }
    Text::with_baseline(&scale.label(tick), at, style, Baseline::Middle).draw(canvas)?;
    Ok(())
}

fn horizontal(left: i32, right: i32, y: i32) -> Line {
    Line::new(Point::new(left, y), Point::new(right, y))
}

/// An image that text and lines can be drawn on.
struct Canvas(RgbImage);

impl OriginDimensions for Canvas {
    fn size(&self) -> Size {
        Size::new(self.0.width(), self.0.height())
    }
}

impl DrawTarget for Canvas {
    type Color = Rgb888;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb888>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for Pixel(at, colour) in pixels {
            if let (Ok(x), Ok(y)) = (at.x.try_into(), at.y.try_into())
                && let Some(pixel) = self.0.get_pixel_mut_checked(x, y)
            {
                *pixel = image::Rgb([colour.r(), colour.g(), colour.b()]);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fredholm::value::{Rgb, Value};

    fn picture(radiosities: impl IntoIterator<Item = f64>) -> Picture {
        let pixels: Vec<_> = radiosities.into_iter().map(|b| Rgb::splat(b / PI)).collect();
        Picture { width: pixels.len(), height: 1, pixels }
    }

    fn labels(scale: &Scale) -> Vec<String> {
        scale.ticks().map(|t| scale.label(t)).collect()
    }

    #[test]
    fn ticks_are_round_numbers_that_enclose_the_range() {
        let scale = Scale::covering(0.013, 0.94, 0.94);
        assert_eq!(labels(&scale), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(
            labels(&Scale::covering(130.0, 1230.0, 1e3)),
            ["0", "200", "400", "600", "800", "1000", "1200", "1400"]
        );
        assert_eq!(labels(&Scale::covering(0.0, 3e-7, 1.0)).last().map(String::as_str), Some("3.0e-7"));
    }

    #[test]
    fn a_lamp_is_above_the_scale_and_does_not_stretch_it() {
        let room = || (0..98).map(|k| 1.0 + f64::from(k) / 97.0);
        let scale = Scale::around(room().collect(), 500.0);
        assert_eq!((scale.ticks().next(), scale.ticks().last(), scale.cut), (Some(1.0), Some(2.0), true));
        assert!(!Scale::around(room().collect(), 2.0).cut);
    }

    #[test]
    fn numbers_of_any_sign_have_a_scale_that_holds_them() {
        let scale = Scale::of_values([-340.0, f64::NAN, 120.0].into_iter());
        assert_eq!(labels(&scale), ["-400", "-300", "-200", "-100", "0", "100", "200"]);
        for even in [300.0, 0.0, -5.0] {
            let scale = Scale::of_values([even; 3].into_iter());
            assert!((0.0..=1.0).contains(&scale.position(even)) && scale.ticks().count() > 1, "{scale:?}");
        }
        assert!(Scale::of_values([].into_iter()).ticks().count() > 1);
    }

    #[test]
    fn an_even_picture_and_a_dark_one_have_scales() {
        for level in [5.0, 0.0] {
            let scale = Scale::around(vec![level; 9], level);
            assert!(scale.ticks().count() > 1 && scale.ticks().all(f64::is_finite), "{scale:?}");
        }
    }

    #[test]
    fn the_map_has_the_palette_the_legend_and_black_for_the_unlit() {
        let picture = Picture { width: 2, height: 200, ..picture([1.0, 0.0].repeat(200)) };
        let scale = Scale::around(vec![1.0; 9], 1.0);
        let image = false_colour(&picture, &scale, "radiosity, W/m\u{b2}");
        let top = viridis(scale.position(1.0));
        assert_eq!((image.get_pixel(0, MARGIN.1).0, image.get_pixel(1, MARGIN.1)), (top, &UNLIT));
        let ink = image.pixels().filter(|p| p.0 == [INK.r(), INK.g(), INK.b()]).count();
        assert!(ink > 300, "{ink}");
    }
}
