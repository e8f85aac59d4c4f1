//! A picture per iteration: the patches as the solver has them.

use super::args::{Radiosity, Solver};
use super::domain::Domain;
use super::outputs::write_png;
use super::picture::{map, view};
use super::settings::Settings;
use crate::output::Folder;
use anyhow::Result;
use fredholm::neumann::estimated_rest;
use fredholm::value::{Rgb, Value};
use radiosity::lights::mean_irradiances;
use radiosity::patches::Patches;
use radiosity::render::{Colour, Exposure, Picture, Preview};
use radiosity::scene::Units;
use radiosity::solve::source;
use radiosity::visibility::Visibility;
use std::f64::consts::PI;
use std::path::PathBuf;
use std::time::Instant;

/// Draws and writes the frames, and keeps account of it.
pub struct Frames {
    folder: Folder,
    every: usize,
    preview: Preview,
    exposure: Option<Exposure>,
    units: Units,
    /// The files written.
    pub files: Vec<PathBuf>,
    /// The seconds spent before the solver began.
    pub preparing: f64,
    /// The seconds spent on drawing and writing while it worked.
    pub recording: f64,
}

/// A shot changes little: a frame for each would show nothing move.
const SHOTS_PER_FRAME: usize = 100;

impl Frames {
    /// Finds out what each pixel shows, once for all frames.
    pub fn new<V: Colour>(
        folder: Folder,
        args: &Radiosity,
        (settings, units): (&Settings, Units),
        domain: &Domain<'_, V>,
    ) -> Self {
        let start = Instant::now();
        let usual = if settings.solver == Solver::Southwell { SHOTS_PER_FRAME } else { 1 };
        let view = view(args, domain);
        Self {
            folder,
            every: args.every.unwrap_or(usual),
            preview: Preview::new(&view, &domain.polygons, &domain.patches, &domain.visibility),
            units,
            exposure: (!args.false_colour).then(|| exposure(&domain.patches, &domain.visibility)),
            files: Vec::new(),
            preparing: start.elapsed().as_secs_f64(),
            recording: 0.0,
        }
    }

    /// Writes the frame of an iteration, from the radiosity of each patch, if it is its turn.
    pub fn record<V: Colour>(
        &mut self,
        iteration: usize,
        patches: &Patches<V>,
        radiosity: impl FnOnce() -> Vec<V>,
    ) -> Result<()> {
        match iteration.is_multiple_of(self.every) {
            true => self.write(iteration, patches, &radiosity()),
            false => Ok(()),
        }
    }

    /// Writes the frame of the solution, unless the last iteration had its turn.
    pub fn finish<V: Colour>(
        &mut self,
        iterations: usize,
        patches: &Patches<V>,
        radiosity: &[V],
    ) -> Result<()> {
        match iterations.is_multiple_of(self.every) && iterations > 0 {
            true => Ok(()),
            false => self.write(iterations, patches, radiosity),
        }
    }

    fn write<V: Colour>(&mut self, iteration: usize, patches: &Patches<V>, radiosity: &[V]) -> Result<()> {
        let start = Instant::now();
        let picture = self.preview.draw(radiosity);
        let exposed = |exposure| picture.develop(exposure);
        let image = self.exposure.map_or_else(|| map(&picture, patches, radiosity, self.units), exposed);
        self.files.push(write_png(self.folder.frame(iteration)?, &image)?);
        self.recording += start.elapsed().as_secs_f64();
        Ok(())
    }
}

/// The surfaces that make the exposure are lit by lamps too, and about this many times as bright as the mean.
const BRIGHT: f64 = 2.0;

/// One exposure for all frames, so that the light is seen to grow, and known before there is any: from the mean of
/// the reflected light, as the ambient term of progressive radiosity estimates it.
pub fn exposure<V: Colour>(patches: &Patches<V>, visibility: &Visibility) -> Exposure {
    let Patches { emission, reflectance, areas, .. } = patches;
    let lit = mean_irradiances(patches, visibility);
    let irradiance = estimated_rest(&source(emission, reflectance, &lit), reflectance, areas).to_rgb();
    let total: f64 = areas.iter().sum();
    let mean = |sum: Rgb, (rho, area): (&V, &f64)| sum + rho.to_rgb() * (area / total);
    let reflectance = reflectance.iter().zip(areas).fold(Rgb::splat(0.0), mean);
    let bright = reflectance * irradiance * (BRIGHT / PI);
    Exposure::automatic(&Picture { width: 1, height: 1, pixels: vec![bright] })
}
