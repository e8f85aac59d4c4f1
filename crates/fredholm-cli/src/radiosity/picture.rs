//! The picture of the solution.

use super::args::{Quantity, Radiosity};
use super::domain::Domain;
use crate::args::name;
use crate::terminal::bar;
use anyhow::{Result, bail};
use image::RgbImage;
use radiosity::patches::Patches;
use radiosity::polygon::Polygon;
use radiosity::render::{
    Colour, Exposure, Picture, Preview, Scale, View, false_colour, final_picture, map_of_values,
};
use radiosity::scene::{Camera, Scene, Units};
use radiosity::solve::Solution;
use radiosity::visibility::Visibility;
use std::f64::consts::FRAC_1_PI;

/// What the map shows; its letters are in Latin-1.
pub const TITLE: &str = "radiosity, W/m² (luminance of the colours)";

/// Where the scene is looked at from, and how finely.
pub fn view<V>(args: &Radiosity, domain: &Domain<'_, V>) -> View {
    view_of(args, domain.scene, &domain.polygons, &domain.visibility)
}

/// The same for a scene that is not cut into patches.
pub fn view_of<V>(args: &Radiosity, scene: &Scene<V>, polygons: &[Polygon], visibility: &Visibility) -> View {
    let aspect = args.size.width as f64 / args.size.height as f64;
    let automatic = || Camera::automatic(polygons, visibility, aspect);
    View {
        camera: scene.camera.unwrap_or_else(automatic),
        width: args.size.width,
        height: args.size.height,
        samples: args.samples,
        gather: args.gather,
    }
}

/// Refuses a map of what is not known.
pub fn check_map(map: Option<Quantity>, units: Units) -> Result<()> {
    let Some(quantity) = map else { return Ok(()) };
    let name = name(&quantity);
    match quantity {
        Quantity::Temperature | Quantity::HeatFlux => {
            bail!("--map {name} is of heat; solve a thermal scene, with --thermal")
        }
        Quantity::Illuminance | Quantity::Luminance if units == Units::Radiometric => bail!(
            "--map {name} is in the eye's units; solve a photometric scene, with --photometric or `units = \"photometric\"`"
        ),
        Quantity::Illuminance | Quantity::Luminance => Ok(()),
    }
}

/// The final picture, as a photograph or as a map of numbers.
pub fn draw<V: Colour>(
    args: &Radiosity,
    domain: &Domain<'_, V>,
    units: Units,
    solution: &Solution<V>,
) -> RgbImage {
    let shown = match args.map {
        Some(Quantity::Illuminance) => Some((&solution.irradiance, 1.0, "illuminance, lx")),
        Some(Quantity::Luminance) => Some((&solution.radiosity, FRAC_1_PI, "luminance, cd/m²")),
        _ => None,
    };
    if let Some((values, factor, title)) = shown {
        let values: Vec<V> = values.iter().map(|value| *value * factor).collect();
        let scale = Scale::automatic(&domain.patches, &values);
        let numbers: Vec<f64> = values.iter().map(|value| value.channels()[0]).collect();
        return map_of_patches(args, domain, &numbers, &scale, title);
    }
    let view = view(args, domain);
    let bar = bar("picture", view.height as u64);
    let row = |done: usize| bar.set_position(done as u64);
    let Domain { scene, patches, visibility, .. } = domain;
    let radiosity = &solution.radiosity;
    let picture = final_picture(&view, scene, patches, visibility, radiosity, &row);
    bar.finish_and_clear();
    if args.false_colour {
        map(&picture, patches, radiosity, units)
    } else {
        picture.develop(Exposure::automatic(&picture))
    }
}

/// The picture in false colours, on a scale of its own: of the radiosity, or of the luminance where units are the eye's.
pub fn map<V: Colour>(picture: &Picture, patches: &Patches<V>, radiosity: &[V], units: Units) -> RgbImage {
    if units == Units::Radiometric {
        return false_colour(picture, &Scale::automatic(patches, radiosity), TITLE);
    }
    let luminances: Vec<V> = radiosity.iter().map(|b| *b * FRAC_1_PI).collect();
    let pixels = picture.pixels.iter().map(|pixel| *pixel * FRAC_1_PI).collect();
    let picture = Picture { pixels, ..*picture };
    false_colour(&picture, &Scale::automatic(patches, &luminances), "luminance, cd/m²")
}

/// A number of every patch as a colour.
pub fn map_of_patches<V: Colour>(
    args: &Radiosity,
    domain: &Domain<'_, V>,
    values: &[f64],
    scale: &Scale,
    title: &str,
) -> RgbImage {
    let view = view(args, domain);
    let preview = Preview::new(&view, &domain.polygons, &domain.patches, &domain.visibility);
    map_of_values(preview.values(values), (view.width, view.height), scale, title)
}
