//! A quick picture of the patches as they are, for the frames of a solution that converges.

use crate::lights;
use crate::patches::Patches;
use crate::polygon::Polygon;
use crate::render::colour::Colour;
use crate::render::fragments::Fragments;
use crate::render::picture::Picture;
use crate::render::view::{Rays, View};
use crate::visibility::Visibility;
use fredholm::value::Rgb;
use std::f64::consts::PI;

/// Which patches each pixel of a view shows: found once, so that a frame costs no rays.
pub struct Preview {
    fragments: Fragments,
    /// The radiance beyond the scene in each pixel, in W/(m² sr).
    beyond: Vec<Rgb>,
}

impl Preview {
    /// Finds the patches in sight. `polygons` are those of the scene, in the order of its surfaces; the view's
    /// `gather` plays no part.
    pub fn new<V: Colour>(
        view: &View,
        polygons: &[Polygon],
        patches: &Patches<V>,
        visibility: &Visibility,
    ) -> Self {
        let rays = Rays::new(&view.camera, view.width, view.height);
        let shape = (rays, view.width, view.height, view.samples);
        let patch_at = |polygon, point| patches.patch_at(polygon, point) as u32;
        let fragments = Fragments::new(shape, polygons, visibility, patch_at);
        let beyond = fragments.beyond(|direction| lights::beyond(&patches.lights, direction).to_rgb());
        Self { fragments, beyond }
    }

    /// The mean of a number of each patch over what a pixel shows; none where most of it shows nothing, or something
    /// without a number (NaN).
    pub fn values(&self, values: &[f64]) -> Vec<Option<f64>> {
        let pixel = |pixel: usize| {
            let shown = self.fragments.all[self.fragments.of_pixel(pixel)].iter();
            let (sum, weight) = shown
                .map(|fragment| (values[fragment.shown as usize], fragment.weight))
                .filter(|(value, _)| value.is_finite())
                .fold((0.0, 0.0), |(sum, all), (value, weight)| (sum + value * weight, all + weight));
            (weight >= 0.5).then(|| sum / weight)
        };
        (0..self.fragments.width * self.fragments.height).map(pixel).collect()
    }

    /// The picture of these radiosities, in W/m², one per patch.
    pub fn draw<V: Colour>(&self, radiosity: &[V]) -> Picture {
        let radiance: Vec<_> = radiosity.iter().map(|b| b.to_rgb() * (1.0 / PI)).collect();
        self.fragments.resolve(|k| radiance[self.fragments.all[k].shown as usize], &self.beyond)
    }
}
