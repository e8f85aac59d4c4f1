//! The light as it is now, as a file: the same writers as those of `fredholm radiosity`.

use super::protocol::{Eye, Format};
use super::setup::Setup;
use super::solvers::Lane;
use super::stage::Stage;
use crate::radiosity::report::{Named, Surface, surfaces};
use anyhow::{Context, Result, anyhow};
use fredholm::operator::Rows;
use fredholm::system::error_bound;
use fredholm::value::{Rgb, Value};
use image::ImageFormat;
use radiosity::export::{Field, write_csv, write_npz};
use radiosity::patches::Patches;
use radiosity::render::{Exposure, View, final_picture};
use radiosity::scene::{Camera, Scene, Units};
use rayon::prelude::*;
use serde::Serialize;
use std::io::Cursor;

/// The name of the file and its content.
pub fn export(
    stage: &Stage,
    setup: &Setup,
    (lane, kept): (&Lane<'_>, &impl Rows),
    format: Format,
    camera: Option<Eye>,
) -> Result<(String, Vec<u8>)> {
    let (scene, patches) = setup.applied(stage);
    let radiosity = lane.shown();
    let light =
        Light { stage, scene, irradiance: irradiance(&patches, setup, kept, &radiosity), patches, radiosity };
    let (ending, content) = match format {
        Format::Csv => ("csv", light.table()?),
        Format::Npz => ("npz", light.arrays()?),
        Format::Json => ("json", light.report(setup, lane)?),
        Format::Png => ("png", light.picture(camera)?),
    };
    Ok((format!("{}.{ending}", crate::radiosity::outputs::stem(&stage.scene.name)), content))
}

/// H of each patch: (B − E)/ρ, and where a patch does not reflect, what its row says.
fn irradiance(patches: &Patches<Rgb>, setup: &Setup, kept: &impl Rows, radiosity: &[Rgb]) -> Vec<Rgb> {
    let of = |buffer: &mut Vec<f64>, i: usize| {
        let (b, e, rho) = (radiosity[i], patches.emission[i], patches.reflectance[i]);
        if rho.channels().iter().all(|rho| *rho > 0.0) {
            (b - e) / rho
        } else {
            kept.row(i, buffer).dot(radiosity) + setup.lit[i]
        }
    };
    (0..radiosity.len()).into_par_iter().map_init(Vec::new, of).collect()
}

/// What is written.
struct Light<'a> {
    stage: &'a Stage,
    scene: Scene<Rgb>,
    patches: Patches<Rgb>,
    radiosity: Vec<Rgb>,
    irradiance: Vec<Rgb>,
}

impl Light<'_> {
    fn table(&self) -> Result<Vec<u8>> {
        let mut bytes = Vec::new();
        match self.stage.units {
            Units::Radiometric => write_csv(&self.field(), &mut bytes)?,
            Units::Photometric => self.grey(|field| Ok(write_csv(field, &mut bytes)?))?,
        }
        Ok(bytes)
    }

    fn arrays(&self) -> Result<Vec<u8>> {
        let mut bytes = Cursor::new(Vec::new());
        match self.stage.units {
            Units::Radiometric => write_npz(&self.field(), &mut bytes)?,
            Units::Photometric => self.grey(|field| Ok(write_npz(field, &mut bytes)?))?,
        }
        Ok(bytes.into_inner())
    }

    fn field(&self) -> Field<'_, Rgb> {
        let light = (self.radiosity.as_slice(), self.irradiance.as_slice());
        Field::light(&self.scene, &self.patches, light, self.stage.units)
    }

    /// The one channel of a photometric scene.
    fn grey(&self, write: impl FnOnce(&Field<'_, f64>) -> Result<()>) -> Result<()> {
        let one = |values: &[Rgb]| -> Vec<f64> { values.iter().map(|value| value.0[0]).collect() };
        let scene = super::setup::grey(&self.scene);
        let mut patches = Patches::new(&scene, self.stage.how.size)?;
        (patches.emission, patches.reflectance) =
            (one(&self.patches.emission), one(&self.patches.reflectance));
        let (radiosity, irradiance) = (one(&self.radiosity), one(&self.irradiance));
        write(&Field::light(&scene, &patches, (&radiosity, &irradiance), self.stage.units))
    }

    fn report(&self, setup: &Setup, lane: &Lane<'_>) -> Result<Vec<u8>> {
        let Self { stage, scene, patches, radiosity, irradiance } = self;
        let norm = stage.norm(&patches.reflectance);
        let report = Report {
            scene: &scene.name,
            patches: patches.len(),
            patch_size: stage.how.size,
            solver: setup.solvers[0],
            iterations: lane.iteration(),
            passes: lane.work(),
            residual: lane.residual(),
            target: setup.target,
            error_bound: error_bound(lane.residual(), norm),
            norm,
            lamps: stage
                .lamps
                .iter()
                .map(|lamp| lamp.name.as_str())
                .zip(setup.gains.iter().copied())
                .collect(),
            units: Named::new(stage.units),
            surfaces: surfaces(scene, patches, stage.units, (radiosity, irradiance)),
        };
        let mut text = serde_json::to_vec_pretty(&report)?;
        text.push(b'\n');
        Ok(text)
    }

    fn picture(&self, camera: Option<Eye>) -> Result<Vec<u8>> {
        let Self { stage, scene, patches, radiosity, .. } = self;
        let (camera, aspect) = match camera {
            Some(eye) => (looking(eye)?, eye.aspect),
            None => (stage.camera(), 1.0),
        };
        let aspect = aspect.clamp(0.25, 4.0);
        let (width, height) = ((SIDE * aspect.sqrt()) as usize, (SIDE / aspect.sqrt()) as usize);
        let view = View { camera, width, height, samples: 9, gather: 64 };
        let picture = final_picture(&view, scene, patches, &stage.visibility, radiosity, &|_| ());
        let image = picture.develop(Exposure::automatic(&picture));
        let mut bytes = Cursor::new(Vec::new());
        image.write_to(&mut bytes, ImageFormat::Png)?;
        Ok(bytes.into_inner())
    }
}

/// The side of a square picture, in pixels, and the root of the area of any other.
const SIDE: f64 = 800.0;

/// The page's camera, checked.
fn looking(eye: Eye) -> Result<Camera> {
    let camera = Camera {
        position: eye.position.into(),
        target: eye.target.into(),
        up: eye.up.into(),
        vertical_angle: eye.vertical_angle.to_radians(),
    };
    camera.check().map_err(|problem| anyhow!("{problem}")).context("there is no picture from that camera")?;
    match eye.aspect > 0.0 && eye.aspect.is_finite() {
        true => Ok(camera),
        false => Err(anyhow!("a picture {} times as wide as high is none", eye.aspect)),
    }
}

/// How the light is, and how well it is known.
#[derive(Serialize)]
struct Report<'a> {
    scene: &'a str,
    patches: usize,
    patch_size: f64,
    solver: super::solvers::Solver,
    iterations: usize,
    /// Form factors used over n².
    passes: f64,
    residual: f64,
    target: f64,
    error_bound: Option<f64>,
    norm: f64,
    /// How many times as bright as in the file.
    lamps: std::collections::BTreeMap<&'a str, f64>,
    units: Named,
    surfaces: Vec<Surface>,
}
