//! The seconds that each stage takes.

use serde::Serialize;
use std::time::Instant;

/// Seconds of each stage.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Seconds {
    /// Reading the scene.
    pub load: f64,
    /// Cutting it into patches.
    pub patches: f64,
    /// Preparing the rays.
    pub visibility: f64,
    /// Finding what points, luminaires, suns and a sky send.
    pub lights: f64,
    /// Computing the form factors that are stored.
    pub form_factors: f64,
    /// Solving, without the frames.
    pub solve: f64,
    /// Drawing and writing the frames.
    pub frames: f64,
    /// Drawing the final picture.
    pub picture: f64,
    /// Writing the other files, but for the JSON.
    pub write: f64,
    /// All of it.
    pub total: f64,
}

/// Does some work and adds its time to a stage.
pub fn timed<T>(seconds: &mut f64, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    *seconds += start.elapsed().as_secs_f64();
    result
}
