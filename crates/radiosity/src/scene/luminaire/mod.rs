//! Luminaires: I(C, γ) in cd from a photometric file, as a point light that is placed and aimed.
//!
//! Both formats have the C-planes of CIE 121: γ is the angle from the axis, which is straight down unless the luminaire is
//! aimed, C the angle about it. Hanging as it was measured, a luminaire has C = 0 towards the east and C = 90 towards the
//! north, so that C grows counter-clockwise seen from above.

pub(super) mod entry;
mod ies;
mod ldt;
mod numbers;
mod web;

pub use web::Web;

use super::error::{Error, Place, Problem, Warning};
use super::text;
use glam::{DMat3, DQuat, DVec3};
use std::path::Path;
use std::sync::Arc;

/// A measured distribution, as a luminaire is aimed.
#[derive(Clone, Debug, PartialEq)]
pub struct Aimed {
    /// What was measured.
    pub web: Arc<Web>,
    /// Its axes in the scene: C = 0 and C = 90 at γ = 90, and what is above.
    axes: DMat3,
}

impl Aimed {
    /// A luminaire turned counter-clockwise seen from above, in radians, and then tilted the shortest way so that it looks along
    /// the unit vector `aim`; straight up it is tilted about its C = 0.
    pub fn new(web: Arc<Web>, [east, north, up]: [DVec3; 3], turn: f64, aim: DVec3) -> Self {
        let (sine, cosine) = turn.sin_cos();
        let hanging = DMat3::from_cols(east * cosine + north * sine, north * cosine - east * sine, up);
        let tilt = if aim.dot(up) > 1.0 - 1e-12 {
            DQuat::from_axis_angle(hanging.x_axis, std::f64::consts::PI)
        } else {
            DQuat::from_rotation_arc(-up, aim)
        };
        Self { web, axes: DMat3::from_quat(tilt) * hanging }
    }

    /// The part of the largest intensity in a direction, a unit vector away from the luminaire.
    pub(crate) fn part(&self, direction: DVec3) -> f64 {
        let [x, y, z] = (self.axes.transpose() * direction).to_array();
        let gamma = x.hypot(y).atan2(-z).to_degrees();
        self.web.at(y.atan2(x).to_degrees(), gamma) / self.web.largest()
    }
}

/// Reads a photometric file; `named_at` is where its name stands.
fn read(file: &Path, named_at: &Place) -> Result<(Web, Vec<Warning>), Error> {
    let bytes = text::bytes(file, named_at)?;
    // Names of firms come in all encodings; what counts is digits.
    let text = String::from_utf8_lossy(&bytes);
    let kind = file.extension().map_or_else(String::new, |kind| kind.to_string_lossy().to_lowercase());
    let (web, told) = match kind.as_str() {
        "ies" => ies::read(&text).map_err(|fault| fault.of(file))?,
        "ldt" => ldt::read(&text).map_err(|fault| fault.of(file))?,
        other => {
            let what =
                format!("files of the kind `{other}` are no luminaires; these are read from .ies and .ldt");
            return Err(Problem::Malformed(what).at(named_at.clone()));
        }
    };
    if web.largest() == 0.0 {
        let what = "the luminaire gives no light: all of its intensities are 0".to_owned();
        return Err(Problem::Malformed(what).at(Place::file(file)));
    }
    let told = told.into_iter().map(|message| Warning { place: Place::file(file), message });
    Ok((web, told.collect()))
}
