//! Which files a run leaves, each prepared before the work begins.

use crate::json::Json;
use crate::output::{Output, refuse_twins};
use anyhow::Result;
use std::path::Path;

/// What was asked for.
pub struct Outputs {
    /// Numbers at the points.
    pub csv: Option<Output>,
    /// All of them.
    pub json: Option<Json>,
    /// A picture.
    pub plot: Option<Output>,
}

impl Outputs {
    /// Makes sure that all of them can be written.
    pub fn prepare(csv: Option<&Path>, json: Option<&Path>, plot: Option<&Path>) -> Result<Self> {
        refuse_twins(&[csv, json, plot])?;
        Ok(Self {
            csv: csv.map(Output::prepare).transpose()?,
            json: json.map(Json::prepare).transpose()?,
            plot: plot.map(Output::prepare).transpose()?,
        })
    }
}
