//! Pictures of functions: curves on linear or logarithmic axes, maps of the plane; as SVG or PNG by the file's name.

mod axis;
mod curves;
mod map;

pub use axis::Scale;
pub use curves::{Axis, Curve, Curves};
pub use map::Map;

use crate::output::Output;
use anyhow::{Result, anyhow};
use kuva::backend::raster::RasterBackend;
use kuva::backend::svg::SvgBackend;
use kuva::render::figure::Figure as Kuva;
use kuva::render::layout::Layout;
use kuva::render::plots::Plot;
use std::io::Write;
use std::path::PathBuf;

/// A picture: panels, one below the other.
#[derive(Debug)]
pub struct Figure {
    /// What stands above all.
    pub title: String,
    /// From top to bottom.
    pub panels: Vec<Panel>,
}

/// A part of a picture with axes of its own.
#[derive(Debug)]
pub enum Panel {
    /// Functions of one variable.
    Curves(Curves),
    /// A function of two.
    Map(Map),
}

/// Pixels of an SVG across; a PNG has twice as many, for screens of today.
const WIDTH: f64 = 800.0;
const PNG_SCALE: f32 = 2.0;

/// Letters of a title that fit the width.
const TITLE_LETTERS: usize = 90;

impl Panel {
    fn height(&self) -> f64 {
        match self {
            Self::Curves(curves) => curves.height,
            Self::Map(map) => map.height(WIDTH),
        }
    }

    fn kuva(&self) -> (Vec<Plot>, Layout) {
        match self {
            Self::Curves(curves) => curves.kuva(),
            Self::Map(map) => map.kuva(),
        }
    }
}

impl Figure {
    /// Draws it into a file, whose name says in which format.
    pub fn write(&self, output: Output) -> Result<PathBuf> {
        let scene = self.kuva().render();
        let is_png = output.path().extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png"));
        let bytes = if is_png {
            let raster = RasterBackend::new().with_scale(PNG_SCALE);
            raster.render_scene(&scene).map_err(|error| anyhow!("cannot draw the picture: {error}"))?
        } else {
            SvgBackend::default().render_scene(&scene).into_bytes()
        };
        output.write(|out| out.write_all(&bytes))
    }

    fn kuva(&self) -> Kuva {
        let (plots, layouts): (Vec<_>, Vec<_>) = self.panels.iter().map(Panel::kuva).unzip();
        let figure = Kuva::new(plots.len(), 1)
            .with_title(shortened(&self.title, TITLE_LETTERS))
            .with_title_size(14)
            .with_plots(plots)
            .with_layouts(layouts)
            .with_cell_size(WIDTH, 1.0);
        let heights = self.panels.iter().map(Panel::height).enumerate();
        heights.fold(figure, |figure, (row, height)| figure.with_row_height(row, height))
    }
}

fn shortened(text: &str, letters: usize) -> String {
    match text.char_indices().nth(letters) {
        None => text.to_owned(),
        Some((end, _)) => format!("{}…", &text[..end]),
    }
}
