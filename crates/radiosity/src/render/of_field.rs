//! The picture of a light that is known at every point: one look at each thing that a pixel shows, curved surfaces as such.

use crate::lights;
use crate::polygon::Polygon;
use crate::reconstruct::Lit;
use crate::render::colour::Colour;
use crate::render::fragments::{Fragment, Fragments};
use crate::render::picture::Picture;
use crate::render::view::{Rays, View};
use crate::visibility::Visibility;
use fredholm::value::Rgb;
use rayon::prelude::*;
use std::f64::consts::FRAC_1_PI;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What each pixel of a view shows, and the light that a field has there.
pub struct Sightings<V> {
    fragments: Fragments,
    /// The radiosity and the irradiance of each, in W/m².
    light: Vec<[V; 2]>,
    /// The radiance beyond the scene in each pixel, in W/(m² sr).
    beyond: Vec<Rgb>,
}

impl<V: Colour> Sightings<V> {
    /// Looks. `polygons` are those of the scene, in the order of its surfaces; the view's `gather` plays no part. `progress`
    /// is told how many rows are lit.
    pub fn new(
        view: &View,
        field: &dyn Lit<V>,
        polygons: &[Polygon],
        visibility: &Visibility,
        progress: &(dyn Fn(usize) + Sync),
    ) -> Self {
        let rays = Rays::new(&view.camera, view.width, view.height);
        let shape = (rays, view.width, view.height, view.samples);
        let fragments = Fragments::new(shape, polygons, visibility, |polygon, _| polygon);
        let done = AtomicUsize::new(0);
        let row = |y: usize| {
            let first = fragments.of_pixel(y * view.width).start;
            let end = fragments.of_pixel((y + 1) * view.width - 1).end;
            let light = field.seen(&mut fragments.all[first..end].iter().map(|f| (f.shown, f.point)));
            progress(done.fetch_add(1, Ordering::Relaxed) + 1);
            light
        };
        let light = (0..view.height).into_par_iter().map(row).collect::<Vec<_>>().concat();
        let beyond = fragments.beyond(|direction| lights::beyond(field.lights(), direction).to_rgb());
        Self { fragments, light, beyond }
    }

    /// The mean over what a pixel shows of a number of its radiosity and irradiance; none where most of it shows nothing.
    pub fn values(&self, number: impl Fn(V, V) -> f64) -> Vec<Option<f64>> {
        let pixel = |pixel: usize| {
            let shown = self.fragments.of_pixel(pixel);
            let (sum, weight) = shown.fold((0.0, 0.0), |(sum, all), k| {
                let ([radiosity, irradiance], Fragment { weight, .. }) =
                    (self.light[k], self.fragments.all[k]);
                (sum + number(radiosity, irradiance) * weight, all + weight)
            });
            (weight >= 0.5).then(|| sum / weight)
        };
        (0..self.fragments.width * self.fragments.height).map(pixel).collect()
    }
}

impl<V: Colour> Sightings<V> {
    /// The picture: the radiance B/π.
    pub fn picture(&self) -> Picture {
        self.fragments.resolve(|k| self.light[k][0].to_rgb() * FRAC_1_PI, &self.beyond)
    }
}
