//! The light that a page shows, as a file: the same writers as those of `fredholm radiosity`.

use super::kept::Kept;
use super::protocol::{Eye, Format, Moment, Shown};
use super::setup::Setup;
use super::solvers::Lane;
use super::stage::Stage;
use crate::radiosity::report::{Named, Surface, surfaces};
use anyhow::{Context, Result, anyhow, bail};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use fredholm::operator::Rows;
use fredholm::system::error_bound;
use fredholm::value::{Rgb, Spectrum, Value};
use image::ImageFormat;
use radiosity::bake::VertexLight;
use radiosity::elements::Space;
use radiosity::export::{Field, write_csv, write_exr_picture, write_npz, write_vertex_glb, write_vtu};
use radiosity::patches::Patches;
use radiosity::render::{Exposure, Picture, View, final_picture};
use radiosity::scene::{Camera, Scene, Units};
use rayon::prelude::*;
use serde::Serialize;
use serde_json::json;
use std::io::Cursor;

/// What is solved, and with which F.
#[derive(Clone, Copy)]
pub struct Source<'a> {
    /// The scene.
    pub stage: &'a Stage,
    /// What is solved in it.
    pub setup: &'a Setup,
    /// F.
    pub kept: &'a Kept<'a>,
    /// Whose coefficients the unknowns are.
    pub space: &'a Space<'a>,
}

/// The name of the file and its content.
pub fn export(
    source: Source<'_>,
    (lane, norm): (&Lane<'_>, f64),
    format: Format,
    camera: Option<Eye>,
    shown: Option<&Shown>,
) -> Result<(String, Vec<u8>)> {
    let Source { stage, setup, .. } = source;
    let of_shown = shown.map(|shown| {
        Setup::new(stage, setup.kind, setup.solvers.clone(), shown.lamps.clone(), shown.reflectance.clone())
    });
    let of_shown = of_shown.transpose()?;
    let setup = of_shown.as_ref().unwrap_or(setup);
    let newest = Moment { iteration: lane.iteration(), work: lane.work(), residual: lane.residual() };
    let (radiosity, moment) = match shown {
        Some(shown) => (colours(&shown.radiosity, stage.patches.len())?, shown.moment),
        None => (lane.shown(), Some(newest)),
    };
    let (scene, patches) = setup.applied(stage);
    let irradiance = irradiance(Source { setup, ..source }, &patches, &radiosity);
    let light = Light { stage, scene, patches, radiosity, irradiance };
    let (ending, content) = match format {
        Format::Csv => ("csv", light.table()?),
        Format::Npz => ("npz", light.arrays()?),
        Format::Vtu => ("vtu", light.cells()?),
        Format::Glb => ("glb", light.triangles(camera)?),
        Format::Json => ("json", light.report(setup, moment, norm)?),
        Format::Png => ("png", light.photograph(camera)?),
        Format::Exr => ("exr", light.radiance(camera)?),
    };
    Ok((format!("{}.{ending}", crate::radiosity::outputs::stem(&stage.scene.name)), content))
}

/// Reads what a page has encoded: a finite colour for each patch.
fn colours(text: &str, count: usize) -> Result<Vec<Rgb>> {
    let bytes = STANDARD.decode(text).context("the light that is shown is not base64")?;
    if bytes.len() != 12 * count {
        bail!("the light that is shown has {} bytes; {count} patches have {}", bytes.len(), 12 * count);
    }
    let numbers: Vec<f64> =
        bytes.chunks_exact(4).map(|b| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]))).collect();
    match numbers.iter().all(|number| number.is_finite()) {
        true => Ok(numbers.chunks_exact(3).map(|c| Spectrum([c[0], c[1], c[2]])).collect()),
        false => bail!("the light that is shown is not finite; restart with a method that converges"),
    }
}

