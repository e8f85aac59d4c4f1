//! The picture of the solution.

use super::args::Radiosity;
use super::domain::Domain;
use crate::terminal::bar;
use image::RgbImage;
use radiosity::patches::Patches;
use radiosity::render::{Colour, Exposure, Picture, Scale, View, false_colour, final_picture};
use radiosity::scene::Camera;

/// What the map shows; its letters are in Latin-1.
const TITLE: &str = "radiosity, W/m² (luminance of the colours)";

/// Where the scene is looked at from, and how finely.
pub fn view<V>(args: &Radiosity, domain: &Domain<'_, V>) -> View {
    let aspect = args.size.width as f64 / args.size.height as f64;
    let automatic = || Camera::automatic(&domain.polygons, &domain.visibility, aspect);
    View {
        camera: domain.scene.camera.unwrap_or_else(automatic),
        width: args.size.width,
        height: args.size.height,
        samples: args.samples,
        gather: args.gather,
    }
}

/// The final picture, as a photograph or as a map of numbers.
pub fn draw<V: Colour>(args: &Radiosity, domain: &Domain<'_, V>, radiosity: &[V]) -> RgbImage {
    let view = view(args, domain);
    let bar = bar("picture", view.height as u64);
    let row = |done: usize| bar.set_position(done as u64);
    let Domain { scene, patches, visibility, .. } = domain;
    let picture = final_picture(&view, scene, patches, visibility, radiosity, &row);
    bar.finish_and_clear();
    if args.false_colour {
        map(&picture, patches, radiosity)
    } else {
        picture.develop(Exposure::automatic(&picture))
    }
}

/// The picture in false colours, on a scale of its own.
pub fn map<V: Colour>(picture: &Picture, patches: &Patches<V>, radiosity: &[V]) -> RgbImage {
    false_colour(picture, &Scale::automatic(patches, radiosity), TITLE)
}
