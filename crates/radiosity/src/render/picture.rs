//! A picture: the radiance that reaches each pixel, linear.

use crate::render::tone::Exposure;
use fredholm::value::Rgb;
use image::RgbImage;

/// Radiance per pixel in W/(m² sr), linear, with the primaries of sRGB.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Pixels from left to right.
    pub width: usize,
    /// Pixels from top to bottom.
    pub height: usize,
    /// The rows from the top, each from the left; black where a ray meets nothing.
    pub pixels: Vec<Rgb>,
}

impl Picture {
    /// The picture as a screen shows it: exposed, its highlights rolled off, in sRGB, 8 bits a channel.
    pub fn develop(&self, exposure: Exposure) -> RgbImage {
        RgbImage::from_fn(self.width as u32, self.height as u32, |x, y| {
            let pixel = self.pixels[y as usize * self.width + x as usize];
            image::Rgb(exposure.to_screen(pixel, x, y))
        })
    }
}
