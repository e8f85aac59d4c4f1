//! work ≤ ∫ rate dt: how far the solvers may have come, in passes (n² form factors), at the speed that a page asks for.

use std::time::{Duration, Instant};

/// From one frame to the next while it plays: what a screen shows.
const FRAME: Duration = Duration::from_millis(33);

/// The longest that a frame is worked on: a solver that cannot keep up still shows ten frames a second and more.
const PATIENCE: Duration = Duration::from_millis(60);

/// The speed and the work that is due.
pub struct Pace {
    rate: Option<f64>,
    due: f64,
    last: Instant,
}

impl Pace {
    /// At rest, with no work due.
    pub fn new() -> Self {
        Self { rate: None, due: 0.0, last: Instant::now() }
    }

    /// From now on so many passes a second, or none.
    pub fn set(&mut self, rate: Option<f64>) {
        self.rate = rate;
        self.last = Instant::now();
    }

    /// Whether it goes on by itself.
    pub fn is_playing(&self) -> bool {
        self.rate.is_some()
    }

    /// Begins anew at the same speed.
    pub fn restart(&mut self) {
        self.due = 0.0;
        self.last = Instant::now();
    }

    /// How long until the next frame.
    pub fn rest(&self) -> Option<Duration> {
        self.rate.map(|_| FRAME.saturating_sub(self.last.elapsed()))
    }

    /// The work that is due now, and when to stop working on it.
    pub fn tick(&mut self) -> (f64, Instant) {
        let now = Instant::now();
        self.due += self.rate.unwrap_or(0.0) * (now - self.last).as_secs_f64();
        self.last = now;
        (self.due, now + PATIENCE)
    }

    /// What was really done: nothing is owed when the solvers do not keep up, and a step by hand counts.
    pub fn done(&mut self, work: f64, late: bool) {
        self.due = if late { work } else { self.due.max(work) };
    }
}
