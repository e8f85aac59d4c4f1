//! Functions of one variable.

use super::axis::Scale;
use kuva::plot::legend::LegendPosition;
use kuva::plot::{LinePlot, ScatterPlot};
use kuva::render::layout::Layout;
use kuva::render::plots::Plot;

/// A panel of curves.
#[derive(Debug)]
pub struct Curves {
    /// Across.
    pub x: Axis,
    /// Up.
    pub y: Axis,
    /// What is drawn.
    pub curves: Vec<Curve>,
    /// In pixels.
    pub height: f64,
}

/// An axis with its name.
#[derive(Clone, Debug)]
pub struct Axis {
    /// What stands beside it.
    pub name: &'static str,
    /// How it runs.
    pub scale: Scale,
}

/// A line through points, with a name for the legend.
#[derive(Clone, Debug)]
pub struct Curve {
    /// In the legend; empty for none.
    pub name: String,
    /// x and y, from left to right; what is not finite is left out.
    pub points: Vec<[f64; 2]>,
    /// Whether the points themselves are shown.
    pub marks: bool,
    /// Whether the line is dashed.
    pub dashed: bool,
}

/// Ten colours that can be told apart.
const COLOURS: [&str; 10] = [
    "#1f77b4", "#d62728", "#2ca02c", "#ff7f0e", "#9467bd", "#8c564b", "#e377c2", "#17becf", "#bcbd22",
    "#7f7f7f",
];

impl Curve {
    /// A line.
    pub fn line(name: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Self { name: name.into(), points, marks: false, dashed: false }
    }
}

impl Curves {
    pub(super) fn kuva(&self) -> (Vec<Plot>, Layout) {
        let placed: Vec<Vec<(f64, f64)>> = self.curves.iter().map(|curve| self.placed(curve)).collect();
        let drawn = self.curves.iter().zip(&placed).enumerate();
        let plots: Vec<Plot> = drawn.flat_map(|(k, (curve, points))| curve.kuva(points, k)).collect();
        let mut layout = Layout::auto_from_plots(&plots)
            .with_x_label(self.x.name)
            .with_y_label(self.y.name)
            .with_x_tick_format(self.x.scale.format())
            .with_y_tick_format(self.y.scale.format())
            .with_legend_position(LegendPosition::OutsideRightTop);
        let all = || placed.iter().flatten();
        if let Some((least, most, step)) = self.x.scale.ticks(all().map(|p| p.0)) {
            layout = layout.with_x_axis_min(least).with_x_axis_max(most).with_x_tick_step(step);
        } else if let Some((least, most)) = range(all().map(|p| p.0)) {
            layout = layout.with_x_axis_min(least).with_x_axis_max(most);
        }
        if let Some((least, most, step)) = self.y.scale.ticks(all().map(|p| p.1)) {
            layout = layout.with_y_axis_min(least).with_y_axis_max(most).with_y_tick_step(step);
        }
        (plots, layout)
    }

    fn placed(&self, curve: &Curve) -> Vec<(f64, f64)> {
        let finite = curve.points.iter().filter(|point| point.iter().all(|c| c.is_finite()));
        finite.map(|[x, y]| (self.x.scale.position(*x), self.y.scale.position(*y))).collect()
    }
}

/// The least and the greatest, if they differ.
fn range(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    let ends = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, m), v| (l.min(v), m.max(v)));
    (ends.0 < ends.1).then_some(ends)
}

impl Curve {
    fn kuva(&self, points: &[(f64, f64)], k: usize) -> Vec<Plot> {
        let colour = COLOURS[k % COLOURS.len()];
        let mut line = LinePlot::new().with_data(points.to_vec()).with_color(colour).with_stroke_width(1.8);
        if !self.name.is_empty() {
            line = line.with_legend(self.name.as_str());
        }
        // A second round through the colours is told apart by its dashes.
        if self.dashed || k >= COLOURS.len() {
            line = line.with_dashed();
        }
        let marks = ScatterPlot::new().with_data(points.to_vec()).with_color(colour).with_size(3.0);
        let marks = self.marks.then(|| marks.into());
        std::iter::once(line.into()).chain(marks).collect()
    }
}