/// H of each patch: (B − E)/ρ, and where a patch does not reflect, what its rows say.
fn irradiance(source: Source<'_>, patches: &Patches<Rgb>, radiosity: &[Rgb]) -> Vec<Rgb> {
    let Source { setup, kept, space, .. } = source;
    let unknowns = space.spread(radiosity);
    let of = |buffer: &mut Vec<f64>, i: usize| {
        let (b, e, rho) = (radiosity[i], patches.emission[i], patches.reflectance[i]);
        if rho.channels().iter().all(|rho| *rho > 0.0) {
            return (b - e) / rho;
        }
        let range = space.range(i);
        let area: f64 = space.weights()[range.clone()].iter().sum();
        range.fold(Rgb::splat(0.0), |sum, a| {
            sum + (kept.row(a, buffer).dot(&unknowns) + setup.lit[a]) * (space.weights()[a] / area)
        })
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

    fn cells(&self) -> Result<Vec<u8>> {
        let mut bytes = Vec::new();
        match self.stage.units {
            Units::Radiometric => write_vtu(&self.field(), &mut bytes)?,
            Units::Photometric => self.grey(|field| Ok(write_vtu(field, &mut bytes)?))?,
        }
        Ok(bytes)
    }

    fn triangles(&self, camera: Option<Eye>) -> Result<Vec<u8>> {
        let Self { stage, scene, patches, radiosity, .. } = self;
        let camera = camera.map_or_else(|| Ok(stage.camera()), looking)?;
        let light = VertexLight::of_patches(scene, patches, radiosity);
        let extras = json!({
            "quantity": "radiance that leaves the surface, B/π: COLOR_0, linear, × extras.radiance_of_1 of the material",
            "unit": stage.units.radiance(),
        });
        let mut bytes = Vec::new();
        write_vertex_glb(scene, &light, &camera, &extras, &mut bytes)?;
        Ok(bytes)
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

    fn report(&self, setup: &Setup, moment: Option<Moment>, norm: f64) -> Result<Vec<u8>> {
        let Self { stage, scene, patches, radiosity, irradiance } = self;
        let discrete = stage.discrete(setup.kind);
        let report = Report {
            scene: &scene.name,
            patches: patches.len(),
            patch_size: stage.how.size,
            method: setup.kind.method,
            space: setup.kind.space,
            unknowns: discrete.dim(),
            state: if moment.is_some() { "a moment of the solver" } else { "a sum over lamps" },
            solver: setup.solvers[0],
            iterations: moment.map(|moment| moment.iteration),
            passes: moment.map(|moment| moment.work),
            residual: moment.map(|moment| moment.residual),
            target: setup.target,
            error_bound: moment.and_then(|moment| error_bound(moment.residual, norm)),
            norm: Some(norm).filter(|norm| norm.is_finite()),
            lamps: discrete
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

    fn photograph(&self, camera: Option<Eye>) -> Result<Vec<u8>> {
        let picture = self.picture(camera)?;
        let image = picture.develop(Exposure::automatic(&picture));
        let mut bytes = Cursor::new(Vec::new());
        image.write_to(&mut bytes, ImageFormat::Png)?;
        Ok(bytes.into_inner())
    }

    fn radiance(&self, camera: Option<Eye>) -> Result<Vec<u8>> {
        let unit = self.stage.units.radiance().replace('²', "^2");
        let note = format!("radiance L in {unit}, linear, Rec. 709");
        let mut bytes = Vec::new();
        write_exr_picture(&self.picture(camera)?, &note, &mut bytes)?;
        Ok(bytes)
    }

    fn picture(&self, camera: Option<Eye>) -> Result<Picture> {
        let Self { stage, scene, patches, radiosity, .. } = self;
        let (camera, aspect) = match camera {
            Some(eye) => (looking(eye)?, eye.aspect),
            None => (stage.camera(), 1.0),
        };
        let aspect = aspect.clamp(0.25, 4.0);
        let (width, height) = ((SIDE * aspect.sqrt()) as usize, (SIDE / aspect.sqrt()) as usize);
        let view = View { camera, width, height, samples: 9, gather: 64 };
        Ok(final_picture(&view, scene, patches, &stage.visibility, radiosity, &|_| ()))
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
    method: crate::radiosity::args::Method,
    space: crate::radiosity::args::Space,
    unknowns: usize,
    /// Of which these numbers are.
    state: &'static str,
    solver: super::solvers::Solver,
    /// None of a sum over lamps, as the next three.
    iterations: Option<usize>,
    /// Form factors used over n², n the number of unknowns.
    passes: Option<f64>,
    residual: Option<f64>,
    target: f64,
    error_bound: Option<f64>,
    norm: Option<f64>,
    /// How many times as bright as in the file.
    lamps: std::collections::BTreeMap<&'a str, f64>,
    units: Named,
    surfaces: Vec<Surface>,
}
