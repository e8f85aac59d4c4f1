//! A function of two variables, in colours.

use kuva::plot::{ColorMap, Heatmap};
use kuva::render::layout::Layout;
use kuva::render::plots::Plot;
use std::sync::Arc;

/// A panel that shows a function of the plane.
#[derive(Debug)]
pub struct Map {
    /// What it shows.
    pub title: String,
    /// Its values, row by row from the least y; NaN outside of the domain.
    pub values: Vec<Vec<f64>>,
    /// Its left and its right end.
    pub x: [f64; 2],
    /// Its lower and its upper end.
    pub y: [f64; 2],
}

/// Pixels that title, axes and colour bar take.
const MARGINS: [f64; 2] = [220.0, 120.0];

/// Heights beyond this do not fit a screen.
const HEIGHTS: std::ops::RangeInclusive<f64> = 260.0..=900.0;

impl Map {
    /// The height at which a unit of y is as long as one of x.
    pub(super) fn height(&self, width: f64) -> f64 {
        let [across, up] = [self.x, self.y].map(|[least, most]| most - least);
        (MARGINS[1] + (width - MARGINS[0]) * up / across).clamp(*HEIGHTS.start(), *HEIGHTS.end())
    }

    pub(super) fn kuva(&self) -> (Vec<Plot>, Layout) {
        let map = Heatmap::new()
            .with_data(self.values.clone())
            .with_x_range(self.x[0], self.x[1])
            .with_y_range(self.y[0], self.y[1])
            .with_cell_size(1.0)
            .with_color_map(ColorMap::Custom(Arc::new(colour)));
        let plots = vec![map.into()];
        let layout = Layout::auto_from_plots(&plots)
            .with_title(self.title.as_str())
            .with_x_label("x")
            .with_y_label("y")
            .with_show_grid(false)
            .with_equal_aspect();
        (plots, layout)
    }
}

/// The palette whose lightness rises evenly; outside of the domain, the paper.
fn colour(t: f64) -> String {
    if t.is_nan() {
        return "#ffffff".to_owned();
    }
    ColorMap::Viridis.map(t)
}
