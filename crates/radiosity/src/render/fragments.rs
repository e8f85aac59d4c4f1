//! What each pixel shows: pixel = Σ weight × radiance over the surfaces that its rays meet.

use crate::polygon::Polygon;
use crate::reconstruct::{Rotation, lattice};
use crate::render::colour::luminance;
use crate::render::picture::Picture;
use crate::render::tone::percentile;
use crate::render::view::{Rays, first_front};
use crate::visibility::Visibility;
use fredholm::value::{Rgb, Spectrum};
use glam::DVec3;
use rayon::prelude::*;

/// The part of a pixel that shows one thing.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fragment {
    /// What it shows: the number of a polygon or of a patch.
    pub(crate) shown: u32,
    /// The share of the pixel.
    pub(crate) weight: f64,
    /// The middle of the points seen.
    pub(crate) point: DVec3,
}

/// The fragments of all pixels, row by row.
pub(crate) struct Fragments {
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) all: Vec<Fragment>,
    /// Pixel k has the fragments first[k] .. first[k + 1].
    first: Vec<usize>,
}

impl Fragments {
    /// Casts `samples` rays through every pixel and sorts what they meet by `shown(polygon, point)`.
    pub(crate) fn new(
        (rays, width, height, samples): (Rays, usize, usize, usize),
        polygons: &[Polygon],
        visibility: &Visibility,
        shown: impl Fn(u32, DVec3) -> u32 + Sync,
    ) -> Self {
        let pixel = |x: usize, y: usize| {
            let mut fragments = Vec::new();
            // The same pattern in every pixel: edges come out even.
            for (s, t) in lattice(samples, Rotation::NONE) {
                let direction = rays.direction(x as f64 + s, y as f64 + t);
                if let Some(hit) = first_front(polygons, visibility, rays.origin(), direction) {
                    let point = rays.origin() + direction * hit.distance;
                    add_sample(&mut fragments, shown(hit.polygon, point), point);
                }
            }
            for fragment in &mut fragments {
                fragment.point /= fragment.weight;
                fragment.weight /= samples as f64;
            }
            fragments
        };
        let rows: Vec<Vec<_>> =
            (0..height).into_par_iter().map(|y| (0..width).map(|x| pixel(x, y)).collect()).collect();
        let mut result = Self { width, height, all: Vec::new(), first: vec![0] };
        for fragments in rows.into_iter().flatten() {
            result.all.extend(fragments);
            result.first.push(result.all.len());
        }
        result
    }

    /// Pixels that show one thing each.
    #[cfg(test)]
    pub(crate) fn with_one_each(width: usize, height: usize, all: Vec<Fragment>) -> Self {
        Self { width, height, first: (0..=all.len()).collect(), all }
    }

    /// Which fragments a pixel has.
    pub(crate) fn of_pixel(&self, pixel: usize) -> std::ops::Range<usize> {
        self.first[pixel]..self.first[pixel + 1]
    }

    /// The picture in which each fragment has the radiance `of` its number.
    ///
    /// Where an edge runs through a pixel, radiances far above the middle of the picture are weighed down, as a
    /// screen will show them: the plain mean with a lamp would be as white as the lamp, and the edge a staircase.
    pub(crate) fn resolve(&self, of: impl Fn(usize) -> Rgb + Sync) -> Picture {
        let middle = self.middle_luminance(&of);
        let pixels = (0..self.width * self.height).into_par_iter().with_min_len(self.width);
        let pixels = pixels.map(|pixel| self.blend(self.of_pixel(pixel), &of, middle)).collect();
        Picture { width: self.width, height: self.height, pixels }
    }

    /// The median luminance of a sixteenth of the fragments.
    fn middle_luminance(&self, of: &impl Fn(usize) -> Rgb) -> f64 {
        let lit = (0..self.all.len()).step_by(16).map(|k| luminance(of(k))).filter(|l| *l > 0.0);
        percentile(lit.collect(), 0.5).unwrap_or(1.0)
    }

    fn blend(&self, pixel: std::ops::Range<usize>, of: &impl Fn(usize) -> Rgb, middle: f64) -> Rgb {
        // What the rays miss is black, and weighs as much as it covers.
        let mut weights = 1.0 - self.all[pixel.clone()].iter().map(|f| f.weight).sum::<f64>();
        let mut sum = Spectrum([0.0; 3]);
        for k in pixel {
            let radiance = of(k);
            let weight = self.all[k].weight / (1.0 + luminance(radiance).max(0.0) / middle);
            weights += weight;
            sum += radiance * weight;
        }
        sum * (1.0 / weights)
    }
}

fn add_sample(fragments: &mut Vec<Fragment>, shown: u32, point: DVec3) {
    match fragments.iter_mut().find(|f| f.shown == shown) {
        Some(fragment) => {
            fragment.weight += 1.0;
            fragment.point += point;
        }
        None => fragments.push(Fragment { shown, weight: 1.0, point }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fredholm::value::Value;

    fn one_pixel(weights: &[f64]) -> Fragments {
        let all = weights.iter().map(|&weight| Fragment { shown: 0, weight, point: DVec3::ZERO }).collect();
        Fragments { width: 1, height: 1, all, first: vec![0, weights.len()] }
    }

    #[test]
    fn equal_fragments_make_a_pixel_of_their_radiance() {
        let picture = one_pixel(&[0.25, 0.5, 0.25]).resolve(|_| Rgb::splat(3.0));
        assert!((picture.pixels[0] - Rgb::splat(3.0)).magnitude() < 1e-15);
    }

    #[test]
    fn a_pixel_that_half_misses_is_darker() {
        let half = one_pixel(&[0.5]).resolve(|_| Rgb::splat(1.0)).pixels[0].0[0];
        assert!((0.3..0.5).contains(&half), "{half}");
        assert_eq!(one_pixel(&[]).resolve(|_| Rgb::splat(1.0)).pixels[0], Rgb::splat(0.0));
    }
}
