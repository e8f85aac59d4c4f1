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
    /// The mean direction of the rays of each pixel that meet nothing, where there are some.
    beyond: Vec<Option<DVec3>>,
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
            let (mut fragments, mut beyond) = (Vec::new(), DVec3::ZERO);
            // The same pattern in every pixel: edges come out even.
            for (s, t) in lattice(samples, Rotation::NONE) {
                let direction = rays.direction(x as f64 + s, y as f64 + t);
                if let Some(hit) = first_front(polygons, visibility, rays.origin(), direction) {
                    let point = rays.origin() + direction * hit.distance;
                    add_sample(&mut fragments, shown(hit.polygon, point), point);
                } else {
                    beyond += direction;
                }
            }
            for fragment in &mut fragments {
                fragment.point /= fragment.weight;
                fragment.weight /= samples as f64;
            }
            (fragments, beyond.try_normalize())
        };
        let rows: Vec<Vec<_>> =
            (0..height).into_par_iter().map(|y| (0..width).map(|x| pixel(x, y)).collect()).collect();
        let mut result = Self { width, height, all: Vec::new(), first: vec![0], beyond: Vec::new() };
        for (fragments, beyond) in rows.into_iter().flatten() {
            result.all.extend(fragments);
            result.first.push(result.all.len());
            result.beyond.push(beyond);
        }
        result
    }

    /// Pixels that show one thing each.
    #[cfg(test)]
    pub(crate) fn with_one_each(width: usize, height: usize, all: Vec<Fragment>) -> Self {
        Self { width, height, first: (0..=all.len()).collect(), all, beyond: vec![None; width * height] }
    }

    /// Which fragments a pixel has.
    pub(crate) fn of_pixel(&self, pixel: usize) -> std::ops::Range<usize> {
        self.first[pixel]..self.first[pixel + 1]
    }

    /// The radiance of what is beyond the scene in each pixel that shows some of it, from that of a direction.
    pub(crate) fn beyond(&self, radiance: impl Fn(DVec3) -> Rgb + Sync) -> Vec<Rgb> {
        let nothing = Spectrum([0.0; 3]);
        self.beyond.par_iter().map(|direction| direction.map_or(nothing, &radiance)).collect()
    }

    /// The picture in which each fragment has the radiance `of` its number, and each pixel `beyond` the scene that of its own.
    ///
    /// Where an edge runs through a pixel, radiances far above the middle of the picture are weighed down, as a
    /// screen will show them: the plain mean with a lamp would be as white as the lamp, and the edge a staircase.
    pub(crate) fn resolve(&self, of: impl Fn(usize) -> Rgb + Sync, beyond: &[Rgb]) -> Picture {
        let middle = self.middle_luminance(&of);
        let pixels = (0..self.width * self.height).into_par_iter().with_min_len(self.width);
        let pixels =
            pixels.map(|pixel| self.blend(self.of_pixel(pixel), &of, beyond[pixel], middle)).collect();
        Picture { width: self.width, height: self.height, pixels }
    }

    /// The median luminance of a sixteenth of the fragments.
    fn middle_luminance(&self, of: &impl Fn(usize) -> Rgb) -> f64 {
        let lit = (0..self.all.len()).step_by(16).map(|k| luminance(of(k))).filter(|l| *l > 0.0);
        percentile(lit.collect(), 0.5).unwrap_or(1.0)
    }

    fn blend(
        &self,
        pixel: std::ops::Range<usize>,
        of: &impl Fn(usize) -> Rgb,
        beyond: Rgb,
        middle: f64,
    ) -> Rgb {
        let (mut weights, mut sum) = (0.0, Spectrum([0.0; 3]));
        let mut add = |radiance: Rgb, covered: f64| {
            let weight = covered / (1.0 + luminance(radiance).max(0.0) / middle);
            weights += weight;
            sum += radiance * weight;
        };
        // What the rays miss is black, or the sky.
        add(beyond, 1.0 - self.all[pixel.clone()].iter().map(|f| f.weight).sum::<f64>());
        pixel.for_each(|k| add(of(k), self.all[k].weight));
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

    const BLACK: [Rgb; 1] = [Spectrum([0.0; 3])];

    fn one_pixel(weights: &[f64]) -> Fragments {
        let all = weights.iter().map(|&weight| Fragment { shown: 0, weight, point: DVec3::ZERO }).collect();
        Fragments { width: 1, height: 1, all, first: vec![0, weights.len()], beyond: vec![Some(DVec3::Z)] }
    }

    #[test]
    fn equal_fragments_make_a_pixel_of_their_radiance() {
        let picture = one_pixel(&[0.25, 0.5, 0.25]).resolve(|_| Rgb::splat(3.0), &BLACK);
        assert!((picture.pixels[0] - Rgb::splat(3.0)).magnitude() < 1e-15);
    }

    #[test]
    fn a_pixel_that_half_misses_is_darker() {
        let half = one_pixel(&[0.5]).resolve(|_| Rgb::splat(1.0), &BLACK).pixels[0].0[0];
        assert!((0.3..0.5).contains(&half), "{half}");
        assert_eq!(one_pixel(&[]).resolve(|_| Rgb::splat(1.0), &BLACK).pixels[0], Rgb::splat(0.0));
    }

    #[test]
    fn what_is_missed_is_the_sky() {
        let pixel = one_pixel(&[0.5]);
        let sky = pixel.beyond(|direction| Rgb::splat(direction.z));
        assert_eq!(sky, [Rgb::splat(1.0)]);
        assert!((pixel.resolve(|_| Rgb::splat(1.0), &sky).pixels[0] - Rgb::splat(1.0)).magnitude() < 1e-15);
    }
}
